// Configurations and signals of one axis in and out of a lane of a batch. What the kind of the axis decides is the same
// in all lanes, and the last one that is set gives it.
#pragma once

#include <array>
#include <cstddef>

#include "firmware/machine/batch/batch_signals.hpp"
#include "stiction/drive/axis.hpp"
#include "stiction/drive/friction_compensation.hpp"

namespace stiction::machine {

// Takes `from` into lane `k` of `to`.
template <class Isa>
STICTION_INLINE void set_lane(Batch<Isa>& to, std::size_t k, Real from) {
  to.set_lane(k, from.value);
}
// Takes `from` into lane `k` of `to`.
template <class Isa, std::size_t length>
STICTION_INLINE void set_lane(std::array<Batch<Isa>, length>& to, std::size_t k, const std::array<Real, length>& from) {
  for (std::size_t i = 0; i < length; ++i) set_lane(to[i], k, from[i]);
}

// Of a PI controller.
// Takes `from` into lane `k` of `to`.
template <class Wide, class Narrow>
STICTION_INLINE void set_pi_lane(Wide& to, std::size_t k, const Narrow& from) {
  set_lane(to.proportional, k, from.proportional);
  set_lane(to.integral, k, from.integral);
  set_lane(to.tracking, k, from.tracking);
}

// Takes `from` into lane `k` of `to`.
template <class Isa>
void set_lane(AxisConfig<BatchSignals<Isa>>& to, std::size_t k, const AxisConfig<DoubleSignals>& from) {
  to.period_ns = from.period_ns;
  to.velocity_feedback = from.velocity_feedback;
  to.current_loop = from.current_loop;
  to.limit_cycle_window_ticks = from.limit_cycle_window_ticks;
  to.quantizer.enabled = from.quantizer.enabled;
  to.notch.enabled = from.notch.enabled;
  set_lane(to.inverse_period, k, from.inverse_period);
  set_lane(to.quantizer.per_metre, k, from.quantizer.per_metre);
  set_lane(to.quantizer.increment, k, from.quantizer.increment);
  set_lane(to.position_gain, k, from.position_gain);
  set_lane(to.velocity_feedforward, k, from.velocity_feedforward);
  set_pi_lane(to.velocity, k, from.velocity);
  set_lane(to.notch.b0, k, from.notch.b0);
  set_lane(to.notch.b1, k, from.notch.b1);
  set_lane(to.notch.b2, k, from.notch.b2);
  set_lane(to.notch.a1, k, from.notch.a1);
  set_lane(to.notch.a2, k, from.notch.a2);
  set_lane(to.current_feedforward, k, from.current_feedforward);
  set_pi_lane(to.current, k, from.current);
  set_lane(to.inverse_pole_pair_pitch, k, from.inverse_pole_pair_pitch);
  set_lane(to.velocity_limit, k, from.velocity_limit);
  set_lane(to.current_limit, k, from.current_limit);
  set_lane(to.voltage_limit, k, from.voltage_limit);
  set_lane(to.following_error_fault, k, from.following_error_fault);
  set_lane(to.over_current_fault, k, from.over_current_fault);
  set_lane(to.over_speed_fault, k, from.over_speed_fault);
}

// Takes `from` into lane `k` of `to`.
template <class Isa>
void set_lane(FrictionCompensationConfig<BatchSignals<Isa>>& to, std::size_t k,
              const FrictionCompensationConfig<DoubleSignals>& from) {
  to.kind = from.kind;
  to.set_point_delay = from.set_point_delay;
  to.lag_ticks.set_lane(k, static_cast<double>(from.lag_ticks));
  set_lane(to.lag_fraction, k, from.lag_fraction);
  to.pulse.lane[k] = from.pulse;
  to.learning.lane[k] = from.learning;
  for (std::size_t i = 0; i < to.friction.elements.size(); ++i) {
    set_lane(to.friction.elements[i].reach, k, from.friction.elements[i].reach);
    set_lane(to.friction.elements[i].stiffness, k, from.friction.elements[i].stiffness);
  }
  set_lane(to.friction.damping, k, from.friction.damping);
  set_lane(to.friction.forward, k, from.friction.forward);
  set_lane(to.friction.backward, k, from.friction.backward);
  set_lane(to.friction.limit, k, from.friction.limit);
}

template <class Isa>
STICTION_INLINE bool lane_of(BatchMask<Isa> mask, std::size_t k) {
  return (mask.bits() >> k & 1U) != 0;
}

// Takes lane `k` of `from` out into `to`.
template <class Isa>
void get_lane(const AxisSignals<BatchSignals<Isa>>& from, std::size_t k, AxisSignals<DoubleSignals>& to) {
  to.x_set.value = from.x_set.lane(k);
  to.v_set.value = from.v_set.lane(k);
  to.a_set.value = from.a_set.lane(k);
  to.x.value = from.x.lane(k);
  to.e.value = from.e.lane(k);
  to.e_held.value = from.e_held.lane(k);
  to.v_ref.value = from.v_ref.lane(k);
  to.v_set_delayed.value = from.v_set_delayed.lane(k);
  to.v.value = from.v.lane(k);
  to.v_error.value = from.v_error.lane(k);
  to.i_integral.value = from.i_integral.lane(k);
  to.i_pi.value = from.i_pi.lane(k);
  to.i_notch.value = from.i_notch.lane(k);
  to.i_feedforward.value = from.i_feedforward.lane(k);
  to.i_set.value = from.i_set.lane(k);
  to.i.value = from.i.lane(k);
  for (std::size_t phase = 0; phase < 3; ++phase) {
    to.i_phase[phase].value = from.i_phase[phase].lane(k);
    to.u_phase[phase].value = from.u_phase[phase].lane(k);
  }
  to.limiting = {lane_of(from.limiting.velocity, k), lane_of(from.limiting.current, k),
                 lane_of(from.limiting.voltage, k)};
  to.fault = from.fault.lane(k);
}

// Takes lane `k` of `from` out into `to`.
template <class Isa>
void get_lane(const FrictionCompensationSignals<BatchSignals<Isa>>& from, std::size_t k,
              FrictionCompensationSignals<DoubleSignals>& to) {
  to.friction.contact.value = from.friction.contact.lane(k);
  to.friction.damping.value = from.friction.damping.lane(k);
  to.friction.sliding.value = from.friction.sliding.lane(k);
  to.friction.sum.value = from.friction.sum.lane(k);
  to.learned.value = from.learned.lane(k);
  to.missing.value = from.missing.lane(k);
  to.current.value = from.current.lane(k);
  to.pulse.value = from.pulse.lane(k);
  to.dropped = lane_of(from.dropped, k);
}

}  // namespace stiction::machine
