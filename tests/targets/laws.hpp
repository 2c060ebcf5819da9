// The laws of the cascade as functions of their own, so that the instructions of each can be counted: inputs from a
// context, results into it. Every count includes those loads and stores.
#pragma once

#include <array>
#include <cstdint>

#include "stiction/drive/axis.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::targets {

struct LawContext {
  using S = FixedSignals;

  explicit LawContext(const AxisConfig<S>& c) : config(c), axis(c), cascade(without_current_loop(c)) {}

  static AxisConfig<S> without_current_loop(AxisConfig<S> c) {
    c.current_loop = CurrentLoop::none;
    return c;
  }

  AxisConfig<S> config;

  // This tick.
  SetPoint<S> set;
  Feedback<S> feedback;
  std::int64_t now_ns = 0;
  bool slow = false;

  // The whole axis, and the same one without current controllers.
  Axis<S> axis;
  AxisSignals<S> signals;
  Command<S> command;
  Axis<S> cascade;
  AxisSignals<S> cascade_signals;
  Command<S> cascade_command;

  // What each law remembers. Their inputs are the axis' own signals of this tick.
  SaturationCounter saturations;
  VelocityEstimator<S>::State estimator;
  VelocityEstimator<S>::Estimate estimate{};
  SpeedDelay<S>::State set_speeds;
  S::Velocity set_speed_then;
  S::Distance quantised;
  S::Velocity v_ref;
  S::Current i_feedforward;
  VelocityPi<S>::State velocity_pi;
  S::Current i_pi;
  S::Current i_wanted;
  Notch<S>::State notch;
  S::Current i_notch;
  VelocityPi<S>::State unlimited_pi;
  Notch<S>::State unlimited_notch;
  S::Current unlimited;
  std::array<S::Sine, 3> phase;
  std::array<S::Current, 3> set_current;
  S::Current amplitude;
  CurrentPi<S>::State current_pi;
  Limited<S::Voltage> voltage{};
};

struct Law {
  const char* name;          // of the function below, as a tool from outside finds it
  void (*step)(void* data);  // on a LawContext
};

extern "C" void law_axis(void* data);

// In the order in which a tick runs them: the whole axis first, as the others take its signals.
extern const std::array<Law, 12> laws;

}  // namespace stiction::targets
