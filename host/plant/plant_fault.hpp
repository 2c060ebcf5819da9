// Faults that the simulated machine makes on command: what a bus does to an answer, what breaks in an axis.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "hal/simulated/faulty_backend.hpp"

namespace stiction::host {

enum class FrameFaultKind : std::uint8_t {
  none,
  lost,
  late,
  duplicate,
  out_of_order,
  stale,
  damaged,
  bus_off,
  babble,
};

struct PlantFaultKind {
  std::string_view name;
  std::string_view text;
  FrameFaultKind frame = FrameFaultKind::none;
  void (*machine)(hal::AxisFaults&, bool acts) = nullptr;  // of the axis; exclusive of the frame
};

inline constexpr std::array<PlantFaultKind, 18> plant_faults{{
    {"frame-lost", "the answer is not sent", FrameFaultKind::lost},
    {"frame-late", "the answer comes with that of the next tick", FrameFaultKind::late},
    {"frame-duplicate", "the answer is sent twice", FrameFaultKind::duplicate},
    {"frame-out-of-order", "an answer of two ticks ago follows the answer", FrameFaultKind::out_of_order},
    {"frame-stale", "an old answer with this tick's number is on the bus before SYNC", FrameFaultKind::stale},
    {"frame-damaged", "a bit of the answer is flipped", FrameFaultKind::damaged},
    {"bus-off", "the controller says that it left the bus", FrameFaultKind::bus_off},
    {"babble", "a node sends 20 frames of nobody a tick", FrameFaultKind::babble},
    {"encoder-open", "no valid position", {}, [](auto& f, bool acts) { f.encoder_open = acts; }},
    {"encoder-frozen", "the same position again and again", {}, [](auto& f, bool acts) { f.encoder_frozen = acts; }},
    {"encoder-jump", "50 um on every position", {}, [](auto& f, bool acts) { f.encoder_shift = acts ? 50e-6 : 0.0; }},
    {"encoder-bit",
     "bit 14 of the count of increments is flipped",
     {},
     [](auto& f, bool acts) { f.flipped_bit = acts ? std::optional(14) : std::nullopt; }},
    {"motor-reversed", "force against the current", {}, [](auto& f, bool acts) { f.motor_reversed = acts; }},
    {"current-offset",
     "5 A on the sensor of phase A",
     {},
     [](auto& f, bool acts) { f.current_offset[0] = acts ? 5.0 : 0.0; }},
    {"power-stage", "it reports a fault and is off", {}, [](auto& f, bool acts) { f.power_stage = acts; }},
    {"late-commands",
     "the power stage obeys 15 ticks late",
     {},
     [](auto& f, bool acts) { f.late_commands = acts ? 15 : 0; }},
    {"limit-negative",
     "the negative limit switch is closed",
     {},
     [](auto& f, bool acts) { f.negative_switch = acts ? hal::SwitchFault::stuck_closed : hal::SwitchFault::none; }},
    {"limit-positive",
     "the positive limit switch is closed",
     {},
     [](auto& f, bool acts) { f.positive_switch = acts ? hal::SwitchFault::stuck_closed : hal::SwitchFault::none; }},
}};

struct PlantFault {
  const PlantFaultKind* kind = nullptr;
  std::size_t axis = 0;
  std::uint64_t from_tick = 0, ticks = 1;

  bool acts(std::uint64_t tick) const { return tick >= from_tick && tick - from_tick < ticks; }
};

}  // namespace stiction::host
