// The stick-slip feed in time: see stick_slip_feed.hpp.
#include "sim/plant/feed/stick_slip_feed.hpp"

#include <algorithm>
#include <cmath>

namespace stiction::sim {
namespace {

using namespace feed_state;

constexpr double smallest_step = 1e-13;    // s; below, the error estimate is rounding
constexpr double step_after_event = 1e-6;  // s; the tool's force begins and ends with an infinite slope
constexpr double smallest_scale = 1e-30;   // of a state that stays zero
constexpr double safety = 0.9, shrinks_most = 0.2, grows_most = 5.0;

// How large each state becomes when the drive carries static friction at the set feed: the floor of its error's scale.
FeedState sizes(const machine::FeedDrive& d, double feed) {
  const double per_angle = d.lead / (2.0 * std::numbers::pi), rest = d.friction.normal_load * d.friction.static_long;
  FeedState size{};
  size[wind_up] = size[travel] = rest / d.carriage.stiffness;
  size[speed] = feed;
  size[motor_speed] = feed / per_angle;
  size[current] = rest * per_angle / d.motor.torque_constant;
  size[voltage] = d.motor.torque_constant * size[motor_speed] + d.motor.resistance * size[current];
  size[speed_integral] = d.current_controller.feedback * size[current];
  size[current_integral] = size[voltage] / d.converter.gain;
  const double ratio = feed / d.tool.reference_speed;
  size[tool_x] = d.tool.force_x * std::pow(ratio, d.tool.exponent_x) / d.tool.stiffness_x;
  size[tool_z] = d.tool.force_z * std::pow(ratio, d.tool.exponent_z) / d.tool.stiffness_z;
  size[tool_x_speed] = size[tool_x] * std::sqrt(d.tool.stiffness_x / d.tool.mass);
  size[tool_z_speed] = size[tool_z] * std::sqrt(d.tool.stiffness_z / d.tool.mass);
  for (double& each : size) each = std::max(each, smallest_scale);
  return size;
}

}  // namespace

StickSlipFeed::StickSlipFeed(const machine::FeedDrive& drive, FeedSource source, FeedEquations equations, double feed,
                             FeedAccuracy accuracy)
    : system_(drive, source, equations, feed), accuracy_(accuracy), scale_(sizes(drive, feed)) {
  derivative_ = system_.derivative(state_, sliding_);
}

double StickSlipFeed::threshold() const {
  const auto& d = system_.drive();
  if (sliding_) return d.friction.in_motion(std::max(state_[speed], 0.0)) + d.cutting.force(state_[speed]);
  // As printed, C_c x6 exceeds (9) at every standstill but the first one: only (10) holds the carriage then.
  const bool held = jumps_.empty() || system_.equations().relative_stick;
  return (held ? d.friction.at_rest(time_ - stopped_at_) : d.friction.in_motion(0.0)) + d.cutting.constant_force;
}

double StickSlipFeed::event(const FeedState& state, double time) const {
  if (sliding_) return -state[speed];
  const auto& d = system_.drive();
  const double cutting = d.cutting.constant_force;
  if (!system_.equations().relative_stick) {
    if (!jumps_.empty()) return system_.drive_force(state) - d.friction.in_motion(0.0) - cutting;
    return d.carriage.stiffness * system_.drive_travel(state) - d.friction.at_rest(time - stopped_at_) - cutting;
  }
  return system_.drive_force(state) - d.friction.at_rest(time - stopped_at_) - cutting;
}

// A difference over a time in which no mode changes noticeably; only its sign is used.
double StickSlipFeed::event_slope(const FeedState& state, const FeedState& derivative, double time) const {
  constexpr double ahead = 1e-7;  // s
  FeedState later = state;
  for (std::size_t i = 0; i < later.size(); ++i) later[i] += ahead * derivative[i];
  return (event(later, time + ahead) - event(state, time)) / ahead;
}

StickSlipFeed::Step StickSlipFeed::step(double h) const {
  return dormand_prince(state_, derivative_, h,
                        [this](const FeedState& state) { return system_.derivative(state, sliding_); });
}

// Whether the step is accurate enough; `h` becomes the length to try next.
bool StickSlipFeed::accept(const Step& trial, double& h) {
  double worst = 0.0;
  for (std::size_t i = 0; i < feed_state::count; ++i) {
    const double scale = std::max(scale_[i], std::abs(trial.state[i]));
    worst = std::max(worst, std::abs(trial.error[i]) / (accuracy_.tolerance * scale));
  }
  const bool accepted = worst <= 1.0 || h <= smallest_step;
  h *= worst > 0.0 ? std::clamp(safety * std::pow(worst, -0.2), shrinks_most, grows_most) : grows_most;
  return accepted;
}

// The length after which the mode ends, within a step of length `h` that ends in `whole`; NaN when it does not.
double StickSlipFeed::first_event(const Step& whole, double h) const {
  const auto event_after = [&](double part) { return event(step(part).state, time_ + part); };
  const double at_start = event(state_, time_);
  double low = 0.0, high = h;
  if (event(whole.state, time_ + h) >= 0.0) {
    // A slide begins with speed zero: the event to find is the next one, behind the first instant of motion.
    if (at_start >= 0.0) {
      for (low = h; low > smallest_step && event_after(low) >= 0.0;) low *= 0.5;
      if (low <= smallest_step) return 0.0;
    }
  } else {
    // Both ends are on this side; the event may be touched between them.
    const auto slope_after = [&](double part) {
      const auto there = step(part);
      return event_slope(there.state, there.derivative, time_ + part);
    };
    if (event_slope(state_, derivative_, time_) <= 0.0 || event_slope(whole.state, whole.derivative, time_ + h) >= 0.0)
      return std::numeric_limits<double>::quiet_NaN();
    for (double rising = 0.0, falling = h; falling - rising > 1e-9 * h;) {
      high = 0.5 * (rising + falling);
      (slope_after(high) > 0.0 ? rising : falling) = high;
    }
    if (event_after(high) < 0.0) return std::numeric_limits<double>::quiet_NaN();
  }
  while (high - low > smallest_step && high - low > 1e-15 * time_) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (event_after(middle) < 0.0 ? low : high) = middle;
  }
  return high;
}

