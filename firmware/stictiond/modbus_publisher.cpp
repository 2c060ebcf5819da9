#include "firmware/stictiond/modbus_publisher.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

#include "firmware/stictiond/modbus_setup.hpp"
#include "hal/tick_clock.hpp"
#include "stiction/drive/state_machine.hpp"

namespace stiction::drive {
namespace {

constexpr std::array<const char*, MotionWrite::kinds> motion_names{
    "controlword",          "mode of operation", "target position", "profile velocity", "profile acceleration",
    "profile deceleration", "target velocity",   "target torque",   "max torque"};

std::vector<std::string> names_of(const machine::Machine& machine) {
  std::vector<std::string> names;
  for (const machine::AxisModel& axis : machine.axes) names.push_back(axis.name);
  return names;
}

std::int64_t now_ns() { return hal::MonotonicTime().now_ns(); }

// What a client sees of a loop that makes no progress.
void mark_stale(PublishedState& state) {
  constexpr std::uint16_t gone = statusword::state_bits | statusword::voltage_bit;
  state.fault = Fault::watchdog_starved;
  for (PublishedAxis& axis : state.axes) {
    axis.statusword = static_cast<std::uint16_t>((axis.statusword & ~gone) | statusword::fault_bit);
    axis.fault = Fault::watchdog_starved;
  }
}

}  // namespace

ModbusPublisher::ModbusPublisher(const machine::Machine& machine, const machine::DriveSetup& setup, ModbusStore store,
                                 Beside beside, Stale stale, bool moves_itself)
    : registers_(machine, setup, store.begun),
      store_(std::move(store)),
      beside_(std::move(beside)),
      stale_(std::move(stale)),
      moves_itself_(moves_itself),
      motion_allowed_(modbus_server_config(setup).motion_allowed),
      axis_names_(names_of(machine)),
      window_(setup.modbus_server.value().commissioning_time),
      stored_(std::make_shared<Stored>(store_.file_holds)),
      kept_(store_.begun),
      server_(
          registers_.map(), modbus_server_config(setup),
          [this](std::span<double> values) {
            PublishedState state = snapshot_.latest();
            if (beside_) beside_(state);
            state.commissioning_seconds = window_.seconds_left(now_ns());
            state.store_result = stored_->result.load();
            show_clients(state);
            if (stale_ && stale_()) mark_stale(state);
            registers_.put_values(state, values);
          },
          this) {}

void ModbusPublisher::open_commissioning() {
  window_.open(now_ns());
  said_->say(fmt::format("Modbus: clients may write parameters for {:g} s", window_.length_s()), now_ns());
}

void ModbusPublisher::close_commissioning() {
  window_.close();
  said_->say("Modbus: clients may not write parameters any more", now_ns());
}

std::optional<hal::ModbusException> ModbusPublisher::rejection_of(std::span<const ParameterWrite> parameters,
                                                                  bool store) {
  if ((store || !parameters.empty()) && !window_.is_open(now_ns())) {
    said_->say(
        fmt::format("Modbus: {} is refused: the commissioning window is closed; expected that an operator of this "
                    "computer opens it (SIGUSR1)",
                    parameters.empty() ? "store_parameters" : parameters.front().key),
        now_ns());
    return hal::ModbusException::illegal_function;
  }
  for (const auto& parameter : parameters)
    if (const auto reason = registers_.rejection_of(parameter); !reason.empty()) {
      said_->say("Modbus: " + reason, now_ns());
      return hal::ModbusException::illegal_value;
    }
  return {};
}

hal::WriteVerdict ModbusPublisher::take(std::span<const hal::RegisterWrite> writes) {
  std::vector<MotionWrite> motions;
  std::vector<ParameterWrite> parameters;
  bool store = false;
  for (const hal::RegisterWrite& write : writes) {
    DriveWrite meaning = registers_.meaning_of(write);
    if (const auto* motion = std::get_if<MotionWrite>(&meaning))
      motions.push_back(*motion);
    else if (auto* parameter = std::get_if<ParameterWrite>(&meaning))
      parameters.push_back(std::move(*parameter));
    else
      store = true;
  }
  if (moves_itself_ && !std::all_of(motions.begin(), motions.end(), MotionMailbox::stops))
    return {.refused = hal::ModbusException::illegal_function};
  if (!motions.empty() && stale_ && stale_()) return {.refused = hal::ModbusException::device_failure};
  if (!parameters.empty() && !parameter_limit_.take(now_ns())) return {.refused = hal::ModbusException::busy};
  if (const auto rejected = rejection_of(parameters, store)) return {.refused = *rejected};
  const bool taken = judge(motions);
  // All at once: a target and the bit that it is taken by may come in one request.
  if (!motions.empty()) motion_.put(motions);
  for (const MotionWrite& motion : motions) said_->say(describe(motion), now_ns());
  if (!taken) return {.refused = hal::ModbusException::busy};
  for (const ParameterWrite& parameter : parameters) {
    registers_.remember(parameter);
    said_->say(fmt::format("Modbus: {} = {}, which takes effect at the next start if it is stored", parameter.key,
                           parameter.value),
               now_ns());
  }
  return store ? ask_store() : hal::WriteVerdict{};
}

// One that is refused refuses all but a stop, which is taken from everybody. What the drive is to do is left in
// `motions`.
bool ModbusPublisher::judge(std::vector<MotionWrite>& motions) {
  const auto passed = judged(motions);
  if (!passed) std::erase_if(motions, [](const MotionWrite& write) { return !MotionMailbox::stops(write); });
  motions = passed ? *passed : judged(motions).value();
  return passed.has_value();
}

std::optional<std::vector<MotionWrite>> ModbusPublisher::judged(std::span<const MotionWrite> motions) {
  using Verdict = ModbusClients::Verdict;
  const PublishedState& state = snapshot_.latest();
  auto after = clients_;
  std::vector<MotionWrite> passed;
  for (MotionWrite write : motions) {
    const auto verdict = after.judge(client_, write, state.axes[write.axis]);
    if (verdict == Verdict::refused) return {};
    write.of_other = verdict == Verdict::pass_as_stop;
    if (verdict != Verdict::ignored) passed.push_back(write);
  }
  clients_ = std::move(after);
  return passed;
}

void ModbusPublisher::show_clients(PublishedState& state) const {
  state.client = client_;
  for (std::size_t i = 0; i < state.axes.size(); ++i) {
    state.axes[i].owner_client = clients_.owner(i);
    state.axes[i].owner_token = static_cast<std::uint16_t>(state.axes[i].owner_token + clients_.changes(i));
  }
}

hal::WriteVerdict ModbusPublisher::ask_store() {
  if (store_.file.empty()) {
    said_->say("Modbus: parameters are not stored: the drive was started without --parameters", now_ns());
    return {.refused = hal::ModbusException::device_failure};
  }
  asked_ = registers_.written();
  stored_->result = StoreResult::under_way;
  const auto ticket =
      disk_.ask([set = *asked_, check = store_.check, said = said_, stored = stored_, file = store_.file.string()] {
        auto ends = StoreResult::rejected;
        try {
          if (check) check(set);
          ends = StoreResult::not_written;
          write_parameters(file, set, stored->file_holds ? KeepAsPrevious::the_file : KeepAsPrevious::what_is_there);
        } catch (const std::exception& error) {
          stored->result = ends;
          said->say(fmt::format("Modbus: parameters are not stored: {}", error.what()), now_ns());
          throw;
        }
        stored->file_holds = true;
        stored->result = StoreResult::stored;
        said->say(fmt::format("Modbus: parameters stored in {}", file), now_ns());
      });
  return {.put_off = ticket};
}

std::optional<hal::WriteVerdict> ModbusPublisher::outcome(std::uint64_t ticket) {
  switch (disk_.outcome(ticket)) {
    case StoreThread::Outcome::under_way:
      return {};
    case StoreThread::Outcome::stored:
      kept_ = asked_;
      return hal::WriteVerdict{};
    case StoreThread::Outcome::failed:
      // A value that refuses a start would refuse every set that follows.
      if (stored_->result == StoreResult::rejected) registers_.take_back(kept_);
      break;
  }
  return hal::WriteVerdict{.refused = hal::ModbusException::device_failure};
}

std::vector<std::string> ModbusPublisher::serve() { return said_->take(now_ns()); }

std::string ModbusPublisher::describe(const MotionWrite& write) const {
  return fmt::format("Modbus: axis {}: {} {}", axis_names_[write.axis],
                     motion_names[static_cast<std::size_t>(write.what)], write.value);
}

}  // namespace stiction::drive
