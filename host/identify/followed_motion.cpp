#include "host/identify/followed_motion.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/identify/recorded_speed.hpp"
#include "host/identify/standstill.hpp"
#include "host/identify/suitability.hpp"
#include "host/log/resolution.hpp"
#include "sim/plant/friction/friction.hpp"

namespace stiction::host {
namespace {

constexpr double position_edge = 100.0;  // Hz; logs slower than five times that are differentiated as they are
constexpr double calm_edge = 10.0;       // Hz, the lowest of the speed that tells the direction
constexpr double of_filter = 0.2;        // of the rate, the highest edge of these filters
constexpr double unresolved = 1e-7;      // m, length of a contact that no log of these rates resolves
// Around a reversal a rigid axis has jumps of its acceleration, which differences and the position's filter smear over
// this much of a log: what is smeared belongs to no force.
constexpr double smeared_time = 0.010;  // s
constexpr double smeared_samples = 3.0;
constexpr double slow_log = 30.0;  // Hz; below it a reversal is shorter than a sample

std::vector<double> low_passed(std::span<const double> x, double edge, double period) {
  if (edge > of_filter / period) return {x.begin(), x.end()};
  const auto lowpass = butterworth(4, 2.0 * edge * period);
  const double padding = static_cast<double>(default_padding(lowpass)) * std::max(1.0, 0.1 / (edge * period));
  return filter_both_ways(lowpass, x, static_cast<std::size_t>(padding));
}

// How much of white noise is left behind filters that answer a unit impulse so.
double gain_of(std::span<const double> answer) {
  double sum = 0.0;
  for (const double value : answer) sum += value * value;
  return std::sqrt(sum);
}

std::vector<double> impulse(double period, double band) {
  const auto half = static_cast<std::size_t>(std::ceil(4.0 / (band * period)));
  std::vector<double> unit(2 * half + 1, 0.0);
  unit[half] = 1.0;
  return unit;
}

// Marks what lies within `reach` samples of a marked one.
std::vector<bool> grown(const std::vector<bool>& marked, std::size_t reach) {
  std::vector<bool> wider(marked.size(), false);
  std::size_t until = 0;
  for (std::size_t i = 0; i < marked.size(); ++i) {
    if (!marked[i]) continue;
    for (std::size_t k = std::max(until, i > reach ? i - reach : 0); k < std::min(i + reach + 1, marked.size()); ++k)
      wider[k] = true;
    until = std::min(i + reach + 1, marked.size());
  }
  return wider;
}

std::vector<std::size_t> sign_changes(std::span<const double> v) {
  std::vector<std::size_t> at;
  for (std::size_t i = 0; i + 1 < v.size(); ++i)
    if (v[i] * v[i + 1] < 0.0) at.push_back(i);
  return at;
}

// Where a rigid axis stands, or cannot be told from one that stands.
std::vector<bool> standing(std::span<const double> v, double dead, double period) {
  std::vector<bool> stands(v.size());
  for (std::size_t i = 0; i < v.size(); ++i) stands[i] = std::abs(v[i]) <= dead;
  if (1.0 / period <= slow_log) {
    // One slow sample is a reversal on the way.
    for (std::size_t i = 0; i < v.size(); ++i)
      if (stands[i] && (i == 0 || !stands[i - 1]) && (i + 1 == v.size() || !stands[i + 1])) stands[i] = false;
    return stands;
  }
  const auto changes = sign_changes(v);
  for (const auto i : changes) stands[i] = stands[i + 1] = true;
  std::vector<std::size_t> gaps;
  for (std::size_t i = 1; i < changes.size(); ++i) gaps.push_back(changes[i] - changes[i - 1]);
  double reach = std::max(smeared_time / period, smeared_samples);
  if (gaps.size() > 1) {
    std::nth_element(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2), gaps.end());
    reach = std::min(reach, std::max(1.0, static_cast<double>(gaps[gaps.size() / 2]) / 6.0));
  }
  return grown(stands, static_cast<std::size_t>(std::lround(reach)));
}

// The mean of each sample and the `reach` on both sides of it; the ends go on as they are.
std::vector<double> running_mean(const std::vector<double>& values, std::size_t reach) {
  const auto n = static_cast<std::ptrdiff_t>(values.size()), far = static_cast<std::ptrdiff_t>(reach);
  const auto at = [&](std::ptrdiff_t i) {
    return values[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, n - 1))];
  };
  std::vector<double> mean(values.size());
  double sum = 0.0;
  for (std::ptrdiff_t k = -far; k <= far; ++k) sum += at(k);
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    // Rounding leaves 1e-13 where there is nothing.
    mean[static_cast<std::size_t>(i)] = std::clamp(sum / static_cast<double>(2 * far + 1), 0.0, 1.0);
    sum += at(i + far + 1) - at(i - far);
  }
  return mean;
}

