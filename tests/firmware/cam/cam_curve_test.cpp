// Curves: their joints, slopes and bounds against the motion in double precision, offsets and scales in both dialects,
// and what is refused.
#include "stiction/motion/cam_curve.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/firmware/cam/cam_bench.hpp"
#include "tests/sim/cam/random_motion.hpp"
#include "tests/support/figure.hpp"

namespace stiction {
namespace {

CamCurve curve_of(const CamCurve::Config& config) {
  CamCurve curve;
  EXPECT_EQ(CamCurve::prepare(config, curve), CamRefusal::none);
  return curve;
}

// Laws that are continuous in their acceleration, of 90 degrees each way, at 130/min: what a set-point does where the
// phase goes by 2^-64 cycles from one segment into the next.
TEST(CamCurve, JointsAndSeamAreContinuousInIntegers) {
  double position = 0.0, velocity = 0.0, acceleration = 0.0;
  int joints = 0;
  for (const char* law : {"3-4-5", "4-5-6-7", "sloping_sine", "modified_sine", "modified_trapezoid"}) {
    sim::cam::Cam cam = test::rise_and_return(law, 1.5707963);
    const auto made = test::test_cam(cam);
    const CamCurve curve = curve_of({.table = &made->table});
    const std::int64_t speed = test::raw_velocity(130.0 / 60.0);
    for (std::uint32_t k = 0; k < made->table.header().count; ++k, ++joints) {
      const std::uint64_t start = std::uint64_t{made->table.segment(k).start} << 32;
      const MasterPosition after{1, start}, before = after + MasterPosition::fine(-1);
      const auto off = CamCurve::chained(curve.slopes(after), {after, speed, 0}) -
                       CamCurve::chained(curve.slopes(before), {before, speed, 0});
      position = std::max(position, std::abs(test::position_of(off.position)));
      velocity = std::max(velocity, std::abs(test::velocity_of(off.velocity)));
      acceleration = std::max(acceleration, std::abs(test::acceleration_of(off.acceleration)));
    }
  }
  test::figure("cam curve: joints and seam, position, velocity, acceleration",
               fmt::format("{:.2f} of 2^-32 rad, {:.2f} of 2^-28 rad/s, {:.2f} of 2^-22 rad/s^2 at {} joints (wanted "
                           "2, 2, 4)",
                           position / test::position_unit, velocity / test::velocity_unit,
                           acceleration / test::acceleration_unit, joints));
  EXPECT_LE(position, 2 * test::position_unit);
  EXPECT_LE(velocity, 2 * test::velocity_unit);
  EXPECT_LE(acceleration, 4 * test::acceleration_unit);
}

TEST(CamCurve, FollowsTheMotionAndItsChainRule) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    sim::cam::RandomMotion random(seed);
    const auto made = test::test_cam(seed % 2 == 0 ? random.rests(4) : random.septics(4));
    const double scale = random.between(-2.0, 2.0), offset = random.between(-3.0, 3.0);
    const double master_offset = random.between(0.0, 1.0), ratio = -7.0 / 3.0;
    const CamCurve curve = curve_of({.table = &made->table,
                                     .ratio = GearRatio(-7, 3),
                                     .master_offset = MasterPosition::way(test::raw_position(master_offset)),
                                     .slave_scale = std::llround(scale * 0x1p32),
                                     .slave_offset = test::raw_position(offset)});
    // Errors of the table, as proven.
    const auto& h = made->table.header();
    const double speed_bound = std::ldexp(static_cast<double>(h.speed_bound), -h.speed_bits);
    const double bend_bound = std::ldexp(static_cast<double>(h.acceleration_bound), -h.acceleration_bits);
    const double speed = 1.3, change = -4.0;
    for (int k = 0; k < 500; ++k) {
      const double at = random.between(-5.0, 5.0), x = ratio * at + master_offset;
      const MasterPoint master{MasterPosition::way(test::raw_position(at)), test::raw_velocity(speed),
                               test::raw_acceleration(change)};
      const MasterPoint seen = curve.seen(master);
      EXPECT_NEAR(test::cycles_of(seen.position), x, 1e-11);
      const MotionPoint point = CamCurve::chained(curve.slopes(seen.position), seen);
      const auto t = test::truth(*made, x);
      const double v = ratio * speed, a = ratio * change;
      EXPECT_NEAR(test::position_of(point.position), scale * t.position + offset, 3e-9);
      EXPECT_NEAR(test::velocity_of(point.velocity), scale * t.slope * v, std::abs(scale * v) * speed_bound + 1e-8);
      EXPECT_NEAR(test::acceleration_of(point.acceleration), scale * (t.bend * v * v + t.slope * a),
                  std::abs(scale) * (v * v * bend_bound + std::abs(a) * speed_bound) + 1e-6);
    }
  }
}

