#include "host/diagnose/reference/reference_extension.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/machine/configuration/double_signals.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/simulate/circle.hpp"
#include "sim/effects/coulomb_mismatch/coulomb_mismatch.hpp"
#include "sim/effects/effects.hpp"
#include "sim/effects/presliding_hysteresis/presliding_hysteresis.hpp"
#include "sim/effects/viscous_mismatch/viscous_mismatch.hpp"
#include "sim/effects/viscous_nonlinear/viscous_nonlinear.hpp"
#include "sim/plant/friction/friction.hpp"

namespace stiction::host {
namespace {

constexpr double least_displacement = 0.05, most_displacement = 500.0;  // scales between which the contact is sought
constexpr int halvings = 8, corrections = 3;

double force_constant_of(const machine::AxisModel& axis) { return axis.motor.force_constant; }

std::vector<SteadyPoint> steady_points(const machine::Machine& machine, const machine::AxisModel& axis) {
  std::vector<SteadyPoint> points;
  for (const auto& row : machine.steady_friction_references)
    if (row.axis == axis.name) points.push_back({row.velocity, row.current * force_constant_of(axis)});
  return points;
}

PreslidingCurve contact_of(const machine::Machine& machine) {
  std::vector<PreslidingPoint> points;
  for (const auto& row : machine.presliding_references)
    points.push_back({row.same_direction, row.force, row.displacement});
  return presliding_curve(points);
}

double displacement_at(const PreslidingCurve& curve, double force) {
  double x0 = 0.0, f0 = 0.0;
  for (std::size_t i = 0; i < curve.force.size(); ++i) {
    if (force <= curve.force[i]) return x0 + (curve.displacement[i] - x0) * (force - f0) / (curve.force[i] - f0);
    x0 = curve.displacement[i];
    f0 = curve.force[i];
  }
  return x0;
}

// Scales of all axes at once, as one circle moves both.
class Scales {
 public:
  Scales(const machine::Machine& machine, ReferenceExtension& extension, ReferenceCircles& circles)
      : machine_(machine), extension_(extension), circles_(circles) {
    for (const auto& axis : machine.axes) {
      const auto* row = measured_row(machine, axis.name, extension.training_feed);
      if (row == nullptr)
        throw MissingRows(fmt::format("axis {}: found no measured [[reference.circle]] row at {:g} m/min; expected one",
                                      axis.name, extension.training_feed * 60.0));
      wanted_.push_back({row->error, row->current});
    }
  }

  void find() {
    find_forces();
    choose_contacts();
    bracket_displacements();
    correct_displacements();
    check();
  }

 private:
  using Laps = std::array<RowFigures, 2>;

  Laps simulate() const { return circles_.at(extended_by(machine_, extension_), extension_.training_feed); }

  // How the current grows with the scale, then Newton's steps: the current is close to linear in it.
  void find_forces() {
    auto laps = simulate();
    slopes_.assign(wanted_.size(), 0.0);
    for (auto& axis : extension_.axes)
      if (!axis.own_rows) axis.force *= 1.1;
    const auto more = simulate();
    for (std::size_t k = 0; k < slopes_.size(); ++k) {
      auto& axis = extension_.axes[k];
      if (axis.own_rows) continue;
      axis.force /= 1.1;
      slopes_[k] = (more[k].current - laps[k].current) / (0.1 * axis.force);
    }
    for (int i = 0; i < corrections; ++i) correct_forces(simulate());
  }

  void correct_forces(const Laps& laps) {
    for (std::size_t k = 0; k < laps.size(); ++k) {
      auto& axis = extension_.axes[k];
      if (axis.own_rows) continue;
      axis.force = std::max(0.05, axis.force + (wanted_[k].current - laps[k].current) / slopes_[k]);
      axis.force_error = std::hypot(current_reading / slopes_[k], friction_drift * axis.force);
    }
  }

  void choose_contacts() {
    const auto laps = simulate();
    for (std::size_t k = 0; k < laps.size(); ++k) {
      auto& axis = extension_.axes[k];
      axis.error_with_file_contact = laps[k].error;
      axis.contact = std::abs(laps[k].error - wanted_[k].error) > 2.0 * error_reading;
    }
  }

  // A softer contact makes a smaller error. The forces follow on the way.
  void bracket_displacements() {
    std::vector<double> low(wanted_.size(), least_displacement), high(wanted_.size(), most_displacement);
    for (int i = 0; i < halvings; ++i) {
      for (std::size_t k = 0; k < low.size(); ++k) extension_.axes[k].displacement = std::sqrt(low[k] * high[k]);
      const auto laps = simulate();
      correct_forces(laps);
      for (std::size_t k = 0; k < low.size(); ++k)
        (laps[k].error > wanted_[k].error ? low : high)[k] = extension_.axes[k].displacement;
    }
  }

  // Newton's steps from there, with the slope over a tenth of the displacement.
  void correct_displacements() {
    const auto laps = simulate();
    for (auto& axis : extension_.axes) axis.displacement *= 1.1;
    const auto softer = simulate();
    std::vector<double> slopes;
    for (std::size_t k = 0; k < laps.size(); ++k) {
      auto& axis = extension_.axes[k];
      axis.displacement /= 1.1;
      slopes.push_back((softer[k].error - laps[k].error) / (0.1 * axis.displacement));
      axis.displacement_error = error_reading / std::abs(slopes[k]);
    }
    for (int i = 0; i < corrections; ++i) {
      const auto now = simulate();
      correct_forces(now);
      for (std::size_t k = 0; k < now.size(); ++k) {
        auto& displacement = extension_.axes[k].displacement;
        displacement = std::clamp(displacement + (wanted_[k].error - now[k].error) / slopes[k], 0.5 * displacement,
                                  2.0 * displacement);
      }
    }
  }

