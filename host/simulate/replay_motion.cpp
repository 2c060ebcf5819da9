#include "host/simulate/replay_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/simulate/replay.hpp"
#include "host/simulate/swing_time.hpp"

namespace stiction::host {
namespace {

constexpr double default_following_error = 2e-3;  // m, as sim::Supervision says

double allowed_following_error(const machine::AxisModel& axis) {
  // No supervision says how far an axis with a different controller may lag or sag.
  if (!axis.cascaded()) return std::numeric_limits<double>::infinity();
  return axis.supervision.following_error.value_or(default_following_error);
}

void require_within_limits(const Log& log, const AxisLog& axis, const machine::AxisModel& machine_axis,
                           const SetPoints& points) {
  const auto& v = points.velocity();
  for (std::size_t k = 0; k < v.size(); ++k)
    if (std::abs(v[k]) > machine_axis.max_velocity) {
      const auto own = machine_axis.coordinate.own("m/s");
      throw LogError(
          fmt::format("{}: sample {}: found a set velocity of {:.4g} {}{}; expected at most {:.4g} {}, the "
                      "max_velocity of axis {}",
                      log.source, k + 1, own.from_linear(v[k]), own.unit, axis.v_set.empty() ? " (from x_set)" : "",
                      own.from_linear(machine_axis.max_velocity), own.unit, machine_axis.name));
    }
}

}  // namespace

ReplayMotion::ReplayMotion(const Log& log, const AxisLog& channels, const machine::AxisModel& axis)
    : points_(log, channels), begin_(log.t.front()), start_(begin_) {
  repeats_ = repeating_motion(log, channels, points_);
  // An axis with ends has not come there from further and further away.
  if (repeats_ && !axis.modulo && std::abs(repeats_->rise) > 1e-3 * axis.travel) repeats_.reset();
  if (repeats_)
    start_ = rest() - repeats_->period * std::ceil((rest() - begin_ + swing_time(axis)) / repeats_->period + 1.0);
  const auto first = repeated(start_);
  v_ = first.velocity;
  a_ = first.acceleration;
  x_ = first.position;
  moving_ = std::abs(v_) > 1e-5;  // m/s; less is what rounding of x_set leaves

  const double back_to_rest = a_ != 0.0 ? v_ / a_ : -1.0;
  uniform_ = back_to_rest > 0.0 && back_to_rest <= longest_lead_in;
  length_ = !moving_ ? 0.0 : uniform_ ? back_to_rest : longest_lead_in;
  // The cascade clips its set speed; other structures have no such limit.
  if (axis.cascaded()) require_within_limits(log, channels, axis, points_);
}

sim::AxisSetPoint ReplayMotion::at(double t) const {
  if (t >= begin_) return points_.at(t);
  if (t >= start_) return repeated(t);
  if (!moving_) return {x_, 0.0, 0.0};
  const double s = std::max(0.0, 1.0 - (start_ - t) / length_);  // 0 to 1 along the lead-in
  if (uniform_) {
    const double v = s * v_;
    return {x_ - 0.5 * (v_ + v) * length_ * (1.0 - s), v, s > 0.0 ? a_ : 0.0};
  }
  // v = s^2 (b + c s) with v(1) = v_ and the log's first acceleration.
  const double b = 3.0 * v_ - a_ * length_, c = a_ * length_ - 2.0 * v_;
  const auto way = [&](double u) { return u * u * u * (b / 3.0 + 0.25 * c * u); };
  return {x_ - length_ * (way(1.0) - way(s)), s * s * (b + c * s), s * (2.0 * b + 3.0 * c * s) / length_};
}

// Of a motion that repeats, at t s before the log as in its first cycle.
sim::AxisSetPoint ReplayMotion::repeated(double t) const {
  if (!repeats_) return points_.at(t);
  const double cycles = std::ceil((begin_ - t) / repeats_->period);
  auto point = points_.at(t + cycles * repeats_->period);
  point.position -= cycles * repeats_->rise;
  return point;
}
// The time of the first cycle at which the axis is slowest, s.
double ReplayMotion::rest() const {
  const auto& v = points_.velocity();
  const auto end = v.begin() + static_cast<std::ptrdiff_t>(repeats_->period / points_.period());
  const auto slowest = std::min_element(v.begin(), end, [](double a, double b) { return std::abs(a) < std::abs(b); });
  return begin_ + static_cast<double>(slowest - v.begin()) * points_.period();
}

double at_time(const Log& log, const std::vector<double>& values, double t) {
  const double place = (t - log.t.front()) / log.period;
  if (values.empty() || place < 0.0 || place > static_cast<double>(values.size() - 1)) return 0.0;
  const auto k = std::min(static_cast<std::size_t>(place), values.size() - 2);
  return values[k] + (values[k + 1] - values[k]) * (place - static_cast<double>(k));
}

double encoder_offset(const AxisLog& axis, double allowed) {
  if (axis.x_set.empty() || axis.x.empty()) return 0.0;
  double sum = 0.0;
  for (std::size_t k = 0; k < axis.x.size(); ++k) sum += axis.x[k] - axis.x_set[k];
  const double mean = sum / static_cast<double>(axis.x.size());
  return std::abs(mean) > allowed ? mean : 0.0;
}

double replay_zero(const machine::Machine& machine, const Log& log, double lead_in) {
  const double slow = machine.timing.slow_period;
  return log.t.front() - std::ceil(lead_in / slow - 1e-9) * slow;
}

void finish_replay(AxisLog& channels, const AxisLog& recorded, const machine::AxisModel& axis,
                   const ReplayMotion& motion) {
  channels.x_set = recorded.x_set;
  channels.v_set = motion.points().velocity();
  channels.a_set = motion.points().acceleration();
  const double offset = encoder_offset(recorded, allowed_following_error(axis));
  for (double& x : channels.x) x += offset;
}

}  // namespace stiction::host