// Bounds hold everywhere, and are near what is reached.
TEST(CamCurve, BoundsItsSlopes) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    sim::cam::RandomMotion random(seed);
    const auto made = test::test_cam(seed % 2 == 0 ? random.rests(4) : random.septics(4));
    const CamCurve curve = curve_of({.table = &made->table, .slave_scale = std::int64_t{3} << 31});
    double slope = 0.0, bend = 0.0, third = 0.0;
    const double cycle = made->motion.cam.cycle();
    for (int k = 0; k < 50'000; ++k) {
      const double x = random.between(0.0, 1.0);
      const auto t = test::truth(*made, x);
      slope = std::max(slope, 1.5 * std::abs(t.slope));
      bend = std::max(bend, 1.5 * std::abs(t.bend));
      third = std::max(third, 1.5 * std::abs(made->motion.curve.derivative(x * cycle, 3, sim::cam::Side::right)) *
                                  cycle * cycle * cycle);
    }
    EXPECT_GE(test::position_of(curve.peaks().slope), slope * 0.99999) << seed;
    EXPECT_LE(test::position_of(curve.peaks().slope), slope * 1.1) << seed;
    EXPECT_GE(test::position_of(curve.peaks().bend), bend * 0.9995) << seed;
    EXPECT_LE(test::position_of(curve.peaks().bend), bend * 2.0) << seed;
    EXPECT_GE(test::position_of(curve.peaks().third), third * 0.99) << seed;
    EXPECT_LE(test::position_of(curve.peaks().third), third * 2.0) << seed;
    // What they are behind a master, by the chain rule.
    const MotionLimits needed = curve.motion(test::limits(2.0, 9.0, 70.0));
    const double y1 = test::position_of(curve.peaks().slope), y2 = test::position_of(curve.peaks().bend),
                 y3 = test::position_of(curve.peaks().third);
    EXPECT_NEAR(test::velocity_of(needed.velocity), y1 * 2.0, 1e-6 * y1);
    EXPECT_NEAR(test::acceleration_of(needed.acceleration), y2 * 4.0 + y1 * 9.0, 1e-5 * y2);
    EXPECT_NEAR(test::jerk_of(needed.jerk), y3 * 8.0 + 3 * y2 * 18.0 + y1 * 70.0, 1e-4 * y3);
  }
}

TEST(CamCurve, TakesOffsetsAndScalingsInBothDialects) {
  const auto cam = test::test_cam(test::rise_and_return("3-4-5", 1.0));
  CamCurve::Config codesys{.table = &cam->table}, twincat = codesys;
  // X = 5/2 master + 0.25, and X = (master - 0.25) / (2/5)
  const MasterPosition offset{0, std::uint64_t{1} << 62};
  CamCurve::scale_then_add(codesys, GearRatio(5, 2), offset);
  CamCurve::subtract_then_divide(twincat, GearRatio(5, 2), offset);
  const MasterPoint master{{1, std::uint64_t{1} << 63}, 0, 0};  // 1.5
  EXPECT_DOUBLE_EQ(test::cycles_of(curve_of(codesys).seen(master).position), 4.0);
  EXPECT_DOUBLE_EQ(test::cycles_of(curve_of(twincat).seen(master).position), 3.125);
}

