// The frames between the drive and the nodes of its axes, one power stage with encoder a node. The drive is the master:
// at each tick it sends SYNC with the tick's number, every node answers with what it sampled at that SYNC, and the
// drive answers that with voltages for the same tick. stiction.dbc describes the same frames to other tools.
//
// Two formats: CAN FD carries the control's own integers, so that nothing is lost; classical frames of eight bytes
// carry rounded ones. In both every cyclic frame has the low bits of its tick as counter, and a checksum over
// identifier, data and counter, so that neither another node's frame nor an old one can pass.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/can/identifiers.hpp"
#include "stiction/drive/exchange.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::hal::can {

enum class Format : std::uint8_t { classical, fd };

struct Frame {
  std::uint32_t id = 0;
  std::uint8_t size = 0;  // bytes of data: 0 to 8, in CAN FD also 12, 16, 20, 24, 32, 48 and 64
  std::array<std::uint8_t, 64> data{};
};

// Plus the node, but for SYNC.
inline constexpr std::uint32_t sync_id = base_of(CobId::sync);
inline constexpr std::uint32_t position_id = base_of(CobId::node_position);  // in CAN FD the whole feedback
inline constexpr std::uint32_t command_id = base_of(CobId::node_command);
inline constexpr std::uint32_t current_id = base_of(CobId::node_current);  // classical only

// What a node says in one tick.
struct NodeFeedback {
  Feedback<FixedSignals> feedback;  // position_time_ns: minus the sample's age at SYNC
  DigitalInputs<FixedSignals> inputs;
  ProtectionInputs<FixedSignals> protection;
  MotorSignalSet motor_signals;  // that the node has; classical frames carry safe torque off alone
};

struct FormatProperties {
  const char* name;
  std::size_t feedback_frames;
  std::uint32_t counter_mask;
  std::array<std::uint8_t, 4> sizes;  // bytes of SYNC, command and the feedback frames; 0: there is none
};
constexpr FormatProperties properties(Format format) {
  return format == Format::fd ? FormatProperties{"CAN FD", 1, 0xFF, {8, 16, 48, 0}}
                              : FormatProperties{"classical CAN", 2, 0x0F, {8, 8, 8, 8}};
}

enum class Kind : std::uint8_t { unknown, sync, command, position, current };

// What the identifier says; node 0 for SYNC. Another size than the format's makes the frame unknown.
struct Address {
  Kind kind = Kind::unknown;
  int node = 0;
};
Address address_of(const Frame& frame, Format format);

Frame encode_sync(std::uint32_t tick);
// `format`: of the bus; `node`: 1 to 127; `tick`: whose low bits are the counter; `command`: voltages and enable.
Frame encode_command(Format format, int node, std::uint32_t tick, const Command<FixedSignals>& command);
// Fills as many frames as the format has for feedback and returns their number. `node`: 1 to 127; `tick`: of the SYNC
// that it answers; `state`: sampled at that SYNC.
std::size_t encode_feedback(Format format, int node, std::uint32_t tick, const NodeFeedback& state,
                            std::span<Frame, 2> frames);

// False when the checksum is wrong; nothing is written then.
bool decode_sync(const Frame& frame, std::uint32_t& tick);
// `counter`: the low bits of the tick, as many as the format's mask has. `frame`: a command by its address; `command`:
// is written. False as for decode_sync().
bool decode_command(Format format, const Frame& frame, std::uint32_t& counter, Command<FixedSignals>& command);
// One of the feedback frames, `kind` as its address says: writes the part of the state that it carries. `format`: of
// the bus; `frame`: received; `counter`: as above.
bool decode_feedback(Format format, Kind kind, const Frame& frame, std::uint32_t& counter, NodeFeedback& state);

}  // namespace stiction::hal::can
