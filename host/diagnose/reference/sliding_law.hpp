// Steady friction over speed from a table of constant speeds, and which of its three parts differ from the machine
// file: F(v) = coulomb + viscous v + rise (1 - exp(-v / rise_velocity)). The parts mask one another (a lower Coulomb
// level and a rise look like no change at medium speed), so all three are fitted first and then tried to be dropped,
// each with a joint refit of the others (F-test, Draper and Smith 1998, ch. 6).
#pragma once

#include <Eigen/Dense>
#include <array>
#include <string>
#include <vector>

#include "host/identify/friction_curves.hpp"

namespace stiction::host {

struct SlidingLaw {
  double coulomb = 0.0;        // N
  double viscous = 0.0;        // N s/m
  double rise = 0.0;           // N
  double rise_velocity = 0.0;  // m/s

  double at(double velocity) const;  // N, for a speed above 0
};

// What may differ from the file, in the order of the vocabulary.
enum class SlidingPart { coulomb, viscous, rise };
inline constexpr std::array sliding_parts{SlidingPart::coulomb, SlidingPart::viscous, SlidingPart::rise};

struct SlidingPartTest {
  SlidingPart part;
  bool named = false;
  double p_value = 1.0;   // that the file's value serves as well, beside the other named parts
  double explains = 0.0;  // share of the file's sum of squares that it takes away, given the others
};

struct SlidingFit {
  SlidingLaw law;
  SlidingLaw errors;  // standard errors; 0 for what stays at the file's value
  std::array<SlidingPartTest, 3> tests;
  double relative_square = 0.0;  // sum of squares of the file's relative deviations from the points
  double deviation_before = 0.0, deviation_after = 0.0;  // N rms, of the points about the file's law and the fitted one
};

// `file`: the law of the machine file, without rise. Throws MissingRows for fewer than seven points
// and for a curve that no guide has (no Coulomb friction, or a slope below zero).
SlidingFit fit_sliding_law(const std::vector<SteadyPoint>& points, const SlidingLaw& file);

}  // namespace stiction::host
