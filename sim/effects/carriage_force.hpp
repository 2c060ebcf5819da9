// A force of an effect on the carriage, as the plant steps it: whose it is, the plant does not know.
#pragma once

#include "sim/effects/carriage_state.hpp"

namespace stiction::sim {

class CarriageForce {
 public:
  CarriageForce() = default;
  CarriageForce(const CarriageForce&) = delete;
  CarriageForce& operator=(const CarriageForce&) = delete;
  virtual ~CarriageForce() = default;

  // Once a step, before the first force() of it; for a force that remembers.
  virtual void advance(const CarriageState&) {}
  // N on the carriage, positive in +x.
  virtual double force(const CarriageState& state) const = 0;
};

}  // namespace stiction::sim
