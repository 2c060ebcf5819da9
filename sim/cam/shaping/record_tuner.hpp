// Two pulses from the record of one dwell: frequency, damping and the lag of the load's encoder are identified from the
// first cycle, both amplitudes come from one linear equation; each further cycle corrects them by what is left.
// Of a linear machine, whatever its drive and its delay, the residuals of two lifts have a ratio that depends on the
// load's pole alone. So where the first residual is that of the model but for a few per cent, the difference is the
// drive's, and scales all residuals; where it is more, something pushes the load that is no part of the model, and is
// cancelled as it was recorded. Coulomb friction at the motor is part of the model.
// A second mode is looked for in what the first one leaves. Where there is one, no model of the drive is asked: four
// pulses make the same ratio of both residuals to nothing that both poles give.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "sim/cam/shaping/identified_drive.hpp"
#include "sim/cam/shaping/pulses.hpp"
#include "sim/cam/shaping/two_modes.hpp"

namespace stiction::sim::cam {

struct TunedCycle {
  double quality = 0.0;       // area of the deviation in the dwell, about its own mean, of the record
  double peak_to_peak = 0.0;  // of the vibration that was fitted, at the beginning of the dwell; 0: below the noise
  std::optional<DwellFit> fit;
  std::optional<DwellFit> second{};  // of a second mode, where there is one
  std::string note{};                // a sentence where the cycle changed nothing
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
  // Of the drive at the output, for the motion alone: a force or a torque.
  double largest_force = std::numeric_limits<double>::infinity();
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
  // record without the whole dwell, for a dwell or a rise that is too short, and for two modes that are too near.
  TunedCycle learn(const CycleRecord& record);

  // Takes the record of a cycle of production behind done(), along cam(): where the gear has become warm and the load
  // vibrates again, it corrects the pulses. No cycle is spent on a probe: every correction is to make the next one
  // better. `next`: of the very next cycle of a machine that does not stop; else the cycles before it had the same
  // motion, and it ran steadily. Throws CamError for a record without the whole dwell.
  TunedCycle follow(const CycleRecord& record, bool next);

  // The cam for the next cycle: its rise with the pulses.
  const Cam& cam() const { return cam_; }
  // Running: the cam for all cycles behind the next one, as far as is known; else cam().
  Cam steady_cam() const;
  const std::optional<PulsePair>& pulses() const { return pulses_; }
  // Of a second mode.
  const std::optional<PulsePair>& second_pulses() const { return second_pulses_; }
  // From the first cycle that vibrates, with one mode.
  const std::optional<IdentifiedDrive>& drive() const { return drive_; }
  // Whether a further cycle would not be better: within the resolution, or worse than one before, to which it returned,
  // or the residual does not go away by pulses.
  bool done() const { return done_; }

 private:
  double ratio_error(const DwellFit& fit) const;
  PulsePair first_pulses(const CycleRecord& record, const DwellFit& fit);
  std::optional<PulsePair> cancelling(std::complex<double> residual, std::complex<double> beyond,
                                      const PulsePlaces& places) const;
  std::complex<double> carried(std::complex<double> residual) const;
  double share_of(const PulsePair& pulses) const;
  PulsePair corrected(std::complex<double> residual) const;
  TunedCycle& keep_better(TunedCycle& cycle, const char* note);
  void use(const PulsePair& pulses, const std::optional<PulsePair>& second = std::nullopt);
  void measure(const DwellRecord& dwell, TunedCycle& cycle);
  void learn_gain(std::complex<double> residual);
  Mode unexcited_mode() const;
  void follow_frequencies();
  std::complex<double> own_part(std::complex<double> residual, const Mode& mode, std::size_t which, bool next);
  bool look_for_second_mode(const DwellRecord& dwell, const std::optional<DwellFit>& fit);
  void place_four();
  std::array<std::complex<double>, 2> carried_of_both() const;
  FourPulses corrected_four(const std::array<std::complex<double>, 2>& residuals) const;
  void correct_four();
  void cancel_own();
  void cancel_own_of(const TunedCycle& cycle);
  Curve rise() const;

  ShapingTask task_;
  TunerSettings settings_;
  std::optional<IdentifiedDrive> drive_;
  std::complex<double> scale_ = 1.0;  // of the model's residuals over those of the records
  PulsePlaces places_;
  bool done_ = false;
  Cam cam_;
  std::optional<PulsePair> pulses_, better_;  // in use, and of the best cycle before
  // Two modes, their residuals in units of lift_transform() over those of the records, and the last records'.
  struct TwoModes {
    std::array<Mode, 2> modes;
    std::array<DwellFit, 2> found;  // in the cycle that showed both
    std::array<std::complex<double>, 2> scale, now, last;
    std::optional<FourPlaces> places;
  };
  std::optional<TwoModes> two_;
  std::optional<PulsePair> second_pulses_, better_second_;
  std::complex<double> first_residual_ = 0.0;  // of the first mode, in the first cycle
  double best_quality_ = 0.0, before_ = 0.0;   // before_: peak to peak of the cycle before
  std::complex<double> last_ = 0.0;            // residual of the cycle before
  std::complex<double> better_last_ = 0.0;     // and of the one before the best
  std::array<std::complex<double>, 2> better_lasts_{};
  int cycles_ = 0;
  // Of production: residuals of the last cycle, as recorded, and what the pulses of the tuning leave of
  // lift_transform().
  std::array<std::complex<double>, 2> before_that_{};
  std::optional<std::array<std::complex<double>, 2>> left_by_tuning_;
};

}  // namespace stiction::sim::cam