TEST(CamCurve, OfAGearIsALine) {
  const CamCurve gear = curve_of({.ratio = GearRatio(1, 3), .slave_offset = 77, .rise = test::raw_position(2.5)});
  const CamSlopes at = gear.slopes({4, std::uint64_t{1} << 62});
  EXPECT_EQ(at.position, test::raw_position(2.5 * 4.25) + 77);
  EXPECT_EQ(at.slope, test::raw_position(2.5));
  EXPECT_EQ(at.bend, 0);
  EXPECT_EQ(gear.slopes({-4, 0}).position, -test::raw_position(10.0) + 77);
}

TEST(CamCurve, OfAOnceOnlyCamGoesOnFromItsEnds) {
  sim::cam::Cam cam{.name = "a", .periodic = false};
  cam.segments = {{.length = 1.0, .stroke = 1.0, .law = "3-4-5"}};
  for (const char* law : {"3-4-5", "linear"}) {
    cam.segments[0].law = law;
    // A line does not end at rest: it is one of an endless slave.
    cam.periodic = law[0] == 'l';
    if (cam.periodic) cam.modulo = 1.0;
    const auto made = test::test_cam(cam);
    const CamCurve curve = curve_of({.table = &made->table, .periodic = false});
    EXPECT_TRUE(curve.outside({1, 0}));
    EXPECT_TRUE(curve.outside({-1, UINT64_MAX}));
    EXPECT_FALSE(curve.outside({0, UINT64_MAX}));
    const double slope = law[0] == 'l' ? 1.0 : 0.0;
    EXPECT_NEAR(test::position_of(curve.slopes({1, std::uint64_t{1} << 54}).position), 1.0 + slope * 0x1p-10, 2e-9);
    EXPECT_NEAR(test::position_of(curve.slopes({-1, -(std::uint64_t{1} << 54)}).position), -slope * 0x1p-10, 2e-9);
  }
}

TEST(CamCurve, RefusesWhatItCannotFollow) {
  CamCurve curve;
  // The acceleration of a parabola jumps.
  const auto parabola = test::test_cam(test::rise_and_return("parabola", 1.0));
  EXPECT_EQ(CamCurve::prepare({.table = &parabola->table}, curve), CamRefusal::not_continuous);
  // A cam from 0 to 1 at rest is one whose slave goes on by 1 each cycle.
  sim::cam::Cam rise{.name = "a", .periodic = true, .modulo = 1.0};
  rise.segments = {{.length = 1.0, .stroke = 1.0, .law = "3-4-5"}};
  const auto endless = test::test_cam(rise);
  ASSERT_EQ(CamCurve::prepare({.table = &endless->table}, curve), CamRefusal::none);
  EXPECT_NEAR(test::position_of(curve.slopes({1'000'000, 0}).position), 1e6, 1e-6);
  // Half of a harmonic: its ends are at rest, but their accelerations are not the same.
  sim::cam::Cam once{.name = "a", .periodic = false};
  once.segments = {{.length = 1.0, .stroke = 1.0, .law = "simple_sine"}};
  const auto single = test::test_cam(once);
  EXPECT_EQ(CamCurve::prepare({.table = &single->table, .periodic = true}, curve), CamRefusal::not_continuous);
  EXPECT_EQ(CamCurve::prepare({.table = &single->table, .periodic = false}, curve), CamRefusal::none);
  EXPECT_EQ(CamCurve::prepare({.table = &single->table, .slave_scale = INT64_MIN, .periodic = false}, curve),
            CamRefusal::scale);
  EXPECT_EQ(CamCurve::prepare({.rise = INT64_MAX}, curve), CamRefusal::scale);
  EXPECT_EQ(CamCurve::prepare({.slave_scale = std::int64_t{1} << 47, .rise = std::int64_t{1} << 50}, curve),
            CamRefusal::scale);
  // Bends and third derivatives beyond the formats, where slopes are not.
  const auto cam = test::test_cam(test::rise_and_return("modified_sine", 1.0));
  for (const int bits : {44, 48})
    EXPECT_EQ(CamCurve::prepare({.table = &cam->table, .slave_scale = std::int64_t{1} << bits}, curve),
              CamRefusal::scale);
}

