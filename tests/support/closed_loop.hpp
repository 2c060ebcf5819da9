// Runs the control loop over a backend and a set-point function and keeps every signal.
#pragma once

#include <cstring>
#include <vector>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "hal/control_loop.hpp"
#include "sim/effects/effects.hpp"
#include "sim/experiment/set_point.hpp"

namespace stiction::test {

template <class S>
std::vector<AxisConfig<S>> configurations(const machine::Machine& machine) {
  std::vector<AxisConfig<S>> configs;
  for (const auto& axis : machine.axes)
    configs.push_back(machine::configure_axis<S>(machine.timing, sim::drive_axis(axis)));
  return configs;
}

inline Ticker ticker_of(const machine::Machine& machine) {
  return Ticker(machine::fast_period_ns(machine.timing),
                static_cast<std::uint32_t>(machine::slow_ratio(machine.timing)));
}

// `set_points(t)` gives one sim::AxisSetPoint an axis at t s; `each_tick(loop, i)` sees the loop before tick i.
template <hal::Backend B, class SetPoints, class EachTick>
std::vector<AxisSignals<typename B::Signals>> record(B& backend, const machine::Machine& machine, int ticks,
                                                     SetPoints&& set_points, EachTick&& each_tick) {
  using S = typename B::Signals;
  const auto configs = configurations<S>(machine);
  hal::ControlLoop loop(backend, std::span<const AxisConfig<S>>(configs), ticker_of(machine));
  std::vector<AxisSignals<S>> trace;
  std::vector<SetPoint<S>> set(machine.axes.size());
  for (int i = 0; i < ticks && !loop.faulted(); ++i) {
    each_tick(loop, i);
    const auto si = set_points(static_cast<double>(loop.now_ns()) * 1e-9);
    for (std::size_t k = 0; k < set.size(); ++k) set[k] = sim::to_set_point<S>(si[k]);
    loop.tick(set);
    trace.insert(trace.end(), loop.signals().begin(), loop.signals().end());
  }
  return trace;
}

// The numbers of a trace as raw words, so that two traces can be compared to the bit.
template <class S>
std::vector<std::int64_t> raw_words(const std::vector<AxisSignals<S>>& trace) {
  std::vector<std::int64_t> words;
  for (const auto& s : trace) {
    for_each_signal(s, [&](auto, auto, auto, auto value) { words.push_back(value.raw()); });
    words.push_back(s.limiting.velocity | s.limiting.current << 1 | s.limiting.voltage << 2 |
                    static_cast<int>(s.fault) << 3);
  }
  return words;
}

}  // namespace stiction::test
