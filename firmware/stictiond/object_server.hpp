// Serves the objects of the axes' nodes over SDO, beside the loop: what is read comes from the state that the loop has
// handed over, a command goes to the loop by its mailbox, a parameter to the desk of all servers, with its window and
// its limits. In one thread (object_thread.hpp), or in a test's.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "firmware/stictiond/can_server.hpp"
#include "firmware/stictiond/loop_exchange.hpp"
#include "firmware/stictiond/objects.hpp"
#include "firmware/stictiond/parameter_desk.hpp"
#include "hal/can/sdo.hpp"

namespace stiction::drive {

class ObjectServer {
 public:
  // Whether the loop makes no progress: what it published last is then shown as a fault and no command is taken.
  using Stale = std::function<bool()>;

  // `configuration`: of the drive; `config`: of its bus; `desk`: for parameters, also of other servers; `links`: what
  // the loop shares of the nodes; `stale`: null for a loop in its own time; `moves_itself`: the programme moves the
  // axes, and clients can only stop them. `configuration` must outlive this.
  ObjectServer(const DriveConfiguration& configuration, const CanServerConfig& config,
               std::shared_ptr<ParameterDesk> desk, std::shared_ptr<NodeLinks> links, Stale stale = {},
               bool moves_itself = false);
  ~ObjectServer();
  ObjectServer(const ObjectServer&) = delete;
  ObjectServer& operator=(const ObjectServer&) = delete;

  // The loop's side.
  LoopExchange& loop() { return loop_; }
  bool motion_allowed() const { return config_.motion_allowed; }
  // `signals`, `now_ns`, `fault`, `status`: as of LoopExchange.
  template <class S, class Status>
  void publish(std::span<const AxisSignals<S>> signals, std::int64_t now_ns, Fault fault, Status status) {
    loop_.publish(signals, now_ns, fault, status);
  }

  // The server's side. The answer to a frame; none: it is of no node of the drive, or an answer is put off. `request`:
  // as received; `now_ns`: of a clock that does not go back.
  std::optional<hal::can::Frame> answer(const hal::can::Frame& request, std::int64_t now_ns);
  // Now and then: `send` is called with answers that were put off and with ends of transfers that were left. `now_ns`:
  // as above.
  void poll(std::int64_t now_ns, const std::function<void(const hal::can::Frame&)>& send);

 private:
  class Node;

  const PublishedState& state();

  const DriveConfiguration& configuration_;
  CanServerConfig config_;
  std::shared_ptr<ParameterDesk> desk_;
  std::shared_ptr<NodeLinks> links_;
  Stale stale_;
  bool moves_itself_;
  LoopExchange loop_;
  PublishedState state_;
  std::vector<double> values_;  // of the registers
  std::vector<std::unique_ptr<Node>> nodes_;
};

}  // namespace stiction::drive
