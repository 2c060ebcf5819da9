#include "sim/cam/shaping/record_tuner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/cam/law.hpp"
#include "sim/cam/shaping/lift.hpp"

namespace stiction::sim::cam {
namespace {

// Until what the drive's own lag leaves of the rise has died: e^-4 of a tenth of a degree is below the resolution.
constexpr double settling = 4.0;  // time constants

// By how much the residual of a drive may differ from that of its model: the stand's cascade is 1.4 % off in amplitude,
// by the dead time and the period of its position loop.
constexpr double drive_share = 0.04;

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

}  // namespace

RecordTuner::RecordTuner(ShapingTask task, double resolution)
    : task_(std::move(task)), resolution_(resolution), cam_(task_.motion.cam) {
  if (!pulse_pair(task_, 0.0))
    throw CamError(fmt::format(
        "found a rise of {:.2f} periods of the load; expected 0.75 or more, which two pulses take", task_.periods()));
}

// What the encoder shows `late` behind the beginning of the dwell, once the drive has settled.
DwellRecord RecordTuner::dwell_of(const CycleRecord& record, double late) const {
  const double wanted = task_.start + task_.stroke;
  const double begin = task_.end() + late * task_.master_speed + settling * drive_lag(task_);
  const double end = std::min(task_.dwell.end(), task_.motion.curve.length());
  DwellRecord dwell;
  for (std::size_t k = 0; k < record.master.size(); ++k) {
    if (record.master[k] < begin || record.master[k] > end) continue;
    dwell.time.push_back((record.master[k] - task_.end()) / task_.master_speed);
    dwell.position.push_back(record.position[k] - wanted);
  }
  if (dwell.time.size() < 12 || dwell.time.back() - dwell.time.front() < task_.mode().period())
    throw CamError(fmt::format(
        "found a dwell of {:.1f} ms behind the drive's lag; expected a period of the load or more, {:.1f} ms",
        dwell.time.empty() ? 0.0 : (dwell.time.back() - dwell.time.front()) * 1e3, task_.mode().period() * 1e3));
  return dwell;
}

// The shaft from frequency and damping, the lag from where the record and the model of the rise agree.
void RecordTuner::identify(const CycleRecord& record, const DwellFit& fit) {
  task_.drive = drive_with_mode(task_.drive, fit.mode);
  const auto model = transfer_response(task_.drive, task_.motion, {.master_speed = task_.master_speed});
  const auto at = [&](double master) {
    const auto behind =
        std::partition_point(model.begin(), model.end(), [&](const LoadState& state) { return state.master < master; });
    if (behind == model.begin()) return model.front();
    if (behind == model.end()) return model.back();
    const LoadState& a = *(behind - 1);
    const double t = (master - a.master) / task_.master_speed;
    return LoadState{master, a.position + t * (a.speed + 0.5 * t * a.acceleration), a.speed + t * a.acceleration,
                     a.acceleration};
  };
  // From a tenth of the rise to a period behind it: there the load moves fast.
  const double begin = task_.begin + 0.1 * task_.length(), end = task_.end() + 0.5 * task_.period_length();
  for (int iteration = 0; iteration < 8; ++iteration) {
    double across = 0.0, along = 0.0, squares = 0.0;
    int count = 0;
    for (std::size_t k = 0; k < record.master.size(); ++k) {
      if (record.master[k] < begin || record.master[k] > end) continue;
      const LoadState state = at(record.master[k] - delay_ * task_.master_speed);
      const double off = state.position - record.position[k];
      across += off * state.speed;
      along += state.speed * state.speed;
      squares += off * off;
      ++count;
    }
    if (along == 0.0) return;
    delay_ += across / along;
    delay_error_ = std::sqrt(squares / std::max(1, count - 1) / along);
  }
  identified_ = true;
}

void RecordTuner::use(const PulsePair& pulses) {
  pulses_ = pulses;
  cam_ = with_lift(task_.motion.cam, with_pulses(task_, pulses));
}

TunedCycle RecordTuner::learn(const CycleRecord& record) {
  TunedCycle cycle;
  // Before the lag is known, 8 ms are more than any encoder's.
  constexpr double unknown_lag = 8e-3;
  const DwellRecord dwell = dwell_of(record, identified_ ? std::max(0.0, delay_) : unknown_lag);
  ++cycles_;
  cycle.fit = fit_dwell(dwell, task_.mode().frequency());
  cycle.quality = area(dwell, cycle.fit ? cycle.fit->offset : mean(dwell.position), task_.master_speed);
  if (cycle.fit) cycle.peak_to_peak = cycle.fit->peak_to_peak();
  if (cycles_ > 1 && cycle.quality > best_quality_) {
    done_ = true;
    cycle.note = "It became worse; the motion of the best cycle is kept.";
    if (better_)
      use(*better_);
    else
      pulses_.reset(), cam_ = task_.motion.cam;
    return cycle;
  }
  best_quality_ = cycle.quality;
  better_ = pulses_;
  if (!cycle.fit || cycle.peak_to_peak < resolution_) {
    done_ = true;
    cycle.note = "The residual is within the resolution of the encoder; nothing is changed.";
    return cycle;
  }
  if (!identified_) {
    identify(record, *cycle.fit);
    // What the model has before the pulses, beside what was recorded, as long before as the encoder is late.
    Lift own;
    own.add(task_.motion.curve);
    const auto model = residual_of(task_, own.sampled(task_.begin, task_.end()), task_.end());
    scale_ = std::exp(task_.mode().pole * delay_);
    const auto ratio = model / (cycle.fit->residual * scale_);
    if (std::abs(ratio - 1.0) < drive_share) scale_ *= ratio;
  }
  const auto correction = pulse_pair(task_, cycle.fit->residual * scale_);
  if (!correction)
    throw CamError("found no room for two pulses at the frequency that was identified; expected a longer rise");
  PulsePair pulses = *correction;
  if (pulses_) {
    pulses.first.amplitude += pulses_->first.amplitude;
    pulses.second.amplitude += pulses_->second.amplitude;
  }
  use(pulses);
  return cycle;
}

}  // namespace stiction::sim::cam
