// Input shapers: a motion in shares, each later than the one before, whose vibrations cancel. ZV and ZVD after Singer,
// Seering 1990; extra-insensitive ones (EI, two humps) after Singhose, Seering, Singer 1996; MZV, three impulses
// in three quarters of a period, is that of machine tools for printing. Times are in periods of the damped vibration,
// K = exp(-zeta pi / sqrt(1 - zeta^2)) is what it keeps over half a period.
#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace stiction::sim::cam {

struct Impulse {
  double time = 0.0;  // in periods
  double share = 0.0;
};

struct InputShaper {
  std::string_view name;
  std::vector<Impulse> (*impulses)(double damping_ratio);
};

// "zv", "mzv", "zvd", "ei", "two-hump-ei". The shares of each add up to 1.
std::span<const InputShaper> input_shapers();

// What the shapers EI leave at their own frequency, as a share of the unshaped vibration.
inline constexpr double ei_tolerance = 0.05;

}  // namespace stiction::sim::cam
