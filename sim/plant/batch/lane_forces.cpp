#include "sim/plant/batch/lane_forces.hpp"

#include "sim/plant/acting_effects.hpp"

namespace stiction::sim {

struct LaneForces::Lane {
  ActingEffects effects;
};

LaneForces::LaneForces(std::size_t lanes) : lanes_(lanes) {}
LaneForces::LaneForces(LaneForces&&) noexcept = default;
LaneForces& LaneForces::operator=(LaneForces&&) noexcept = default;
LaneForces::~LaneForces() = default;

void LaneForces::set(std::size_t lane, const machine::AxisModel& axis, double step, double position) {
  ActingEffects effects(axis, step, position);
  if (!effects.any()) return;
  lanes_[lane] = std::make_unique<Lane>(Lane{std::move(effects)});
  any_ = true;
}

void LaneForces::advance(const double* position, const double* velocity, const double* motor_force, double* applied,
                         double* friction) {
  for (std::size_t k = 0; k < lanes_.size(); ++k) {
    applied[k] = friction[k] = 0.0;
    if (!lanes_[k]) continue;
    const auto forces = lanes_[k]->effects.advance(position[k], velocity[k], motor_force[k]);
    applied[k] = forces.applied;
    friction[k] = forces.friction;
  }
}

}  // namespace stiction::sim
