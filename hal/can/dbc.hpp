// The frames of frames.hpp and process_data.hpp for other tools, as a DBC file (Vector's format; CAN FD by the
// attribute VFrameFormat).
#pragma once

#include <string>
#include <vector>

#include "hal/can/frames.hpp"

namespace stiction::hal::can {

struct DbcAxis {
  std::string name;
  int node;
};

struct DbcBus {
  Format format = Format::classical;
  std::vector<DbcAxis> axes{};  // empty: there is no such bus
  int level = 2;                // of the frames with a motion controller (process_data.hpp)
};

// `nodes`: of the axes' power stages and encoders. `server`: what a motion controller sends and gets, with positions in
// units of `increment` (m); its SYNC is described where it is the only one.
std::string dbc_text(const DbcBus& nodes, const DbcBus& server = {}, double increment = 1e-9);

}  // namespace stiction::hal::can
