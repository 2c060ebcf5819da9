// The nodes of a machine's axes on a CAN bus: the other end of hal/can. They live by the drive's SYNC: its tick number
// moves the plant on, so that a run repeats to the bit whatever the speed of the machine that runs it.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "hal/backend.hpp"
#include "hal/can/can_socket.hpp"
#include "host/plant/fault_schedule.hpp"
#include "host/plant/plant_under_bus.hpp"

namespace stiction::host {

struct CanNodesConfig {
  std::string interface;
  hal::can::Format format = hal::can::Format::fd;
  std::vector<int> nodes;
};

class CanNodes {
 public:
  // A node takes its power stage off when this many SYNCs brought no command, or none came for this long.
  static constexpr std::uint64_t commands_missed_allowed = 3;
  static constexpr std::int64_t silence_ns = 5'000'000;
  static constexpr int silent_ticks = 80;  // by which the plant moves on in that time

  // `faults` must outlive this. Throws hal::can::CanError. `config`: interface, format and nodes; `plant`: the machine
  // behind them.
  CanNodes(const CanNodesConfig& config, PlantUnderBus plant, const FaultSchedule& faults);

  // Serves until `stop` is true; it is asked at least every silence_ns.
  void serve(const std::function<bool()>& stop);

  std::uint64_t ticks() const { return tick_; }  // of the plant, since the start
  std::span<const Command<FixedSignals>> commands() const { return acting_; }
  std::uint64_t damaged_commands() const { return damaged_; }

 private:
  void on_sync(std::uint32_t number);
  void on_command(const hal::can::Frame& frame, int node);
  void on_silence();
  void advance();
  void answer(std::uint32_t number);
  void send_feedback(std::size_t axis, std::uint32_t number);
  bool faulty(FrameFaultKind kind, std::size_t axis, std::uint64_t tick) const;
  void disturb_bus(std::size_t axis);

  CanNodesConfig config_;
  PlantUnderBus plant_;
  const FaultSchedule& faults_;
  hal::can::CanSocket socket_;
  std::vector<Command<FixedSignals>> received_, acting_;
  std::vector<std::uint64_t> command_tick_;  // of the plant, at which the last valid command came
  std::vector<hal::can::NodeFeedback> state_;
  std::vector<hal::can::NodeFeedback> held_;  // answers kept back, to be late or old
  std::vector<Feedback<FixedSignals>> feedback_;
  std::vector<DigitalInputs<FixedSignals>> inputs_;
  std::vector<ProtectionInputs<FixedSignals>> protection_;
  bool synced_ = false;
  std::uint32_t number_ = 0;  // of the last SYNC
  std::uint64_t tick_ = 0;
  std::uint64_t damaged_ = 0;
};

}  // namespace stiction::host
