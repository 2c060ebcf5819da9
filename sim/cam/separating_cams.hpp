// Cams that tell causes apart, for an axis that follows a master: laws whose accelerations have different spectra, each
// over two rises and at three speeds of the master. Which one serves is for the caller to compute, as with the motions
// of sim/experiment/separating_trajectories.hpp.
#pragma once

#include <optional>
#include <span>

#include "sim/cam/motion.hpp"

namespace stiction::sim::cam {

// What a cam may use of a slave. A rotary slave in rad, a linear one in m.
struct CamRange {
  double cycle = 0.0;              // rad, of the master
  Coordinate slave{};              // kind of the slave
  double start = 0.0;              // where the slave rests at the master's 0
  double stroke = 0.0;             // by which it moves, with its sign
  bool returns = false;            // whether it comes back in the cycle; else each cycle begins where one ended
  std::optional<double> modulo{};  // of a slave that does not return: the same place again
};

struct SeparatingCam {
  const char* law = "";      // of laws()
  double rise_share = 0.0;   // of a rise: of the cycle, of a slave that returns of half of it
  double speed_share = 0.0;  // of the highest speed of the master that the axis permits with this rise
  const char* words = "";    // what its law shows
};

std::span<const SeparatingCam> separating_cams();

// The length of the rise (rad of the master) of `each` within the `range`.
double rise_of(const SeparatingCam& each, const CamRange& range);

// The cam of `each` within the `range`, named "next": a rest, the rise, a rest, and of a slave that returns the way
// back and a rest. Its cycle begins and ends in the middle of a rest.
Cam separating_cam(const SeparatingCam& each, const CamRange& range);

}  // namespace stiction::sim::cam
