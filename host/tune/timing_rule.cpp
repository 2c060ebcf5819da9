#include "host/tune/timing_rule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "firmware/machine/configuration/compensation_configuration.hpp"
#include "firmware/machine/configuration/conversion.hpp"
#include "firmware/machine/configuration/double_signals.hpp"
#include "host/identify/filter.hpp"
#include "host/identify/identification.hpp"

namespace stiction::host {
namespace {

using S = machine::DoubleSignals;

constexpr double before = 3e-3, after = 40e-3;  // s, around a reversal

// The current that the feedforward gives for the set way, A.
std::vector<double> feedforward(const AxisLog& channels, const std::vector<double>& v_set,
                                const machine::Machine& machine, const machine::AxisModel& axis, double period) {
  machine::Machine at_rate = machine;
  at_rate.timing.fast_period = period;  // the law counts its damping in ticks
  const auto config = machine::configure_compensation<S>(at_rate, axis).friction;
  FrictionFeedforward<S>::State state;
  SaturationCounter none;
  std::vector<double> current;
  for (std::size_t k = 0; k < channels.x_set.size(); ++k) {
    const double dx = k == 0 ? 0.0 : channels.x_set[k] - channels.x_set[k - 1];
    current.push_back(FrictionFeedforward<S>::step(config, state, {dx}, {v_set[k]}, none).sum.value);
  }
  return current;
}

// The error (m) that a lacking `force` (N) makes in the loop of PI velocity and P position control, without its delays.
std::vector<double> response(const std::vector<double>& force, const machine::AxisModel& axis, double period) {
  const double k = axis.velocity_controller.gain * axis.motor.force_constant, kv = axis.position_controller.gain;
  const auto& time = axis.velocity_controller.integral_time;
  const double per_time = time ? 1.0 / *time : 0.0;
  double e = 0.0, rate = 0.0, sum = 0.0;
  std::vector<double> error;
  for (const double lacking : force) {
    const double push = lacking - k * (per_time + kv) * e - k * kv * per_time * sum;
    rate = (rate + period / axis.mass * push) / (1.0 + period / axis.mass * k);
    e += period * rate;
    sum += period * e;
    error.push_back(e);
  }
  return error;
}

double mean(const std::vector<double>& values, std::size_t begin, std::size_t end) {
  double sum = 0.0;
  for (std::size_t k = begin; k < end; ++k) sum += values[k];
  return sum / static_cast<double>(end - begin);
}

}  // namespace

std::string_view TimingError::verdict(double tick) const {
  if (std::abs(late) <= std::max(2.0 * standard_error, 0.25 * tick)) return "in time";
  return late > 0.0 ? "too late" : "too early";
}

TimingError timing_of(const Log& log, const machine::Machine& machine, std::size_t axis_index) {
  const auto& axis = machine.axes.at(axis_index);
  const auto& channels = channels_of(log, axis);
  if (channels.x_set.empty())
    throw LogError(
        fmt::format("{}: found no x_set[m]; expected the set position, with which the timing is compared", log.source));
  const double period = log.period;
  const auto v_set = central_difference(channels.x_set, period);
  auto force = central_difference(feedforward(channels, v_set, machine, axis, period), period);
  for (double& f : force) f *= axis.motor.force_constant;
  const auto shape = response(force, axis, period);

  const auto window_before = static_cast<std::size_t>(before / period);
  const auto window_after = static_cast<std::size_t>(after / period);
  double product = 0.0, square = 0.0;
  std::vector<std::pair<double, double>> parts;  // product and square of each reversal
  for (std::size_t k = std::max<std::size_t>(1, window_before); k + window_after < v_set.size(); ++k) {
    if (!(v_set[k - 1] * v_set[k] < 0.0 || (v_set[k] == 0.0 && v_set[k - 1] * v_set[k + 1] < 0.0))) continue;
    const std::size_t begin = k - window_before, end = k + window_after;
    std::vector<double> e;
    for (std::size_t i = begin; i < end; ++i) e.push_back(channels.x_set[i] - channels.x[i]);
    const double e_mean = mean(e, 0, window_before + 1), shape_mean = mean(shape, begin, begin + window_before + 1);
    double p = 0.0, s = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      const double g = shape[i] - shape_mean;
      p += (e[i - begin] - e_mean) * g;
      s += g * g;
    }
    product += p;
    square += s;
    parts.emplace_back(p, s);
  }
  if (parts.size() < 2 || !(square > 0.0))
    throw LogError(
        fmt::format("{}: found {} reversals with compensation in the motion of axis {}; expected two or more",
                    log.source, parts.size(), axis.name));
  TimingError timing{product / square, 0.0, static_cast<int>(parts.size())};
  double scatter = 0.0;
  for (const auto& [p, s] : parts) scatter += (p - timing.late * s) * (p - timing.late * s);
  const double count = static_cast<double>(parts.size());
  timing.standard_error = std::sqrt(scatter * count / (count - 1.0)) / square;
  return timing;
}

}  // namespace stiction::host
