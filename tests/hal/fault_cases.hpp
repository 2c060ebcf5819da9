// Every row of the fault table as something that breaks on the moving cross table, with an oracle outside of the
// control that says from which tick on the row's condition holds.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/drive_bench.hpp"

namespace stiction::test {

using Bench = DriveBench<FixedSignals>;

// What the coming tick shows of an axis, in double precision.
struct Shown {
  double x = 0.0;                               // m
  double v = 0.0;                               // m/s, from the position shown before
  bool faster = false;                          // the carriage itself, than in the tick before
  double i = 0.0;                               // A, that makes the force
  std::int64_t gap_ns = 0;                      // from the tick before
  double set = 0.0, set_before = 0.0;           // m, of the coming tick and of the last one
  double x_at_begin = 0.0, set_at_begin = 0.0;  // m, x and set_before of the tick from which the case shows
};

struct FaultCase {
  Fault fault;
  std::string name;
  // Breaks the axis; called before each tick, `since` counts them.
  std::function<void(Bench&, std::size_t axis, int since)> inject;
  // Whether the row's condition holds in the coming tick, by what the world shows. Left out: from the injection on.
  std::function<bool(Bench&, std::size_t axis, const Shown&)> violated{};
  int shows_after = 1;         // ticks from the injection: feedback is read before a tick begins
  int within = 0;              // ticks, of a row whose detection time depends on the signal
  bool shows_at_rest = false;  // so that no reset is taken while it is there
  bool recurs = false;         // does not show at rest but comes back with the motion
  bool at_one_place = false;   // of the circle, whenever it is injected
  // m/s, of the circle: at a slower feed the drive overcomes it, which is no fault.
  double least_feed = 0.0;
  bool holding = false;                                     // the axes hold their position when it happens
  sim::Direction back = sim::Direction::counter_clockwise;  // of the circle that leads away from where it ends
  std::string machine{};                                    // a setting of it, {} the axis' name
  std::function<void(machine::DriveAxisSetup&, std::size_t axis)> setup{};
};

std::vector<FaultCase> fault_cases();

// Takes back whatever a case has done; switches stay where they are.
void repair(Bench& bench, std::size_t axis);

}  // namespace stiction::test
