// Parameters of the friction feedforward from logs, as a commissioning engineer has them: circles or other motions with
// reversals and all speeds that matter, with the current. What the motor's force is beyond the acceleration of the mass
// is fitted by stop operators of many distances on the measured way, a sliding curve for each direction and a constant
// force; then the stop operators are drawn together to as many as the drive has. The fit takes the measured way and the
// drive the set one: with the compensation on they are the same to a micrometre.
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/identify/motion.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

struct TuningSettings {
  Amperes amperes = Amperes::amplitude;
  SignalSettings signals{1000.0, 1000.0, 7, 0.05, 0.05};
  int per_decade = 8;  // distances of the stop operators
};

struct FrictionTuning {
  machine::FrictionFeedforwardParameters
      friction;                    // look_ahead is left at 0: expected_look_ahead(), then timing_rule.hpp
  double coulomb = 0.0;            // A, sum of the levels
  double mass = 0.0;               // kg, as the logs say; the drive's feedforward keeps the machine file's
  double constant_current = 0.0;   // A, of the first log
  double current_rms = 0.0;        // A, without the mass' part
  double residual_rms = 0.0;       // A, of it not explained
  double reduction_error = 0.0;    // A, largest change of the presliding curve by drawing elements together
  std::vector<std::string> notes;  // sentences: what the logs could not determine
};

// `axis`: of the machine that the logs belong to. Throws LogError for logs that cannot be used: without current, or
// which never slide further than the longest presliding element. `settings`: elements, nodes and limits.
FrictionTuning tune_friction(const std::vector<Log>& logs, const machine::AxisModel& axis,
                             const TuningSettings& settings = {});

// The look-ahead (s) that the drive's own delays suggest: the inverter's dead time, a tick of hold and half a tick of
// sampling; the current loop's lag is small beside them.
double expected_look_ahead(const machine::Timing& timing, const machine::AxisModel& axis);

}  // namespace stiction::host
