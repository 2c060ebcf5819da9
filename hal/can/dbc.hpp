// The frames of frames.hpp for other tools, as a DBC file (Vector's format; CAN FD by the attribute VFrameFormat).
#pragma once

#include <span>
#include <string>

#include "hal/can/frames.hpp"

namespace stiction::hal::can {

struct DbcAxis {
  std::string name;
  int node;
};

std::string dbc_text(Format format, std::span<const DbcAxis> axes);

}  // namespace stiction::hal::can
