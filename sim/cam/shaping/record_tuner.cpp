#include "sim/cam/shaping/record_tuner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/cam/law.hpp"
#include "sim/cam/shaping/lift.hpp"

namespace stiction::sim::cam {
namespace {

// By how much the residual of a drive may differ from that of its model and still be the drive's: dead time and the
// periods of its loops, about a millisecond, are a tenth of the load's radian. What is further off is no such drive.
constexpr double drive_share = 0.1;

// Before the lag is known, 8 ms are more than any encoder's.
constexpr double unknown_lag = 8e-3;

double area(const DwellRecord& record, double offset, double master_speed) {
  double sum = 0.0;
  for (std::size_t k = 1; k < record.time.size(); ++k)
    sum += 0.5 * (record.time[k] - record.time[k - 1]) * master_speed *
           (std::fabs(record.position[k] - offset) + std::fabs(record.position[k - 1] - offset));
  return sum;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(std::max<std::size_t>(1, values.size()));
}

// What the encoder shows `late` behind the beginning of the dwell, once the drive has settled.
DwellRecord dwell_of(const ShapingTask& task, const CycleRecord& record, double late) {
  const double wanted = task.start + task.stroke;
  const double begin = task.end() + late * task.master_speed + settled(task) - task.end();
  const double end = std::min(task.dwell.end(), task.motion.curve.length());
  DwellRecord dwell;
  for (std::size_t k = 0; k < record.master.size(); ++k) {
    if (record.master[k] < begin || record.master[k] > end) continue;
    dwell.time.push_back((record.master[k] - task.end()) / task.master_speed);
    dwell.position.push_back(record.position[k] - wanted);
  }
  if (dwell.time.size() < 12 || dwell.time.back() - dwell.time.front() < task.mode().period())
    throw CamError(fmt::format(
        "found a dwell of {:.1f} ms behind the drive's lag; expected a period of the load or more, {:.1f} ms",
        dwell.time.empty() ? 0.0 : (dwell.time.back() - dwell.time.front()) * 1e3, task.mode().period() * 1e3));
  return dwell;
}

PulsePair room_for(const std::optional<PulsePair>& pulses) {
  if (!pulses)
    throw CamError("found no room for two pulses at the frequency that was identified; expected a longer rise");
  return *pulses;
}

}  // namespace

double record_quality(const ShapingTask& task, const CycleRecord& record) {
  const DwellRecord dwell = dwell_of(task, record, unknown_lag);
  return area(dwell, mean(dwell.position), task.master_speed);
}

RecordTuner::RecordTuner(ShapingTask task, TunerSettings settings)
    : task_(std::move(task)), settings_(std::move(settings)), cam_(task_.motion.cam) {
  if (!pulse_pair(task_, 0.0))
    throw CamError(fmt::format(
        "found a rise of {:.2f} periods of the load; expected 0.75 or more, which two pulses take", task_.periods()));
}

// The pulses at `places` that cancel `residual`. `beyond`: what a cycle from rest does not have, of the cycle before,
// or by no model of the drive.
std::optional<PulsePair> RecordTuner::cancelling(std::complex<double> residual, std::complex<double> beyond,
                                                 const PulsePlaces& places) const {
  auto pulses = pulse_pair(task_, residual, places);
  // Friction makes the equation one that is not linear: the model's next cycles take the place of the machine's.
  constexpr int modelled_cycles = 4;
  for (int k = 0; k < modelled_cycles && pulses && drive_->coulomb > 0.0; ++k) {
    const Motion next = compose(with_lift(task_.motion.cam, with_pulses(task_, *pulses)));
    const auto correction = pulse_pair(task_, modelled_residual(task_, *drive_, next) + beyond, places);
    pulses->first.amplitude += correction->first.amplitude;
    pulses->second.amplitude += correction->second.amplitude;
  }
  return pulses;
}

// What a cycle's `residual` is in the dwell of the next one.
std::complex<double> RecordTuner::carried(std::complex<double> residual) const {
  if (!settings_.running) return 0.0;
  return residual * std::exp(drive_->ringing.pole * (task_.motion.curve.length() / task_.master_speed));
}

// Of the axis' limits, by the rise with those pulses.
double RecordTuner::share_of(const PulsePair& pulses) const {
  if (!settings_.share_of_limits) return 0.0;
  return settings_.share_of_limits(compose(with_lift(task_.motion.cam, with_pulses(task_, pulses))), drive_->coulomb);
}

// Those in use, and such that cancel `residual`.
PulsePair RecordTuner::corrected(std::complex<double> residual) const {
  PulsePair pulses = room_for(pulse_pair(task_, residual, places_));
  if (pulses_) {
    pulses.first.amplitude += pulses_->first.amplitude;
    pulses.second.amplitude += pulses_->second.amplitude;
  }
  return pulses;
}

// The pulses that cancelled what was carried over have done so in the next cycle.
Cam RecordTuner::steady_cam() const {
  if (!settings_.running || !drive_ || done_) return cam_;
  return with_lift(task_.motion.cam, with_pulses(task_, corrected(-carried(last_))));
}

// The pulses for the second cycle: those at the end of the rise, where they are smallest; where these break a limit of
// the axis, the first ones that do not, or those that break it least.
PulsePair RecordTuner::first_pulses(const CycleRecord& record, const DwellFit& fit) {
  drive_ = identify_drive(task_, record, fit, settings_.running);
  task_.drive = drive_->drive;
  // As long before as the encoder is late.
  scale_ = std::exp(fit.mode.pole * drive_->delay);
  const auto recorded = fit.residual * scale_,
             modelled = modelled_residual(task_, *drive_, task_.motion, drive_->cycles);
  const auto ratio = modelled / recorded;
  const bool drives = std::abs(ratio - 1.0) < drive_share;
  if (drives) scale_ *= ratio;
  // Running, the next cycle begins as this one did: its own residual and what is carried over make the same sum.
  last_ = fit.residual * scale_;
  const std::complex<double> beyond = (drives ? 0.0 : recorded - modelled) + carried(last_);
  std::optional<PulsePair> best;
  double least = 0.0;
  for (const auto& places : pulse_places()) {
    const auto pulses = cancelling(last_, beyond, places);
    if (!pulses) continue;
    double share = share_of(*pulses);
    // And those of the cycles behind the next one, which have no more than their own residual to cancel.
    if (settings_.running)
      if (const auto own = pulse_pair(task_, last_ - carried(last_), places)) share = std::max(share, share_of(*own));
    if (best && share >= least) continue;
    best = pulses;
    least = share;
    places_ = places;
    if (least <= usable_share) return *best;
  }
  return room_for(best);
}

void RecordTuner::use(const PulsePair& pulses) {
  pulses_ = pulses;
  cam_ = with_lift(task_.motion.cam, with_pulses(task_, pulses));
}

TunedCycle& RecordTuner::keep_better(TunedCycle& cycle, const char* note) {
  done_ = true;
  cycle.note = note;
  if (better_)
    use(*better_);
  else
    pulses_.reset(), cam_ = task_.motion.cam;
  return cycle;
}

TunedCycle RecordTuner::learn(const CycleRecord& record) {
  TunedCycle cycle;
  const DwellRecord dwell = dwell_of(task_, record, drive_ ? std::max(0.0, drive_->delay) : unknown_lag);
  ++cycles_;
  cycle.fit = fit_dwell(dwell, task_.mode().frequency());
  cycle.quality = area(dwell, cycle.fit ? cycle.fit->offset : mean(dwell.position), task_.master_speed);
  if (cycle.fit) cycle.peak_to_peak = cycle.fit->peak_to_peak();
  if (cycles_ > 1 && cycle.quality > best_quality_)
    return keep_better(cycle, "It became worse; the motion of the best cycle is kept.");
  best_quality_ = cycle.quality;
  better_ = pulses_;
  if (!cycle.fit || cycle.peak_to_peak < settings_.resolution) {
    done_ = true;
    cycle.note = "The residual is within the resolution of the encoder; nothing is changed.";
    if (settings_.running && drive_ && cycles_ > 1) {
      use(corrected(-carried(last_)));
      cycle.note =
          "The residual is within the resolution of the encoder; the motion cancels its own residual from now on.";
    }
    return cycle;
  }
  // A linear machine is at rest after one correction but for what its drive differs from the model.
  if (cycles_ > 1 && cycle.peak_to_peak > 0.5 * before_) {
    done_ = true;
    cycle.note = "The residual does not go away by pulses; nothing is changed.";
    return cycle;
  }
  before_ = cycle.peak_to_peak;
  if (!drive_) {
    use(first_pulses(record, *cycle.fit));
    return cycle;
  }
  const auto residual = cycle.fit->residual * scale_;
  use(corrected(residual - carried(last_) + carried(residual)));
  last_ = residual;
  return cycle;
}

}  // namespace stiction::sim::cam
