// Every identifier of 11 bits that the drive sends or takes on CAN, in one table: those of CANopen's predefined
// connection set (CiA 301, 7.3.5), and what the drive's own frames have beside it. Two axes' nodes (frames.hpp) and a
// motion controller (process_data.hpp, sdo.hpp, network.hpp) may be on one bus, so that no row may touch a different
// one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace stiction::hal::can {

inline constexpr int highest_node = 127;

enum class CobId : std::uint8_t {
  network,
  sync,
  emergency,
  target_speed,
  node_position,
  node_command,
  node_current,
  mode,
  state,
  target,
  motion,
  offsets,
  sdo_answer,
  sdo_request,
  target_torque,
  heartbeat,
};

struct Identifier {
  CobId use;
  std::uint32_t base;
  bool of_node;  // plus the node, 1 to 127
  bool to_drive, of_drive;
  const char* text;
};

// In the order of CobId, which is that of their priority.
inline constexpr std::array<Identifier, 16> identifier_table{{
    {CobId::network, 0x000, false, true, false, "NMT: state of the nodes"},
    {CobId::sync, 0x080, false, true, true, "SYNC: begins a cycle"},
    {CobId::emergency, 0x080, true, false, true, "EMCY: a fault, or its end"},
    {CobId::target_speed, 0x100, true, true, false, "controlword, target velocity"},
    {CobId::node_position, 0x180, true, true, false, "position of a power stage's encoder, or of a master's (CiA 406)"},
    {CobId::node_command, 0x200, true, false, true, "voltages of a power stage"},
    {CobId::node_current, 0x280, true, true, false, "currents of a power stage"},
    {CobId::mode, 0x300, true, true, false, "controlword, mode of operation"},
    {CobId::state, 0x380, true, false, true, "statusword, actual position, actual torque"},
    {CobId::target, 0x400, true, true, false, "controlword, target position"},
    {CobId::motion, 0x480, true, false, true, "actual velocity, following error"},
    {CobId::offsets, 0x500, true, true, false, "velocity offset, torque offset"},
    {CobId::sdo_answer, 0x580, true, false, true, "SDO: answer of the drive"},
    {CobId::sdo_request, 0x600, true, true, false, "SDO: request to the drive"},
    {CobId::target_torque, 0x680, true, true, false, "controlword, target torque, max torque"},
    {CobId::heartbeat, 0x700, true, true, true, "boot-up and heartbeat"},
}};

constexpr std::uint32_t base_of(CobId use) { return identifier_table[static_cast<std::size_t>(use)].base; }
constexpr std::uint32_t id_of(CobId use, int node) { return base_of(use) + static_cast<std::uint32_t>(node); }

constexpr bool identifiers_are_in_order() {
  for (std::size_t i = 0; i < identifier_table.size(); ++i)
    if (identifier_table[i].use != static_cast<CobId>(i)) return false;
  return true;
}
// Whether no identifier has two meanings.
constexpr bool identifiers_are_apart() {
  const auto first = [](const Identifier& row) { return row.base + (row.of_node ? 1u : 0u); };
  const auto last = [](const Identifier& row) { return row.base + (row.of_node ? unsigned{highest_node} : 0u); };
  for (const auto& a : identifier_table)
    for (const auto& b : identifier_table)
      if (a.use != b.use && first(a) <= last(b) && first(b) <= last(a)) return false;
  return true;
}
static_assert(identifiers_are_in_order() && identifiers_are_apart());

}  // namespace stiction::hal::can
