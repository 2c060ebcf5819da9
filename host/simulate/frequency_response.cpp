#include "host/simulate/frequency_response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/log/own_units.hpp"
#include "host/log/shown_units.hpp"
#include "host/simulate/circle.hpp"
#include "host/simulate/control_run.hpp"
#include "host/simulate/starts.hpp"
#include "sim/experiment/move_sequence.hpp"
#include "sim/experiment/shuttle_path.hpp"
#include "sim/experiment/test_signal.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

constexpr double usual_linear_speed = 2.0 / 60.0;  // m/s
constexpr double usual_speed_share = 1.0 / 3.0;    // of the highest of a rotary axis
constexpr double settling_time = 0.2;              // s after a start, 17 time constants of the position loop
constexpr double pause = 0.02;                     // s between two sines
constexpr double multisine_density = 50.0;         // lines per decade
constexpr double sine_density = 25.0;
constexpr double share_of_limit = 0.1;
constexpr double share_of_travel = 0.8;  // that passes of many sines take

// The slowest start of the axes.
sim::Dynamics start_of(const FrequencyResponsePlan& plan) {
  auto slowest = start_on(plan.machine.axes.front());
  for (const auto& axis : plan.machine.axes)
    if (const auto start = start_on(axis); start.acceleration < slowest.acceleration) slowest = start;
  return slowest;
}

// Samples after which a multisine repeats: whole slow periods.
int block_of(const FrequencyResponsePlan& plan) {
  const auto& timing = plan.machine.timing;
  return machine::slow_ratio(timing) *
         std::max(1, static_cast<int>(std::lround(1.0 / (plan.lowest * timing.slow_period))));
}

// A stretch of test signal: so many blocks of whole periods of these lines.
struct Stretch {
  int block = 0;  // samples
  std::vector<int> lines;
};

class Schedule {
 public:
  explicit Schedule(const FrequencyResponsePlan& plan)
      : plan_(plan),
        period_(plan.machine.timing.fast_period),
        passes_(passes_of(plan)),
        path_(*plan.speed, start_of(plan).acceleration, start_of(plan).jerk, cruise()) {
    for (const auto& axis : plan.machine.axes) {
      if (axis.modulo || path_.stroke() <= axis.travel) continue;
      const ShownUnits own(axis.coordinate);
      throw InfeasibleMotion(fmt::format(
          "speed: found {:.4g} {}, with which a pass of {:.2f} s takes {:.0f} {unit}; expected at most the travel of "
          "axis {}, {:.0f} {unit}: a lower speed, fewer periods or a higher lowest frequency",
          own.feed(*plan.speed), own.feed.unit, path_.pass_duration(), own.position(path_.stroke()), axis.name,
          own.position(axis.travel), fmt::arg("unit", own.position.unit)));
    }
  }

  sim::AxisSetPoint at(double t) const { return path_.at(t); }
  std::size_t ticks() const {
    return static_cast<std::size_t>(std::ceil(path_.pass_duration() * static_cast<double>(passes_.size()) / period_));
  }

  // The test signal of one axis, tick by tick.
  std::vector<double> test(double amplitude, std::uint64_t seed) const {
    std::vector<double> signal(ticks(), 0.0);
    for (std::size_t pass = 0; pass < passes_.size(); ++pass) {
      const double begin = static_cast<double>(pass) * path_.pass_duration() + path_.cruise_begin() + settling_time;
      auto tick = static_cast<std::size_t>(std::ceil(begin / period_));
      for (const auto& stretch : passes_[pass]) {
        const auto block = sim::multisine(stretch.block, stretch.lines, amplitude, seed++);
        for (int repeat = 0; repeat <= plan_.periods; ++repeat, tick += block.size())
          std::copy(block.begin(), block.end(), signal.begin() + static_cast<std::ptrdiff_t>(tick));
        tick += static_cast<std::size_t>(pause / period_);
      }
    }
    return signal;
  }

 private:
  using Pass = std::vector<Stretch>;

