#include "firmware/stictiond/tuned_axis.hpp"

#include <fmt/format.h>

#include "firmware/stictiond/table_range.hpp"

namespace stiction::drive {
namespace {

constexpr std::array<const char*, cam_tuning_refusals> refusals{
    "none",
    "the rest behind the rise is shorter than a period of the load",
    "the axis moved in its rest, or what the load does there is no vibration of the configured frequency",
    "current or voltage was at its limit",
    "the load is farther from its place than a record holds",
    "the master did not turn at the speed that the cam is tuned for",
    "the position of the load is not known",
    "a pulse would be larger than drive.cam_tuning.amplitude",
    "the axis does not take the table, which asks for more than its limits or its travel",
    "the table is followed with a scale, a ratio, or a begin where the axis or the master was",
    "nothing that was tried is better",
    "the axis does not follow the table that is tuned",
    "tuning is not configured"};

constexpr std::array<const char*, 5> states{"off", "idle", "tuning", "settling", "watching"};

std::uint32_t place_of(std::uint32_t offer) { return offer & 3u; }
std::uint32_t serial_of(std::uint32_t offer) { return offer >> 2; }

}  // namespace

const char* words_of(CamTuningRefusal refusal) { return refusals[static_cast<std::size_t>(refusal)]; }
const char* name_of(CamTuningState state) { return states[static_cast<std::size_t>(state)]; }

TunedAxis::TunedAxis(const Config& config) : config_(config), period_(config.tuner.given.period), tuner_(config.tuner) {
  for (auto& slot : slots_) slot.config = tuner_.config();
  publish();
}

void TunedAxis::step(CamMode& mode, const LoadReading<S>& load, bool limited) {
  ++ticks_;
  exchange(mode);
  record(mode, load, limited);
  follows_.store(mode.table() == config_.number, std::memory_order_relaxed);
}

void TunedAxis::exchange(CamMode& mode) {
  if (taking_ != 0 && !mode.exchanging()) {
    if (mode.exchanged(config_.number) == table_of(place_of(taking_))) {
      in_force_ = taking_;
      refused_.store(CamRefusal::none, std::memory_order_relaxed);
    } else {
      const CamRefusal refusal = mode.status().refusal;
      refused_.store(refusal == CamRefusal::none ? CamRefusal::not_enabled : refusal, std::memory_order_relaxed);
    }
    taking_ = 0;
    taken_.store(in_force_, std::memory_order_relaxed);
    offered_.store(0, std::memory_order_release);
    return;
  }
  const std::uint32_t offered = offered_.load(std::memory_order_acquire);
  // A request of a client comes first.
  if (taking_ != 0 || offered == 0 || mode.table() != config_.number || mode.status().waiting || mode.braking()) return;
  const CamRefusal refusal = mode.exchange(config_.number, table_of(place_of(offered)));
  if (refusal == CamRefusal::none) {
    taking_ = offered;
    return;
  }
  refused_.store(refusal, std::memory_order_relaxed);
  offered_.store(0, std::memory_order_release);
}

void TunedAxis::record(const CamMode& mode, const LoadReading<S>& load, bool limited) {
  Slot* slot = &slots_[at_];
  if (slot->full.load(std::memory_order_acquire)) return;
  const CamStatus& status = mode.status();
  const MasterPoint master = mode.seen();
  CamTuning::Input in;
  in.master = master.position;
  in.velocity = master.velocity;
  in.load = load.position.raw();
  in.set_point = mode.point().position;
  in.valid = load.valid;
  in.limited = limited;
  in.follows = status.active && (status.in_sync || mode.exchanging()) && mode.table() == config_.number &&
               !mode.phasing() && !mode.superposes();
  const auto before = slot->state.stage;
  CamTuning::step(slot->config, slot->state, in);
  const auto now = slot->state.stage;
  if (now == CamTuning::Stage::dwell && before != now) {
    slot->cycle = master.position.cycles;
    slot->tick = ticks_;
    slot->serial = serial_of(in_force_);
    slot->as_its_table = mode.as_its_table();
  }
  if (now != CamTuning::Stage::full) return;
  slot->full.store(true, std::memory_order_release);
  at_ = 1 - at_;
  // Sees in this tick already that the master is between two cycles.
  slot = &slots_[at_];
  if (!slot->full.load(std::memory_order_acquire)) CamTuning::step(slot->config, slot->state, in);
}

void TunedAxis::show(PublishedCamTuning& shown) const {
  shown.state = static_cast<std::uint16_t>(state_.load(std::memory_order_relaxed));
  shown.refusal = static_cast<std::uint16_t>(refusal_.load(std::memory_order_relaxed));
  shown.quality = quality_.load(std::memory_order_relaxed);
  shown.before = before_.load(std::memory_order_relaxed);
  shown.frequency = frequency_.load(std::memory_order_relaxed);
  shown.steps = steps_.load(std::memory_order_relaxed);
}

void TunedAxis::round(const LogSink& say) {
  take_command(say);
  take_answer(say);
  take_records(say);
  offer(say);
  say_state(say);
  publish();
}

void TunedAxis::take_command(const LogSink& say) {
  const auto command = asked_.exchange(CamTuningCommand::none, std::memory_order_acq_rel);
  if (command == CamTuningCommand::none) return;
  if (command == CamTuningCommand::start && !follows_.load(std::memory_order_relaxed)) {
    refusal_.store(CamTuningRefusal::no_table, std::memory_order_relaxed);
    say(LogLevel::warning,
        fmt::format("cam tuning: axis {}: {}; it does not begin", config_.name, words_of(CamTuningRefusal::no_table)));
    return;
  }
  tuner_.command(command);
}

void TunedAxis::take_answer(const LogSink& say) {
  if (waiting_ == 0 || offered_.load(std::memory_order_acquire) != 0) return;
  const bool taken = taken_.load(std::memory_order_relaxed) == waiting_;
  waiting_ = 0;
  if (taken) return;
  const CamRefusal refusal = refused_.load(std::memory_order_relaxed);
  // A request of a client came between; the table is offered again.
  if (refusal == CamRefusal::not_enabled) return;
  say(LogLevel::warning, fmt::format("cam tuning: axis {}: {} (refusal {} of the cam)", config_.name,
                                     words_of(CamTuningRefusal::axis_limits), static_cast<int>(refusal)));
  tuner_.reject(CamTuningRefusal::axis_limits);
}

void TunedAxis::take_records(const LogSink& say) {
  for (std::size_t k = 0; k < slots_.size(); ++k) {
    Slot& slot = slots_[next_slot_];
    if (!slot.full.load(std::memory_order_acquire)) return;
    next_slot_ = 1 - next_slot_;
    const PulseAmplitudes before = tuner_.pulses();
    tuner_.learn({.config = &slot.config,
                  .state = &slot.state,
                  .cycle = slot.cycle,
                  .time = static_cast<double>(slot.tick) * period_,
                  .pulses = pulses_[slot.serial % kept_pulses],
                  .as_its_table = slot.as_its_table});
    if (tuner_.pulses() != before)
      say(LogLevel::info,
          fmt::format("cam tuning: axis {}: quality number {:.3g} mm, pulses of {:.4g} mm and {:.4g} mm", config_.name,
                      1e3 * tuner_.quality(), 1e3 * tuner_.pulses().first, 1e3 * tuner_.pulses().second));
    slot.config = tuner_.config();
    CamTuning::release(slot.state);
    slot.full.store(false, std::memory_order_release);
  }
}

void TunedAxis::offer(const LogSink& say) {
  if (waiting_ != 0) return;
  const std::uint32_t in_force = taken_.load(std::memory_order_relaxed);
  if (tuner_.pulses() == pulses_[serial_of(in_force) % kept_pulses]) return;
  const bool without = tuner_.pulses() == PulseAmplitudes{};
  const std::uint32_t place = without ? 0 : place_of(in_force) == 1 ? 2 : 1;
  if (!without && !write(place)) {
    say(LogLevel::warning,
        fmt::format("cam tuning: axis {}: {}", config_.name, words_of(CamTuningRefusal::axis_limits)));
    tuner_.reject(CamTuningRefusal::axis_limits);
    return;
  }
  ++serial_;
  pulses_[serial_ % kept_pulses] = tuner_.pulses();
  waiting_ = offer_of(serial_, place);
  offered_.store(waiting_, std::memory_order_release);
}

bool TunedAxis::write(std::uint32_t number) {
  Place& place = places_[number - 1];
  const auto& design = tuner_.design();
  place.bytes = with_pulses(*config_.tuner.given.table, config_.bytes, design.rise(), design.places(), tuner_.pulses());
  if (CamTable::read(place.bytes, place.table) != CamTableProblem::none) return false;
  const CamCurve::Config config{.table = &place.table, .periodic = place.table.header().periodic};
  if (CamCurve::prepare(config, place.made.curve) != CamRefusal::none) return false;
  find_range(place.table, place.made);
  return true;
}

void TunedAxis::say_state(const LogSink& say) {
  const auto state = tuner_.state();
  const auto refusal = tuner_.refusal();
  const auto& name = config_.name;
  if (state == CamTuningState::tuning && said_state_ != state && said_state_ != CamTuningState::settling)
    say(LogLevel::notice,
        fmt::format("cam tuning: axis {}: begins; quality number {:.3g} mm", name, 1e3 * tuner_.quality()));
  const bool ends = said_state_ == CamTuningState::settling || said_state_ == CamTuningState::tuning;
  if (state != said_state_ && ends && (state == CamTuningState::idle || state == CamTuningState::watching))
    say(LogLevel::notice,
        fmt::format(
            "cam tuning: axis {}: ends after {} tables; quality number {:.3g} mm, before {:.3g} mm, load at {:.3f} Hz",
            name, tuner_.steps(), 1e3 * tuner_.quality(), 1e3 * tuner_.quality_before(), tuner_.frequency()));
  // A machine that is watched stops and starts.
  const bool tells = state == CamTuningState::tuning || ends;
  if (refusal != said_refusal_ && refusal != CamTuningRefusal::none && tells)
    say(LogLevel::warning, fmt::format("cam tuning: axis {}: {}", name, words_of(refusal)));
  if (tuner_.grown() != said_grown_)
    say(LogLevel::warning,
        fmt::format(
            "cam tuning: axis {}: the quality number has grown to {:.3g} mm, above drive.cam_tuning.quality_limit",
            name, 1e3 * tuner_.quality()));
  said_grown_ = tuner_.grown();
  said_state_ = state;
  said_refusal_ = refusal;
}

void TunedAxis::publish() {
  const bool left_out = refusal_.load(std::memory_order_relaxed) == CamTuningRefusal::no_table &&
                        tuner_.state() == CamTuningState::idle && tuner_.refusal() == CamTuningRefusal::none;
  state_.store(tuner_.state(), std::memory_order_relaxed);
  if (!left_out) refusal_.store(tuner_.refusal(), std::memory_order_relaxed);
  quality_.store(tuner_.quality(), std::memory_order_relaxed);
  before_.store(tuner_.quality_before(), std::memory_order_relaxed);
  frequency_.store(tuner_.frequency(), std::memory_order_relaxed);
  steps_.store(static_cast<std::uint16_t>(tuner_.steps()), std::memory_order_relaxed);
}

}  // namespace stiction::drive
