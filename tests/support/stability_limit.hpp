// The gain at which an axis goes unstable, found by raising it: on the linear machine, no friction, no quantizer, no
// limits, until the swing after a 150 N step no longer decays.
#pragma once

#include <array>
#include <cmath>

#include "hal/simulated/simulated_backend.hpp"
#include "sim/plant/friction/coulomb_viscous.hpp"
#include "sim/plant/friction/parameters.hpp"
#include "tests/support/closed_loop.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {

inline machine::Machine linear_axis(std::size_t axis) {
  auto machine = cross_table({"axis.*.encoder.velocity=ideal"});
  machine.axes = {machine.axes[axis]};
  auto& a = machine.axes[0];
  // The DC equivalent with the inductance that the star point leaves of the winding's: linear at every position.
  a.motor.model = machine::MotorModel::dc;
  a.motor.phase_inductance -= a.motor.mutual_inductance;
  a.encoder.increment = 0.0;
  a.position_controller.increment = 0.0;
  sim::set_parameters<sim::CoulombViscous<>>(a.friction, {0.0, 0.0});
  a.friction.use = "coulomb_viscous";
  a.inverter.voltage_limit = a.inverter.current_limit = 1e12;
  a.supervision = {1.0, 1e6, 1e3};  // what comes here is running away
  a.max_velocity = 1e12;
  return machine;
}

// What is left of the swing a third of a second later, as a share.
inline double remainder_of_swing(const machine::Machine& machine) {
  const std::array<double, 1> start{0.0};
  hal::SimulatedBackend<machine::DoubleSignals> backend(machine, start);
  backend.plant(0).set_external_force(150.0);
  constexpr int per_second = 16000;
  constexpr int ticks = per_second * 6 / 10;
  const auto trace = record(
      backend, machine, ticks, [](double) { return std::array<sim::AxisSetPoint, 1>{}; }, [](auto&, int) {});
  if (trace.size() < ticks) return HUGE_VAL;  // stopped by a fault
  const auto largest = [&](double from, double to) {
    double result = 0.0;
    for (auto i = static_cast<std::size_t>(from * per_second); i < static_cast<std::size_t>(to * per_second); ++i)
      result = std::max(result, std::abs(trace[i].e.value));
    return result;
  };
  const double early = largest(0.1, 0.2);
  // A well damped loop is down to rounding by then; there, growth means nothing.
  if (early < 1e-13 * largest(0.0, 0.1)) return 0.0;
  return largest(0.1 + 1.0 / 3.0, 0.2 + 1.0 / 3.0) / early;
}

inline constexpr double decays_well = 0.1;  // by a factor of ten in a third of a second
inline constexpr double decays_at_all = 1.0;

// The factor at which `scale(axis, factor)` leaves more than `share` of the swing, to 0.3 %.
template <class Scale>
double limit_factor(std::size_t axis, double share, Scale&& scale) {
  double stable = 1.0, unstable = 40.0;
  while (unstable / stable > 1.003) {
    const double factor = std::sqrt(stable * unstable);
    auto machine = linear_axis(axis);
    scale(machine.axes[0], factor);
    (remainder_of_swing(machine) < share ? stable : unstable) = factor;
  }
  return std::sqrt(stable * unstable);
}

}  // namespace stiction::test
