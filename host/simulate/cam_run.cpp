#include "host/simulate/cam_run.hpp"

#include <array>
#include <cmath>
#include <deque>
#include <random>

#include "firmware/machine/configuration/double_signals.hpp"
#include "host/simulate/control_run.hpp"
#include "host/simulate/log_recorder.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

// The true master: from rest to `speed` within one cycle by a constant acceleration, then steady.
class TrueMaster {
 public:
  TrueMaster(double speed, double cycle) : speed_(speed), cycle_(cycle), ramp_(2.0 * cycle / speed) {}

  double ramp() const { return ramp_; }  // s
  double cycle_time() const { return cycle_ / speed_; }
  double position(double t) const {
    if (t <= 0.0) return 0.0;
    return t < ramp_ ? 0.5 * speed_ * t * t / ramp_ : cycle_ + speed_ * (t - ramp_);
  }
  double speed(double t) const { return t <= 0.0 ? 0.0 : t < ramp_ ? speed_ * t / ramp_ : speed_; }
  double acceleration(double t) const { return t > 0.0 && t < ramp_ ? speed_ / ramp_ : 0.0; }

 private:
  double speed_, cycle_, ramp_;
};

struct MasterState {
  double position, speed, acceleration;
};

// The master as the slave sees it, tick by tick.
class SeenMaster {
 public:
  // `window`: ticks over which a measured position is differentiated; `period` of a tick, s.
  SeenMaster(const TrueMaster& master, MasterSignal signal, double cycle, int window, double period)
      : master_(master), signal_(signal), cycle_(cycle), window_(static_cast<std::size_t>(window)), period_(period) {}

  MasterState at(double t) {
    const double position = master_.position(t);
    if (signal_ == MasterSignal::ideal) return {position, master_.speed(t), master_.acceleration(t)};
    const double seen = signal_ == MasterSignal::steps
                            ? std::floor(position / cycle_ * master_steps) * cycle_ / master_steps
                            : position + noise_(engine_) * master_noise * cycle_;
    past_.push_back(seen);
    if (past_.size() > window_ + 1) past_.pop_front();
    const auto steps = static_cast<double>(past_.size() - 1);
    return {seen, steps > 0.0 ? (seen - past_.front()) / (steps * period_) : 0.0, 0.0};
  }

 private:
  const TrueMaster& master_;
  MasterSignal signal_;
  double cycle_;
  std::size_t window_;
  double period_;
  std::deque<double> past_;
  std::mt19937_64 engine_{1};
  std::normal_distribution<double> noise_;
};

// The slave over any number of cycles.
class Slave {
 public:
  explicit Slave(const sim::cam::Motion& motion) : motion_(motion), cycle_(motion.cam.cycle()) {
    const auto& curve = motion.curve;
    rise_ = curve.derivative(curve.end(), 0, sim::cam::Side::left) - curve(curve.begin());
  }
  // In the slave's unit; `factor` makes it metres.
  sim::AxisSetPoint at(const MasterState& master, double factor) const {
    const double x = place(master.position);
    const auto& piece = motion_.curve.pieces()[motion_.curve.piece_at(x)];
    const double slope = piece.derivative(x, 1);
    return {
        .position = position(master.position) * factor,
        .velocity = slope * master.speed * factor,
        .acceleration = (piece.derivative(x, 2) * master.speed * master.speed + slope * master.acceleration) * factor};
  }
  double position(double master) const { return motion_.curve(place(master)) + rise_ * std::floor(master / cycle_); }
  double place(double master) const { return master - cycle_ * std::floor(master / cycle_); }

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

}  // namespace

template <class S>
CamRun run_cam(machine::Machine machine, const sim::cam::Motion& motion, const CamRunSettings& settings) {
  auto& axis = machine.axes.front();
  switch_off(axis, settings);
  const double radius = axis.coordinate.rotary() ? axis.coordinate.radius : 1.0, cycle = motion.cam.cycle();
  const double period = machine.timing.fast_period;
  const TrueMaster master(settings.master_speed, cycle);
  SeenMaster seen(master, settings.master, cycle, static_cast<int>(machine.timing.slow_period / period), period);
  const Slave slave(motion);
  ControlRun<S> run(machine, std::array<double, 1>{slave.position(0.0) * radius});
  LogRecorder recorder(machine);
  const auto record = recorder.template sink<S>();

  CamRun result;
  result.segments.resize(motion.segments.size());
  Sums whole;
  std::vector<Sums> parts(motion.segments.size());
  std::vector<double> masters;
  double squares = 0.0, energy = 0.0;
  const double begin = master.ramp(), end = begin + settings.cycles * master.cycle_time();
  const double last = end - master.cycle_time();
  while (run.time() < end) {
    const double t = run.time();
    const bool measured = t >= begin;
    if (measured) {
      auto& plant = run.plant(0);
      const double now = master.position(run.set_point_time()), place = slave.place(now);
      const double error = slave.position(now) - plant.position() / radius;
      const double effort = plant.motor_force() * radius, power = plant.motor_force() * plant.velocity();
      const std::size_t at = motion.segment_of(motion.curve.piece_at(place));
      include(result.error, whole, error, place);
      include(result.segments[at], parts[at], error, place);
      result.peak_effort = std::max(result.peak_effort, std::fabs(effort));
      result.peak_power = std::max(result.peak_power, std::fabs(power));
      squares += effort * effort;
      energy += power * period;
      if (t >= last) {
        result.master.push_back(place);
        result.following.push_back(error);
        result.effort.push_back(effort);
      }
      masters.push_back(place);
    }
    run.tick(std::array{slave.at(seen.at(t), radius)}, measured ? record : TraceSink<S>{});
  }
  result.rms_effort = std::sqrt(squares / static_cast<double>(whole.count));
  result.energy = energy / settings.cycles;
  result.log = recorder.take();
  // Of each tick in the order of the record.
  masters.resize(result.log.t.size(), 0.0);
  result.log.axes.front().master = std::move(masters);
  result.log.axes.front().table.assign(result.log.t.size(), settings.table);
  return result;
}

template CamRun run_cam<FixedSignals>(machine::Machine, const sim::cam::Motion&, const CamRunSettings&);
template CamRun run_cam<machine::DoubleSignals>(machine::Machine, const sim::cam::Motion&, const CamRunSettings&);

}  // namespace stiction::host
