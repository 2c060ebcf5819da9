// The record of a run in which the current comes late against the position, as the effect time_skew has it: the trace's
// current and voltage channels are those of an earlier time, or of a later one where the delay is negative.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "firmware/machine/configuration/conversion.hpp"
#include "sim/effects/effects.hpp"
#include "sim/effects/time_skew/time_skew.hpp"
#include "stiction/drive/axis_signals.hpp"

namespace stiction::host {

template <class S>
class LateCurrent {
 public:
  using Sink = std::function<void(std::int64_t, std::span<const AxisSignals<S>>)>;

  explicit LateCurrent(const machine::Machine& machine) {
    for (const auto& axis : machine.axes) {
      const double ticks = sim::record_delay(axis) / machine.timing.fast_period;
      delays_.push_back(ticks);
      longest_ = std::max(longest_, static_cast<std::size_t>(std::max(0.0, std::ceil(ticks))));
      ahead_ = std::max(ahead_, static_cast<std::size_t>(std::max(0.0, std::ceil(-ticks))));
    }
  }

  // Passes on the tick of `now_ns`, or, where the current is early, the tick as long ago as that: the record ends as
  // much sooner. Before the first tick the current is that of the first. `signals`: of the axes in this tick; `sink`:
  // takes the record.
  void record(std::int64_t now_ns, std::span<const AxisSignals<S>> signals, const Sink& sink) {
    if (longest_ == 0 && ahead_ == 0) return sink(now_ns, signals);
    ticks_.push_back({now_ns, {signals.begin(), signals.end()}});
    if (ticks_.size() > longest_ + ahead_ + 1) ticks_.pop_front();
    if (++seen_ <= ahead_) return;
    const std::size_t place = ticks_.size() - 1 - ahead_;
    auto row = ticks_[place].signals;
    for (std::size_t k = 0; k < row.size(); ++k) take_current(row[k], k, static_cast<double>(place) - delays_[k]);
    sink(ticks_[place].now_ns, row);
  }

 private:
  struct Tick {
    std::int64_t now_ns;
    std::vector<AxisSignals<S>> signals;
  };

  void take_current(AxisSignals<S>& s, std::size_t axis, double at) const {
    const double place = std::clamp(at, 0.0, static_cast<double>(ticks_.size() - 1));
    const auto before = static_cast<std::size_t>(place);
    const double share = place - static_cast<double>(before);
    const AxisSignals<S>& a = ticks_[before].signals[axis];
    const AxisSignals<S>& b = ticks_[std::min(before + 1, ticks_.size() - 1)].signals[axis];
    const auto mix = [&](const auto& p, const auto& q, auto& to) {
      machine::convert(machine::to_si(p) + share * (machine::to_si(q) - machine::to_si(p)), to);
    };
    mix(a.i, b.i, s.i);
    mix(a.i_set, b.i_set, s.i_set);
    for (std::size_t j = 0; j < s.i_phase.size(); ++j) {
      mix(a.i_phase[j], b.i_phase[j], s.i_phase[j]);
      mix(a.u_phase[j], b.u_phase[j], s.u_phase[j]);
    }
  }

  std::vector<double> delays_;  // in ticks, one an axis
  std::size_t longest_ = 0, ahead_ = 0;
  std::size_t seen_ = 0;
  std::deque<Tick> ticks_;
};

}  // namespace stiction::host
