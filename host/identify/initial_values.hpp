// First values by hand, as one reads them off a record (Mendricky 2006, 5.2-5.4): Coulomb friction from the step of the
// force at a reversal (5.3), viscous friction from the force over speed, mass from the force over acceleration
// (5.10-5.12). A check of the fit that shares nothing with it but the signals.
#pragma once

#include <optional>

#include "host/identify/log_rows.hpp"

namespace stiction::host {

struct InitialValues {
  std::optional<double>
      coulomb;  // N, half the step of the force without mass and viscous part, median of the reversals
  std::optional<double> viscous;  // N s/m, slope of the force over speed where the axis does not accelerate
  std::optional<double> mass;     // kg, median of what is left over acceleration where it accelerates
};

InitialValues initial_values(const LogRows& rows);

}  // namespace stiction::host
