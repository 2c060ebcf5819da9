// The process data that a motion controller and the drive exchange on CAN: PDOs with objects of CiA 402, one node an
// axis. No checksum and no counter, so that any controller can send them: identifier, length and range are what can be
// judged. Little-endian. Identifiers: identifiers.hpp; those of target speed and target torque are none of the
// predefined set, whose other PDOs are a node's.
//
//   mode           3 B  6040h controlword, 6060h mode of operation
//   target         6 B  6040h controlword, 607Ah target position
//   target speed   6 B  6040h controlword, 60FFh target velocity
//   target torque  6 B  6040h controlword, 6071h target torque, 6072h max torque
//   offsets        6 B  60B1h velocity offset, 60B2h torque offset
//   state          6 B  6041h statusword, 6064h position actual value
//                  8 B  the same and 6077h torque actual value
//   motion         8 B  606Ch velocity actual value, 60F4h following error
//   SYNC           0 B  begins a cycle
//
// Units: positions and following error in increments, velocities in 1000 increments a second, torque in thousandths of
// the current limit.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "hal/can/frames.hpp"

namespace stiction::hal::can {

enum class Pdo : std::uint8_t { mode, target, offsets, position, motion, speed, torque, position_and_torque };

struct PdoDescription {
  Pdo pdo;
  CobId use;
  std::uint8_t size;  // bytes
  bool received;      // by the drive
  int level;          // from which on it is exchanged; 0: no position is commanded without it
  bool cyclic;        // each cycle, and not in the place of a different one
  int last_level = 2;
  constexpr std::uint32_t id() const { return base_of(use); }  // plus the node
  constexpr bool exchanged_at(int wanted) const { return level <= wanted && wanted <= last_level; }
};
inline constexpr std::array<PdoDescription, 8> pdo_table{{
    {Pdo::mode, CobId::mode, 3, true, 0, false},
    {Pdo::target, CobId::target, 6, true, 0, true},
    {Pdo::offsets, CobId::offsets, 6, true, 1, true},
    {Pdo::position, CobId::state, 6, false, 0, true, 1},
    {Pdo::motion, CobId::motion, 8, false, 1, true},
    {Pdo::speed, CobId::target_speed, 6, true, 0, false},
    {Pdo::torque, CobId::target_torque, 6, true, 0, false},
    {Pdo::position_and_torque, CobId::state, 8, false, 2, true},
}};
constexpr const PdoDescription& description_of(Pdo pdo) { return pdo_table[static_cast<std::size_t>(pdo)]; }

// What a PDO to the drive asks for; the objects that its kind carries.
struct ControllerData {
  std::uint16_t controlword = 0;     // 6040h: mode, target, speed, torque
  std::int8_t mode = 0;              // 6060h: mode
  std::int32_t target = 0;           // 607Ah: target
  std::int32_t speed = 0;            // 60FFh: speed
  std::int32_t velocity_offset = 0;  // 60B1h: offsets
  std::int16_t torque_offset = 0;    // 60B2h: offsets
  std::int16_t torque = 0;           // 6071h: torque
  std::uint16_t most_torque = 0;     // 6072h: torque
};

enum class PdoVerdict : std::uint8_t { good, unknown, wrong_size };

struct PdoAddress {
  PdoVerdict verdict = PdoVerdict::unknown;
  Pdo pdo = Pdo::target;
  int node = 0;
};
// What a frame to the drive is. `node` and `pdo` also of one with a wrong size.
PdoAddress pdo_address_of(const Frame& frame);
// Of a frame that pdo_address_of() finds good.
ControllerData decode_pdo(Pdo pdo, const Frame& frame);

// Frames by their objects. `pdo`: which one; `node`: of the axis, 1 to 127; `data`: what a controller sends;
// `statusword`: of CiA 402; `position`: in position increments; `velocity`: in 1000 of them per second;
// `following_error`: in position increments; `torque`: in thousandths of the current limit.
Frame encode_pdo(Pdo pdo, int node, const ControllerData& data);  // as a controller sends it
Frame encode_position(int node, std::uint16_t statusword, std::int32_t position);
Frame encode_motion(int node, std::int32_t velocity, std::int32_t following_error);
Frame encode_position(int node, std::uint16_t statusword, std::int32_t position, std::int16_t torque);
inline constexpr Frame plain_sync{sync_id, 0, {}};

}  // namespace stiction::hal::can
