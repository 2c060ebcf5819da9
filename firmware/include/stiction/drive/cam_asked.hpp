// What a bus asks for of an axis in the modes of cam and gear: commands, and the values that hold until changed.
#pragma once

#include <cstdint>

#include "stiction/motion/cam_request.hpp"

namespace stiction {

enum class CamCommand : std::uint8_t {
  none,
  engage,     // MC_CamIn, MC_GearIn: with the values asked for; also to a different table, scale or offset on the run
  leave,      // MC_CamOut, to standstill or to the speed asked for
  cancel,     // deletes what waits
  phase,      // MC_Phasing: the phase asked for
  superpose,  // MC_MoveSuperimposed: the displacement asked for, on top of what the axis follows or where it stands
  leave_to,   // to standstill at the position asked for
  engage_second,  // a second cam on top (MC_CombineAxes), with the values asked for; a table in the mode of a gear too
  leave_second    // it goes to nothing, from wherever it is
};
inline constexpr int cam_commands = 9;

struct CamAsked {
  std::uint16_t table = 1;  // from 1
  CamTrigger trigger = CamTrigger::at_once;
  CamApproach approach = CamApproach::catch_up;
  bool master_relative = false, slave_relative = false, backward = false;
  std::int64_t ticks = 16;         // of the approach by ticks
  std::int64_t distance = 1;       // of the approach by distance, 2^-40 cycles
  MasterPosition at{};             // of a trigger by position
  MotionPoint tolerance{};         // of curves that agree
  MasterPosition master_offset{};  // cam and gear
  std::int64_t slave_offset = 0;   // 2^-40 m
  std::int64_t slave_scale = std::int64_t{1} << 32;
  std::int32_t numerator = 1;  // of the ratio
  std::uint16_t denominator = 1;
  std::int64_t gear_way = 0;        // of the slave in a cycle of the master behind the ratio, 2^-40 m
  std::int64_t phase = 0;           // 2^-40 cycles
  std::int64_t leave_speed = 0;     // 2^-52 m a tick
  std::int64_t superposed = 0;      // 2^-40 m
  std::int64_t leave_position = 0;  // 2^-40 m

  // When and how, of what is asked for.
  constexpr CamRequest request() const {
    CamRequest made;
    made.trigger = trigger;
    made.approach = approach;
    made.master_relative = master_relative;
    made.slave_relative = slave_relative;
    made.backward = backward;
    made.span = Span::of(approach == CamApproach::distance ? distance : ticks);
    made.at = at;
    made.tolerance = tolerance;
    return made;
  }
};

}  // namespace stiction
