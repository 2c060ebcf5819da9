// Laps of many trials of one axis at once, in the lanes of batches (host/batch): what a search over parameters of the
// drive asks for, in double precision.
#pragma once

#include <span>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "sim/experiment/circle_path.hpp"

namespace stiction::host {

// The largest |x_set - x| (m, at the encoder, unquantised) of the last lap of each of `machines`, whose `axis` (index)
// drives its part of the `circle` alone over `laps` laps, at least 1; infinite where the drive trips. The machines
// differ in their parameters alone: periods and delay of the set-points are those of the first. An axis that a batch
// cannot run goes on as in run_quadrants(), with the firmware's signals. Throws InfeasibleMotion, ConfigurationError.
std::vector<double> last_lap_errors(std::span<const machine::Machine> machines, std::size_t axis,
                                    const sim::CircleSettings& circle, int laps);

}  // namespace stiction::host
