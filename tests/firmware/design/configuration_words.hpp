// Every number of a drive's configuration as raw words, so that two can be compared to the bit.
#pragma once

#include <cstdint>
#include <vector>

#include "stiction/drive/axis.hpp"
#include "stiction/drive/friction_compensation.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::test {

inline std::vector<std::int64_t> words(const AxisConfig<FixedSignals>& c) {
  return {c.period_ns,
          c.inverse_period.raw(),
          c.quantizer.enabled,
          c.quantizer.per_metre.raw(),
          c.quantizer.increment.raw(),
          c.position_gain.raw(),
          c.velocity_feedforward.raw(),
          static_cast<int>(c.velocity_feedback),
          c.velocity.proportional.raw(),
          c.velocity.integral.raw(),
          c.velocity.tracking.raw(),
          c.notch.enabled,
          c.notch.b0.raw(),
          c.notch.b1.raw(),
          c.notch.b2.raw(),
          c.notch.a1.raw(),
          c.notch.a2.raw(),
          c.current_feedforward.raw(),
          static_cast<int>(c.current_loop),
          c.current.proportional.raw(),
          c.current.integral.raw(),
          c.current.tracking.raw(),
          c.inverse_pole_pair_pitch.raw(),
          c.velocity_limit.raw(),
          c.current_limit.raw(),
          c.voltage_limit.raw(),
          c.following_error_fault.raw(),
          c.over_current_fault.raw(),
          c.over_speed_fault.raw(),
          c.limit_cycle_window_ticks};
}

inline std::vector<std::int64_t> words(const FrictionCompensationConfig<FixedSignals>& c) {
  std::vector<std::int64_t> all{static_cast<int>(c.kind),
                                c.set_point_delay,
                                c.lag_ticks,
                                c.lag_fraction.raw(),
                                c.pulse.amplitude.raw(),
                                c.pulse.final_amplitude.raw(),
                                c.pulse.rise.raw(),
                                c.pulse.fall.raw(),
                                c.pulse.flat_until.raw(),
                                c.pulse.delay_ticks,
                                c.pulse.duration_ticks,
                                c.friction.damping.raw(),
                                c.friction.limit.raw(),
                                c.learning.adapt,
                                c.learning.rate_gain.raw(),
                                c.learning.error_gain.raw(),
                                c.learning.dead_zone.raw(),
                                c.learning.error_limit.raw(),
                                c.learning.filter.raw(),
                                c.learning.filter_rest.raw(),
                                c.learning.gain.raw(),
                                c.learning.keep.raw(),
                                c.learning.smoothing.raw(),
                                c.learning.limit.raw(),
                                c.learning.credit_ticks,
                                c.learning.tolerance.raw()};
  for (const auto& element : c.friction.elements) {
    all.push_back(element.reach.raw());
    all.push_back(element.stiffness.raw());
  }
  for (const auto* table : {&c.friction.forward, &c.friction.backward})
    for (const auto current : *table) all.push_back(current.raw());
  for (const auto& table : c.learning.tables)
    for (const auto current : table) all.push_back(current.raw());
  return all;
}

}  // namespace stiction::test
