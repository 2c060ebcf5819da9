#include <utility>

#include "host/batch/kernel.hpp"

namespace stiction::host {

Kernel::~Kernel() = default;

LanePlants::LanePlants(std::size_t lanes) : plants_(lanes) {}

void LanePlants::set(std::size_t lane, std::unique_ptr<sim::AxisPlant> plant) { plants_[lane] = std::move(plant); }

void LanePlants::set_external_force(const double* force) {
  for (auto& plant : plants_) {
    if (plant) plant->set_external_force(*force);
    ++force;
  }
}

void LanePlants::command(const double* voltage, unsigned enabled) {
  const std::size_t n = plants_.size();
  for (std::size_t k = 0; k < n; ++k)
    if (plants_[k]) plants_[k]->command({voltage[k], voltage[n + k], voltage[2 * n + k]}, (enabled >> k & 1U) != 0);
}

void LanePlants::advance_tick() {
  for (auto& plant : plants_)
    if (plant) plant->advance_tick();
}

void LanePlants::read(double* position, double* velocity) {
  for (auto& plant : plants_) {
    *position++ = plant ? plant->read_encoder() : 0.0;
    *velocity++ = plant ? plant->encoder_velocity() : 0.0;
  }
}

void LanePlants::currents(double* rows) const {
  const std::size_t n = plants_.size();
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t phase = 0; phase < 3; ++phase)
      rows[phase * n + k] = plants_[k] ? plants_[k]->current()[phase] : 0.0;
}

void LanePlants::motor_force(double* out) const {
  for (const auto& plant : plants_) *out++ = plant ? plant->motor_force() : 0.0;
}

void LanePlants::position(double* out) const {
  for (const auto& plant : plants_) *out++ = plant ? plant->position() : 0.0;
}

}  // namespace stiction::host