  double duration(const Stretch& stretch) const { return stretch.block * (plan_.periods + 1) * period_ + pause; }
  double duration(const Pass& pass) const {
    double sum = settling_time;
    for (const auto& stretch : pass) sum += duration(stretch);
    return sum;
  }
  double cruise() const {
    double longest = 0.0;
    for (const auto& pass : passes_) longest = std::max(longest, duration(pass));
    return longest;
  }

  std::vector<Pass> passes_of(const FrequencyResponsePlan& plan) const {
    const int slow = machine::slow_ratio(plan.machine.timing);
    const int block = block_of(plan);
    if (plan.signal == TestSignal::multisine)
      return std::vector<Pass>(static_cast<std::size_t>(plan.passes),
                               Pass{{block, sim::test_lines(block, slow, multisine_density)}});
    double longest = HUGE_VAL;
    for (const auto& axis : plan.machine.axes) longest = std::min(longest, share_of_travel * axis.travel / *plan.speed);
    std::vector<Pass> passes{{}};
    for (const int line : sim::test_lines(block, slow, sine_density)) {
      // Higher frequencies have many periods in a fifth of the block.
      const int parts = line >= 10 && block % 5 == 0 ? 5 : 1;
      const Stretch stretch{block / parts, {std::max(1, static_cast<int>(std::lround(line / double(parts))))}};
      if (!passes.back().empty() && duration(passes.back()) + duration(stretch) > longest) passes.emplace_back();
      passes.back().push_back(stretch);
    }
    return passes;
  }

  const FrequencyResponsePlan& plan_;
  double period_;
  std::vector<Pass> passes_;
  sim::ShuttlePath path_;
};

double limit_of(const machine::AxisModel& axis) {
  return axis.motor.driven_by_volts() ? axis.inverter.voltage_limit : axis.inverter.current_limit * axis.motor.count;
}

const char* unit_of(const machine::AxisModel& axis) { return axis.motor.driven_by_volts() ? "V" : "A"; }

// Keeps the signals of an axis as a drive's log has them.
void record(AxisLog& log, const AxisSignals<FixedSignals>& s, double test, bool force_motor) {
  log.x_set.push_back(machine::to_si(s.x_set));
  log.v_set.push_back(machine::to_si(s.v_set));
  log.x.push_back(machine::to_si(s.x));
  log.v.push_back(machine::to_si(s.v));
  if (force_motor) {
    log.u.push_back(machine::to_si(s.i_set));
    log.u_inject.push_back(test);
  } else {
    log.i.push_back(machine::to_si(s.i));
    log.i_set.push_back(machine::to_si(s.i_set));
    log.i_inject.push_back(test);
  }
}

// What must not happen while the test signal acts.
class Watch {
 public:
  void see(double t, double v_set, double velocity, const Limiting& limiting) {
    const double along = std::copysign(1.0, v_set) * velocity;
    if (along < slowest_) {
      slowest_ = along;
      time_ = t;
    }
    limited_ += limiting.velocity || limiting.current || limiting.voltage;
  }
  bool saw_test() const { return slowest_ < HUGE_VAL; }
  void check(const machine::AxisModel& axis, double speed, double amplitude) const {
    const auto feed = ShownUnits(axis.coordinate).feed;
    if (limited_ > 0)
      throw InfeasibleMotion(fmt::format(
          "amplitude: found {:.4g} {}, with which axis {} is held back at a limit of velocity, current or voltage in "
          "{} samples; expected an amplitude that stays within them, and a stable loop",
          amplitude, unit_of(axis), axis.name, limited_));
    if (slowest_ <= 0.0)
      throw InfeasibleMotion(fmt::format(
          "speed: found {:.4g} {feed}, but with a test signal of {:.4g} {} axis {} falls to {:.3g} {feed} at {:.3f} s; "
          "expected a speed that never crosses zero: at least {:.2g} {feed}, or a smaller amplitude",
          feed(speed), amplitude, unit_of(axis), axis.name, feed(slowest_), time_, feed(1.3 * (speed - slowest_)),
          fmt::arg("feed", feed.unit)));
  }

