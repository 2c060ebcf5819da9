// The moving mass differs from the file's: the carriage has `mass`, the drive's feedforward keeps the file's value.
#pragma once

#include <array>

#include "firmware/machine/model/machine.hpp"
#include "firmware/machine/model/parameter.hpp"

namespace stiction::sim {

struct MassMismatch {
  struct Parameters {
    double mass = 0.0;
  };
  static constexpr std::string_view name = "mass_mismatch";
  static constexpr std::string_view text = "the moving mass";
  static constexpr bool several = false;
  static constexpr std::array<machine::Parameter<Parameters>, 1> parameters{{
      {"mass", "kg", machine::positive(), &Parameters::mass, {}, "true moving mass"},
  }};

  static void change(const Parameters& p, machine::AxisModel& plant) { plant.mass = p.mass; }
};

}  // namespace stiction::sim
