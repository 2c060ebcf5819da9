// Records of one axis as someone who commissions a machine makes them, on the simulated machine: constant speeds both
// ways, a circle, small reversals; and the same kinds of motion with other speeds, feeds and amplitudes, for
// validation.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

struct CommissioningRecord {
  std::string name;  // of its file: "speeds"
  bool held_out = false;
  Log log;  // 1 kHz: x_set, x, i or u
};

// Runs the axis in closed loop: the firmware, or its laws in double precision where its number formats do not hold the
// axis. Noise, drawn from `seed`: a coloured force on the carriage that the log does not have (2.5 N rms below 3 Hz and
// 2 N rms below 40 Hz, as guides and wipers give), 0.03 A rms on the recorded current, and what the machine's encoder
// adds. Speeds, strokes and accelerations are those of the axis where they are less; a rotary axis has all of them in
// proportion to its travel, its speed and its motor. Throws FaultTripped. `machine`: with its effects; `axis`: index of
// the one that moves; `progress`: called after each record.
std::vector<CommissioningRecord> record_commissioning(const machine::Machine& machine, std::size_t axis,
                                                      std::uint64_t seed, const std::function<void()>& progress = {});
inline constexpr int commissioning_records = 6;

// The same of any set-points, one axis' log at 1 kHz or near it: such as those that a diagnosis proposes. `machine`:
// with its effects; `set_points`: a log with x_set; `seed`: of the noise.
Log record_set_points(const machine::Machine& machine, std::size_t axis, const Log& set_points, std::uint64_t seed);

}  // namespace stiction::host
