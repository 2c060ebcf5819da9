#include "firmware/stictiond/cam_tuner.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/stictiond/load_mode_fit.hpp"

namespace stiction::drive {
namespace {

using Complex = std::complex<double>;

// Of the vibration of a cycle before, where it counts as gone.
constexpr double gone = 0.05;
// A frequency that differs by more is taken from the record; the pulses' phase is then off by less than 0.05.
constexpr double known_frequency = 2e-3;
// By how much a drive may differ from its model, as at the desk.
constexpr double drive_share = 0.04;

double value(std::int64_t raw) { return std::ldexp(static_cast<double>(raw), -40); }
std::int64_t raw(double value) { return std::llround(std::ldexp(value, 40)); }

}  // namespace

CamTuner::CamTuner(const Config& config)
    : config_(config), design_(std::make_unique<machine::CamTuningDesign>(config.given)) {
  // As long as there are pulses, whatever the frequency becomes.
  config_.given.places = design_->places();
}

void CamTuner::command(CamTuningCommand command) {
  switch (command) {
    case CamTuningCommand::start:
      return begin(state_ == CamTuningState::watching || after_ == CamTuningState::watching ? CamTuningState::watching
                                                                                            : CamTuningState::idle);
    case CamTuningCommand::watch:
      over_ = 0;
      after_ = CamTuningState::watching;
      if (state_ == CamTuningState::idle) state_ = after_;
      return;
    case CamTuningCommand::stop:
      after_ = CamTuningState::idle;
      if (state_ == CamTuningState::tuning && best_) wanted_ = best_->pulses;
      state_ = CamTuningState::idle;
      return;
    case CamTuningCommand::restore:
      after_ = state_ = CamTuningState::idle;
      wanted_ = {};
      return;
    case CamTuningCommand::none:
      return;
  }
}

void CamTuner::begin(CamTuningState after) {
  state_ = CamTuningState::tuning;
  after_ = after;
  refusal_ = outcome_ = CamTuningRefusal::none;
  at_start_ = wanted_;
  best_.reset();
  steps_ = worse_ = identified_ = over_ = refused_ = 0;
  first_ = true;
}

void CamTuner::end(CamTuningRefusal reason) {
  outcome_ = refusal_ = reason;
  if (best_) wanted_ = best_->pulses;
  const double left = std::exp(design_->mode().pole().real() / config_.given.speed);
  settle_ = 1 + static_cast<int>(std::ceil(std::log(gone) / std::log(std::min(left, 0.99))));
  state_ = steps_ == 0 ? after_ : CamTuningState::settling;
  over_ = 0;
}

void CamTuner::reject(CamTuningRefusal reason) {
  if (state_ != CamTuningState::tuning) {
    wanted_ = at_start_;
    refusal_ = reason;
    return;
  }
  end(reason);
}

std::optional<Complex> CamTuner::own_part(const Record& record, Complex vibration) const {
  const Complex p = design_->mode().pole();
  if (!last_) return {};
  const double since = record.time - last_->time;
  if (std::exp(p.real() * since) < 1e-3) return vibration;
  if (record.cycle != last_->cycle + 1) return {};
  return vibration - last_->vibration * std::exp(p * since);
}

bool CamTuner::identify(const Record& record) {
  constexpr int most = 3;
  if (identified_ == most) return false;
  ++identified_;
  const auto found = load_frequency({record.state->record.data(), record.state->kept},
                                    record.config->every * config_.given.period, config_.given.mode);
  if (!found || std::abs(*found / config_.given.mode.frequency - 1.0) < known_frequency) return false;
  auto given = config_.given;
  given.mode.frequency = *found;
  const bool without = wanted_ == PulseAmplitudes{};
  if (without) given.places.reset();
  try {
    design_ = std::make_unique<machine::CamTuningDesign>(given);
  } catch (const machine::CamTuningError&) {
    return false;  // the frequency before it holds
  }
  config_.given = given;
  config_.given.places = design_->places();
  factor_ = 1.0;
  last_.reset();
  best_.reset();
  return true;
}

void CamTuner::learn(const Record& record) {
  ++cycles_;
  auto fit = CamTuning::evaluate(*record.config, *record.state);
  if (fit.refusal == CamTuningRefusal::none && !record.as_its_table) fit.refusal = CamTuningRefusal::relative;
  if (fit.refusal != CamTuningRefusal::none) {
    refusal_ = fit.refusal;
    last_.reset();
    // A cycle that was disturbed is left out; a machine that is none to tune ends it.
    constexpr int most = 5;
    if (state_ == CamTuningState::tuning && ++refused_ == most) end(fit.refusal);
    return;
  }
  if (state_ == CamTuningState::tuning) refusal_ = CamTuningRefusal::none;
  quality_ = value(fit.quality);
  // Made for the frequency before this one.
  if (record.config->turn_im != config().turn_im) {
    last_.reset();
    return;
  }
  const Complex vibration{value(fit.re), value(fit.im)};
  const auto own = own_part(record, vibration);
  last_ = Seen{record.cycle, record.time, vibration};
  const bool as_wanted = record.pulses == wanted_;
  switch (state_) {
    case CamTuningState::tuning:
      if (first_) before_ = quality_;
      first_ = false;
      if (!as_wanted || identify(record) || !own) return;
      return tune(*own);
    case CamTuningState::settling:
      if (as_wanted && own) compare(*own);
      return;
    case CamTuningState::watching:
      return watch();
    default:
      return;
  }
}

// The model's vibration of the pulses there are, beside what was recorded: where the difference is that of a drive, it
// scales all of them.
void CamTuner::scale_by_model(Complex own) {
  const Complex ratio = (design_->own() + design_->vibration(wanted_.first, wanted_.second)) / own;
  if (std::abs(ratio - 1.0) < drive_share) factor_ = ratio;
}

// What a change of the pulses made, beside what it was to make.
void CamTuner::learn_drive(const Tried& before, const Tried& now) {
  const Complex expected =
      design_->vibration(now.pulses.first - before.pulses.first, now.pulses.second - before.pulses.second);
  const Complex made = now.own - before.own;
  if (std::abs(made) < 16.0 * config_.given.increment) return;
  const Complex ratio = expected / made;
  if (std::abs(ratio) > 0.4 && std::abs(ratio) < 2.5) factor_ = ratio;
}

void CamTuner::tune(Complex own) {
  const Tried now{wanted_, own};
  if (!best_) {
    scale_by_model(own);
  } else if (now.pulses != best_->pulses) {
    learn_drive(*best_, now);
  }
  const bool worse = best_ && std::abs(own) > std::abs(best_->own);
  worse_ = worse ? worse_ + 1 : 0;
  if (!worse) best_ = now;
  if (2.0 * std::abs(best_->own) < config_.given.increment) return end(CamTuningRefusal::none);
  if (worse_ == 2) return end(CamTuningRefusal::worse);
  if (steps_ == config_.steps) return end(worse ? CamTuningRefusal::worse : CamTuningRefusal::none);
  try_from(*best_);
}

void CamTuner::try_from(const Tried& tried) {
  CamTuning::Fit fit;
  fit.re = raw(tried.own.real());
  fit.im = raw(tried.own.imag());
  CamTuning::change(config(), fit);
  const PulseAmplitudes next{tried.pulses.first + value(fit.first), tried.pulses.second + value(fit.second)};
  if (std::max(std::abs(next.first), std::abs(next.second)) > config_.amplitude)
    return end(CamTuningRefusal::amplitude);
  ++steps_;
  wanted_ = next;
}

void CamTuner::compare(Complex own) {
  if (--settle_ > 0) return;
  if (wanted_ != at_start_ && quality_ > before_) {
    state_ = after_;
    refusal_ = CamTuningRefusal::worse;
    wanted_ = at_start_;
    return;
  }
  // Cycle upon cycle adds up: what is left is larger than one of them alone, and better known.
  const bool within = 2.0 * std::abs(last_->vibration) < config_.given.increment;
  if (within || outcome_ != CamTuningRefusal::none || steps_ == config_.steps) {
    state_ = after_;
    return;
  }
  state_ = CamTuningState::tuning;
  best_ = Tried{wanted_, own};
  worse_ = 0;
  try_from(*best_);
}

void CamTuner::watch() {
  over_ = config_.quality_limit > 0.0 && quality_ > config_.quality_limit ? over_ + 1 : 0;
  if (over_ == most_over) ++grown_;
  if (over_ < most_over || !config_.by_itself || cycles_ < next_start_) return;
  next_start_ = cycles_ + config_.pause;
  begin(CamTuningState::watching);
}

}  // namespace stiction::drive
