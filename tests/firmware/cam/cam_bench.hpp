// What the tests of the electronic cam share: units of a tick of 62.5 us, tables of real motions, and a watch over
// set-points that knows nothing of cams: differences of positions, speeds and accelerations alone.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "sim/cam/motion.hpp"
#include "sim/cam/segment_table.hpp"
#include "stiction/motion/cam_motion.hpp"
#include "stiction/motion/master.hpp"

namespace stiction::test {

inline constexpr double rate = 16000.0;  // 1/s

inline std::int64_t raw_position(double x) { return std::llround(std::ldexp(x, 40)); }
inline std::int64_t raw_velocity(double v) { return std::llround(std::ldexp(v / rate, 52)); }
inline std::int64_t raw_acceleration(double a) { return std::llround(std::ldexp(a / rate / rate, 64)); }
inline std::int64_t raw_jerk(double j) { return std::llround(std::ldexp(j / rate / rate / rate, 76)); }
inline double position_of(std::int64_t raw) { return std::ldexp(static_cast<double>(raw), -40); }
inline double velocity_of(std::int64_t raw) { return std::ldexp(static_cast<double>(raw), -52) * rate; }
inline double acceleration_of(std::int64_t raw) { return std::ldexp(static_cast<double>(raw), -64) * rate * rate; }
inline double jerk_of(std::int64_t raw) { return std::ldexp(static_cast<double>(raw), -76) * rate * rate * rate; }
// In cycles/s, as VirtualMaster::run takes it.
inline std::int64_t master_speed(double cycles) { return std::llround(std::ldexp(cycles / rate, 64)); }

// Cycles, of a place whose double has the digits for it.
inline double cycles_of(const MasterPosition& at) {
  return static_cast<double>(at.cycles) + std::ldexp(static_cast<double>(at.phase), -64);
}

inline MotionLimits limits(double v, double a, double j) { return {raw_velocity(v), raw_acceleration(a), raw_jerk(j)}; }

// A motion and its table, which stay where they are.
struct TestCam {
  sim::cam::Motion motion;
  std::vector<std::uint8_t> bytes;
  CamTable table;
};

// `tolerance`: of the table, in the slave's unit.
inline std::unique_ptr<TestCam> test_cam(const sim::cam::Cam& cam, double tolerance = 1e-10) {
  auto made = std::make_unique<TestCam>();
  made->motion = sim::cam::compose(cam);
  // Some parts, at least, where a whole number is asked for.
  made->bytes = (tolerance < 1.0 ? sim::cam::table_within(made->motion, tolerance)
                                 : sim::cam::table_of_parts(made->motion, static_cast<int>(tolerance)))
                    .bytes;
  EXPECT_EQ(CamTable::read(made->bytes, made->table), CamTableProblem::none);
  return made;
}

// The checksum of a table's `bytes` that were changed.
inline void sign(std::vector<std::uint8_t>& bytes) {
  const std::size_t end = bytes.size() - CamTable::checksum_size;
  const std::uint32_t sum = Crc32{}.add(bytes, end).value();
  for (std::size_t k = 0; k < 4; ++k) bytes[end + k] = static_cast<std::uint8_t>(sum >> (8 * k));
}

// The motion in double precision: position, and its first and second derivative over cycles, at `x` cycles.
struct TrueSlopes {
  double position, slope, bend;
};
inline TrueSlopes truth(const TestCam& cam, double x) {
  const auto& curve = cam.motion.curve;
  const double cycle = cam.motion.cam.cycle(), turns = std::floor(x), at = (x - turns) * cycle;
  const double rise = curve.derivative(curve.end(), 0, sim::cam::Side::left) - curve(0.0);
  const auto d = [&](int order) { return curve.derivative(at, order, sim::cam::Side::right); };
  return {d(0) + turns * rise, d(1) * cycle, d(2) * cycle * cycle};
}

// Rise, dwell, return, dwell, as a periodic cam of `stroke`.
inline sim::cam::Cam rise_and_return(const std::string& law, double stroke, bool periodic = true) {
  sim::cam::Cam cam{.name = "a", .periodic = periodic};
  cam.segments = {{.length = 2.0, .stroke = stroke, .law = law},
                  {.length = 0.8},
                  {.length = 2.4, .stroke = -stroke, .law = law},
                  {.length = 1.0}};
  return cam;
}

// The worst of what set-points did, from one tick to the next, against the limits of their axis.
class Watch {
 public:
  explicit Watch(const MotionLimits& limits)
      : velocity_(velocity_of(limits.velocity)),
        acceleration_(acceleration_of(limits.acceleration)),
        jerk_(jerk_of(limits.jerk)) {}

  void see(const MotionPoint& p) {
    const double v = velocity_of(p.velocity), a = acceleration_of(p.acceleration);
    over_velocity = std::max(over_velocity, std::abs(v) - velocity_);
    over_acceleration = std::max(over_acceleration, std::abs(a) - acceleration_);
    if (seen_) {
      const double v0 = velocity_of(last_.velocity), a0 = acceleration_of(last_.acceleration);
      // Hermite's quadrature: exact to the fourth degree, so that but for a joint of the curve within the tick nothing
      // is left of a motion without a jump.
      const double way = position_of(p.position - last_.position);
      position_jump = std::max(position_jump, std::abs(way - (v0 + v) / 2 / rate + (a - a0) / 12 / rate / rate));
      // That of a trapezoid with slopes of up to J.
      speed_jump = std::max(speed_jump, std::abs(v - v0 - (a0 + a) / 2 / rate) - jerk_ / 4 / rate / rate);
      over_jerk = std::max(over_jerk, std::abs(a - a0) * rate - jerk_);
    }
    last_ = p;
    seen_ = true;
  }

  // The next set-point is not compared with the one before.
  void begin() { seen_ = false; }

  double position_jump = 0.0, speed_jump = 0.0;
  double over_velocity = 0.0, over_acceleration = 0.0, over_jerk = 0.0;

 private:
  double velocity_, acceleration_, jerk_;
  MotionPoint last_{};
  bool seen_ = false;
};

// Units that jumps and excesses are held to: those of the position controller's deviations, of speeds and accelerations
// in stiction/number/fixed_signals.hpp.
inline constexpr double position_unit = 0x1p-32, velocity_unit = 0x1p-28, acceleration_unit = 0x1p-22;

}  // namespace stiction::test
