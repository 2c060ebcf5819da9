// The tuner of a cam on drawn machines, row by row: how often it reaches what is wanted, with an interval.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "tests/cam_tuning/truth.hpp"

namespace stiction::cam_tuning {

// How often something is so.
struct Share {
  int count = 0, of = 0;

  double percent() const { return of > 0 ? 100.0 * count / of : 0.0; }
  void add(bool yes) { count += yes, ++of; }
};
// Its 95 % interval, which is Wilson's, percent.
struct Bounds {
  double low, high;
};
Bounds bounds(const Share& share);
// "92 of 100, 85.0 to 95.9 %".
std::string text(const Share& share);

// Qualities of the cycles of one machine, deg^2, the first one untuned.
std::vector<double> tuned_qualities(const Truth& truth, int cycles);

struct Tuned {
  int cases = 0;
  Share second, third;  // within what is wanted
  double worst_second = 0.0, worst_third = 0.0;
};

// `cases` drawn machines by `seed` whose first cycle is worse than 1.56 deg^2; `change` makes each of them what the row
// is about. Wanted are `second` deg^2 in cycle 2 and `third` in cycle 3.
Tuned tuned(std::uint64_t seed, int cases, const std::function<void(Truth&)>& change, double second, double third);

// `cases` machines by `seed` with a second mode whose residual is `residuals` of the first one's.
struct TwoModesTuned {
  Share both_found;
  Share third;          // within 2.0 deg^2 in cycle 3
  Share third_or_said;  // or the tuner said of the second mode why not
  double worst_first = 0.0, worst_third = 0.0;
};
TwoModesTuned with_two_modes(std::uint64_t seed, int cases, double residuals);
std::string text(const TwoModesTuned& found);

// Seven cycles of `cases` machines by `seed`, of which the quality number alone is known.
struct ByNumber {
  Share within;  // 2.0 deg^2 in the end
  double worst = 0.0;
  std::size_t most = 0;  // cycles
};
ByNumber by_number(std::uint64_t seed, int cases);

// A machine that does not stop: twelve cycles of the untuned motion, and four of what the tuner made of the record of
// the one before each.
struct RunningTuned {
  std::vector<double> qualities;  // deg^2, of the last untuned cycle and the four behind it
  std::vector<double> settled;    // deg^2, the same behind the first 20 degrees of the dwell
};
RunningTuned tuned_running(const Truth& truth);

// `cases` machines by `seed` whose untuned cycle is worse than 1.56 deg^2 when they run on.
struct RunningCampaign {
  Share second, always;  // within 0.6 deg^2: the cycle behind the record; it and all behind it
  double worst_first = 0.0, worst_second = 0.0, worst_later = 0.0;
};
RunningCampaign without_stop(std::uint64_t seed, int cases);

// Of backlash: cases that end worse than they began, by more than a tenth of what the encoder's resolution is worth.
Share worsened_by_backlash(std::uint64_t seed, int cases, double backlash);

// How often the 95 % intervals of the first cycle hold the truth.
struct Covered {
  Share frequency, damping, delay;
};
Covered covered(std::uint64_t seed, int cases);

struct Row {
  const char* name;
  const char* about;
  const char* wanted;
  std::string (*run)(std::uint64_t seed, int cases);
};
std::span<const Row> rows();

}  // namespace stiction::cam_tuning
