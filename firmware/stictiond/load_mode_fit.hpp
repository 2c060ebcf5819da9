// The frequency of a load from the record of one dwell, where it is not what the configuration says: a gearbox that
// warms up loses stiffness. Beside the loop.
#pragma once

#include <optional>
#include <span>

#include "firmware/machine/configuration/cam_tuning_configuration.hpp"

namespace stiction::drive {

// The frequency (Hz) within 20 % of that of `mode`, with its damping, whose damped sine about a constant fits
// `deviations` best, a deviation each `interval` (s). None where it is at an end of that range, or where noise is more
// than an eighth of the vibration. Some hundred fits of three parameters.
std::optional<double> load_frequency(std::span<const std::int32_t> deviations, double interval,
                                     const machine::LoadMode& mode);

}  // namespace stiction::drive
