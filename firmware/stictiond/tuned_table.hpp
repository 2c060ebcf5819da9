// A cam's table with two pulses within its rise: the same segments, divided where a pulse begins or ends, with their
// polynomials. The rise itself takes its stroke from them, so that the rest behind it stays where it is.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "firmware/machine/configuration/cam_tuning_configuration.hpp"
#include "stiction/motion/cam_table.hpp"

namespace stiction::drive {

struct PulseAmplitudes {
  double first = 0.0, second = 0.0;  // in the unit of the table

  friend bool operator==(const PulseAmplitudes&, const PulseAmplitudes&) = default;
};

// The bytes of `table` with pulses of those `amplitudes` at those `places` of its `rise`. Not for the loop's tick: the
// work grows with the table, and it allocates. Its errors are those of the table but for rounding; switch tracks and
// windows stay. Empty where a number is beyond the format.
std::vector<std::uint8_t> with_pulses(const CamTable& table, std::span<const std::uint8_t> bytes,
                                      const machine::TunedRise& rise, const machine::PulsePlaces& places,
                                      const PulseAmplitudes& amplitudes);

}  // namespace stiction::drive
