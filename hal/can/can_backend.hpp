// The axes' power stages and encoders as nodes of a CAN bus whose master is this drive (frames.hpp): SYNC at each tick,
// feedback of every node, voltages to every node.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hal/backend.hpp"
#include "hal/can/answer_check.hpp"
#include "hal/can/can_socket.hpp"
#include "hal/frame_watch.hpp"
#include "hal/tick_clock.hpp"

namespace stiction::hal::can {

struct CanBackendConfig {
  std::string interface;
  Format format = Format::fd;
  std::vector<int> nodes;               // one an axis, 1 to 127, all different
  std::vector<std::uint32_t> others{};  // identifiers that belong on this bus beside the nodes': no foreign frames
  double answer_share = 0.75;           // of the period, for which answers are waited for
};

struct BusCounts {
  std::uint64_t send_failed = 0;   // frames that the kernel did not take
  std::uint64_t unknown_id = 0;    // frames with an identifier that the drive does not use
  std::uint64_t error_frames = 0;  // of the controller
  std::uint64_t lost_in_kernel = 0;
};

class CanBackend {
 public:
  using Signals = FixedSignals;

  // `clock` gives the ticks. Throws CanError where the bus or the configuration is not as it must be.
  CanBackend(const CanBackendConfig& config, TickClock& clock);

  std::size_t axis_count() const { return nodes_.size(); }
  void begin() { clock_.restart(); }
  std::int64_t wait_for_tick();
  void read(std::span<Feedback<Signals>> feedback);
  void read_inputs(std::span<DigitalInputs<Signals>> inputs) const;
  void read_protection(std::span<ProtectionInputs<Signals>> inputs) const;
  // As the node's last answer says.
  MotorSignalSet motor_signals(std::size_t axis) const { return nodes_[axis].state.motor_signals; }
  void write(std::span<const Command<Signals>> command);
  Fault fault(std::size_t axis) const { return nodes_[axis].fault; }
  // Tells every node to switch off, once; without a loop that goes on the silence on the bus does it within 5 ms.
  void cut_power() noexcept;

  // Whether every node has answered SYNC within `ticks` ticks; to be asked before the loop starts. No voltage is sent.
  // The nodes that did not are in `silent`.
  bool find_nodes(int ticks, std::vector<int>& silent);

  const AnswerCounts& counts(std::size_t axis) const { return nodes_[axis].check.counts(); }
  BusCounts bus_counts() const;

 private:
  struct Node {
    int id;
    AnswerCheck check;
    FrameWatch watch;
    Fault fault = Fault::none;
    NodeFeedback state{};
    NodeFeedback arriving{};
  };

  void send(const Frame& frame);
  void take(const Received& received);
  void watch_bus();
  void look_for_adapter();
  bool complete() const;

  Format format_;
  TickClock& clock_;
  std::int64_t answer_ns_;
  CanSocket nodes_socket_;  // the nodes' frames, and error frames
  // All others. Not error frames: a socket whose filters must all be passed gets an error frame only where it has no
  // more than one (net/can/raw.c, raw_rcv).
  CanSocket watch_socket_;
  std::vector<Node> nodes_;
  std::uint32_t tick_ = 0;
  bool started_ = false;
  std::int64_t now_ns_ = 0;
  std::int64_t look_again_ns_ = 0;  // for an adapter, not before
  bool bus_off_ = false;
  bool bus_off_now_ = false;          // in this tick, whether or not the controller is back within it
  std::uint32_t unknown_id_now_ = 0;  // in this tick
  BusCounts bus_;
};

static_assert(WiredBackend<CanBackend> && KernelTimeBackend<CanBackend> && ProtectionBackend<CanBackend>);

}  // namespace stiction::hal::can
