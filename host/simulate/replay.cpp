#include "host/simulate/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "firmware/machine/configuration/double_signals.hpp"
#include "host/log/own_units.hpp"
#include "host/log/repeating_motion.hpp"
#include "host/log/set_points.hpp"
#include "host/simulate/endless_counter.hpp"
#include "host/simulate/injection.hpp"
#include "host/simulate/swing_time.hpp"
#include "sim/effects/effects.hpp"
#include "sim/effects/time_skew/time_skew.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

constexpr double default_following_error = 2e-3;  // m, as sim::Supervision says

// An axis' set-points with the way to the log's first one.
class Motion {
 public:
  Motion(const Log& log, const AxisLog& channels, const machine::AxisModel& axis)
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
  }

  double lead_in() const { return begin_ - start_ + length_; }  // s

  // At t s on the log's clock; before the lead-in the axis rests at its beginning.
  sim::AxisSetPoint at(double t) const {
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

  const SetPoints& points() const { return points_; }

 private:
  // Of a motion that repeats, at t s before the log as in its first cycle.
  sim::AxisSetPoint repeated(double t) const {
    if (!repeats_) return points_.at(t);
    const double cycles = std::ceil((begin_ - t) / repeats_->period);
    auto point = points_.at(t + cycles * repeats_->period);
    point.position -= cycles * repeats_->rise;
    return point;
  }
  // The time of the first cycle at which the axis is slowest, s.
  double rest() const {
    const auto& v = points_.velocity();
    const auto end = v.begin() + static_cast<std::ptrdiff_t>(repeats_->period / points_.period());
    const auto slowest = std::min_element(v.begin(), end, [](double a, double b) { return std::abs(a) < std::abs(b); });
    return begin_ + static_cast<double>(slowest - v.begin()) * points_.period();
  }

  SetPoints points_;
  std::optional<RepeatingMotion> repeats_;
  double begin_, start_;  // s; of the log, and of the cycles that are gone through before it
  double v_ = 0.0, a_ = 0.0, x_ = 0.0;
  bool moving_ = false, uniform_ = false;
  double length_ = 0.0;
};

double allowed_following_error(const machine::AxisModel& axis) {
  // No supervision says how far an axis with a different controller may lag or sag.
  if (!axis.cascaded()) return std::numeric_limits<double>::infinity();
  return axis.supervision.following_error.value_or(default_following_error);
}

