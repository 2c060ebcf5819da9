#include "host/simulate/parabolic_chatter.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "host/simulate/control_run.hpp"
#include "sim/plant/friction/coulomb_viscous.hpp"
#include "sim/plant/friction/parabolic.hpp"
#include "sim/plant/friction/parameters.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

double explicit_friction(const sim::ParabolicParameters& p, double velocity) {
  if (velocity == 0.0) return 0.0;
  return std::copysign(p.force_at_1_m_per_s * std::pow(std::abs(velocity), 1.0 / p.order), velocity);
}

}  // namespace

double chatter_amplitude(const sim::ParabolicParameters& friction, double mass, double step) {
  const double n = friction.order;
  return std::pow(friction.force_at_1_m_per_s, n / (n - 1.0)) * std::pow(step / (2.0 * mass), 1.0 / (n - 1.0));
}

ChatterRun impact_with_parabolic_friction(machine::Machine machine, double force, double time,
                                          std::optional<double> step) {
  auto& friction = machine.axes.at(0).friction;
  const auto parameters = sim::parameters_of<sim::Parabolic<>>(friction);
  friction.use = sim::Parabolic<>::name;
  if (step) {  // then it comes from outside, as a force
    friction.use = sim::CoulombViscous<>::name;
    friction.models[friction.use] = sim::values_of<sim::CoulombViscous<>>({0.0, 0.0});
  }
  const std::array<double, 1> origin{0.0};
  const std::array<sim::AxisSetPoint, 1> standstill{};
  ControlRun<FixedSignals> run(machine, origin);
  ChatterRun result;
  constexpr double duration = 1.0, settled = 0.5, shown = 0.005;  // s
  double held = 0.0, next_evaluation = 0.0, before = 0.0;
  int evaluations = 0, changes = 0;
  while (run.time() < duration) {
    const double t = run.time();
    auto& plant = run.plant(0);
    bool evaluated = !step;
    if (step && t > next_evaluation - 1e-9) {
      held = explicit_friction(parameters, plant.velocity());
      next_evaluation += *step;
      evaluated = true;
    }
    plant.set_external_force((t >= time ? force : 0.0) - held);
    const double now = step ? held : plant.friction_force();
    run.tick(standstill);
    if (t < settled) continue;
    if (t < settled + shown) {
      result.friction.x.push_back((t - settled) * 1e3);
      result.friction.y.push_back(now);
    }
    if (!evaluated) continue;
    result.least = std::min(result.least, now);
    result.greatest = std::max(result.greatest, now);
    result.rms += now * now;
    changes += now * before < 0.0;
    before = now;
    ++evaluations;
  }
  result.rms = std::sqrt(result.rms / evaluations);
  result.alternating = static_cast<double>(changes) / evaluations;
  return result;
}

}  // namespace stiction::host
