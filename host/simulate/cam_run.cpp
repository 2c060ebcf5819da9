#include "host/simulate/cam_run.hpp"

#include <array>
#include <cmath>
#include <deque>
#include <numbers>
#include <type_traits>

#include "firmware/machine/configuration/cam_configuration.hpp"
#include "firmware/machine/configuration/double_signals.hpp"
#include "host/simulate/control_run.hpp"
#include "host/simulate/log_recorder.hpp"
#include "host/simulate/swing_time.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

// Where the motion is at a master, over any number of cycles.
class Slave {
 public:
  explicit Slave(const sim::cam::Motion& motion) : motion_(motion), cycle_(motion.cam.cycle()) {
    const auto& curve = motion.curve;
    rise_ = curve.derivative(curve.end(), 0, sim::cam::Side::left) - curve(curve.begin());
  }
  // In the slave's unit.
  double position(const MasterPosition& master) const {
    return motion_.curve(place(master)) + rise_ * static_cast<double>(master.cycles);
  }
  double place(const MasterPosition& master) const {
    return std::ldexp(static_cast<double>(master.phase), -64) * cycle_;
  }

 private:
  const sim::cam::Motion& motion_;
  double cycle_, rise_;
};

struct Sums {
  double errors = 0.0;
  std::size_t count = 0;
};

void include(FollowingError& error, Sums& sums, double value, double place) {
  sums.errors += std::fabs(value);
  ++sums.count;
  error.mean = sums.errors / static_cast<double>(sums.count);
  if (std::fabs(value) > error.peak) error.peak = std::fabs(value), error.place = place;
}

void switch_off(machine::AxisModel& axis, const CamRunSettings& settings) {
  if (!settings.feedforward) axis.feedforward = {};
  if (!settings.compensation) axis.friction_compensation.reset();
}

// With the set-point in the drive's formats where the control has them.
template <class S>
void tick(ControlRun<S>& run, const CamSetPoints& set_points, const TraceSink<S>& trace) {
  if constexpr (std::is_same_v<S, FixedSignals>) {
    if (run.cascaded()) return run.tick(std::array{set_points.set_point()}, trace);
  }
  run.tick(std::array{set_points.in_si()}, trace);
}

}  // namespace

template <class S>
CamRun run_cam(machine::Machine machine, const sim::cam::Motion& motion, const CamRunSettings& settings) {
  auto& axis = machine.axes.front();
  switch_off(axis, settings);
  const double radius = axis.coordinate.rotary() ? axis.coordinate.radius : 1.0, cycle = motion.cam.cycle();
  const double period = machine.timing.fast_period;
  // The log's master is an angle: of a linear one that of its cycle.
  const double angle = motion.cam.master == sim::cam::Coordinate::rotary ? cycle : 2.0 * std::numbers::pi;
  CamSetPoints set_points(machine.timing, axis, motion, settings.master_speed, settings.master);
  const Slave slave(motion);
  ControlRun<S> run(machine, std::array<double, 1>{set_points.start()});
  LogRecorder recorder(machine);
  const auto record = recorder.template sink<S>();
  // Ticks by which compensation holds set-points back; what is followed now was made so long ago.
  const auto late = static_cast<std::size_t>(std::lround((run.time() - run.set_point_time()) / period));
  std::deque<MasterPoint> made;

  CamRun result;
  result.segments.resize(motion.segments.size());
  Sums whole;
  std::vector<Sums> parts(motion.segments.size());
  std::vector<double> masters, speeds, loads;
  double squares = 0.0, energy = 0.0;
  std::int64_t first_cycle = -1;
  // What the start did to an elastic axis is over before anything is measured.
  const auto settled = static_cast<std::int64_t>(std::ceil(swing_time(axis) * std::abs(settings.master_speed) / cycle));
  while (true) {
    set_points.step();
    made.push_back(set_points.master());
    if (made.size() > late + 1) made.pop_front();
    const MasterPoint& followed = made.front();
    const bool at_speed = set_points.at_speed() && made.size() == late + 1;
    // From the first whole cycle at speed on.
    if (first_cycle < 0 && at_speed && made.front().velocity == made.back().velocity)
      first_cycle = followed.position.cycles + 1 + settled;
    const std::int64_t gone = followed.position.cycles - first_cycle;
    if (first_cycle >= 0 && gone >= settings.cycles) break;
    const bool measured = first_cycle >= 0 && gone >= 0;
    if (measured) {
      auto& plant = run.plant(0);
      const double place = slave.place(followed.position);
      const double error = slave.position(followed.position) - plant.position() / radius;
      const double effort = plant.motor_force() * radius, power = plant.motor_force() * plant.velocity();
      const std::size_t at = motion.segment_of(motion.curve.piece_at(place));
      include(result.error, whole, error, place);
      include(result.segments[at], parts[at], error, place);
      result.peak_effort = std::max(result.peak_effort, std::fabs(effort));
      result.peak_power = std::max(result.peak_power, std::fabs(power));
      squares += effort * effort;
      energy += power * period;
      if (gone + 1 == settings.cycles) {
        result.master.push_back(place);
        result.following.push_back(error);
        result.effort.push_back(effort);
      }
      if (const auto seen = plant.read_second_encoder()) loads.push_back(*seen / radius);
      masters.push_back(place / cycle * angle);
      speeds.push_back(machine::motion_bounds({followed.velocity, 0, 0}, period).velocity * angle);
    }
    tick(run, set_points, measured ? record : TraceSink<S>{});
  }
  result.rms_effort = std::sqrt(squares / static_cast<double>(whole.count));
  result.energy = energy / settings.cycles;
  result.log = recorder.take();
  // Of each tick in the order of the record.
  auto& log = result.log.axes.front();
  masters.resize(result.log.t.size(), 0.0);
  speeds.resize(result.log.t.size(), 0.0);
  log.master = std::move(masters);
  log.master_speed = std::move(speeds);
  if (!loads.empty()) loads.resize(result.log.t.size(), loads.back());
  log.x_load = std::move(loads);
  log.table.assign(result.log.t.size(), settings.table);
  return result;
}

template CamRun run_cam<FixedSignals>(machine::Machine, const sim::cam::Motion&, const CamRunSettings&);
template CamRun run_cam<machine::DoubleSignals>(machine::Machine, const sim::cam::Motion&, const CamRunSettings&);

}  // namespace stiction::host
