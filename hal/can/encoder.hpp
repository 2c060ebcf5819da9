// What the drive takes from an encoder on CAN (CiA 406, device profile for encoders): its first transmit PDO in the
// predefined mapping, the position value (6004h, unsigned, 4 bytes, little-endian), which comes each cycle timer
// (6200h) or with SYNC; and its emergency messages (CiA 301, 7.2.7). Frames alone.
#pragma once

#include <cstdint>
#include <optional>

#include "hal/can/frames.hpp"

namespace stiction::hal::can {

// Of encoder `node`; none: the `frame` is not its position, or does not begin with one. What a mapping of its own adds
// behind the position is left alone.
constexpr std::optional<std::uint32_t> encoder_position_of(const Frame& frame, int node) {
  if (frame.id != id_of(CobId::node_position, node) || frame.size < 4 || frame.size > 8) return {};
  std::uint32_t position = 0;
  for (std::size_t k = 4; k-- > 0;) position = position << 8 | frame.data[k];
  return position;
}

// Whether encoder `node` says that it has an error; none: the `frame` says nothing of it. An error code of 0 is the end
// of all errors.
constexpr std::optional<bool> encoder_error_of(const Frame& frame, int node) {
  if (frame.id != id_of(CobId::emergency, node) || frame.size != 8) return {};
  return frame.data[0] != 0 || frame.data[1] != 0;
}

}  // namespace stiction::hal::can
