#include "host/log/inspection.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "host/log/determinable.hpp"
#include "host/log/resolution.hpp"
#include "host/log/statistics.hpp"

namespace stiction::host {
namespace {

using Values = std::vector<double>;

constexpr double window = 0.01;           // s, of the fitted motion
constexpr double steady = 0.01;           // part of the speed that a plateau may wander
constexpr double shortest_plateau = 0.1;  // s
constexpr double sliding = 1e-4;          // m, that are surely beyond presliding; less is creep under a spring
constexpr double same_speed = 0.03;       // plateaus nearer than this are one
constexpr double independent = 0.01;      // s, between samples that count as independent
constexpr double held_still = 0.005;      // s at the very end of the range that no free signal stays

// Below this speed a sample rests: a thousandth of the fastest, or what the encoder's rounding makes of rest.
double rest_speed(const Values& v) { return std::max(1e-3 * largest_magnitude(v), 1e-6); }

int count_reversals(const Values& v, double rest) {
  int reversals = 0;
  double last = 0.0;
  for (const double speed : v) {
    if (std::abs(speed) < rest) continue;
    reversals += last * speed < 0.0;
    last = speed;
  }
  return reversals;
}

std::vector<SpeedPlateau> plateaus_of(const Values& v, double rest, double period) {
  std::vector<SpeedPlateau> plateaus;
  for (std::size_t begin = 0; begin < v.size();) {
    std::size_t end = begin + 1;
    while (end < v.size() && std::abs(v[end] - v[begin]) <= steady * std::abs(v[begin])) ++end;
    const double duration = static_cast<double>(end - begin) * period;
    if (std::abs(v[begin]) < rest || duration < shortest_plateau) {
      ++begin;
      continue;
    }
    double mean = 0.0;
    for (std::size_t k = begin; k < end; ++k) mean += v[k] / static_cast<double>(end - begin);
    if (std::abs(mean) * duration < sliding) {
      begin = end;
      continue;
    }
    const auto known = std::ranges::find_if(
        plateaus, [&](const auto& p) { return std::abs(p.speed - mean) <= same_speed * std::abs(mean); });
    if (known == plateaus.end())
      plateaus.push_back({mean, duration});
    else
      known->duration += duration;
    begin = end;
  }
  std::ranges::sort(plateaus, {}, &SpeedPlateau::speed);
  return plateaus;
}

// Runs of one value within a ten-thousandth of the greatest magnitude.
std::optional<Saturation> saturation_of(const LogChannel& channel, const Values& values, double period) {
  const double top = largest_magnitude(values);
  if (top == 0.0) return std::nullopt;
  const auto least = static_cast<std::size_t>(std::max(5.0, std::ceil(held_still / period)));
  std::size_t run = 0, held = 0;
  for (std::size_t k = 0; k <= values.size(); ++k) {
    const bool at_end =
        k < values.size() && std::abs(values[k]) >= (1.0 - 1e-4) * top && (run == 0 || values[k] * values[k - 1] > 0.0);
    if (at_end) {
      ++run;
      continue;
    }
    if (run >= least) held += run;
    run = 0;
  }
  if (held == 0) return std::nullopt;
  return Saturation{channel.name, top, static_cast<double>(held) / static_cast<double>(values.size())};
}

std::optional<RigidFit> fit_effort(const Values& effort, const FittedMotion& motion, double rest, double period) {
  std::vector<std::size_t> moving;
  for (std::size_t k = 0; k < effort.size(); ++k)
    if (std::abs(motion.v[k]) >= rest) moving.push_back(k);
  if (moving.size() < 20) return std::nullopt;
  const auto rows = static_cast<Eigen::Index>(moving.size());
  Eigen::MatrixXd columns(rows, 4);
  Eigen::VectorXd values(rows);
  for (Eigen::Index r = 0; r < rows; ++r) {
    const auto k = moving[static_cast<std::size_t>(r)];
    columns.row(r) << motion.a[k], motion.v[k], std::copysign(1.0, motion.v[k]), 1.0;
    values[r] = effort[k];
  }
  // Scaled to one, so that a column that hardly moves is no rounding problem; one that does not move stays 0.
  Eigen::Vector4d scale;
  for (int c = 0; c < 4; ++c) scale[c] = std::max(columns.col(c).norm(), 1e-300);
  const Eigen::MatrixXd unit = columns * scale.cwiseInverse().asDiagonal();
  const Eigen::Matrix4d normal = unit.transpose() * unit + 1e-12 * Eigen::Matrix4d::Identity();
  const Eigen::Matrix4d inverse = normal.inverse();
  const Eigen::Vector4d solution = inverse * (unit.transpose() * values);
  const double residual = (values - unit * solution).norm() / std::sqrt(static_cast<double>(rows));
  const double count = std::max(5.0, static_cast<double>(rows) * std::min(1.0, period / independent));
  RigidFit fit;
  fit.residual = residual;
  for (int c = 0; c < 4; ++c) {
    const auto at = static_cast<std::size_t>(c);
    fit.value[at] = solution[c] / scale[c];
    fit.error[at] = residual * std::sqrt(inverse(c, c) * static_cast<double>(rows) / count) / scale[c];
    fit.inflation[at] = inverse(c, c);
  }
  return fit;
}

// Of a over b.
double slope_through_origin(const Values& a, const Values& b) {
  double ab = 0.0, bb = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) ab += a[k] * b[k], bb += b[k] * b[k];
  return bb > 0.0 ? ab / bb : 0.0;
}

std::optional<double> delay_of(const AxisLog& axis, const FittedMotion& motion) {
  if (axis.x_set.empty()) return std::nullopt;
  // About the mean: the encoder may have another zero.
  Values behind(axis.x.size());
  double mean = 0.0;
  for (std::size_t k = 0; k < behind.size(); ++k)
    mean += (axis.x_set[k] - axis.x[k]) / static_cast<double>(behind.size());
  for (std::size_t k = 0; k < behind.size(); ++k) behind[k] = axis.x_set[k] - axis.x[k] - mean;
  return slope_through_origin(behind, motion.v);
}

AxisInspection inspect_axis(const Log& log, const AxisLog& axis, const KnownAxis& known) {
  AxisInspection out;
  out.axis = axis.axis;
  const auto motion = fitted_motion(axis.x, log.period);
  const auto [least, most] = std::ranges::minmax(axis.x);
  out.stroke = most - least;
  out.max_speed = largest_magnitude(motion.v);
  out.max_acceleration = largest_magnitude(motion.a);
  const double rest = rest_speed(motion.v);
  std::size_t moving = 0, forward = 0;
  for (const double v : motion.v) {
    moving += std::abs(v) >= rest;
    forward += v >= rest;
  }
  out.at_rest = 1.0 - static_cast<double>(moving) / static_cast<double>(motion.v.size());
  out.forward = moving > 0 ? static_cast<double>(forward) / static_cast<double>(moving) : 0.0;
  out.reversals = count_reversals(motion.v, rest);
  out.plateaus = plateaus_of(motion.v, rest, log.period);
  for (const auto* name : {"i", "F", "u"})
    for (const auto& channel : log_channels)
      if (std::string_view(channel.name) == name && !(axis.*channel.values).empty()) {
        if (out.effort == nullptr) out.effort = &channel;
        if (const auto found = saturation_of(channel, axis.*channel.values, log.period))
          out.saturation.push_back(*found);
      }
  if (out.effort != nullptr && out.stroke > sliding)
    out.fit = fit_effort(axis.*out.effort->values, motion, rest, log.period);
  if (!axis.i.empty() && !axis.force.empty()) out.force_per_current = slope_through_origin(axis.force, axis.i);
  const bool fitted = out.fit && out.fit->value[0] > 4.0 * out.fit->error[0];
  if (fitted && known.mass) out.force_constant = *known.mass / out.fit->value[0];
  out.delay = delay_of(axis, motion);
  for (const auto& channel : log_channels)
    if (const auto& values = axis.*channel.values; !values.empty())
      out.resolution.push_back({&channel, increment_of(axis, channel.values), noise_of(values)});
  out.limited = limited_channels(log, axis, known.effort_limit);
  // A rounded peak repeats its greatest value too.
  std::erase_if(out.saturation, [&](const Saturation& s) {
    return out.effort != nullptr && s.channel == out.effort->name &&
           std::ranges::none_of(out.limited, [&](const auto& l) { return l.channel == out.effort; });
  });
  AxisLog masked;
  masked.left_out = axis.left_out;
  out.left_out = static_cast<double>(leave_out(masked, out.limited)) / static_cast<double>(axis.x.size());
  out.questions = questions_of(log, axis, known);
  if (!known.mass || !known.force_constant) out.only_a_ratio = known_only_as_ratio(log, axis);
  add_suspicions(log, axis, known, out);
  if (!axis.rotary) add_determinable(log, axis, known, motion, out);
  return out;
}

}  // namespace

