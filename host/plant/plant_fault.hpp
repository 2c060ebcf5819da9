// Faults that the simulated machine makes on command: what a bus does to an answer, what lines show, what breaks in an
// axis.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "hal/simulated/faulty_backend.hpp"
#include "hal/simulated/motor_inputs_backend.hpp"

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

enum class LineFaultKind : std::uint8_t { none, tracks_together, track_noise };

using BreakPart = void (*)(hal::AxisFaults&, bool acts);
using ShowSignal = void (*)(hal::MotorSignals&, bool acts);

// Of one kind: what a CAN bus does, what digital lines do, or what breaks in the axis.
struct PlantFaultKind {
  std::string_view name;
  std::string_view text;
  FrameFaultKind frame = FrameFaultKind::none;
  LineFaultKind line = LineFaultKind::none;
  BreakPart machine = nullptr;
  ShowSignal signal = nullptr;
  bool shows_on_lines = true;  // a part that breaks, a signal
  bool shows_on_modbus = true;

  // `bus`: "can", "modbus" or "gpio".
  constexpr bool possible_on(std::string_view bus) const {
    if (frame != FrameFaultKind::none) return bus == "can";
    if (line != LineFaultKind::none) return bus == "gpio";
    return bus == "gpio" ? shows_on_lines : bus != "modbus" || shows_on_modbus;
  }
};

// A fault of a bus. `name`: of the option --fault; `frame`: what happens to frames; `text`: explanation for users.
constexpr PlantFaultKind of_frames(std::string_view name, FrameFaultKind frame, std::string_view text) {
  return {.name = name, .text = text, .frame = frame};
}
// A fault of digital lines. `name`, `text`: as above; `line`: what happens to them.
constexpr PlantFaultKind of_lines(std::string_view name, LineFaultKind line, std::string_view text) {
  return {.name = name, .text = text, .line = line};
}
// A fault of a part. `name`, `text`: as above; `part`: breaks and repairs it; `on_lines`: it shows behind GPIO lines.
constexpr PlantFaultKind of_part(std::string_view name, std::string_view text, BreakPart part, bool on_lines = true) {
  return {.name = name, .text = text, .machine = part, .shows_on_lines = on_lines};
}

// What motor and power stage tell of themselves. `name`, `text`: as above; `signal`: shows it and ends it; `on_lines`,
// `on_modbus`: it shows there.
constexpr PlantFaultKind of_signal(std::string_view name, std::string_view text, ShowSignal signal,
                                   bool on_lines = false, bool on_modbus = true) {
  return {.name = name, .text = text, .signal = signal, .shows_on_lines = on_lines, .shows_on_modbus = on_modbus};
}

// Beyond what any machine file allows.
inline constexpr double shown_high_voltage = 2000.0, shown_low_voltage = 1.0;  // V
inline constexpr double shown_heat = 200.0;                                    // degrees Celsius

inline constexpr std::array<PlantFaultKind, 27> plant_faults{{
    of_frames("frame-lost", FrameFaultKind::lost, "the answer is not sent"),
    of_frames("frame-late", FrameFaultKind::late, "the answer is sent together with that of the next tick"),
    of_frames("frame-duplicate", FrameFaultKind::duplicate, "the answer is sent twice"),
    of_frames("frame-out-of-order", FrameFaultKind::out_of_order, "an answer of two ticks before follows the answer"),
    of_frames("frame-stale", FrameFaultKind::stale,
              "an old answer with the number of this tick is on the bus before SYNC"),
    of_frames("frame-damaged", FrameFaultKind::damaged, "a bit of the answer is flipped"),
    of_frames("bus-off", FrameFaultKind::bus_off,
              "the CAN controller reports that it left the bus, then that it is back"),
    of_frames("babble", FrameFaultKind::babble, "a node sends 20 frames with an unknown identifier per tick"),
    of_lines("tracks-together", LineFaultKind::tracks_together, "both tracks of the encoder change at once"),
    of_lines("track-noise", LineFaultKind::track_noise, "20 edges in a tick, back and forth"),
    of_part("encoder-open", "no valid position; on lines: no edges", [](auto& f, bool acts) { f.encoder_open = acts; }),
    of_part("encoder-frozen", "the same position is repeated", [](auto& f, bool acts) { f.encoder_frozen = acts; }),
    of_part("encoder-jump", "50 um are added to every position",
            [](auto& f, bool acts) { f.encoder_shift = acts ? 50e-6 : 0.0; }),
    of_part(
        "encoder-bit", "bit 14 of the increment count is flipped",
        [](auto& f, bool acts) { f.flipped_bit = acts ? std::optional(14) : std::nullopt; }, false),
    of_part("motor-reversed", "the force acts against the current",
            [](auto& f, bool acts) { f.motor_reversed = acts; }),
    of_part(
        "current-offset", "5 A are added to the sensor of phase A",
        [](auto& f, bool acts) { f.current_offset[0] = acts ? 5.0 : 0.0; }, false),
    of_part("power-stage", "the power stage reports a fault and is off",
            [](auto& f, bool acts) { f.power_stage = acts; }),
    of_part("late-commands", "the power stage obeys 15 ticks late",
            [](auto& f, bool acts) { f.late_commands = acts ? 15 : 0; }),
    of_part(
        "limit-negative", "the negative limit switch is closed",
        [](auto& f, bool acts) { f.negative_switch = acts ? hal::SwitchFault::stuck_closed : hal::SwitchFault::none; }),
    of_part(
        "limit-positive", "the positive limit switch is closed",
        [](auto& f, bool acts) { f.positive_switch = acts ? hal::SwitchFault::stuck_closed : hal::SwitchFault::none; }),
    of_signal(
        "torque-off", "both channels of safe torque off are open, the stage has no torque",
        [](auto& s, bool acts) { s.torque_off_a = s.torque_off_b = acts; }, true),
    of_signal(
        "torque-off-channel", "channel A of safe torque off is open, the stage has no torque",
        [](auto& s, bool acts) { s.torque_off_a = acts; }, true),
    of_signal("dc-link-high", "the DC link shows 2000 V",
              [](auto& s, bool acts) { s.dc_link = acts ? std::optional(shown_high_voltage) : std::nullopt; }),
    of_signal("dc-link-low", "the DC link shows 1 V",
              [](auto& s, bool acts) { s.dc_link = acts ? std::optional(shown_low_voltage) : std::nullopt; }),
    of_signal("motor-hot", "the motor shows 200 degrees Celsius",
              [](auto& s, bool acts) { s.motor_temperature = acts ? std::optional(shown_heat) : std::nullopt; }),
    of_signal("stage-hot", "the power stage shows 200 degrees Celsius",
              [](auto& s, bool acts) { s.stage_temperature = acts ? std::optional(shown_heat) : std::nullopt; }),
    of_signal(
        "hall-open", "all Hall signals are low",
        [](auto& s, bool acts) { s.hall = acts ? std::optional(std::uint8_t{0}) : std::nullopt; }, true, false),
}};

struct PlantFault {
  const PlantFaultKind* kind = nullptr;
  std::size_t axis = 0;
  std::uint64_t from_tick = 0, ticks = 1;

  bool acts(std::uint64_t tick) const { return tick >= from_tick && tick - from_tick < ticks; }
};

}  // namespace stiction::host
