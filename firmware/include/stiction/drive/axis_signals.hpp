// Every signal of the cascade in one tick: what a trace records at the full rate.
#pragma once

#include <array>
#include <cstdint>

#include "stiction/drive/faults.hpp"
#include "stiction/number/choice.hpp"

namespace stiction {

template <class S>
struct AxisSignals {
  typename S::Position x_set{};
  typename S::Velocity v_set{};
  typename S::Acceleration a_set{};
  typename S::Position x{};
  typename S::Distance e{};
  typename S::Distance e_held{};
  typename S::Velocity v_ref{};
  typename S::Velocity v_set_delayed{};
  typename S::Velocity v{};
  typename S::Velocity v_error{};
  typename S::VelocityIntegral i_integral{};
  typename S::Current i_pi{};
  typename S::Current i_notch{};
  typename S::Current i_feedforward{};
  typename S::Current i_set{};
  typename S::Current i{};
  std::array<typename S::Current, 3> i_phase{};
  std::array<typename S::Voltage, 3> u_phase{};
  Each<S, Limiting> limiting{};
  Each<S, Fault> fault{};
};

// The one list of the signals above: calls visit(name, unit, text, value) for each numeric one, in order. Names are
// those of the log's columns.
template <class S, class Visit>
constexpr void for_each_signal(const AxisSignals<S>& s, Visit&& visit) {
  visit("x_set", "m", "set position", s.x_set);
  visit("v_set", "m/s", "set velocity", s.v_set);
  visit("a_set", "m/s^2", "set acceleration", s.a_set);
  visit("x", "m", "measured position", s.x);
  visit("v", "m/s", "measured or estimated velocity", s.v);
  visit("i", "A", "current amplitude that makes the force", s.i);
  visit("i_set", "A", "set current behind the limit", s.i_set);
  visit("e", "m", "following error", s.e);
  visit("e_held", "m", "following error as the position controller holds it, sampled and quantised", s.e_held);
  visit("v_ref", "m/s", "velocity reference, position controller and feedforward, behind the limit", s.v_ref);
  visit("v_set_delayed", "m/s", "set velocity at the time of the measured one", s.v_set_delayed);
  visit("v_error", "m/s", "velocity error", s.v_error);
  visit("i_integral", "A", "integral part of the velocity controller", s.i_integral);
  visit("i_pi", "A", "output of the velocity controller", s.i_pi);
  visit("i_notch", "A", "output of the notch filter", s.i_notch);
  visit("i_feedforward", "A", "current feedforward", s.i_feedforward);
  visit("i_A", "A", "current of phase A, or of the DC motor", s.i_phase[0]);
  visit("i_B", "A", "current of phase B", s.i_phase[1]);
  visit("i_C", "A", "current of phase C", s.i_phase[2]);
  visit("u_A", "V", "voltage command of phase A, or of the DC motor", s.u_phase[0]);
  visit("u_B", "V", "voltage command of phase B", s.u_phase[1]);
  visit("u_C", "V", "voltage command of phase C", s.u_phase[2]);
}

}  // namespace stiction