  void check() const {
    const auto laps = simulate();
    for (std::size_t k = 0; k < laps.size(); ++k) {
      const auto& axis = extension_.axes[k];
      const bool current = axis.own_rows || std::abs(laps[k].current / wanted_[k].current - 1.0) < 0.01;
      const bool error = !axis.contact || std::abs(laps[k].error - wanted_[k].error) < error_reading;
      if (!current || !error)
        throw MissingRows(fmt::format(
            "axis {}: found no friction that gives {:.2f} um and {:.2f} A (nearest {:.2f} um, {:.2f} A); expected a "
            "row of a circle that friction can explain",
            axis.axis, wanted_[k].error * 1e6, wanted_[k].current, laps[k].error * 1e6, laps[k].current));
    }
  }

  const machine::Machine& machine_;
  ReferenceExtension& extension_;
  ReferenceCircles& circles_;
  std::vector<RowFigures> wanted_;
  std::vector<double> slopes_;  // A, of the current over the scale of the friction
};

}  // namespace

sim::CircleRun reference_circle(const machine::Machine& machine, double feed) {
  sim::CircleSettings settings;
  settings.feed = feed;
  return run_circle<machine::DoubleSignals>(machine, settings);
}

const machine::CircleReference* measured_row(const machine::Machine& machine, const std::string& axis, double feed) {
  const auto row = std::find_if(machine.circle_references.begin(), machine.circle_references.end(),
                                [&](const machine::CircleReference& candidate) {
                                  return candidate.measured && candidate.axis == axis &&
                                         std::abs(candidate.feed - feed) < 1e-6 * feed;
                                });
  return row == machine.circle_references.end() ? nullptr : &*row;
}

SlidingLaw file_law(const machine::AxisModel& axis) {
  const auto plant = sim::plant_axis(axis);
  const auto steady = sim::steady_friction(plant.friction);
  constexpr double slow = 0.1, fast = 1.0;  // m/s, beyond presliding and Stribeck's fall
  const double viscous = (steady(fast, 1.0) - steady(slow, 1.0)) / (fast - slow);
  const SlidingLaw law{steady(slow, 1.0) - viscous * slow, viscous, 0.0, 0.0};
  const double between = 0.5 * (slow + fast);
  if (!(std::abs(law.at(between) / steady(between, 1.0) - 1.0) < 0.01))
    throw MissingRows(fmt::format(
        "axis {}: found the friction model {}; expected one whose friction is Coulomb and viscous in sliding",
        axis.name, axis.friction.use));
  return law;
}

std::vector<machine::Effect> effects_of(const machine::Machine& machine, const ReferenceExtension& extension,
                                        std::size_t axis) {
  const auto& own = extension.axes[axis];
  const auto& law = extension.sliding.law;
  std::vector<machine::Effect> effects;
  double coulomb = file_law(machine.axes[axis]).coulomb;
  for (const auto& test : extension.sliding.tests) {
    if (!test.named) continue;
    if (test.part == SlidingPart::coulomb)
      effects.push_back(sim::effect_of<sim::CoulombMismatch>({coulomb = own.force * law.coulomb}));
    else if (test.part == SlidingPart::viscous)
      effects.push_back(sim::effect_of<sim::ViscousMismatch>({own.force * law.viscous}));
    else
      effects.push_back(sim::effect_of<sim::ViscousNonlinear>({own.force * law.rise, law.rise_velocity}));
  }
  if (own.contact)
    effects.push_back(sim::effect_of<sim::PreslidingHysteresis>(
        {own.stiffness_per_force * coulomb / own.displacement, own.distance * own.displacement}));
  return effects;
}

machine::Machine extended_by(machine::Machine machine, const ReferenceExtension& extension) {
  const machine::Machine file = machine;
  for (std::size_t k = 0; k < machine.axes.size(); ++k) {
    auto& effects = machine.axes[k].effects;
    for (auto& effect : effects_of(file, extension, k)) {
      if (!(*sim::find_effect(effect.name))->several)
        std::erase_if(effects, [&](const machine::Effect& other) { return other.name == effect.name; });
      effects.push_back(std::move(effect));
    }
  }
  return machine;
}

ReferenceExtension extend_by_rows(const machine::Machine& machine, double training_feed, ReferenceCircles& circles) {
  ReferenceExtension extension;
  extension.training_feed = training_feed;
  const auto source = std::find_if(machine.axes.begin(), machine.axes.end(),
                                   [&](const auto& axis) { return !steady_points(machine, axis).empty(); });
  if (source == machine.axes.end())
    throw MissingRows(
        fmt::format("{}: found no [[reference.steady_friction]] row; expected those of one axis at least", machine.id));
  extension.sliding = fit_sliding_law(steady_points(machine, *source), file_law(*source));
  const auto contact = contact_of(machine);
  const double creeping = contact.coulomb();
  for (const auto& axis : machine.axes) {
    AxisExtension own;
    own.axis = axis.name;
    own.law_from = source->name;
    own.own_rows = axis.name == source->name;
    own.force = own.own_rows ? 1.0 : file_law(axis).coulomb / file_law(*source).coulomb;
    own.stiffness_per_force = contact.force.front() / contact.displacement.front() / creeping;
    own.distance = displacement_at(contact, 0.9 * creeping);
    extension.axes.push_back(own);
  }
  Scales(machine, extension, circles).find();
  return extension;
}

}  // namespace stiction::host
