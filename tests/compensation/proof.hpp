// The proof of the friction compensation: parameters from logs of a truth machine, then every case with the
// compensation off, with the best speed pulse (a), with the friction feedforward (b) and with learning (c).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/tune/compensation_tuning.hpp"
#include "tests/compensation/truth.hpp"

namespace stiction::compensation {

inline constexpr double metre_per_minute = 1.0 / 60.0;
inline constexpr std::array<double, 5> feeds{3.2, 8.0, 16.0, 24.0, 48.0};  // m/min
inline constexpr double pulse_feed = 16.0;                                 // m/min, at which (a) is tuned
inline constexpr double current_noise = 0.02;                              // A rms
inline constexpr int learning_laps = 4;

// One axis of a truth with all that was tuned for it.
struct TunedAxis {
  machine::Machine machine;  // the truth; both axes, of which `axis` is tuned
  std::size_t axis = 0;
  host::CompensationTuning tuning;
};

// `with_pulse`: tunes (a) too, which takes 500 laps.
TunedAxis tune(const Truth& truth, std::size_t axis, bool with_pulse);

// The machine of a tuned axis with that compensation in use.
machine::Machine with_compensation(const TunedAxis& tuned, CompensationKind kind);

// m, the largest error of a lap, and the largest current up to then.
struct Outcome {
  double error = 0.0;    // m
  double current = 0.0;  // A
  bool dropped = false;
};
Outcome drive_circle(const machine::Machine& machine, std::size_t axis, double feed, double radius, std::uint64_t seed);

// The largest error while swinging by `amplitude` m, from end to end, after a longer move.
Outcome drive_small_reversals(const machine::Machine& machine, std::size_t axis, double amplitude, std::uint64_t seed);

// What an axis does in 60 s of standstill after a move.
struct Standstill {
  double creep = 0.0;             // m, of the mean position of a second, largest against the first
  double peak_to_peak = 0.0;      // m, of the encoder's position without its noise, largest of a second
  int changes_of_held_error = 0;  // how often the quantised error changed: a limit cycle changes it for ever
};
Standstill stand_still(const machine::Machine& machine, std::size_t axis, double seconds, std::uint64_t seed);

}  // namespace stiction::compensation
