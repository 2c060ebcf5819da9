// Two pulses from the record of one dwell: frequency, damping and the lag of the load's encoder are identified from the
// first cycle, both amplitudes come from one linear equation; each further cycle corrects them by what is left.
// Of a linear machine, whatever its drive and its delay, the residuals of two lifts have a ratio that depends on the
// load's pole alone. So where the first residual is that of the model but for a few per cent, the difference is the
// drive's, and scales all residuals; where it is more, something pushes the load that is no part of the model, such as
// friction, and is cancelled as it was recorded.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/cam/shaping/dwell_fit.hpp"
#include "sim/cam/shaping/pulses.hpp"

namespace stiction::sim::cam {

// The load as its encoder has it, over one cycle from rest.
struct CycleRecord {
  std::vector<double> master;    // rising, from 0
  std::vector<double> position;  // as many, in the slave's unit
};

struct TunedCycle {
  double quality = 0.0;       // area of the deviation in the dwell, about its own mean, of the record
  double peak_to_peak = 0.0;  // of the vibration that was fitted, at the beginning of the dwell; 0: below the noise
  std::optional<DwellFit> fit;
  std::string note{};  // a sentence where the cycle changed nothing
};

class RecordTuner {
 public:
  // For a `task`, whose drive's frequency is a guess within 35 %. `resolution`: of the load's encoder, in the slave's
  // unit.
  RecordTuner(ShapingTask task, double resolution);

  // Takes the record of a cycle with the motion that motion() had then, and makes the next one. Throws CamError for a
  // record without the whole dwell, and for a dwell or a rise that is too short.
  TunedCycle learn(const CycleRecord& record);

  // The cam for the next cycle: its rise with the pulses.
  const Cam& cam() const { return cam_; }
  const std::optional<PulsePair>& pulses() const { return pulses_; }
  double delay() const { return delay_; }  // s, of the load's encoder and the drive behind the model
  double delay_error() const { return delay_error_; }
  const ElasticDrive& drive() const { return task_.drive; }  // as identified
  // Whether a further cycle would not be better: within the resolution, or worse than one before, to which it returned.
  bool done() const { return done_; }

 private:
  DwellRecord dwell_of(const CycleRecord& record, double late) const;
  void identify(const CycleRecord& record, const DwellFit& fit);
  void use(const PulsePair& pulses);

  ShapingTask task_;
  double resolution_;
  double delay_ = 0.0, delay_error_ = 0.0;
  std::complex<double> scale_ = 1.0;  // of the model's residuals over those of the records
  bool identified_ = false, done_ = false;
  Cam cam_;
  std::optional<PulsePair> pulses_, better_;  // in use, and of the best cycle before
  double best_quality_ = 0.0;
  int cycles_ = 0;
};

}  // namespace stiction::sim::cam
