#include "host/requests/given_force.hpp"

#include <fmt/format.h>

#include <cmath>

#include "host/requests/names.hpp"
#include "host/requests/usage_error.hpp"

namespace stiction::host {

double WatchedForce::at(const AxisState& state) const {
  asked_.store(true, std::memory_order_relaxed);
  const double force = force_(state);
  if (!std::isfinite(force))
    throw UsageError(
        fmt::format("effect on axis {}: found the force {} at {:.6f} s, position {:g}, speed {:g}; "
                    "expected a finite number",
                    axis_, force, state.time, state.position, state.velocity));
  return force;
}

void WatchedForce::act_on(machine::AxisModel& axis) {
  const auto law = [this, radius = axis.coordinate.rotary() ? axis.coordinate.radius : 1.0](const auto& s) {
    return at({s.time, s.position / radius, s.velocity / radius, s.motor_force * radius}) / radius;
  };
  axis.effects.push_back(given_.emplace_back(std::make_unique<sim::GivenForce>(law))->effect());
}

void add_forces(machine::Machine& machine, const std::vector<RequestForce>& forces) {
  for (const auto& each : forces) {
    require_known("effect", each.axis, "an axis of " + machine.id, axis_names(machine));
    for (auto& axis : machine.axes)
      if (axis.name == each.axis) each.watch->act_on(axis);
  }
}

}  // namespace stiction::host
