#include "host/tune/lap_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "firmware/machine/configuration/compensation_configuration.hpp"
#include "host/batch/batch_run.hpp"
#include "host/simulate/circle.hpp"
#include "host/simulate/quadrant_run.hpp"
#include "sim/effects/effects.hpp"
#include "sim/effects/master_delay/master_delay.hpp"

namespace stiction::host {
namespace {

constexpr double no_lap = std::numeric_limits<double>::infinity();

// The cascade, with the set-points that the path has.
bool runs_in_batches(const machine::AxisModel& axis) { return axis.cascaded() && !(sim::master_delay(axis) > 0.0); }

std::vector<double> one_by_one(std::span<const machine::Machine> machines, std::size_t axis,
                               const sim::CircleSettings& circle, int laps) {
  std::vector<double> errors;
  for (const auto& machine : machines) {
    try {
      errors.push_back(run_quadrants(machine, axis, circle, laps).peak_error.back());
    } catch (const FaultTripped&) {
      errors.push_back(no_lap);
    }
  }
  return errors;
}

}  // namespace

std::vector<double> last_lap_errors(std::span<const machine::Machine> machines, std::size_t axis,
                                    const sim::CircleSettings& circle, int laps) {
  const auto& first_machine = machines.front();
  check_circle(first_machine.axes.at(axis), circle);
  if (!std::ranges::all_of(machines, [&](const auto& machine) { return runs_in_batches(machine.axes.at(axis)); }))
    return one_by_one(machines, axis, circle, laps);
  constexpr double turn = 2.0 * std::numbers::pi, begin = sim::CirclePath::lap_begin - turn;
  const sim::CirclePath path(circle);
  const std::size_t coordinate = axis % 2;  // as run_quadrants()
  const double delay = machine::set_point_delay(first_machine);
  std::vector<BatchRun::Member> members;
  for (const auto& machine : machines) members.push_back({&machine, axis, path.at(0.0).axes[coordinate].position});
  BatchRun run(members);
  std::vector<double> peaks(machines.size(), 0.0), errors(machines.size());
  for (;;) {
    const double time = run.time(), turned = path.at(std::max(0.0, time - delay)).turned - begin;
    if (turned >= turn * laps) break;
    const auto set = path.at(time).axes[coordinate];
    run.tick({&set, 1});
    if (turned < turn * (laps - 1)) continue;
    run.values(Row::e, errors);
    for (std::size_t k = 0; k < peaks.size(); ++k) peaks[k] = std::max(peaks[k], std::abs(errors[k]));
  }
  if (run.any_fault())
    for (std::size_t k = 0; k < peaks.size(); ++k)
      if (run.fault(k) != Fault::none) peaks[k] = no_lap;
  return peaks;
}

}  // namespace stiction::host
