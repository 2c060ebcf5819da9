// Axes of all kinds for a batch, drawn at random from the machines that ship, and their set-points.
#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "sim/experiment/set_point.hpp"

namespace stiction::host {

// A machine of one axis, with a motion of its own.
struct RandomMember {
  machine::Machine machine;
  double start = 0.0;                  // m
  double amplitude = 0.0, rate = 0.0;  // of its motion: m, rad/s
  double slow = 0.0;                   // m/s, added to it
  double injected = 0.0;               // A, of a square wave
  double pushed = 0.0;                 // N, of a wave from outside
  int breaks_at = -1;                  // tick from which its set-points are no numbers; -1: none
};

// `count` of them, all with the periods of the first one.
std::vector<RandomMember> random_members(std::size_t count, std::mt19937_64& random);

// The set-point of a member in tick `tick`.
sim::AxisSetPoint set_point_of(const RandomMember& member, int tick);
// N on its carriage behind that tick.
double external_force_of(const RandomMember& member, int tick);

}  // namespace stiction::host
