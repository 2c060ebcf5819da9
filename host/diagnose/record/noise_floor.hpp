// What the noise of a record alone leaves of its residual force and of its position error: the least that a simulation
// can deviate by. A residual above it is not noise.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/identify/motion.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

struct NoiseFloor {
  // N rms, of the rows: from the encoder's increment and noise, the clock's jitter, the noise of the current (force,
  // voltage), and what inverse dynamics can be off by without any noise.
  double encoder = 0.0, clock = 0.0, effort = 0.0, dynamics = 0.0;
  double position = 0.0;   // m rms, of the difference of two positions, and of two loops that hunt within an increment
  double increment = 0.0;  // m, the coarsest of file and records

  double force() const;  // N rms, all of them together
};

// Through the same filters as the residual: the record's own motion with and without the rounding and the noise of the
// encoder, and with the time of each sample off by the jitter; white noise of the effort. `logs` of one axis; `axis` of
// the file; `settings` of the rows; `counts`: weight of each row; `replayed`: the simulation's records of the same
// logs, whose own restlessness above the band is no noise of the record; may be empty. `expected`: the file's force of
// the rows. `seed` of the noise.
NoiseFloor noise_floor(const std::vector<Log>& logs, const machine::AxisModel& axis, const SignalSettings& settings,
                       const Eigen::VectorXd& counts, const std::vector<Log>& replayed, const Eigen::VectorXd& expected,
                       std::uint64_t seed);

// Of the expected force: what the inverse dynamics of a record may be off by whatever the machine does, by filtered
// derivatives and by a contact moved from sample to sample. Exact records of the shipped machines leave 0.3e-4
// to 3.4e-4 of it without any noise; of a residual that small no part is a cause, however significant.
inline constexpr double resolution_of_dynamics = 5e-4;

}  // namespace stiction::host
