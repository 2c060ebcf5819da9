#include "sim/cam/shaping/record_tuner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/cam/law.hpp"
#include "sim/cam/shaping/lift.hpp"
#include "sim/cam/shaping/running_places.hpp"

namespace stiction::sim::cam {
namespace {

// By how much the residual of a drive may differ from that of its model and still be the drive's: dead time and the
// periods of its loops, about a millisecond, are a tenth of the load's radian. What is further off is no such drive.
constexpr double drive_share = 0.1, of_drives = drive_share / 1.96;  // the latter as a standard deviation

// Before the lag is known, 8 ms are more than any encoder's.
constexpr double unknown_lag = 8e-3;

// Of production: corrections are for vibrations above these shares of the resolution from peak to peak, of a cycle that
// follows the last one and of one that ran steadily: the fit of some hundred samples knows them ten times better than
// one sample does. A part of each is taken, so that noise is not followed.
constexpr double worth_following = 0.2, worth_correcting = 1.0, followed_part = 0.6;

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

// Two modes that are too near for a second one to be found beat: where the beat rises, the vibration grows. Throws
// CamError where the one of the `dwell` does, by more than the encoder's `resolution`.
void require_one_mode(const DwellRecord& dwell, const DwellFit& fit, double resolution) {
  if (growth_of(dwell, fit) < resolution) return;
  const double length = dwell.time.back() - dwell.time.front();
  throw CamError(fmt::format(
      "found a vibration at about {:.2f} Hz that grows in the dwell, as that of two modes does which {:.0f} ms do not "
      "tell apart; expected one that decays, or modes {:.1f} Hz apart or more, or a longer dwell",
      fit.mode.frequency() / (2.0 * std::numbers::pi), 1e3 * length, 1.0 / length));
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
  if (!pulses_) return room_for(pulse_pair(task_, residual, places_));
  PulsePair pulses = pulse_pair_at(task_, residual, *pulses_);
  pulses.first.amplitude += pulses_->first.amplitude;
  pulses.second.amplitude += pulses_->second.amplitude;
  return pulses;
}

// The pulses that cancelled what was carried over have done so in the next cycle.
Cam RecordTuner::steady_cam() const {
  if (!settings_.running || done_) return cam_;
  if (two_) {
    const auto four = corrected_four({-carried_of_both()[0], -carried_of_both()[1]});
    return with_lift(task_.motion.cam, with_pulses(task_, four));
  }
  if (!drive_) return cam_;
  return with_lift(task_.motion.cam, with_pulses(task_, corrected(-carried(last_))));
}

// The standard error of the model's residual over that of the record, which was fitted by `fit`: of the record's
// residual, and of the model's by frequency and damping.
double RecordTuner::ratio_error(const DwellFit& fit) const {
  const auto with = [&](double frequency, double damping) {
    IdentifiedDrive other = *drive_;
    const double w = fit.mode.frequency() + frequency, zeta = fit.mode.damping_ratio() + damping;
    other.ringing.pole = {-zeta * w, w * std::sqrt(1.0 - zeta * zeta)};
    other.drive = drive_with_mode(task_.drive, other.ringing);
    return modelled_residual(task_, other, task_.motion, other.cycles);
  };
  const auto here = with(0.0, 0.0);
  const double by_frequency = std::abs(with(fit.frequency_error, 0.0) - here) / std::abs(here),
               by_damping = std::abs(with(0.0, fit.damping_error) - here) / std::abs(here);
  return std::hypot(fit.residual_error / std::abs(fit.residual), by_frequency, by_damping);
}

// The pulses for the second cycle: from rest those at the end of the rise, where they are smallest, running those that
// leave the load most still by the model; where these break a limit of the axis, the first ones that do not, or those
// that break it least.
PulsePair RecordTuner::first_pulses(const CycleRecord& record, const DwellFit& fit) {
  drive_ = identify_drive(task_, record, fit, settings_.running);
  task_.drive = drive_->drive;
  // As long before as the encoder is late.
  scale_ = std::exp(fit.mode.pole * drive_->delay);
  const auto recorded = fit.residual * scale_,
             modelled = modelled_residual(task_, *drive_, task_.motion, drive_->cycles);
  const auto ratio = modelled / recorded;
  const bool drives = std::abs(ratio - 1.0) < drive_share;
  // As far as it is known: a rise that hardly vibrates shows its own errors for the drive's.
  if (drives) {
    const double error = ratio_error(fit) / of_drives;
    scale_ *= 1.0 + (ratio - 1.0) / (1.0 + error * error);
  }
  // Running, the next cycle begins as this one did: its own residual and what is carried over make the same sum.
  last_ = fit.residual * scale_;
  const std::complex<double> beyond = (drives ? 0.0 : recorded - modelled) + carried(last_);
  std::vector<PulsePlaces> in_turn;
  if (settings_.running)
    in_turn = running_places(task_, {.all = last_,
                                     .carried = carried(last_),
                                     .frequency_error = fit.frequency_error / fit.mode.frequency(),
                                     .largest_force = usable_share * settings_.largest_force});
  in_turn.insert(in_turn.end(), pulse_places().begin(), pulse_places().end());
  std::optional<PulsePair> best;
  double least = 0.0;
  for (const auto& places : in_turn) {
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

// The rise of the cam in use.
Curve RecordTuner::rise() const {
  if (!pulses_) return own_rise(task_, task_.stroke);
  if (!second_pulses_) return with_pulses(task_, *pulses_);
  return with_pulses(task_, FourPulses{*pulses_, *second_pulses_});
}

// What the residuals of the last cycle are in the dwell of the next one.
std::array<std::complex<double>, 2> RecordTuner::carried_of_both() const {
  if (!settings_.running) return {};
  const double time = task_.motion.curve.length() / task_.master_speed;
  return {two_->last[0] * std::exp(two_->modes[0].pole * time), two_->last[1] * std::exp(two_->modes[1].pole * time)};
}

// A first mode that does not vibrate in the dwell is where the rise leaves least, near the one of the machine file.
Mode RecordTuner::unexcited_mode() const {
  const Mode nominal = task_.mode();
  Mode found = nominal;
  double least = std::numeric_limits<double>::infinity();
  const Curve own = own_rise(task_, task_.stroke);
  constexpr int steps = 140;
  for (int k = 0; k <= steps; ++k) {
    const Mode mode{nominal.pole * (0.65 + 0.7 * k / steps)};
    const double left = std::abs(lift_transform(task_, own, mode));
    if (left < least) least = left, found = mode;
  }
  return found;
}

// Whether there is a second mode in what the `fit` of the first one left of the `dwell`.
bool RecordTuner::look_for_second_mode(const DwellRecord& dwell, const std::optional<DwellFit>& fit) {
  // What is carried over of a mode that was not known is not known either.
  if (cycles_ > 1 && settings_.running) return false;
  // A fit of noise has no frequency.
  constexpr double of_a_vibration = 0.02;
  const bool vibrates = fit && fit->frequency_error < of_a_vibration * fit->mode.frequency();
  const bool known = cycles_ > 1 && drive_, still = cycles_ == 1 && !vibrates;
  if (!known && !still && !fit) return false;
  const Mode first = known ? drive_->ringing : still ? unexcited_mode() : fit->mode;
  const auto found = fit_two_modes(dwell, first, settings_.resolution, known || still);
  if (!found) return false;
  two_.emplace();
  two_->found = found->modes;
  for (std::size_t m = 0; m < 2; ++m) {
    two_->modes[m] = found->modes[m].mode;
    auto own = found->modes[m].residual;
    if (settings_.running)
      own *= 1.0 - std::exp(two_->modes[m].pole * (task_.motion.curve.length() / task_.master_speed));
    two_->scale[m] = lift_transform(task_, rise(), two_->modes[m]) / own;
  }
  // The first mode is better known from the cycle in which it was not cancelled.
  if (known)
    two_->scale[0] = lift_transform(task_, own_rise(task_, task_.stroke), two_->modes[0]) / first_residual_;
  else
    task_.drive = drive_with_mode(task_.drive, two_->modes[0]);
  // That of the model, where the rise does not show it.
  if (still) {
    const Curve pulse = law_curve("polynomial_3_4_5", task_.begin, 0.5 * task_.period_length(), 1.0);
    two_->scale[0] = lift_transform(task_, pulse, two_->modes[0]) / residual_of(task_, pulse, task_.end());
  }
  return true;
}

// What the `dwell` says of the `cycle`.
void RecordTuner::measure(const DwellRecord& dwell, TunedCycle& cycle) {
  double offset = 0.0;
  if (!two_) {
    cycle.fit = fit_dwell(dwell, task_.mode().frequency());
    if (cycle.fit && cycles_ == 1) first_residual_ = cycle.fit->residual;
    // Running, the mode is better known from the cycle in which it was not cancelled.
    if (settings_.running && drive_) {
      if (!cycle.fit) cycle.fit.emplace();
      cycle.fit->mode = drive_->ringing;
      cycle.fit->residual = residual_with_mode(dwell, drive_->ringing, &cycle.fit->offset);
    }
    offset = cycle.fit ? cycle.fit->offset : mean(dwell.position);
    if (cycle.fit) cycle.peak_to_peak = cycle.fit->peak_to_peak();
  }
  if (two_ || look_for_second_mode(dwell, cycle.fit)) {
    const auto both = residuals_with_modes(dwell, two_->modes);
    offset = both.offset;
    cycle.fit = two_->found[0];
    cycle.second = two_->found[1];
    cycle.fit->residual = both.of[0];
    cycle.second->residual = both.of[1];
    cycle.fit->offset = cycle.second->offset = offset;
    two_->last = two_->now;
    for (std::size_t m = 0; m < 2; ++m) two_->now[m] = both.of[m] * two_->scale[m];
    if (cycles_ == 1) two_->last = two_->now;
    cycle.peak_to_peak = cycle.fit->peak_to_peak() + cycle.second->peak_to_peak();
  }
  cycle.quality = area(dwell, offset, task_.master_speed);
  if (!two_ && cycles_ == 1 && cycle.fit) require_one_mode(dwell, *cycle.fit, settings_.resolution);
}

// Where the four pulses are: where they ask for least, and of those that a limit of the axis forbids the ones that
// break it least.
void RecordTuner::place_four() {
  const auto residuals = settings_.running
                             ? two_->now
                             : std::array{lift_transform(task_, own_rise(task_, task_.stroke), two_->modes[0]),
                                          lift_transform(task_, own_rise(task_, task_.stroke), two_->modes[1])};
  double least = 0.0;
  constexpr std::size_t most = 8;
  const auto places = four_places(task_, two_->modes, residuals);
  if (places.empty())
    throw CamError("found no room for four pulses at the two frequencies that were identified; expected a longer rise");
  for (std::size_t k = 0; k < std::min(most, places.size()); ++k) {
    const auto pulses = four_pulses(task_, two_->modes, residuals, places[k]);
    const double share =
        settings_.share_of_limits
            ? settings_.share_of_limits(compose(with_lift(task_.motion.cam, with_pulses(task_, pulses))),
                                        drive_ ? drive_->coulomb : 0.0)
            : 0.0;
    if (k > 0 && share >= least) continue;
    least = share;
    two_->places = places[k];
    if (least <= usable_share) return;
  }
}

// The four pulses in use, and such that cancel `residuals`.
FourPulses RecordTuner::corrected_four(const std::array<std::complex<double>, 2>& residuals) const {
  if (!second_pulses_) return four_pulses(task_, two_->modes, residuals, *two_->places);
  const FourPulses now{*pulses_, *second_pulses_};
  FourPulses four = four_pulses_at(task_, two_->modes, residuals, now);
  for (std::size_t m = 0; m < 2; ++m) {
    four[m].first.amplitude += now[m].first.amplitude;
    four[m].second.amplitude += now[m].second.amplitude;
  }
  return four;
}

// The pulses for the next cycle, with two modes.
void RecordTuner::correct_four() {
  // Pulses that were for one mode alone give way to four.
  const bool placed_now = !two_->places;
  if (placed_now) place_four();
  std::array<std::complex<double>, 2> residuals = two_->now;
  const double time = task_.motion.curve.length() / task_.master_speed;
  for (std::size_t m = 0; m < 2; ++m) {
    if (settings_.running) residuals[m] += two_->now[m] * std::exp(two_->modes[m].pole * time) - carried_of_both()[m];
    // What they had cancelled is back then.
    if (placed_now && pulses_)
      residuals[m] += lift_transform(task_, own_rise(task_, task_.stroke), two_->modes[m]) -
                      lift_transform(task_, rise(), two_->modes[m]);
  }
  if (placed_now) pulses_.reset();
  const auto four = corrected_four(residuals);
  use(four[0], four[1]);
  two_->last = two_->now;
}

// What was carried over has been cancelled: from now on the pulses are for the cycle's own residuals.
void RecordTuner::cancel_own() {
  if (!two_) return use(corrected(-carried(last_)));
  const auto four = corrected_four({-carried_of_both()[0], -carried_of_both()[1]});
  use(four[0], four[1]);
}

// The same where the last `cycle` says what of its own it left.
void RecordTuner::cancel_own_of(const TunedCycle& cycle) {
  if (!two_) return use(corrected(cycle.fit->residual * scale_ - carried(last_)));
  const auto before = carried_of_both();
  const auto four = corrected_four({two_->now[0] - before[0], two_->now[1] - before[1]});
  use(four[0], four[1]);
}

// The first correction has shown what pulses do: where it left more of the last residual than a model may be off, the
// pulses' gain is that of the machine (the rule of the secant).
void RecordTuner::learn_gain(std::complex<double> residual) {
  constexpr double of_model = 0.15;
  if (std::abs(residual) < of_model * std::abs(last_)) return;
  const auto gain = last_ / (last_ - residual);
  // Further off it is no gain.
  constexpr double most = 3.0;
  if (!(std::abs(gain) < most)) return;
  scale_ *= gain;
  last_ *= gain;
}

void RecordTuner::use(const PulsePair& pulses, const std::optional<PulsePair>& second) {
  pulses_ = pulses;
  second_pulses_ = second;
  cam_ = with_lift(task_.motion.cam, rise());
}

TunedCycle& RecordTuner::keep_better(TunedCycle& cycle, const char* note) {
  done_ = true;
  cycle.note = note;
  if (better_) {
    use(*better_, better_second_);
    // It was for one cycle alone.
    if (settings_.running) {
      last_ = better_last_;
      if (two_) two_->last = better_lasts_;
      if (better_second_.has_value() == two_.has_value()) cancel_own();
    }
  } else {
    pulses_.reset(), second_pulses_.reset(), cam_ = task_.motion.cam;
  }
  return cycle;
}

TunedCycle RecordTuner::learn(const CycleRecord& record) {
  TunedCycle cycle;
  const DwellRecord dwell = dwell_of(task_, record, drive_ ? std::max(0.0, drive_->delay) : unknown_lag);
  ++cycles_;
  const bool had_two = two_.has_value();
  measure(dwell, cycle);
  const bool still = !cycle.fit || cycle.peak_to_peak < settings_.resolution;
  // Running, one more cycle costs nothing, and of two numbers that the encoder does not resolve neither is worse.
  const bool within_noise = settings_.running && cycles_ > 1 && still;
  if (cycles_ > 1 && cycle.quality > best_quality_ && !within_noise)
    return keep_better(cycle, "It became worse; the motion of the best cycle is kept.");
  best_quality_ = cycle.quality;
  better_ = pulses_;
  better_second_ = second_pulses_;
  better_last_ = last_;
  if (two_) better_lasts_ = two_->last;
  // The first quiet cycle of a machine that runs on was for what the one before it had left; how still the load is with
  // nothing carried over, the next one shows.
  const bool quiet_before = before_ < settings_.resolution;
  if (still && !(within_noise && (drive_ || two_) && !quiet_before)) {
    done_ = true;
    cycle.note = "The residual is within the resolution of the encoder; nothing is changed.";
    if (within_noise && (drive_ || two_)) {
      cancel_own_of(cycle);
      cycle.note =
          "The residual is within the resolution of the encoder; the motion cancels its own residual from now on.";
    }
    return cycle;
  }
  // A linear machine is at rest after two corrections, of which the first one has shown its gain, but for a mode that
  // had not been seen. Running, what the untuned cycle left is still carried over then, and the frequency is not known
  // well enough for so much of it.
  const int enough = settings_.running ? 3 : 2;
  if (cycles_ > enough && !still && cycle.peak_to_peak > 0.5 * before_ && had_two == two_.has_value()) {
    done_ = true;
    cycle.note = "The residual does not go away by pulses; nothing is changed.";
    if (settings_.running && (drive_ || two_)) cancel_own();
    return cycle;
  }
  before_ = cycle.peak_to_peak;
  if (two_) {
    correct_four();
    if (!had_two) cycle.note = "A second mode vibrates too; four pulses are for both.";
    return cycle;
  }
  if (!drive_) {
    use(first_pulses(record, *cycle.fit));
    return cycle;
  }
  if (cycles_ == 2) learn_gain(cycle.fit->residual * scale_);
  const auto residual = cycle.fit->residual * scale_;
  use(corrected(residual - carried(last_) + carried(residual)));
  last_ = residual;
  return cycle;
}

// A warm gear has a different frequency, and a load that is still does not show it. But the pulses do, which cancel at
// that frequency alone: it is where they leave as little as those of the tuning did.
void RecordTuner::follow_frequencies() {
  const Curve now = rise();
  const auto follow = [&](Mode mode, std::complex<double> left) {
    // Golden section; a gear does not warm by more in a cycle.
    const auto off = [&](double share) { return std::abs(lift_transform(task_, now, {mode.pole * share}) - left); };
    constexpr double reach = 0.005, golden = 0.6180339887;
    double low = 1.0 - reach, high = 1.0 + reach;
    while (high - low > 2e-5) {
      const double a = high - golden * (high - low), b = low + golden * (high - low);
      (off(a) < off(b) ? high : low) = off(a) < off(b) ? b : a;
    }
    return Mode{mode.pole * (0.5 * (low + high))};
  };
  if (two_) {
    for (std::size_t m = 0; m < 2; ++m) two_->modes[m] = follow(two_->modes[m], (*left_by_tuning_)[m]);
  } else {
    drive_->ringing = follow(drive_->ringing, (*left_by_tuning_)[0]);
    task_.drive = drive_with_mode(task_.drive, drive_->ringing);
  }
}

// What a cycle makes itself of the `residual` of its record of `mode`, number `which`.
std::complex<double> RecordTuner::own_part(std::complex<double> residual, const Mode& mode, std::size_t which,
                                           bool next) {
  if (!settings_.running) return residual;
  const auto carried = std::exp(mode.pole * (task_.motion.curve.length() / task_.master_speed));
  return next ? residual - before_that_[which] * carried : residual * (1.0 - carried);
}

TunedCycle RecordTuner::follow(const CycleRecord& record, bool next) {
  TunedCycle cycle;
  const DwellRecord dwell = dwell_of(task_, record, drive_ ? std::max(0.0, drive_->delay) : unknown_lag);
  ++cycles_;
  if (!drive_ && !two_) {
    cycle.quality = area(dwell, mean(dwell.position), task_.master_speed);
    return cycle;
  }
  // The last motion of a tuning that did not end was for one cycle alone.
  if (settings_.running && !done_) cancel_own();
  done_ = true;
  const std::size_t count = two_ ? 2 : 1;
  if (!left_by_tuning_) {
    left_by_tuning_.emplace();
    for (std::size_t m = 0; m < count; ++m)
      (*left_by_tuning_)[m] = lift_transform(task_, rise(), two_ ? two_->modes[m] : drive_->ringing);
    // Of the cycle before it nothing is known here.
    next = false;
  }
  std::array<std::complex<double>, 2> residuals{}, own{};
  double offset = 0.0;
  if (two_) {
    const auto both = residuals_with_modes(dwell, two_->modes);
    residuals = both.of, offset = both.offset;
    for (std::size_t m = 0; m < 2; ++m) own[m] = own_part(residuals[m], two_->modes[m], m, next) * two_->scale[m];
  } else {
    residuals[0] = residual_with_mode(dwell, drive_->ringing, &offset);
    own[0] = own_part(residuals[0], drive_->ringing, 0, next) * scale_;
  }
  before_that_ = residuals;
  cycle.quality = area(dwell, offset, task_.master_speed);
  cycle.peak_to_peak = 4.0 * (std::abs(residuals[0]) + std::abs(residuals[1]));
  const double worth = settings_.resolution * (settings_.running && next ? worth_following : worth_correcting);
  if (cycle.peak_to_peak < worth) return cycle;
  for (auto& each : own) each *= followed_part;
  if (two_) {
    const auto four = corrected_four(own);
    use(four[0], four[1]);
  } else {
    use(corrected(own[0]));
  }
  follow_frequencies();
  cycle.note = "The load vibrates again; the pulses are corrected.";
  return cycle;
}

}  // namespace stiction::sim::cam
