#include "firmware/stictiond/modbus_publisher.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "firmware/stictiond/modbus_setup.hpp"
#include "hal/tick_clock.hpp"
#include "stiction/drive/state_machine.hpp"

namespace stiction::drive {
namespace {

constexpr std::array<const char*, MotionWrite::kinds> motion_names{"controlword",
                                                                   "mode of operation",
                                                                   "target position",
                                                                   "profile velocity",
                                                                   "profile acceleration",
                                                                   "profile deceleration",
                                                                   "target velocity",
                                                                   "target torque",
                                                                   "max torque",
                                                                   "cam table",
                                                                   "cam trigger",
                                                                   "cam approach",
                                                                   "cam options",
                                                                   "cam time",
                                                                   "cam distance",
                                                                   "cam position",
                                                                   "cam master offset",
                                                                   "cam slave offset",
                                                                   "cam slave scale",
                                                                   "gear numerator",
                                                                   "gear denominator",
                                                                   "gear way",
                                                                   "cam phase",
                                                                   "cam tolerance",
                                                                   "cam tolerance of speed",
                                                                   "cam tolerance of acceleration",
                                                                   "cam leave speed",
                                                                   "cam superposed",
                                                                   "cam leave position",
                                                                   "master speed",
                                                                   "cam tuning",
                                                                   "cam command"};

std::vector<std::string> names_of(const machine::Machine& machine) {
  std::vector<std::string> names;
  for (const machine::AxisModel& axis : machine.axes) names.push_back(axis.name);
  return names;
}

std::int64_t now_ns() { return hal::MonotonicTime().now_ns(); }

}  // namespace

ModbusPublisher::ModbusPublisher(std::shared_ptr<ParameterDesk> desk, const machine::Machine& machine,
                                 const machine::DriveSetup& setup, Beside beside, Stale stale, bool moves_itself)
    : desk_(std::move(desk)),
      beside_(std::move(beside)),
      stale_(std::move(stale)),
      moves_itself_(moves_itself),
      motion_allowed_(modbus_server_config(setup).motion_allowed),
      axis_names_(names_of(machine)),
      server_(
          desk_->registers().map(), modbus_server_config(setup),
          [this](std::span<double> values) {
            PublishedState state = loop_.latest();
            if (beside_) beside_(state);
            desk_->show(state);
            show_clients(state);
            if (stale_ && stale_()) mark_stale(state);
            desk_->registers().put_values(state, values);
          },
          this) {}

hal::WriteVerdict ModbusPublisher::take(std::span<const hal::RegisterWrite> writes) {
  std::vector<MotionWrite> motions;
  std::vector<ParameterWrite> parameters;
  bool store = false;
  for (const hal::RegisterWrite& write : writes) {
    DriveWrite meaning = desk_->registers().meaning_of(write);
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
  if (const auto rejected = desk_->rejection_of(parameters, store, "Modbus")) return {.refused = *rejected};
  const bool taken = judge(motions);
  // All at once: a target and the bit that it is taken by may come in one request.
  if (!motions.empty()) loop_.put(motions);
  for (const MotionWrite& motion : motions) desk_->said().say(describe(motion), now_ns());
  if (!taken) return {.refused = hal::ModbusException::busy};
  return desk_->take(parameters, store, "Modbus");
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
  const PublishedState& state = loop_.latest();
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

std::optional<hal::WriteVerdict> ModbusPublisher::outcome(std::uint64_t ticket) { return desk_->outcome(ticket); }

std::vector<std::string> ModbusPublisher::serve() { return desk_->said().take(now_ns()); }

std::string ModbusPublisher::describe(const MotionWrite& write) const {
  return fmt::format("Modbus: axis {}: {} {}", axis_names_[write.axis],
                     motion_names[static_cast<std::size_t>(write.what)], write.value);
}

}  // namespace stiction::drive
