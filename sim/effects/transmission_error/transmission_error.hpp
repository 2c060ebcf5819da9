// The load is ahead of what the ratio makes of the motor's angle, and behind it, in waves over the turns of a wheel:
//   e = cosine cos(order phi) + sine sin(order phi),  phi the wheel's angle, 0 at the position 0.
// An eccentric wheel does that once in its turn, teeth as often as they mesh. The wheel turns `per` times in a turn of
// the screw, pulley or rotary axis: 1 is that one itself, the transmission's ratio the motor. It acts on the shaft
// between motor and load; an axis without one cannot have it.
#pragma once

#include <array>

#include "firmware/machine/model/machine.hpp"
#include "firmware/machine/model/parameter.hpp"

namespace stiction::sim {

struct PeriodicTransmissionError {
  struct Parameters {
    double per = 1.0;
    double order = 1.0;
    double cosine = 0.0;
    double sine = 0.0;
  };
  static constexpr std::string_view name = "transmission_error";
  static constexpr std::string_view text = "an error of the transmission that returns with the turns of a wheel";
  static constexpr bool several = true;
  static constexpr std::array<machine::Parameter<Parameters>, 4> parameters{{
      {"per",
       "1",
       machine::positive(),
       &Parameters::per,
       {},
       "turns of the wheel in a turn of screw, pulley or rotary axis; 1: that one, the ratio: the motor"},
      {"order", "1", machine::positive(), &Parameters::order, {}, "waves in a turn of the wheel"},
      {"cosine",
       "m",
       machine::any_value(),
       &Parameters::cosine,
       {},
       "amplitude at the load that is largest at the position 0"},
      {"sine", "m", machine::any_value(), &Parameters::sine, {}, "amplitude a quarter of a wave later"},
  }};

  // Throws EffectError on an axis without a shaft.
  static void check_axis(const Parameters& p, const machine::AxisModel& axis);
};

}  // namespace stiction::sim
