// Times that the simulation lacks: `delay`, by which the current is recorded late against the position (of the record
// alone: nothing in the loop knows it), and `loop_delay`, which the controller's output needs beyond the inverter's
// dead time.
#pragma once

#include <array>

#include "firmware/machine/model/machine.hpp"
#include "firmware/machine/model/parameter.hpp"
#include "sim/effects/effects.hpp"

namespace stiction::sim {

struct TimeSkew {
  struct Parameters {
    double delay = 0.0;
    double loop_delay = 0.0;
  };
  static constexpr std::string_view name = "time_skew";
  static constexpr std::string_view text = "current recorded late against position, or a delay in the loop";
  static constexpr bool several = false;
  static constexpr std::array<machine::Parameter<Parameters>, 2> parameters{{
      {"delay", "s", {-0.1, 0.1}, &Parameters::delay, 0.0, "by which the current is recorded late; negative: early"},
      {"loop_delay", "s", machine::not_negative(0.1), &Parameters::loop_delay, 0.0,
       "of the loop, beyond the dead time"},
  }};

  // The dead time need not be a multiple of the plant's step, see InverterModel.
  static void change(const Parameters& p, machine::AxisModel& plant) { plant.inverter.dead_time += p.loop_delay; }
};

// By which the current of this axis is recorded late against its position, s.
inline double record_delay(const machine::AxisModel& axis) {
  double delay = 0.0;
  for (const auto& skew : effects_of<TimeSkew>(axis)) delay += skew.delay;
  return delay;
}

}  // namespace stiction::sim
