#include "host/plant/can_nodes.hpp"

#include <linux/can.h>
#include <linux/can/error.h>

#include <algorithm>
#include <array>
#include <ctime>

namespace stiction::host {
namespace {

using hal::can::Frame;
using hal::can::Kind;

std::vector<hal::can::Filter> filters_of(const CanNodesConfig& config) {
  std::vector<hal::can::Filter> filters{{hal::can::sync_id, CAN_SFF_MASK}};
  for (const int node : config.nodes)
    filters.push_back({hal::can::command_id + static_cast<std::uint32_t>(node), CAN_SFF_MASK});
  return filters;
}

std::int64_t monotonic_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000 + now.tv_nsec;
}

// More than this is not a tick that the drive missed but another drive, or the same one started again.
constexpr std::uint32_t most_ticks_missed = 16000;

}  // namespace

CanNodes::CanNodes(const CanNodesConfig& config, PlantUnderBus plant, const FaultSchedule& faults)
    : config_(config),
      plant_(std::move(plant)),
      faults_(faults),
      socket_(config.interface, config.format, filters_of(config), false),
      received_(config.nodes.size()),
      acting_(config.nodes.size()),
      command_tick_(config.nodes.size()),
      state_(config.nodes.size()),
      held_(config.nodes.size()),
      feedback_(config.nodes.size()),
      inputs_(config.nodes.size()),
      protection_(config.nodes.size()) {}

void CanNodes::serve(const std::function<bool()>& stop) {
  hal::can::Received received;
  while (!stop()) {
    if (!socket_.receive(received, monotonic_ns() + silence_ns)) {
      on_silence();
      socket_.find_again();
      continue;
    }
    const auto address = hal::can::address_of(received.frame, config_.format);
    std::uint32_t number = 0;
    if (address.kind == Kind::sync && hal::can::decode_sync(received.frame, number)) on_sync(number);
    if (address.kind == Kind::command) on_command(received.frame, address.node);
  }
}

void CanNodes::on_sync(std::uint32_t number) {
  const std::uint32_t passed = number - number_;
  if (!synced_ || passed > most_ticks_missed) {
    // The first tick is the start; the plant has not moved since.
    if (synced_) advance();
    synced_ = true;
  } else {
    for (std::uint32_t i = 0; i < passed; ++i) advance();
  }
  number_ = number;
  answer(number);
}

void CanNodes::advance() {
  for (std::size_t i = 0; i < acting_.size(); ++i) {
    const bool watched = tick_ - command_tick_[i] < commands_missed_allowed;
    acting_[i] = watched ? received_[i] : Command<FixedSignals>{};
  }
  plant_.advance(acting_);
  ++tick_;
}

// Without SYNC there is no drive: the stages are off and time goes on.
void CanNodes::on_silence() {
  if (!synced_) return;
  for (auto& command : received_) command = {};
  for (int i = 0; i < silent_ticks; ++i) advance();
}

void CanNodes::on_command(const Frame& frame, int node) {
  const auto place = std::find(config_.nodes.begin(), config_.nodes.end(), node);
  if (place == config_.nodes.end()) return;
  const auto axis = static_cast<std::size_t>(place - config_.nodes.begin());
  std::uint32_t counter = 0;
  Command<FixedSignals> command;
  if (!hal::can::decode_command(config_.format, frame, counter, command)) {
    ++damaged_;
    return;
  }
  if (counter != (number_ & hal::can::properties(config_.format).counter_mask)) return;
  received_[axis] = command;
  command_tick_[axis] = tick_;
}

bool CanNodes::faulty(FrameFaultKind kind, std::size_t axis, std::uint64_t tick) const {
  return faults_.acts(&PlantFaultKind::frame, kind, axis, tick);
}

void CanNodes::answer(std::uint32_t number) {
  plant_.sample(feedback_, inputs_);
  plant_.sample_protection(protection_);
  for (std::size_t i = 0; i < state_.size(); ++i) {
    state_[i] = {feedback_[i], inputs_[i], protection_[i], plant_.motor_signals(i)};
    state_[i].feedback.position_time_ns = 0;  // sampled at SYNC
    send_feedback(i, number);
    held_[i] = state_[i];
  }
}

void CanNodes::send_feedback(std::size_t axis, std::uint32_t number) {
  using enum FrameFaultKind;
  const auto send = [&](const hal::can::NodeFeedback& state, std::uint32_t tick, bool damage = false) {
    std::array<Frame, 2> frames;
    const std::size_t count =
        hal::can::encode_feedback(config_.format, config_.nodes[axis], tick, state, std::span<Frame, 2>(frames));
    for (std::size_t i = 0; i < count; ++i) {
      if (damage) frames[i].data[0] ^= 0x10;
      socket_.send(frames[i]);
    }
  };
  // What was kept back in the tick before comes first.
  if (tick_ > 0 && faulty(late, axis, tick_ - 1)) send(held_[axis], number - 1);
  if (!faulty(lost, axis, tick_) && !faulty(late, axis, tick_) && !faulty(stale, axis, tick_))
    send(state_[axis], number, faulty(damaged, axis, tick_));
  if (faulty(duplicate, axis, tick_)) send(state_[axis], number);
  if (faulty(out_of_order, axis, tick_)) send(held_[axis], number - 2);
  disturb_bus(axis);
  // On the bus now, with the next tick's number: before its SYNC.
  if (faulty(stale, axis, tick_ + 1)) send(state_[axis], number + 1);
}

void CanNodes::disturb_bus(std::size_t axis) {
  using enum FrameFaultKind;
  if (faulty(bus_off, axis, tick_)) socket_.send({CAN_ERR_FLAG | CAN_ERR_BUSOFF, 8, {}});
  if (tick_ > 0 && faulty(bus_off, axis, tick_ - 1) && !faulty(bus_off, axis, tick_))
    socket_.send({CAN_ERR_FLAG | CAN_ERR_RESTARTED, 8, {}});
  if (faulty(babble, axis, tick_))
    for (int i = 0; i < 20; ++i) socket_.send({0x7F0, 8, {}});
}

}  // namespace stiction::host