// The bytes of a table with other bits of position, speed and acceleration.
void with_bits(const test::TestCam& cam, int position, int speed, int acceleration, CamRefusal expected) {
  auto bytes = cam.bytes;
  bytes[9] = static_cast<std::uint8_t>(position);
  bytes[10] = static_cast<std::uint8_t>(speed);
  bytes[11] = static_cast<std::uint8_t>(acceleration);
  test::sign(bytes);
  CamTable table;
  ASSERT_EQ(CamTable::read(bytes, table), CamTableProblem::none) << position << ' ' << speed << ' ' << acceleration;
  CamCurve curve;
  EXPECT_EQ(CamCurve::prepare({.table = &table}, curve), expected) << position << ' ' << speed << ' ' << acceleration;
}

TEST(CamCurve, RefusesScalesThatItsFormatsDoNotHold) {
  const auto cam = test::test_cam(test::rise_and_return("3-4-5", 1.0));
  const auto& h = cam->table.header();
  const auto p = static_cast<int>(h.position_bits), v = static_cast<int>(h.speed_bits),
             a = static_cast<int>(h.acceleration_bits);
  with_bits(*cam, p, v, a, CamRefusal::none);
  with_bits(*cam, p + 40, v + 40, a + 40, CamRefusal::none);  // 2^-40 times as large
  with_bits(*cam, 7, 7 + v - p, 7 + a - p, CamRefusal::scale);
  with_bits(*cam, p, 7, a, CamRefusal::scale);
  with_bits(*cam, p, v, 7, CamRefusal::scale);
  // Positions of some 2^30 units.
  with_bits(*cam, 8 + std::max({0, p - v, p - a}), 8, 8, CamRefusal::scale);
}

TEST(CamCurve, RefusesATableThatWasMadeWithAJump) {
  const auto cam = test::test_cam(test::rise_and_return("3-4-5", 1.0));
  const auto with = [&cam](std::size_t at, std::int32_t change) {
    auto bytes = cam->bytes;
    std::uint32_t word = 0;
    for (std::size_t k = 4; k-- > 0;) word = word << 8 | bytes[at + k];
    word += static_cast<std::uint32_t>(change);
    for (std::size_t k = 0; k < 4; ++k) bytes[at + k] = static_cast<std::uint8_t>(word >> (8 * k));
    test::sign(bytes);
    CamTable table;
    EXPECT_EQ(CamTable::read(bytes, table), CamTableProblem::none);
    CamCurve curve;
    return CamCurve::prepare({.table = &table}, curve);
  };
  const std::size_t second = CamTable::header_size + CamTable::segment_size;
  EXPECT_EQ(with(second, 0), CamRefusal::none);
  EXPECT_EQ(with(second + 8, 1 << 17), CamRefusal::not_continuous);  // its position, by 2 nrad
  // In the second segment: its slope at the begin, and what takes the position back at its end.
  const auto coefficient = [](const std::vector<std::uint8_t>& bytes, std::size_t at) {
    std::uint32_t word = 0;
    for (std::size_t k = 4; k-- > 0;) word = word << 8 | bytes[at + k];
    return static_cast<std::int32_t>(word);
  };
  auto bytes = cam->bytes;
  const std::int32_t change = 1 << 16;
  for (const auto& [n, sign] : {std::pair<std::size_t, int>{0, 1}, {1, -1}}) {
    const auto word = static_cast<std::uint32_t>(coefficient(bytes, second + 16 + 4 * n) + sign * change);
    for (std::size_t k = 0; k < 4; ++k) bytes[second + 16 + 4 * n + k] = static_cast<std::uint8_t>(word >> (8 * k));
  }
  test::sign(bytes);
  CamTable table;
  ASSERT_EQ(CamTable::read(bytes, table), CamTableProblem::none);
  CamCurve curve;
  EXPECT_EQ(CamCurve::prepare({.table = &table}, curve), CamRefusal::not_continuous);
}

TEST(CamPeaks, EndWhereTheirFormatDoes) {
  const CamPeaks peaks{INT64_MAX / 2, INT64_MAX / 2, INT64_MAX / 2};
  const MotionLimits needed = peaks.motion(test::limits(4000.0, 1e6, 1e6));
  EXPECT_GE(needed.acceleration, INT64_MAX / 8);
  EXPECT_GE(needed.jerk, INT64_MAX / 8 * 5);
}

}  // namespace
}  // namespace stiction
