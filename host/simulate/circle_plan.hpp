// Several circles at once: every combination of friction model, feed and direction, on all processors.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "host/log/log.hpp"
#include "host/simulate/circle.hpp"

namespace stiction::host {

enum class SignalKind { fixed_point, double_precision };

struct CirclePlan {
  machine::Machine machine;
  SignalKind signals = SignalKind::fixed_point;
  double radius = 0.09;  // m
  std::vector<std::string> friction;
  std::vector<double> feeds;  // m/s
  std::vector<sim::Direction> directions;
};

// One combination of a plan.
struct CircleCase {
  machine::Machine machine;  // with its friction model in use
  sim::CircleSettings settings;
  SignalKind signals;
};

// In the order friction, feed, direction. Throws InfeasibleMotion before anything runs.
std::vector<CircleCase> cases_of(const CirclePlan& plan);

// A fault in one of the cases, with the case, so that it can be run again with a trace: runs repeat to the bit.
class CaseFailed : public FaultTripped {
 public:
  CaseFailed(const FaultTripped& tripped, CircleCase failed) : FaultTripped(tripped), circle_case(std::move(failed)) {}
  CircleCase circle_case;
};

// Runs all cases; `done` is called after each, from any thread. What it throws leaves this function, and no further
// case begins. Throws CaseFailed for the first case, in order, that tripped a fault.
sim::CircleResult run_circles(const CirclePlan& plan, const std::function<void()>& done = {});

// Runs one case and writes its trace to `file` (CSV), also when a fault stops it: then FaultTripped is thrown after the
// file is complete.
sim::CircleRun run_traced(const CircleCase& circle_case, const std::filesystem::path& file);

// Runs `circle_case` and returns every tick of it as a log in memory. Throws FaultTripped.
Log run_logged(const CircleCase& circle_case);

}  // namespace stiction::host
