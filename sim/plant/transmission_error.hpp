// By how much a load is ahead of what the ratio alone makes of its motor's angle: waves over the turns of the motor, of
// a wheel inside the gear, and of the screw, pulley or rotary axis.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "firmware/machine/model/machine.hpp"
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
      if (error) waves_[count_++] = {error->amplitude, error->order * angle_per_metre, error->phase, of_motor};
    };
    add(transmission.motor_error, per_motor_turn, true);
    add(transmission.gear_error, per_output_turn * transmission.gear_ratio.value_or(1.0), false);
    add(transmission.output_error, per_output_turn, false);
  }

  bool any() const { return count_ != 0; }

  struct Ahead {
    double distance = 0.0;  // m
    double rate = 0.0;      // m/s
  };
  // With the `load` and the `motor` where they are (m) at the velocities `load_rate` and `motor_rate` (m/s).
  Ahead at(double load, double load_rate, double motor, double motor_rate) const {
    Ahead sum;
    for (std::size_t k = 0; k < count_; ++k) {
      const Wave& wave = waves_[k];
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
  std::array<Wave, 3> waves_{};
  std::size_t count_ = 0;
};

}  // namespace stiction::sim
