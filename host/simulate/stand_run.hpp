// A cam on an elastic axis with the firmware's cascade, from rest at the master's 0 with a master that turns steadily
// from the beginning: what a study of residual vibration assumes, so that the run compares with its models
// (sim/cam/stand). The cycles behind the first show the steady state.
#pragma once

#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"
#include "sim/cam/stand/dwell.hpp"

namespace stiction::host {

struct StandSettings {
  double master_speed = 0.0;  // rad/s or m/s
  int cycles = 1;
  std::uint64_t seed = 1;  // of the encoders' noise
};

struct StandRun {
  std::vector<sim::cam::LoadState> load;  // as it is, one a tick; the acceleration is the mean since the tick before
  std::vector<sim::cam::LoadState> measured;  // by the second encoder, late and with noise; position alone; none: none
  double motor_error = 0.0;                   // peak following error of the motor, in the slave's unit
  Log log;                                    // of all of it, with the channels master and table
};

// `motion` on the only axis of `machine`, with those `settings`. S: FixedSignals or machine::DoubleSignals. Throws
// FaultTripped, machine::ConfigurationError, and sim::cam::StandError for a motion that moves at the master's 0.
template <class S>
StandRun run_stand(const machine::Machine& machine, const sim::cam::Motion& motion, const StandSettings& settings);

}  // namespace stiction::host
