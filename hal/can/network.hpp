// What a node of CANopen says of itself and is told beside process data: network management (NMT) with boot-up and
// heartbeat, and emergency messages (CiA 301, 7.2.8.3 and 7.2.7). Frames alone; who acts upon them is
// firmware/stictiond/can_server.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "hal/can/frames.hpp"

namespace stiction::hal::can {

// As heartbeats have it.
enum class NodeState : std::uint8_t { boot_up = 0, stopped = 4, operational = 5, pre_operational = 127 };
constexpr const char* name_of(NodeState state) {
  return state == NodeState::operational       ? "operational"
         : state == NodeState::stopped         ? "stopped"
         : state == NodeState::pre_operational ? "pre-operational"
                                               : "boot-up";
}

enum class NetworkCommand : std::uint8_t {
  start = 1,
  stop = 2,
  enter_pre_operational = 128,
  reset_node = 129,
  reset_communication = 130,
};

struct NetworkOrder {
  NetworkCommand command = NetworkCommand::start;
  int node = 0;  // 0: all
};

// None: the frame is no order of the network's master, or one that the standard does not have.
constexpr std::optional<NetworkOrder> network_order_of(const Frame& frame) {
  if (frame.id != base_of(CobId::network) || frame.size != 2 || frame.data[1] > highest_node) return {};
  for (const auto command : {NetworkCommand::start, NetworkCommand::stop, NetworkCommand::enter_pre_operational,
                             NetworkCommand::reset_node, NetworkCommand::reset_communication})
    if (frame.data[0] == static_cast<std::uint8_t>(command)) return NetworkOrder{command, frame.data[1]};
  return {};
}

// The state of `node` that an order leads to. A node that is reset says its boot-up and starts by itself.
constexpr NodeState state_after(NetworkCommand command) {
  return command == NetworkCommand::stop                    ? NodeState::stopped
         : command == NetworkCommand::enter_pre_operational ? NodeState::pre_operational
                                                            : NodeState::operational;
}
constexpr bool resets(NetworkCommand command) {
  return command == NetworkCommand::reset_node || command == NetworkCommand::reset_communication;
}

// Boot-up, or a heartbeat.
constexpr Frame encode_heartbeat(int node, NodeState state) {
  Frame frame{id_of(CobId::heartbeat, node), 1, {}};
  frame.data[0] = static_cast<std::uint8_t>(state);
  return frame;
}

// 1001h of an error code: bit 0 with every error, and the bit of the code's class (CiA 301, 7.5.2.2).
constexpr std::uint8_t error_register_of(std::uint16_t code) {
  if (code == 0) return 0;
  struct ClassBit {
    std::uint16_t first, last;
    std::uint8_t bit;
  };
  constexpr std::array<ClassBit, 6> classes{{{0x2000, 0x2fff, 1},
                                             {0x3000, 0x3fff, 2},
                                             {0x4000, 0x4fff, 3},
                                             {0x8100, 0x81ff, 4},
                                             {0x8200, 0x8fff, 5},
                                             {0xff00, 0xffff, 7}}};
  unsigned bits = 1;
  for (const auto& row : classes)
    if (row.first <= code && code <= row.last) bits |= 1u << row.bit;
  return static_cast<std::uint8_t>(bits);
}

// `node`: 1 to 127; `code`: as of 603Fh, 0: the error is over; `own`: the first of the manufacturer's bytes, the number
// of the fault.
constexpr Frame encode_emergency(int node, std::uint16_t code, std::uint8_t own) {
  Frame frame{id_of(CobId::emergency, node), 8, {}};
  frame.data[0] = static_cast<std::uint8_t>(code);
  frame.data[1] = static_cast<std::uint8_t>(code >> 8);
  frame.data[2] = error_register_of(code);
  frame.data[3] = own;
  return frame;
}

}  // namespace stiction::hal::can
