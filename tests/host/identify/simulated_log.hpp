// Logs of the simulated cross table's X axis, as someone who commissions it would record them: constant speeds both
// ways, a circle, small reversals. The closed loop runs once (laws in double precision); the noise of encoder and
// current is added to the recorded signals, not inside the loop, so that one run serves any number of seeds.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"
#include "sim/experiment/commissioning_path.hpp"

namespace stiction::test {

using sim::circle;
using sim::constant_speeds;
using sim::small_reversals;
using sim::Trajectory;

// The three that the campaign records: 24 s together.
std::vector<Trajectory> commissioning();

// Runs the X axis of `machine` in closed loop and records t, x_set, x, i (A) at `period` (s), a multiple of the fast
// period. Position and current are those of the plant, without noise.
host::Log simulated(const machine::Machine& machine, const Trajectory& trajectory, double period = 1e-3);

struct Noise {
  double position = 5e-9;  // m rms, and the encoder's increment
  double current = 0.01;   // rms, of the largest current of the log
};
host::Log with_noise(const host::Log& log, const Noise& noise, std::uint64_t seed);

}  // namespace stiction::test
