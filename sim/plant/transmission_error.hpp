// By how much a load is ahead of what the ratio alone makes of its motor's angle: waves over the turns of the motor, of
// a wheel inside the gear, and of the screw, pulley or rotary axis, and those of the effect transmission_error.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "sim/effects/effects.hpp"
#include "sim/effects/transmission_error/transmission_error.hpp"
#include "sim/number/sine_cosine.hpp"

namespace stiction::sim {

class TransmissionError {
 public:
  // Of an `axis` with a transmission.
  explicit TransmissionError(const machine::AxisModel& axis) {
    const auto& transmission = *axis.transmission;
    const double per_motor_turn = 1.0 / axis.motor_coordinate.radius;  // rad of the motor in a metre
    const double per_output_turn = per_motor_turn / transmission.ratio;
    const auto add = [&](const std::optional<machine::TransmissionErrorParameters>& error, double angle_per_metre,
                         bool of_motor) {
      if (error) waves_.push_back({error->amplitude, error->order * angle_per_metre, error->phase, of_motor});
    };
    add(transmission.motor_error, per_motor_turn, true);
    add(transmission.gear_error, per_output_turn * transmission.gear_ratio.value_or(1.0), false);
    add(transmission.output_error, per_output_turn, false);
    for (const auto& error : effects_of<PeriodicTransmissionError>(axis))
      waves_.push_back({std::hypot(error.cosine, error.sine), error.order * per_output_turn * error.per,
                        std::atan2(error.cosine, error.sine), of_motor(transmission, error.per)});
  }

  // Whether a wheel of so many turns in a turn of screw, pulley or rotary axis is the motor's.
  static bool of_motor(const machine::TransmissionParameters& transmission, double per) {
    return std::abs(per - transmission.ratio) < 1e-6 * transmission.ratio;
  }

  bool any() const { return !waves_.empty(); }

  struct Ahead {
    double distance = 0.0;  // m
    double rate = 0.0;      // m/s
  };
  // With the `load` and the `motor` where they are (m) at the velocities `load_rate` and `motor_rate` (m/s).
  Ahead at(double load, double load_rate, double motor, double motor_rate) const {
    Ahead sum;
    for (const Wave& wave : waves_) {
      const auto [sine, cosine] = sine_cosine(wave.angle_per_metre * (wave.of_motor ? motor : load) + wave.phase);
      sum.distance += wave.amplitude * sine;
      sum.rate += wave.amplitude * wave.angle_per_metre * cosine * (wave.of_motor ? motor_rate : load_rate);
    }
    return sum;
  }

 private:
  struct Wave {
    double amplitude, angle_per_metre, phase;
    bool of_motor;
  };
  std::vector<Wave> waves_;
};

}  // namespace stiction::sim
