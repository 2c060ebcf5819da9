// Faults of frames that the simulated nodes make on command: what a bus does to an answer.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace stiction::host {

enum class FrameFaultKind : std::uint8_t {
  lost,
  late,
  duplicate,
  out_of_order,
  stale,
  damaged,
  bus_off,
  babble,
};

struct FrameFaultName {
  FrameFaultKind kind;
  std::string_view name;
  std::string_view text;
};
inline constexpr std::array<FrameFaultName, 8> frame_faults{{
    {FrameFaultKind::lost, "frame-lost", "the answer is not sent"},
    {FrameFaultKind::late, "frame-late", "the answer comes with that of the next tick"},
    {FrameFaultKind::duplicate, "frame-duplicate", "the answer is sent twice"},
    {FrameFaultKind::out_of_order, "frame-out-of-order", "an answer of two ticks ago follows the answer"},
    {FrameFaultKind::stale, "frame-stale", "the answer of this tick is on the bus before SYNC, with old data"},
    {FrameFaultKind::damaged, "frame-damaged", "a bit of the answer is flipped"},
    {FrameFaultKind::bus_off, "bus-off", "the controller says that it left the bus"},
    {FrameFaultKind::babble, "babble", "a node sends 20 frames of nobody a tick"},
}};

struct FrameFault {
  FrameFaultKind kind = FrameFaultKind::lost;
  std::size_t axis = 0;
  std::uint64_t from_tick = 0, ticks = 1;

  bool acts(std::uint64_t tick) const { return tick >= from_tick && tick - from_tick < ticks; }
};

}  // namespace stiction::host
