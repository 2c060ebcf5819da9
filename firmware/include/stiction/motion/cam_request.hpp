// What a slave can be asked for that follows a cam or a gear, and what it says of itself. The names are those of
// PLCopen Motion Control, Part 1; docs/cam_drive.md has the map.
#pragma once

#include <cstdint>

#include "stiction/motion/bridge.hpp"
#include "stiction/motion/cam_curve.hpp"
#include "stiction/motion/master_position.hpp"

namespace stiction {

// When a request begins to act.
enum class CamTrigger : std::uint8_t {
  at_once,
  master_position,  // where the master passes a position of its axis, in either direction
  cam_position,     // where the new curve's master passes a phase of its cycle
  next_cycle,       // where the cycle of the curve begins anew that is followed, or else of the new one
  curves_agree      // as soon as position, speed and acceleration agree with those before within a tolerance; where the
                    // cycle begins where the master is, in the tick behind
};

// How it comes to the new motion.
enum class CamApproach : std::uint8_t {
  catch_up,  // in the shortest of the lengths of BridgeLengths that keeps the slave's limits
  ticks,     // in the ticks of the span
  distance   // in the way of the master of the span, from standstill: the slave stands until the master moves
};

// What is the motion asked for.
enum class CamGoal : std::uint8_t {
  curve,    // to follow a curve: MC_CamIn, MC_GearIn, MC_GearInPos
  position  // to stand at a position: an end of following that is nowhere else
};

struct CamRequest {
  const CamCurve* curve = nullptr;  // of the goal curve; it must stay as long as it waits or is followed
  CamGoal goal = CamGoal::curve;
  CamTrigger trigger = CamTrigger::at_once;
  CamApproach approach = CamApproach::catch_up;
  bool master_relative = false;  // the cycle begins where the master is at the trigger (MasterAbsolute = FALSE)
  bool slave_relative = false;   // the curve begins where the slave is at the trigger (SlaveAbsolute = FALSE)
  bool backward = false;         // of a distance: the way in which the master covers it
  bool free_way = false;         // only the speed is to be the curve's, the position comes as it does: MC_GearIn; of a
                                 // curve alone
  Span span{};                   // ticks, or 2^-40 cycles of the curve's master
  MasterPosition at{};           // of a trigger by position
  MotionPoint tolerance{};       // of curves_agree
  std::int64_t position = 0;     // the goal's, 2^-40 units
};

enum class CamFault : std::uint8_t {
  none,
  master_lost,      // no valid position
  master_too_fast,  // beyond the speed or the acceleration that the limits were computed for
  master_jumped     // not where its speed leads
};

struct CamStatus {
  bool busy = false;                      // it follows, waits, or is on its way out
  bool active = false;                    // it has control of the axis: a curve is followed
  bool in_sync = false;                   // and no bridge is left
  bool waiting = false;                   // a request waits for its trigger or for room
  bool end_of_profile = false;            // in the tick in which a cycle ends
  bool command_aborted = false;           // the last request was replaced, cancelled, or ended by a stop or fault
  CamRefusal refusal = CamRefusal::none;  // of the last request
  CamFault fault = CamFault::none;        // until a request is accepted again
};

}  // namespace stiction