void StickSlipFeed::take_step(double limit) {
  const double remaining = limit - time_;
  double h = std::min({next_step_, accuracy_.largest_step, remaining});
  while (true) {
    const auto trial = step(h);
    double wanted = h;
    if (!accept(trial, wanted)) {
      h = wanted;
      continue;
    }
    const double ends = first_event(trial, h);
    if (std::isnan(ends)) {
      // A step cut short by the limit says nothing against the next one.
      next_step_ = h < remaining ? wanted : std::max(next_step_, wanted);
      move(trial, h);
      if (h >= remaining) time_ = limit;
    } else {
      move(step(ends), ends);
      change_mode();
    }
    return;
  }
}

void StickSlipFeed::move(const Step& step, double h) {
  time_ += h;
  state_ = step.state;
  derivative_ = step.derivative;
  for (std::size_t i = 0; i < feed_state::count; ++i) scale_[i] = std::max(scale_[i], std::abs(state_[i]));
  if (sliding_) jumps_.back().peak_speed = std::max(jumps_.back().peak_speed, state_[speed]);
}

void StickSlipFeed::change_mode() {
  state_[speed] = 0.0;
  if (sliding_) {
    jumps_.back().stop = time_;
    jumps_.back().stop_travel = state_[travel];
    stopped_at_ = time_;
  } else {
    FeedJump jump;
    jump.start = time_;
    jump.start_travel = state_[travel];
    jump.break_away_force = system_.drive_force(state_);
    jump.dwell = time_ - stopped_at_;
    jumps_.push_back(jump);
  }
  sliding_ = !sliding_;
  derivative_ = system_.derivative(state_, sliding_);
  next_step_ = step_after_event;
}

void StickSlipFeed::advance_to(double time) {
  while (time_ < time) take_step(time);
}

bool StickSlipFeed::advance_to_standstill(double time) {
  const auto stops = [this] { return jumps_.size() - (sliding_ ? 1 : 0); };
  const auto before = stops();
  while (time_ < time && stops() == before) take_step(time);
  return stops() > before;
}

}  // namespace stiction::sim
