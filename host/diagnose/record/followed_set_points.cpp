#include "host/diagnose/record/followed_set_points.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "host/diagnose/record/replay_setup.hpp"
#include "host/identify/filter.hpp"
#include "host/identify/identification.hpp"
#include "host/simulate/control_run.hpp"

namespace stiction::host {
namespace {

constexpr int order = 4;
constexpr int rounds = 6, rounds_from_known = 3;
constexpr double highest_edge = 0.8;  // of half the log's rate
// Of the position loop's bandwidth. Faster motion is the loop's answer to what disturbs the axis: regressors of it
// would carry the disturbance that they are regressed on.
constexpr double followed = 2.0;
constexpr double missed = 0.01;  // of the stroke, rms: the machine does not go this way

std::vector<double> less(std::vector<double> one, const std::vector<double>& other) {
  std::transform(one.begin(), one.end(), other.begin(), one.begin(), std::minus<>());
  return one;
}

double mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return sum / static_cast<double>(values.size());
}

Lowpass lowpass_of(const machine::AxisModel& axis, double period) {
  return butterworth(order, 2.0 * followed_up_to(axis, period) * period);
}

// One record in its course.
class Follower {
 public:
  Follower(const machine::Machine& machine, std::size_t axis, const Log& log)
      : machine_(machine),
        axis_(axis),
        log_(log),
        lowpass_(lowpass_of(machine.axes[axis], log.period)),
        wanted_(smoothed(channels().x)) {}

  // The set positions of the round that came nearest, of which the first is `begin` (m), or, empty, the motion; empty
  // where none could be simulated, or, by `how`, did not come near.
  std::vector<double> learned(Following how, const std::vector<double>& begin) {
    std::vector<double> best, set = begin.empty() ? wanted_ : begin;
    double least = INFINITY;
    for (int round = 0; round < (begin.empty() ? rounds : rounds_from_known); ++round) {
      const auto missing = missing_with(set);
      if (missing.empty()) break;
      if (const double square = mean_square(missing); square < least)
        least = square, best = set;
      else
        break;
      add(set, missing);
    }
    if (how == Following::as_near_as_it_comes) return best;
    const auto [low, high] = std::minmax_element(wanted_.begin(), wanted_.end());
    const double increment = machine_.axes[axis_].encoder.increment;
    if (!(std::sqrt(least) < std::max(missed * (*high - *low), increment))) return {};
    return best;
  }

 private:
  AxisLog& channels() { return channels_of(log_, machine_.axes[axis_]); }
  std::vector<double> smoothed(const std::vector<double>& values) const {
    return filter_both_ways(lowpass_, values, default_padding(lowpass_));
  }

  // m, of the recorded motion beyond the simulated one; empty where the machine cannot follow.
  std::vector<double> missing_with(const std::vector<double>& set) {
    channels().x_set = set;
    try {
      auto setup = replay_setup_of(machine_, axis_, {log_});
      setup.machine.axes.front().encoder.noise = 0.0;
      return smoothed(less(wanted_, simulated_positions(setup).front()));
    } catch (const FaultTripped&) {
      return {};
    } catch (const LogError&) {  // faster than the file allows
      return {};
    }
  }

  // A position loop without velocity feedforward lags by the reciprocal of its gain.
  void add(std::vector<double>& set, const std::vector<double>& missing) const {
    const auto& axis = machine_.axes[axis_];
    const double lead = (1.0 - axis.feedforward.velocity) / axis.position_controller.gain;
    const auto speed = central_difference(missing, log_.period);
    for (std::size_t i = 0; i < set.size(); ++i) set[i] += missing[i] + lead * speed[i];
  }

  const machine::Machine& machine_;
  std::size_t axis_;
  Log log_;
  Lowpass lowpass_;
  std::vector<double> wanted_;  // m
};

}  // namespace

bool have_set_points(const std::vector<Log>& logs, const machine::AxisModel& axis) {
  return std::none_of(logs.begin(), logs.end(), [&](const Log& log) { return channels_of(log, axis).x_set.empty(); });
}

std::vector<Log> with_recorded_set_points(const machine::AxisModel& axis, std::vector<Log> logs, double cutoff) {
  for (auto& log : logs) {
    auto& channels = channels_of(log, axis);
    if (!channels.x_set.empty()) continue;
    const auto lowpass = butterworth(order, std::min(2.0 * cutoff * log.period, highest_edge));
    channels.x_set = filter_both_ways(lowpass, channels.x, default_padding(lowpass));
  }
  return logs;
}

std::vector<Log> with_set_points(const machine::Machine& machine, std::size_t axis, std::vector<Log> logs,
                                 Following how, const std::vector<Log>& made_by) {
  const auto& model = machine.axes[axis];
  const bool follows = model.cascaded() && model.position_controller.gain > 0.0;
  if (model.unknown_controller() || !follows) return logs;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    auto& channels = channels_of(logs[k], model);
    if (!channels.x_set.empty()) continue;
    const auto begin = made_by.empty() ? std::vector<double>{} : channels_of(made_by[k], model).x_set;
    channels.x_set = Follower(machine, axis, logs[k]).learned(how, begin);
  }
  return logs;
}

double followed_up_to(const machine::AxisModel& axis, double period) {
  const double bandwidth = axis.position_controller.gain / (2.0 * std::numbers::pi);
  return std::min(followed * bandwidth, 0.5 * highest_edge / period);
}

}  // namespace stiction::host
