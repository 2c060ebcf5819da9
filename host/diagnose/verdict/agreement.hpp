// Whether a simulation agrees with the records: what it leaves of the held-out force and position against what noise
// alone would leave.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "host/log/shown_units.hpp"

namespace stiction::host {

enum class Status { agrees, does_not_agree, cannot_tell };
// "agrees", "does not agree", "cannot tell".
std::string_view name_of(Status status);

// Of one axis on the held-out data, with the machine file as it is or as it was extended.
struct Remainder {
  double force_rms = 0.0;                    // N, of the residual
  std::optional<double> position_error_rms;  // m, in closed loop; none: no set-points, or withheld
  double noise_force_rms = 0.0;              // N, NoiseFloor::force()
  double noise_position_rms = 0.0;           // m, NoiseFloor::position
  double record_force_rms = 0.0;             // N, of the record's force about its mean
  bool repeats = false;                      // whether something without a name was found in it
  double disturbed_position_rms = 0.0;       // m, what forces like the residual make of the position in closed loop
};

struct Agreement {
  Status status = Status::cannot_tell;
  std::string reason;  // a clause for readers, with the figures
};

// Over what noise leaves: the floor is an estimate and the residual a sample.
inline constexpr double force_margin = 1.25;

// A residual up to force_margin times the floor is noise of the sensors. What is beyond it and repeats with nothing
// (place, speed, acceleration, force, time, reversals) is what disturbs the axis, noise as well. A position error up to
// twice what both make is noise. Where they are more than 0.3 of the force, agreement would say nothing. `rest`:
// figures of the axis; `withheld`: why there is no position error, for the reason; empty: there are no set-points;
// `units`: of the axis, for the reason.
Agreement agreement_of(const Remainder& rest, const std::string& withheld, const ShownUnits& units);

}  // namespace stiction::host