FittedMotion fitted_motion(const Values& x, double period) {
  const auto samples = static_cast<int>(x.size());
  const int half = std::max(1, std::min(std::max(2, static_cast<int>(0.5 * window / period)), (samples - 1) / 2));
  FittedMotion motion{Values(x.size()), Values(x.size())};
  if (samples < 3) {
    motion.v.assign(x.size(), (x.back() - x.front()) / period);
    return motion;
  }
  // Sums over the window of s^2 and s^4 for s = -half..half.
  double s2 = 0.0, s4 = 0.0;
  for (int s = -half; s <= half; ++s) s2 += s * s, s4 += std::pow(s, 4);
  const double n = 2.0 * half + 1.0;
  for (int k = 0; k < samples; ++k) {
    const int middle = std::clamp(k, half, samples - 1 - half);
    const double origin = x[static_cast<std::size_t>(middle)];
    double first = 0.0, second = 0.0, sum = 0.0;
    for (int s = -half; s <= half; ++s) {
      const double value = x[static_cast<std::size_t>(middle + s)] - origin;
      sum += value;
      first += s * value;
      second += s * s * value;
    }
    const double curvature = 2.0 * (n * second - s2 * sum) / (n * s4 - s2 * s2);
    const auto at = static_cast<std::size_t>(k);
    motion.a[at] = curvature / (period * period);
    motion.v[at] = (first / s2 + curvature * (k - middle)) / period;
  }
  return motion;
}

Inspection inspect(const Log& log, const std::vector<KnownAxis>& known) {
  Inspection inspection;
  inspection.duration = log.t.back() - log.t.front();
  for (std::size_t k = 0; k < log.axes.size(); ++k)
    inspection.axes.push_back(inspect_axis(log, log.axes[k], k < known.size() ? known[k] : KnownAxis{}));
  return inspection;
}

}  // namespace stiction::host
