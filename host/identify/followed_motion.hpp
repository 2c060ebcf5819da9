// The motion of a log for a band that follows the data: with a level of the friction, with the samples that do not
// count, with the derivatives of the set position as instruments, and with the encoder's noise in the rows.
#pragma once

#include <vector>

#include "host/identify/contact.hpp"
#include "host/identify/motion.hpp"

namespace stiction::host {

// What stands for the friction's level in a regression at any rate and resolution.
struct LevelModel {
  bool sticks = false;  // sgn(v), and at standstill a reaction that no motion tells; else a contact
  ContactShape shape;   // of the contact
  // Whether the level rises with the weight that goes with the angle: a column of its own beside the level's.
  bool rises_with_weight = false;
};

// The friction law of `axis`; with `sticks` sgn(v) whatever it is. A law without a contact that does not stick has the
// length of a contact that no log resolves.
LevelModel level_model(const machine::AxisModel& axis, bool sticks);

// A contact too short for any log of these rates: sgn(v), which keeps its sign at standstill.
LevelModel unresolved_contact();

// m rms: of the increment on which the positions lie (the file's where the log shows none) and of the file's noise.
double position_noise(const AxisLog& channels, const machine::AxisModel& axis);

// Samples whose effort is at the limit of the machine or a flat top: what saturated() finds, and what the log itself
// leaves out. `channels`: of `axis` in the log.
std::vector<bool> left_out(const AxisLog& channels, const machine::AxisModel& axis);

// Motion of `log` for rows up to `band` (Hz); `channels`, `axis`, `amperes`: as for force_of(); `model`: of the level.
Motion followed_motion(const Log& log, const AxisLog& channels, const machine::AxisModel& axis, Amperes amperes,
                       double band, const LevelModel& model);

// The filters of such rows.
SignalSettings followed_signals(double band);

}  // namespace stiction::host
