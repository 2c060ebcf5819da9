// Whether logs can be identified from: what is missing or suspicious, and what to record instead. Every check throws
// LogError, "FILE: found ...; expected ...".
#pragma once

#include <string>
#include <vector>

#include "host/identify/friction_fit.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

// What all logs together contain.
struct Excitation {
  double duration = 0.0;              // s
  double highest_speed = 0.0;         // m/s
  double highest_acceleration = 0.0;  // m/s^2, at the rows' bandwidth
  int reversals = 0;                  // of the velocity, from one side of its noise to the other
  std::vector<double> speeds;         // m/s, at least a factor 1.5 apart, each kept for 0.1 s in steady sliding
};
Excitation excitation_of(const LogRows& rows);

// Names of the logs for a message: "a.csv, b.csv".
std::string sources_of(const std::vector<Motion>& motions);

// A log of no more than a fifth of a second cannot be filtered.
void require_samples(const Log& log);

// Refuses a current (force, voltage) that stood at the machine's limit, or whose largest value is a flat top. `log`:
// for messages; `channels`: of the axis in it; `axis`: of the machine. Throws LogError.
void refuse_saturation(const Log& log, const AxisLog& channels, const machine::AxisModel& axis);

// The samples at which it stood there. `channels`, `axis`: as above.
std::vector<bool> saturated(const AxisLog& channels, const machine::AxisModel& axis);

// Name of the channel that drives: "voltage".
const char* name_of_effort(const AxisLog& channels, const machine::AxisModel& axis);

// Refuses logs that are too short or hardly move. `excitation`: of all; `sources`: their names.
void require_motion(const Excitation& excitation, const std::string& sources);

// Refuses logs that are too short, without reversals or without enough speeds.
void require_excitation(const Excitation& excitation, const std::string& sources);

// Refuses a force that drives where friction brakes, by its energy: its sign is swapped against the position's.
void refuse_swapped_sign(const LogRows& rows);

}  // namespace stiction::host
