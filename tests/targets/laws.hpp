// The laws of the cascade as functions of their own, so that the instructions of each can be counted: inputs from a
// context, results into it. Every count includes those loads and stores.
#pragma once

#include <array>
#include <cstdint>

#include "stiction/drive/axis.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/targets/compensation.hpp"

namespace stiction::targets {

struct LawContext {
  using S = FixedSignals;

  explicit LawContext(const AxisConfig<S>& c)
      : config(c),
        axis(c),
        cascade(without_current_loop(c, c.velocity_feedback)),
        given(without_current_loop(c, VelocityFeedback::given)),
        part(c) {}

  static AxisConfig<S> without_current_loop(AxisConfig<S> c, VelocityFeedback feedback) {
    c.current_loop = CurrentLoop::none;
    c.velocity_feedback = feedback;
    return c;
  }

  AxisConfig<S> config;

  // This tick.
  SetPoint<S> set;
  Feedback<S> feedback;
  std::int64_t now_ns = 0;
  bool slow = false;

  // The whole axis; the same one without current controllers; and that with a velocity given by the encoder.
  Axis<S> axis;
  Axis<S> cascade;
  Axis<S> given;
  AxisSignals<S> signals;  // of the whole axis
  AxisSignals<S> other_signals;
  AxisSignals<S> part_signals;  // what a part finds of this tick
  Command<S> command;

  // What the laws below work on: the axis' own state before this tick, restored for each of them, and the axis' own
  // signals of this tick. So a law has the very numbers that it has in the axis.
  AxisState<S> before;
  AxisState<S> state;
  Axis<S> part;         // the axis itself as it was before this tick
  S::Current i_wanted;  // ahead of the limit; the axis does not show it

  VelocityEstimator<S>::Estimate estimate{};
  S::Velocity v_set_delayed;
  S::Distance e_held;
  S::Velocity v_ref;
  S::Current i_feedforward;
  S::Current i_pi;
  S::Current i_notch;
  S::Current i_unlimited;
  std::array<S::Sine, 3> phase;
  std::array<S::Current, 3> i_set_phase;
  S::Current amplitude;
  Limited<S::Voltage> voltage{};

  // The stage between set-points and axis, one of each kind; they keep their own state.
  FrictionCompensation<S> pulse{compensation_config(CompensationKind::pulse)};
  FrictionCompensation<S> friction{compensation_config(CompensationKind::friction)};
  FrictionCompensation<S> learning{compensation_config(CompensationKind::learning)};
  FrictionCompensationSignals<S> compensation_signals;
  SetPoint<S> set_of_pulse, set_of_friction, set_of_learning;  // each kind changes its own
};

struct Law {
  const char* name;          // of the function below, as a tool from outside finds it
  void (*step)(void* data);  // on a LawContext
};

extern "C" void law_axis(void* data);
extern "C" void law_velocity_loop(void* data);

// In the order in which a tick runs them: the whole axis first, as the others take its signals.
extern const std::array<Law, 17> laws;

}  // namespace stiction::targets
