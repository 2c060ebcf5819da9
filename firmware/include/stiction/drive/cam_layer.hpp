// One of the motions whose sum an axis follows in the modes of cam and gear: what it follows, and what of it waits.
#pragma once

#include <cstdint>

#include "stiction/drive/faults.hpp"
#include "stiction/motion/cam_motion.hpp"

namespace stiction {

// The fault of the drive that a motion's is.
constexpr Fault fault_of(CamFault fault) {
  switch (fault) {
    case CamFault::master_lost:
      return Fault::master_lost;
    case CamFault::master_too_fast:
      return Fault::master_too_fast;
    case CamFault::master_jumped:
      return Fault::synchronisation_lost;
    case CamFault::none:
      break;
  }
  return Fault::none;
}

// A motion that follows the master, and the request that it has not decided yet.
struct CamLayer {
  explicit constexpr CamLayer(const CamMotion::Config& of) : motion(of) {}

  constexpr void start(std::int64_t position) {
    motion.start(position);
    waiting = nullptr;
    undecided = false;
    table = 0;
  }
  constexpr void cancel() {
    motion.cancel();
    waiting = nullptr;
    undecided = false;
  }
  // Takes `request` in the place of one that waits. `number`: of the table, at `curve`.
  constexpr CamRefusal take(const CamRequest& request, const CamCurve* curve, std::uint16_t number) {
    const CamRefusal found = motion.engage(request);
    if (found != CamRefusal::none) return found;
    waiting = curve;
    waiting_table = number;
    undecided = true;
    return CamRefusal::none;
  }
  constexpr CamRefusal leave(std::int64_t speed) {
    waiting = nullptr;
    undecided = false;
    return motion.leave(speed);
  }
  constexpr void leave_to_rest() {
    if (!motion.at_rest() || motion.status().waiting) leave(0);
  }
  // Behind a tick: why what was asked for was refused in it.
  constexpr CamRefusal decide() {
    const CamStatus& status = motion.status();
    const bool decided = undecided && !status.waiting;
    const CamRefusal found = decided ? status.refusal : CamRefusal::none;
    if (decided && found == CamRefusal::none && status.active) table = waiting_table;
    if (decided) waiting = nullptr, undecided = false;
    if (!status.active) table = 0;
    return found;
  }

  CamMotion motion;
  const CamCurve* waiting = nullptr;
  std::uint16_t table = 0, waiting_table = 0;
  bool undecided = false;
};

}  // namespace stiction
