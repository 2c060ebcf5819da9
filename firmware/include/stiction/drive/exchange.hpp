// What crosses the borders of an axis each tick: set-point in, feedback in, command out.
#pragma once

#include <array>
#include <cstdint>

#include "stiction/number/choice.hpp"

namespace stiction {

template <class S>
struct SetPoint {
  typename S::Position position{};
  typename S::Velocity velocity{};
  typename S::Acceleration acceleration{};
  Each<S, bool> valid{true};  // false: the source had a value that is not a number or that the formats cannot hold
  typename S::Current injection{};  // a test signal added to the set current
  bool by_current = false;          // the set current is `injection` alone; position and speed are those that are shown
  bool limits_current = false;      // the set current is held to most_current in place of the axis' own limit
  typename S::Current most_current{};
};

template <class S>
struct Feedback {
  typename S::Position position{};
  Each<S, std::int64_t> position_time_ns{};  // when the encoder sampled it, on the clock of the loop
  Each<S, bool> position_valid{};
  typename S::Velocity velocity{};               // only of encoders that give one
  std::array<typename S::Current, 3> current{};  // of the phases; of an equivalent DC motor in the first place
  Each<S, bool> fault{};                         // the power stage's or the encoder's own fault input
};

template <class S>
struct Command {
  std::array<typename S::Voltage, 3> voltage{};  // of the phases; of an equivalent DC motor in the first place
  Each<S, bool> enable{};                        // false: the power stage must be off
};

// Switches and marks of an axis, for its supervision and its homing. True: the switch is reached, whatever its wiring.
template <class S>
struct DigitalInputs {
  bool limit_negative = false;
  bool limit_positive = false;
  bool home = false;
  bool index = false;                     // the encoder's index mark was passed since the tick before,
  typename S::Position index_position{};  // here
  std::uint8_t hall = 0;                  // signals A, B, C of the motor's Hall sensors in bits 0 to 2; 0: none
};

// What an encoder at the load shows, beside the one of the control loops.
template <class S>
struct LoadReading {
  typename S::Position position{};  // with the zero of the axis' encoder
  bool valid = false;
};

// What the power stage and the motor tell about themselves, for their protection.
template <class S>
struct ProtectionInputs {
  typename S::Voltage dc_link{};
  std::int16_t motor_temperature = 0, stage_temperature = 0;  // tenths of a degree Celsius
  bool torque_off_a = false, torque_off_b = false;            // channels of safe torque off that are open
};

// Which signals of a motor and its power stage there are. What is not there is zero in the inputs above.
struct MotorSignalSet {
  bool hall = false, dc_link = false, motor_temperature = false, stage_temperature = false;
  bool torque_off = false;

  constexpr bool operator==(const MotorSignalSet&) const = default;
};

}  // namespace stiction
