// An axis as a node of CANopen in the loop's thread: its state by network management, boot-up and heartbeat, the watch
// over a heartbeat of its commander (1016h), and emergency messages (CiA 301). Nothing here waits, allocates or locks.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "firmware/stictiond/modbus_registers.hpp"
#include "hal/can/network.hpp"
#include "stiction/drive/faults.hpp"
#include "stiction/drive/remote_axis.hpp"

namespace stiction::drive {

// What the loop and the server of a node's objects share of it.
struct NodeLink {
  static constexpr std::size_t kept_errors = 8;

  // Written over SDO; a reset of the communication takes them back.
  std::atomic<std::uint16_t> heartbeat_ms = 0;  // 1017h; 0: none is sent
  std::atomic<std::uint32_t> watched = 0;       // 1016h, sub-index 1: node in bits 16 to 22, ms in bits 0 to 15
  // Written by the loop.
  std::atomic<hal::can::NodeState> state = hal::can::NodeState::boot_up;
  std::atomic<std::uint32_t> resets = 0;                                // of the communication
  std::atomic<std::uint32_t> error_count = 0;                           // since the start
  std::array<std::atomic<std::uint32_t>, kept_errors> newest_errors{};  // 1003h; the k-th at k % kept_errors
};
using NodeLinks = std::array<NodeLink, most_published_axes>;

class CanopenNode {
 public:
  // `node`: 1 to 127; `link`: must outlive this.
  CanopenNode(int node, NodeLink& link) : node_(node), link_(&link) {}

  // An order of the network's master. True: the state of the node has changed. `order`: for this node or all; `axis`:
  // one that loses its commander on this bus where process data end.
  bool take(const hal::can::NetworkOrder& order, RemoteAxis& axis) {
    if (order.node != 0 && order.node != node_) return false;
    const auto before = state_;
    state_ = state_after(order.command);
    if (resets(order.command)) {
      booting_ = true;
      link_->heartbeat_ms = 0;
      link_->watched = 0;
      link_->resets.fetch_add(1);
    }
    link_->state = state_;
    if (before == hal::can::NodeState::operational && (state_ != before || booting_))
      axis.disconnect(CommandSource::can);
    return state_ != before || booting_;
  }

  // A heartbeat of a different node. `node`: which; `now_ns`: time of the tick.
  void hear(int node, std::int64_t now_ns) {
    if (node != watched_node(link_->watched)) return;
    heard_ns_ = now_ns;
    heard_ = true;
  }

  // Once a cycle, before the tick: a commander whose heartbeat has ended is lost. The watch begins with the first
  // heartbeat, as the standard has it. `now_ns`: time of the tick; `axis`: that it commands.
  void watch(std::int64_t now_ns, RemoteAxis& axis) {
    const std::uint32_t watched = link_->watched;
    if (watched != watched_) heard_ = false;
    watched_ = watched;
    const std::int64_t most_ns = std::int64_t{watched & 0xffffu} * 1'000'000;
    if (!heard_ || most_ns == 0 || now_ns - heard_ns_ <= most_ns) return;
    heard_ = false;
    axis.disconnect(CommandSource::can);
  }

  bool exchanges() const { return state_ == hal::can::NodeState::operational; }  // process data
  hal::can::NodeState state() const { return state_; }

  // Once a cycle, behind the tick: `send` is called with each frame that is due. `now_ns`: time of the tick; `fault`:
  // of the axis.
  template <class Send>
  void step(std::int64_t now_ns, Fault fault, Send send) {
    using hal::can::NodeState;
    if (booting_) {
      booting_ = false;
      send(hal::can::encode_heartbeat(node_, NodeState::boot_up));
      link_->state = state_;
      sent_ns_ = now_ns;
    }
    keep(fault);
    if (fault != said_ && state_ != NodeState::stopped) {
      said_ = fault;
      send(hal::can::encode_emergency(node_, error_code_of(fault), static_cast<std::uint8_t>(fault)));
    }
    const std::int64_t period_ns = std::int64_t{link_->heartbeat_ms.load()} * 1'000'000;
    if (period_ns == 0) {
      sent_ns_ = now_ns;
    } else if (now_ns - sent_ns_ >= period_ns) {
      // From when it was due, or it would come a cycle late each time.
      sent_ns_ = now_ns - sent_ns_ < 2 * period_ns ? sent_ns_ + period_ns : now_ns;
      send(hal::can::encode_heartbeat(node_, state_));
    }
  }

 private:
  static int watched_node(std::uint32_t watched) { return static_cast<int>((watched >> 16) & 0x7fu); }

  void keep(Fault fault) {
    if (fault == kept_) return;
    kept_ = fault;
    if (fault == Fault::none) return;
    const std::uint32_t count = link_->error_count;
    link_->newest_errors[count % NodeLink::kept_errors] =
        std::uint32_t{error_code_of(fault)} | static_cast<std::uint32_t>(fault) << 16;
    link_->error_count = count + 1;
  }

  int node_;
  NodeLink* link_;
  hal::can::NodeState state_ = hal::can::NodeState::operational;
  bool booting_ = true;
  std::int64_t sent_ns_ = 0;  // the last heartbeat
  Fault said_ = Fault::none, kept_ = Fault::none;
  std::uint32_t watched_ = 0;
  bool heard_ = false;
  std::int64_t heard_ns_ = 0;
};

}  // namespace stiction::drive