// 0 where a sample is left out, 1 elsewhere, with edges as smooth as the band when the position is noisy: the band
// cancels noise of the second derivative from sample to sample, and a sharp edge cuts that in two.
std::vector<double> weights(const std::vector<bool>& out, double period, double band, bool noisy) {
  std::vector<double> weight(out.size());
  const auto width = static_cast<std::size_t>(std::lround(0.4 / (band * period)));
  if (!noisy || width < 2) {
    for (std::size_t i = 0; i < out.size(); ++i) weight[i] = out[i] ? 0.0 : 1.0;
    return weight;
  }
  const auto wide = grown(out, width / 2);
  for (std::size_t i = 0; i < out.size(); ++i) weight[i] = wide[i] ? 0.0 : 1.0;
  // Three running means are nearly a raised cosine, and take the same time at any width.
  for (int pass = 0; pass < 3; ++pass) weight = running_mean(weight, width / 6);
  return weight;
}

// Puts the recorded speed and its derivative in the place of those of the position, where it is quieter in the rows and
// the speed of that position; returns the speed then. `noise`: m rms, of the position; `filter`: of the rows; `unit`:
// an impulse.
std::optional<std::vector<double>> take_recorded_speed(const Log& log, const AxisLog& channels, double noise,
                                                       const RowFilter& filter, const std::vector<double>& unit,
                                                       Motion& motion) {
  constexpr double worth = 0.5;  // of the acceleration's noise: a little less is no reason to trust a second channel
  const auto speed = recorded_speed(log, channels, noise);
  const auto answer = low_passed(unit, position_edge, log.period);
  const double of_speed = speed.noise * gain_of(filter.whole(answer));
  const double of_acceleration = speed.noise * gain_of(filter.whole(derivatives(answer, log.period).first));
  if (of_acceleration > worth * motion.acceleration_noise) return std::nullopt;
  motion.speed_objection = speed.objection;
  if (!speed.consistent) return std::nullopt;
  motion.recorded_speed = true;
  motion.speed_noise = of_speed;
  motion.acceleration_noise = of_acceleration;
  auto v = low_passed(channels.v, position_edge, log.period);
  motion.a = derivatives(v, log.period).first;
  return v;
}

// Samples that do not count get the force between their neighbours: an outlier would reach others through the filter.
void bridge(std::vector<double>& force, const std::vector<bool>& out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (!out[i]) continue;
    std::size_t end = i;
    while (end < out.size() && out[end]) ++end;
    const double before = i > 0 ? force[i - 1] : end < out.size() ? force[end] : 0.0;
    const double after = end < out.size() ? force[end] : before;
    for (std::size_t k = i; k < end; ++k)
      force[k] = before + (after - before) * static_cast<double>(k - i + 1) / static_cast<double>(end - i + 1);
    i = end;
  }
}

}  // namespace

LevelModel level_model(const machine::AxisModel& axis, bool sticks) {
  LevelModel model{sticks, {}, false};
  if (sticks) return model;
  const auto contact = sim::contact_of(axis.friction);
  model.shape.inverse_length = contact ? contact->stiffness / contact->level : 1.0 / unresolved;
  return model;
}

LevelModel unresolved_contact() {
  LevelModel model;
  model.shape.inverse_length = 1.0 / unresolved;
  return model;
}

