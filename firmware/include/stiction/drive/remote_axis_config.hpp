// What an axis that others command over a bus is configured with (remote_axis.hpp).
#pragma once

#include "stiction/drive/command_owner.hpp"
#include "stiction/drive/torque_mode.hpp"
#include "stiction/motion/position_profile.hpp"
#include "stiction/motion/set_point_interpolator.hpp"
#include "stiction/motion/speed_step_limit.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction {

struct RemoteAxisConfig {
  using S = FixedSignals;
  SetPointInterpolator::Config interpolation{};  // with the ways that the limits of the axis allow in a cycle
  bool streamed = false;                         // targets of csp come from outside; else csp holds where it is
  S::Position low{}, high{};                     // of targets: the ends of the travel
  PositionProfile::Config profile{};
  PositionProfile::Move fastest{};      // limits of a move; also what a move has that nobody gave values for
  S::Position target_window{};          // about the target, within which it is reached
  TorqueMode::Config torque{};          // cst
  CommandOwner::Config owner{};         // watch over who commands
  S::Velocity halting{};                // change of the speed in a tick by which a profile halts at least (605Dh)
  SpeedStepLimit::Config step_limit{};  // csp: of the speed that the targets make

  // Whether an axis may go to `target`: it lies within the ends, or not further out than `from`, where the axis is.
  constexpr bool allows(S::Position target, S::Position from) const {
    const bool below = target < low && target < from;
    const bool above = target > high && target > from;
    return !below && !above;
  }
};

}  // namespace stiction