void require_within_limits(const Log& log, const AxisLog& axis, const machine::AxisModel& machine_axis,
                           const Motion& motion) {
  const auto& v = motion.points().velocity();
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

// The values of one axis that a replay keeps, at one time.
struct Sample {
  double x = 0.0, v = 0.0, i = 0.0, i_set = 0.0, force = 0.0, x_load = 0.0;
  std::uint32_t phase = 0;  // 2^-32 turns
};

// Everything but the phase, which is that of the earlier tick: it jumps at the end of a turn.
Sample between(const Sample& a, const Sample& b, double s) {
  if (s > 1.0 - 1e-4) return b;  // to the bit, whatever the rounding of the two clocks
  const auto mix = [s](double p, double q) { return p + s * (q - p); };
  return {mix(a.x, b.x),         mix(a.v, b.v),           mix(a.i, b.i), mix(a.i_set, b.i_set),
          mix(a.force, b.force), mix(a.x_load, b.x_load), a.phase};
}

// Collects the simulated values at the log's times; currents at the times at which the machine's record has them.
class Sampler {
 public:
  Sampler(const Log& log, const std::vector<std::size_t>& axes, const machine::Machine& machine)
      : times_(log.t), machine_(machine), before_(log.axes.size()), now_(log.axes.size()) {
    out_.source = log.source;
    out_.t = log.t;
    out_.period = log.period;
    for (const auto& axis : log.axes) out_.axes.emplace_back().axis = axis.axis;
    for (const std::size_t axis : axes) places_.push_back({axis, sim::record_delay(machine.axes[axis])});
    for (std::size_t k = 0; k < axes.size(); ++k)
      if (machine.axes[axes[k]].modulo_counts) out_.axes[k].turn = shown_turn(machine.axes[axes[k]]);
    for (auto& axis : out_.axes)
      for (auto* values : {&axis.x, &axis.v, &axis.force, &axis.i, &axis.i_set}) values->reserve(times_.size());
  }

  bool done() const {
    return std::all_of(places_.begin(), places_.end(), [&](const Place& p) {
      return p.next_motion == times_.size() && p.next_current == times_.size();
    });
  }

  // The values of the tick at t s; ticks come in order. Leaves `values` with others.
  void add(double t, std::vector<Sample>& values) {
    before_.swap(now_);
    now_.swap(values);
    const double earlier = std::exchange(time_, t);
    for (std::size_t k = 0; k < places_.size(); ++k) {
      Place& p = places_[k];
      take(p.next_motion, 0.0, earlier, [&](double s) { keep_motion(k, between(before_[k], now_[k], s)); });
      take(p.next_current, p.delay, earlier, [&](double s) { keep_current(k, between(before_[k], now_[k], s)); });
    }
  }

  Log finish() { return std::move(out_); }

 private:
  struct Place {
    std::size_t axis;  // of the machine
    double delay;      // s
    std::size_t next_motion = 0, next_current = 0;
  };

  // Calls keep(place between the last two ticks) for every sample that is due; what is recorded early ends with the
  // log, where the last value stays.
  template <class Keep>
  void take(std::size_t& next, double delay, double earlier, Keep&& keep) const {
    for (; next < times_.size(); ++next) {
      const double due = std::min(times_[next] - delay, times_.back());
      // Stamps and ticks are multiples of different steps: a nanosecond is none.
      if (due > time_ + 1e-9) return;
      keep(std::isfinite(earlier) ? std::clamp((due - earlier) / (time_ - earlier), 0.0, 1.0) : 1.0);
    }
  }

  void keep_motion(std::size_t k, const Sample& sample) {
    out_.axes[k].x.push_back(sample.x);
    out_.axes[k].v.push_back(sample.v);
    if (machine_.axes[places_[k].axis].second_encoder) out_.axes[k].x_load.push_back(sample.x_load);
    if (machine_.axes[places_[k].axis].modulo_counts) out_.axes[k].phase.push_back(sample.phase);
  }
  void keep_current(std::size_t k, const Sample& sample) {
    auto& axis = out_.axes[k];
    const auto& simulated = machine_.axes[places_[k].axis];
    axis.force.push_back(sample.force);
    if (simulated.commanded_in_volts()) axis.u.push_back(sample.i_set);
    if (simulated.motor.driven_by_volts()) return;
    const bool ideal = simulated.motor.model == machine::MotorModel::force;  // its current is the command
    axis.i.push_back(ideal ? sample.i_set : sample.i);
    if (!ideal && !simulated.commanded_in_volts()) axis.i_set.push_back(sample.i_set);
  }

  const std::vector<double>& times_;
  const machine::Machine& machine_;
  std::vector<Place> places_;
  std::vector<Sample> before_, now_;
  double time_ = -std::numeric_limits<double>::infinity();
  Log out_;
};

// Linear between the log's samples; 0 outside them.
double at_time(const Log& log, const std::vector<double>& values, double t) {
  const double place = (t - log.t.front()) / log.period;
  if (values.empty() || place < 0.0 || place > static_cast<double>(values.size() - 1)) return 0.0;
  const auto k = std::min(static_cast<std::size_t>(place), values.size() - 2);
  return values[k] + (values[k + 1] - values[k]) * (place - static_cast<double>(k));
}

}  // namespace

std::vector<std::size_t> match_axes(const machine::Machine& machine, const Log& log, const std::string& axis) {
  std::string known;
  for (const auto& each : machine.axes) known += (known.empty() ? "" : ", ") + each.name;
  const auto index_of = [&](const std::string& name) {
    for (std::size_t k = 0; k < machine.axes.size(); ++k)
      if (machine.axes[k].name == name) return k;
    throw LogError(fmt::format("{}: found the axis {}; expected one of {}: {}", log.source, name, machine.id, known));
  };
  std::vector<std::size_t> indices;
  for (const auto& each : log.axes) {
    if (!each.axis.empty())
      indices.push_back(index_of(each.axis));
    else if (!axis.empty())
      indices.push_back(index_of(axis));
    else if (machine.axes.size() == 1)
      indices.push_back(0);
    else
      throw LogError(
          fmt::format("{}: found channels without an axis, and {} has several; expected --axis with one of: "
                      "{}",
                      log.source, machine.id, known));
  }
  return indices;
}

double encoder_offset(const AxisLog& axis, double allowed) {
  if (axis.x_set.empty() || axis.x.empty()) return 0.0;
  double sum = 0.0;
  for (std::size_t k = 0; k < axis.x.size(); ++k) sum += axis.x[k] - axis.x_set[k];
  const double mean = sum / static_cast<double>(axis.x.size());
  return std::abs(mean) > allowed ? mean : 0.0;
}

