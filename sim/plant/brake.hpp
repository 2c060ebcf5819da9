// A holding brake: engaged, it yields like a spring from where it closed and slips under more than its holding force
// (a bristle as that of Dahl 1968 with a force that is cut at its end). Released, it does nothing.
#pragma once

#include <algorithm>
#include <cmath>

#include "firmware/machine/model/machine.hpp"
#include "sim/effects/carriage_force.hpp"

namespace stiction::sim {

class Brake final : public CarriageForce {
 public:
  // `parameters`: of the file; `mass` (kg): that it holds, for a tenth of critical damping; `step`: of the plant, s.
  Brake(const machine::BrakeParameters& parameters, double mass, double step)
      : holding_force_(parameters.holding_force),
        stiffness_(parameters.stiffness),
        damping_(0.2 * std::sqrt(parameters.stiffness * mass)),
        half_step_(0.5 * step) {}

  // `position`: of the carriage (m), where it closes.
  void set(bool released, double position) {
    if (engaged_ == released) closed_at_ = position;
    engaged_ = !released;
  }

  void advance(const CarriageState& state) override {
    const double most = holding_force_ / stiffness_;
    closed_at_ = std::clamp(closed_at_, state.position - most, state.position + most);
  }
  double force(const CarriageState& state) const override {
    if (!engaged_) return 0.0;
    const double held =
        stiffness_ * (state.position + half_step_ * state.velocity - closed_at_) + damping_ * state.velocity;
    return -std::clamp(held, -holding_force_, holding_force_);
  }

 private:
  double holding_force_, stiffness_, damping_, half_step_;
  bool engaged_ = false;
  double closed_at_ = 0.0;  // m
};

}  // namespace stiction::sim
