// The drive as a node of a motion controller's CAN bus, one an axis (hal/can/process_data.hpp): takes what the
// controller sends when a cycle begins, and answers with SYNC, states and positions. In the loop's thread: nothing here
// waits, allocates or locks; the work of a cycle is bounded.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "firmware/stictiond/canopen_node.hpp"
#include "firmware/stictiond/log_ring.hpp"
#include "hal/can/can_socket.hpp"
#include "hal/can/process_data.hpp"
#include "stiction/drive/remote_axis.hpp"

namespace stiction::drive {

struct CanServerConfig {
  std::string interface;
  hal::can::Format format = hal::can::Format::classical;
  std::vector<int> nodes;             // one an axis, all different
  std::vector<double> current_limit;  // A, of each axis
  double increment = 1e-9;            // m
  std::uint32_t cycle_ticks = 1;      // slow ticks from one cycle to the next
  int frames = 1;                     // level of the frames that are exchanged (process_data.hpp)
  bool motion_allowed = false;
  int heartbeat_node = 0;     // of the controller; 0: none
  bool sends_sync = true;     // false: another one does on this bus
  bool follows_sync = false;  // of the controller
};

struct CanServerCounts {
  std::uint64_t taken = 0;       // frames that were taken
  std::uint64_t wrong_size = 0;  // of an axis' identifiers with another length
  // Because motion is not allowed, the mode is not there, a different one commands, or the node is not operational.
  std::uint64_t refused = 0;
};

// What the controller sees of an axis.
struct ShownAxis {
  std::uint16_t statusword = 0;
  double position = 0.0, velocity = 0.0, following_error = 0.0;  // m, m/s, m
  double current = 0.0;                                          // A, that makes the force
  Fault fault = Fault::none;
};

// What the controller's frames ask of the axes, frame by frame; without a socket.
class ControllerFrames {
 public:
  ControllerFrames(const CanServerConfig& config, LogRing& log);

  // Any frame; those that are of no axis are left alone. `now_ns`: time of the tick, for the log; `axes`: those that
  // the frames command, in the order of the configuration.
  void take(std::int64_t now_ns, const hal::can::Frame& frame, std::span<RemoteAxis> axes);

  // Behind all frames of a cycle: commanders whose heartbeat has ended. `now_ns`, `axes`: as above.
  void begin_cycle(std::int64_t now_ns, std::span<RemoteAxis> axes);
  CanopenNode& node(std::size_t axis) { return nodes_[axis].canopen; }
  // What the server of the nodes' objects shares with the loop.
  std::shared_ptr<NodeLinks> links() const { return links_; }

  const CanServerConfig& config() const { return config_; }
  const CanServerCounts& counts() const { return counts_; }

 private:
  struct Node {
    CanopenNode canopen;
    std::uint16_t refused_word = 0;  // the last one that was said to be refused
    std::int64_t state_said_ns = INT64_MIN;
    std::int64_t said_ns = INT64_MIN;  // a wrong size
    std::int64_t owned_said_ns = INT64_MIN;
  };

  void say_refused(std::int64_t now_ns, std::size_t axis, std::uint16_t controlword);
  void say_owned(std::int64_t now_ns, std::size_t axis, std::uint16_t controlword, const RemoteAxis& remote);
  bool take_heartbeat(std::int64_t now_ns, const hal::can::Frame& frame, std::span<RemoteAxis> axes);
  void take_order(std::int64_t now_ns, const hal::can::NetworkOrder& order, std::span<RemoteAxis> axes);
  void ask(std::int64_t now_ns, std::size_t axis, hal::can::Pdo pdo, const hal::can::ControllerData& data,
           RemoteAxis& remote);
  void ask_offsets(std::size_t axis, const hal::can::ControllerData& data, RemoteAxis& remote) const;

  CanServerConfig config_;
  LogRing& log_;
  std::shared_ptr<NodeLinks> links_ = std::make_shared<NodeLinks>();
  std::vector<Node> nodes_;
  CanServerCounts counts_;
};

class CanServer {
 public:
  static constexpr std::uint32_t most_taken = 64;  // frames in a cycle: a babbling controller does not hold the loop

  // Throws hal::can::CanError where the bus is not as it must be.
  CanServer(const CanServerConfig& config, LogRing& log);

  // In each slow tick, before it. True: a cycle began, and `axes` have what came for it.
  bool receive(std::int64_t now_ns, std::span<RemoteAxis> axes);
  // Once behind each true of receive().
  void send(std::span<const ShownAxis> axes);

  // How old the controller's SYNC was when the last cycle began, ns; none came, or it is not followed: nothing.
  std::optional<std::int64_t> sync_age_ns() const { return sync_age_ns_; }
  const CanServerCounts& counts() const { return frames_.counts(); }
  bool motion_allowed() const { return frames_.config().motion_allowed; }
  std::shared_ptr<NodeLinks> links() const { return frames_.links(); }
  std::uint64_t send_failed() const { return send_failed_; }  // frames that the kernel did not take

 private:
  void send(const hal::can::Frame& frame);
  void send_classical(const hal::can::Frame& frame);

  ControllerFrames frames_;
  hal::can::CanSocket socket_;
  std::uint32_t slow_ticks_ = 0;
  std::int64_t now_ns_ = 0;                 // of the last cycle
  std::int64_t look_again_ns_ = INT64_MIN;  // for an adapter, not before
  std::uint64_t send_failed_ = 0;
  std::optional<std::int64_t> sync_age_ns_;
};

}  // namespace stiction::drive
