// Two pulses from the record of one dwell: frequency, damping and the lag of the load's encoder are identified from the
// first cycle, both amplitudes come from one linear equation; each further cycle corrects them by what is left.
// Of a linear machine, whatever its drive and its delay, the residuals of two lifts have a ratio that depends on the
// load's pole alone. So where the first residual is that of the model but for a few per cent, the difference is the
// drive's, and scales all residuals; where it is more, something pushes the load that is no part of the model, and is
// cancelled as it was recorded. Coulomb friction at the motor is part of the model.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/cam/shaping/identified_drive.hpp"
#include "sim/cam/shaping/pulses.hpp"

namespace stiction::sim::cam {

struct TunedCycle {
  double quality = 0.0;       // area of the deviation in the dwell, about its own mean, of the record
  double peak_to_peak = 0.0;  // of the vibration that was fitted, at the beginning of the dwell; 0: below the noise
  std::optional<DwellFit> fit;
  std::string note{};  // a sentence where the cycle changed nothing
};

// The quality number of the `record` of a cycle along the motion of `task`: the area of the deviation from its mean in
// the dwell, behind what the drive and any encoder lag; in the slave's unit times the master's. Throws CamError for a
// record without the whole dwell.
double record_quality(const ShapingTask& task, const CycleRecord& record);

struct TunerSettings {
  double resolution = 0.0;  // of the load's encoder, in the slave's unit
  // The largest share of a limit of the axis that a motion takes, with that Coulomb friction at the motor, as a torque
  // or a force at the output; none: no limits.
  std::function<double(const Motion& motion, double coulomb)> share_of_limits{};
  // The machine does not stop: each record is of a running cycle, the first one behind many of the untuned motion. What
  // the last cycle left is cancelled with the cycle's own residual, so the motion of the next cycle is not that of the
  // one behind it.
  bool running = false;
};

// The share of the axis' limits that set-points of a trial may take: a drive damped as cascades usually are overshoots
// by 7 % where the acceleration jumps, and one at its limit is not linear.
inline constexpr double usable_share = 0.9;

class RecordTuner {
 public:
  // For a `task`, whose drive's frequency is a guess within 35 %, and with those `settings`.
  RecordTuner(ShapingTask task, TunerSettings settings);

  // Takes the record of a cycle with the motion that motion() had then, and makes the next one. Throws CamError for a
  // record without the whole dwell, and for a dwell or a rise that is too short.
  TunedCycle learn(const CycleRecord& record);

  // The cam for the next cycle: its rise with the pulses.
  const Cam& cam() const { return cam_; }
  // Running: the cam for all cycles behind the next one, as far as is known; else cam().
  Cam steady_cam() const;
  const std::optional<PulsePair>& pulses() const { return pulses_; }
  const std::optional<IdentifiedDrive>& drive() const { return drive_; }  // from the first cycle that vibrates
  // Whether a further cycle would not be better: within the resolution, or worse than one before, to which it returned,
  // or the residual does not go away by pulses.
  bool done() const { return done_; }

 private:
  PulsePair first_pulses(const CycleRecord& record, const DwellFit& fit);
  std::optional<PulsePair> cancelling(std::complex<double> residual, std::complex<double> beyond,
                                      const PulsePlaces& places) const;
  std::complex<double> carried(std::complex<double> residual) const;
  double share_of(const PulsePair& pulses) const;
  PulsePair corrected(std::complex<double> residual) const;
  TunedCycle& keep_better(TunedCycle& cycle, const char* note);
  void use(const PulsePair& pulses);

  ShapingTask task_;
  TunerSettings settings_;
  std::optional<IdentifiedDrive> drive_;
  std::complex<double> scale_ = 1.0;  // of the model's residuals over those of the records
  PulsePlaces places_;
  bool done_ = false;
  Cam cam_;
  std::optional<PulsePair> pulses_, better_;  // in use, and of the best cycle before
  double best_quality_ = 0.0, before_ = 0.0;  // before_: peak to peak of the cycle before
  std::complex<double> last_ = 0.0;           // residual of the cycle before
  int cycles_ = 0;
};

}  // namespace stiction::sim::cam