double position_noise(const AxisLog& channels, const machine::AxisModel& axis) {
  const double found = increment_of(channels, &AxisLog::x);
  const double increment = found > 0.0 ? found : axis.encoder.increment;
  return std::hypot(increment / std::sqrt(12.0), axis.encoder.noise);
}

SignalSettings followed_signals(double band) {
  SignalSettings settings;
  settings.cutoff = position_edge;
  settings.band = band;
  settings.skip_start = settings.skip_end = 0.0;
  return settings;
}

std::vector<bool> left_out(const AxisLog& channels, const machine::AxisModel& axis) {
  auto out = saturated(channels, axis);
  for (std::size_t i = 0; i < channels.left_out.size(); ++i) out[i] = out[i] || channels.left_out[i];
  return out;
}

Motion followed_motion(const Log& log, const AxisLog& channels, const machine::AxisModel& axis, Amperes amperes,
                       double band, const LevelModel& model) {
  const double period = log.period;
  Motion motion{log.source, period, log.t, {}, {}, {}, {}, channels.i, channels.x_set};
  motion.force = force_of(log, channels, axis, amperes);
  motion.force_is_current = channels.force.empty() && channels.external_force.empty();
  motion.x = low_passed(channels.x, position_edge, period);
  motion.constant = shape_of_constant(axis, motion.x);
  auto d = derivatives(motion.x, period);
  motion.v = std::move(d.first);
  motion.a = std::move(d.second);
  if (!channels.x_set.empty()) {
    auto set = derivatives(low_passed(channels.x_set, position_edge, period), period);
    motion.set_v = std::move(set.first);
    motion.set_a = std::move(set.second);
  }
  const double noise = position_noise(channels, axis);
  // The direction needs a calmer speed than the rows do.
  const double calm = std::clamp(2.5 * band, calm_edge, position_edge);
  const auto unit = impulse(period, std::min(band, calm));
  const auto answer = derivatives(low_passed(unit, position_edge, period), period);
  const Motion alone{"", period, std::vector<double>(unit.size()), {}, {}, {}, {}, {}, {}};
  const RowFilter filter(alone, followed_signals(band));
  motion.speed_noise = noise * gain_of(filter.whole(answer.first));
  motion.acceleration_noise = noise * gain_of(filter.whole(answer.second));
  std::optional<std::vector<double>> recorded;
  if (!channels.v.empty()) recorded = take_recorded_speed(log, channels, noise, filter, unit, motion);

  auto out = left_out(channels, axis);
  bridge(motion.force, out);
  auto slow = motion;
  slow.x = low_passed(channels.x, calm, period);
  slow.v = derivatives(slow.x, period).first;
  if (!model.sticks) {
    motion.level = contact_of(slow, model.shape).level;
  } else {
    // A band that reaches further than the filters do leaves the speed as it was measured, and four times its noise
    // would take most of a small servo's motion for standstill.
    const double clear = std::max(calm_edge, std::min(calm, of_filter / period));
    const auto direction = clear < calm ? derivatives(low_passed(channels.x, clear, period), period).first : slow.v;
    double highest = 0.0;
    for (const double v : direction) highest = std::max(highest, std::abs(v));
    const double speed_noise = noise * gain_of(derivatives(low_passed(unit, clear, period), period).first);
    const bool seen = noise > 1e-9;
    const auto stands = standing(direction, std::max(seen ? 4.0 * speed_noise : 0.0, 2e-3 * highest), period);
    motion.level.resize(direction.size());
    for (std::size_t i = 0; i < direction.size(); ++i) {
      motion.level[i] = direction[i] > 0.0 ? 1.0 : direction[i] < 0.0 ? -1.0 : 0.0;
      out[i] = out[i] || stands[i];
    }
  }
  motion.v = recorded ? std::move(*recorded) : std::move(slow.v);
  if (std::find(out.begin(), out.end(), true) != out.end())
    motion.weight = weights(out, period, band, noise > 1e-7 / std::sqrt(12.0));
  return motion;
}

}  // namespace stiction::host
