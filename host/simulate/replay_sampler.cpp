#include "host/simulate/replay_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/simulate/endless_counter.hpp"
#include "sim/effects/time_skew/time_skew.hpp"

namespace stiction::host {
namespace {

// Everything but the phase, which is that of the earlier tick: it jumps at the end of a turn.
ReplaySample between(const ReplaySample& a, const ReplaySample& b, double s) {
  if (s > 1.0 - 1e-4) return b;  // to the bit, whatever the rounding of the two clocks
  const auto mix = [s](double p, double q) { return p + s * (q - p); };
  return {mix(a.x, b.x),         mix(a.v, b.v),           mix(a.i, b.i), mix(a.i_set, b.i_set),
          mix(a.force, b.force), mix(a.x_load, b.x_load), a.phase};
}

}  // namespace

ReplaySampler::ReplaySampler(const Log& log, const std::vector<std::size_t>& axes, const machine::Machine& machine)
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

// Calls keep(place between the last two ticks) for every sample that is due; what is recorded early ends with the
// log, where the last value stays.
template <class Keep>
void ReplaySampler::take(std::size_t& next, double delay, double earlier, Keep&& keep) const {
  for (; next < times_.size(); ++next) {
    const double due = std::min(times_[next] - delay, times_.back());
    // Stamps and ticks are multiples of different steps: a nanosecond is none.
    if (due > time_ + 1e-9) return;
    keep(std::isfinite(earlier) ? std::clamp((due - earlier) / (time_ - earlier), 0.0, 1.0) : 1.0);
  }
}

bool ReplaySampler::done() const {
  return std::all_of(places_.begin(), places_.end(),
                     [&](const Place& p) { return p.next_motion == times_.size() && p.next_current == times_.size(); });
}

void ReplaySampler::add(double t, std::vector<ReplaySample>& values) {
  before_.swap(now_);
  now_.swap(values);
  const double earlier = std::exchange(time_, t);
  for (std::size_t k = 0; k < places_.size(); ++k) {
    Place& p = places_[k];
    take(p.next_motion, 0.0, earlier, [&](double s) { keep_motion(k, between(before_[k], now_[k], s)); });
    take(p.next_current, p.delay, earlier, [&](double s) { keep_current(k, between(before_[k], now_[k], s)); });
  }
}

void ReplaySampler::keep_motion(std::size_t k, const ReplaySample& sample) {
  out_.axes[k].x.push_back(sample.x);
  out_.axes[k].v.push_back(sample.v);
  if (machine_.axes[places_[k].axis].second_encoder) out_.axes[k].x_load.push_back(sample.x_load);
  if (machine_.axes[places_[k].axis].modulo_counts) out_.axes[k].phase.push_back(sample.phase);
}

void ReplaySampler::keep_current(std::size_t k, const ReplaySample& sample) {
  auto& axis = out_.axes[k];
  const auto& simulated = machine_.axes[places_[k].axis];
  axis.force.push_back(sample.force);
  if (simulated.commanded_in_volts()) axis.u.push_back(sample.i_set);
  if (simulated.motor.driven_by_volts()) return;
  const bool ideal = simulated.motor.model == machine::MotorModel::force;  // its current is the command
  axis.i.push_back(ideal ? sample.i_set : sample.i);
  if (!ideal && !simulated.commanded_in_volts()) axis.i_set.push_back(sample.i_set);
}

}  // namespace stiction::host