 private:
  double slowest_ = HUGE_VAL, time_ = 0.0;
  int limited_ = 0;
};

// The run tick by tick: set-points, the test signals of the axes, and what is kept of them.
class Recording {
 public:
  explicit Recording(const FrequencyResponsePlan& plan)
      : plan_(plan), schedule_(plan), watches_(plan.machine.axes.size()) {
    for (const auto& axis : plan.machine.axes) {
      amplitudes_.push_back(plan.amplitude.value_or(share_of_limit * limit_of(axis)));
      tests_.push_back(schedule_.test(amplitudes_.back(), plan.seed + 1000 * log_.axes.size()));
      log_.axes.emplace_back().axis = axis.name;
    }
    log_.source = "simulation";
    log_.period = plan.machine.timing.fast_period;
    log_.comments = {{"experiment", "frequency-response"}, {"machine", plan.machine.name}};
  }

  Log take() {
    try {
      run();
    } catch (const FaultTripped& fault) {
      check();
      // Before the test signal acts, the fault is the machine's own.
      if (std::none_of(watches_.begin(), watches_.end(), [](const Watch& watch) { return watch.saw_test(); })) throw;
      throw InfeasibleMotion(fmt::format(
          "amplitude: found {:.4g} {}, with which the axis stops: {}; expected an amplitude that the supervision lets "
          "pass, and a stable loop",
          amplitudes_.front(), unit_of(plan_.machine.axes.front()), fault.what()));
    }
    check();
    for (std::size_t k = 0; k < log_.axes.size(); ++k)
      log_.axes[k] = in_own_units(std::move(log_.axes[k]), plan_.machine.axes[k].coordinate);
    return std::move(log_);
  }

 private:
  void check() const {
    for (std::size_t k = 0; k < watches_.size(); ++k)
      watches_[k].check(plan_.machine.axes[k], *plan_.speed, amplitudes_[k]);
  }
  void run() {
    const auto& axes = plan_.machine.axes;
    std::vector<sim::AxisSetPoint> set(axes.size());
    const std::vector<double> start(axes.size(), 0.0);
    ControlRun<FixedSignals> run(plan_.machine, start);
    for (std::size_t tick = 0; tick < schedule_.ticks(); ++tick) {
      const double t = run.time();
      for (std::size_t k = 0; k < axes.size(); ++k) {
        set[k] = schedule_.at(t);
        set[k].injection = tests_[k][tick];
      }
      run.tick(set, [&](std::int64_t, std::span<const AxisSignals<FixedSignals>> signals) {
        log_.t.push_back(t);
        for (std::size_t k = 0; k < axes.size(); ++k) {
          const double test = tests_[k][tick];
          record(log_.axes[k], signals[k], test, axes[k].motor.driven_by_volts());
          if (test != 0.0) watches_[k].see(t, set[k].velocity, run.plant(k).velocity(), signals[k].limiting);
        }
      });
    }
  }

  const FrequencyResponsePlan& plan_;
  Schedule schedule_;
  std::vector<double> amplitudes_;
  std::vector<std::vector<double>> tests_;
  std::vector<Watch> watches_;
  Log log_;
};

}  // namespace

double usual_speed(const FrequencyResponsePlan& plan) {
  const auto& axis = plan.machine.axes.front();
  if (!axis.coordinate.rotary()) {
    double speed = usual_linear_speed;
    for (const auto& each : plan.machine.axes) speed = std::min(speed, each.max_velocity);
    return speed;
  }
  const double wanted = std::min(usual_speed_share * axis.max_velocity, 0.5 * highest_followed_speed(axis));
  if (axis.modulo) return wanted;
  const double cruise = settling_time + block_of(plan) * (plan.periods + 1) * plan.machine.timing.fast_period + pause;
  return sim::speed_within(share_of_travel * axis.travel, wanted, cruise, start_of(plan));
}

Log run_frequency_response(const FrequencyResponsePlan& plan) {
  auto complete = plan;
  if (!complete.speed) complete.speed = usual_speed(plan);
  return Recording(complete).take();
}

}  // namespace stiction::host