template <class S>
Log replay_linear(const machine::Machine& machine, const Log& log, const ReplaySettings& settings,
                  const TraceSink<S>& trace) {
  const auto indices = match_axes(machine, log, settings.axis);
  std::vector<Motion> motions;
  std::vector<Injection> injections;
  std::vector<double> start(machine.axes.size(), 0.0);
  double lead_in = 0.0;
  for (std::size_t k = 0; k < indices.size(); ++k) {
    motions.emplace_back(log, log.axes[k], machine.axes[indices[k]]);
    injections.emplace_back(log, log.axes[k], machine.axes[indices[k]]);
    // The cascade clips its set speed; other structures have no such limit.
    if (machine.axes[indices[k]].cascaded())
      require_within_limits(log, log.axes[k], machine.axes[indices[k]], motions.back());
    lead_in = std::max(lead_in, motions.back().lead_in());
  }
  // Whole slow periods before the log.
  const double slow = machine.timing.slow_period;
  const double zero = log.t.front() - std::ceil(lead_in / slow - 1e-9) * slow;  // on the log's clock
  for (std::size_t k = 0; k < indices.size(); ++k) start[indices[k]] = motions[k].at(zero).position;

  ControlRun<S> run(machine, start);
  Sampler sampler(log, indices, machine);
  std::vector<sim::AxisSetPoint> points(machine.axes.size());
  std::vector<Sample> values(indices.size());
  std::vector<EndlessCounter> counters;
  for (const std::size_t index : indices) counters.emplace_back(machine.axes[index]);
  while (!sampler.done()) {
    const double t = zero + run.time();
    for (std::size_t k = 0; k < indices.size(); ++k) {
      points[indices[k]] = motions[k].at(t);
      points[indices[k]].injection = injections[k].at(t);
      auto& plant = run.plant(indices[k]);
      if (!log.axes[k].external_force.empty()) plant.set_external_force(at_time(log, log.axes[k].external_force, t));
      values[k].force = plant.motor_force();
      values[k].x_load = plant.read_second_encoder().value_or(0.0);
    }
    run.tick(points, trace);
    for (std::size_t k = 0; k < indices.size(); ++k) {
      const auto& s = run.signals(indices[k]);
      values[k] = {machine::to_si(s.x),     machine::to_si(s.v), machine::to_si(s.i),
                   machine::to_si(s.i_set), values[k].force,     values[k].x_load};
      if (!counters[k].counts_phase()) continue;
      counters[k].see(run.encoder_counts(indices[k]));
      values[k].phase = counters[k].phase();
    }
    sampler.add(t, values);
  }
  auto out = sampler.finish();
  for (std::size_t k = 0; k < indices.size(); ++k) {
    auto& axis = out.axes[k];
    axis.x_set = log.axes[k].x_set;
    axis.v_set = motions[k].points().velocity();
    axis.a_set = motions[k].points().acceleration();
    const double offset = encoder_offset(log.axes[k], allowed_following_error(machine.axes[indices[k]]));
    for (double& x : axis.x) x += offset;
  }
  return out;
}

template <class S>
Log replay(const machine::Machine& machine, const Log& log, const ReplaySettings& settings, const TraceSink<S>& trace) {
  const auto indices = match_axes(machine, log, settings.axis);
  const auto coordinate = [&](std::size_t k) { return machine.axes[indices[k]].coordinate; };
  bool any = false;
  for (std::size_t k = 0; k < indices.size(); ++k) {
    require_same_kind(log, log.axes[k], machine.axes[indices[k]]);
    any = any || coordinate(k).rotary();
  }
  if (!any) return replay_linear<S>(machine, log, settings, trace);
  Log linear = log;
  for (std::size_t k = 0; k < indices.size(); ++k) linear.axes[k] = as_linear(std::move(linear.axes[k]), coordinate(k));
  Log out = replay_linear<S>(machine, linear, settings, trace);
  for (std::size_t k = 0; k < indices.size(); ++k) out.axes[k] = in_own_units(std::move(out.axes[k]), coordinate(k));
  return out;
}

Log replay_linear_as_held(const machine::Machine& machine, const Log& log, const ReplaySettings& settings) {
  return machine.fits_formats() ? replay_linear<FixedSignals>(machine, log, settings)
                                : replay_linear<machine::DoubleSignals>(machine, log, settings);
}

template Log replay_linear<FixedSignals>(const machine::Machine&, const Log&, const ReplaySettings&,
                                         const TraceSink<FixedSignals>&);
template Log replay_linear<machine::DoubleSignals>(const machine::Machine&, const Log&, const ReplaySettings&,
                                                   const TraceSink<machine::DoubleSignals>&);
template Log replay<FixedSignals>(const machine::Machine&, const Log&, const ReplaySettings&,
                                  const TraceSink<FixedSignals>&);
template Log replay<machine::DoubleSignals>(const machine::Machine&, const Log&, const ReplaySettings&,
                                            const TraceSink<machine::DoubleSignals>&);

}  // namespace stiction::host
