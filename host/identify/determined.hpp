// Which of the fitted parameters the data determine, and what to record for the others. Internal to this room.
#pragma once

#include <string>

#include "host/identify/identification.hpp"

namespace stiction::host {

struct Scales {
  double coulomb;                  // N, level of the friction
  double highest_speed;            // m/s, of the machine
  double data_speed;               // m/s, the highest of the data
  double data_acceleration;        // m/s^2, the highest of the data
  machine::Coordinate coordinate;  // of the axis, for what is told of speeds
  double whole_rise = 0.0;         // the load coefficient that would make all of the level
};

inline constexpr const char* record_speeds = "constant speeds from a few mm/s up to the highest, each both ways";
inline constexpr const char* record_angles = "slow motion over a wide angle on both sides of the rest, each both ways";
inline constexpr const char* record_accelerations = "moves with accelerations of 1 m/s^2 and more, both ways";

// Sorts a parameter into one of the two lists of `result`. `fitted`: with its replicates; `scales`: of friction and
// motion; `blocks`: of the fit; `how`: a clause that is added to the parameter's own.
void judge(Identification& result, const FittedParameter& fitted, const Scales& scales, std::size_t blocks,
           const std::string& how);

// The same for those of the contact of `fit`. `result`, `scales`: as above.
void judge_contact(Identification& result, const FrictionFit& fit, const Scales& scales);

// Names those of the contact as not determined, because of `why`.
void name_contact(Identification& result, const char* why);

}  // namespace stiction::host
