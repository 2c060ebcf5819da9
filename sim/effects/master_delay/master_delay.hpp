// A slave that follows its master late: the drive has its set-points `delay` after the time that the log gives them,
// which is that of the master's position. A bus, an estimator of the master without look-ahead or a cam that is
// evaluated before its master is does that. The loop itself is not slower by it.
#pragma once

#include <array>

#include "firmware/machine/model/machine.hpp"
#include "firmware/machine/model/parameter.hpp"
#include "sim/effects/effects.hpp"

namespace stiction::sim {

struct MasterDelay {
  struct Parameters {
    double delay = 0.0;
  };
  static constexpr std::string_view name = "master_delay";
  static constexpr std::string_view text = "the slave follows its master late";
  static constexpr bool several = false;
  static constexpr std::array<machine::Parameter<Parameters>, 1> parameters{{
      {"delay", "s", machine::not_negative(0.1), &Parameters::delay, {}, "by which the set-points come late"},
  }};
};

// By which this axis has its set-points late, s.
inline double master_delay(const machine::AxisModel& axis) {
  double delay = 0.0;
  for (const auto& late : effects_of<MasterDelay>(axis)) delay += late.delay;
  return delay;
}

}  // namespace stiction::sim
