// What the GPIO backend is told: lines of a gpiochip, quadrature encoders on two of them, and half bridges behind the
// kernel's PWM class. Plain numbers; the machine file's tables [drive.gpio] and [drive.axis.NAME.line] hold the same.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace stiction::hal {

// A line by its number on the chip; below 0: not wired.
struct LineConfig {
  int offset = -1;
  // The line is low while it says yes: an inverting input, or a switch that opens a contact to the supply when it is
  // reached (normally closed), so that a broken wire reads as reached.
  bool active_low = false;

  bool wired() const { return offset >= 0; }
};

// Of the inputs, inside the chip where it can.
enum class Bias : std::uint8_t { as_is, pull_up, pull_down, none };

// What one axis has on digital lines.
struct AxisLines {
  std::string name;   // of the axis, for messages
  LineConfig enable;  // out: the power stage may be on
  LineConfig brake;   // out: the brake is released
  LineConfig fault;   // in: of the power stage
  LineConfig limit_negative, limit_positive, home, index;
  LineConfig torque_off_a, torque_off_b;  // in: a channel of safe torque off is open
  LineConfig hall_a, hall_b, hall_c;      // in: of the motor
};

// A line for the whole machine: out, the pulse for a watchdog outside of the computer.
struct WatchdogConfig {
  LineConfig line;
  std::int64_t period_ns = 10'000'000;  // from one edge to the next
};

struct QuadratureConfig {
  LineConfig a, b;         // A leads B in the positive direction
  double increment = 0.0;  // m from one edge of the tracks to the next
  // Edges a second, both tracks together, that the machine's kernel was measured to hold; more are a fault.
  double rate = 10e3;
  // How long an edge may take from its interrupt to the queue. Edges are put in order only when they are that old, so
  // the position is one of so long ago, and its time stamp says so.
  std::int64_t settle_ns = 50'000;
};

struct PwmConfig {
  std::string chip;       // folder of the PWM class, such as /sys/class/pwm/pwmchip0
  int first_channel = 0;  // the half bridges follow each other
  int half_bridges = 2;   // 2: a full bridge for one voltage; 3: three phases
  std::int64_t period_ns = 62'500;
  double dc_link = 0.0;  // V between the rails
  // A channel that runs is what a run that was killed left: it is stopped and taken over. False: it is left alone.
  bool takes_over = false;
};

struct GpioAxisConfig {
  AxisLines lines;
  QuadratureConfig encoder;
  PwmConfig pwm;
};

struct GpioBackendConfig {
  std::string chip;  // path, name, label or number of the gpiochip
  Bias bias = Bias::as_is;
  std::vector<GpioAxisConfig> axes;
  WatchdogConfig watchdog{};
  std::vector<LineConfig> tracks{};  // out: of a cam switch; those that are not wired have their number all the same
};

}  // namespace stiction::hal
