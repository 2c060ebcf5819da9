#include "host/cam/step/forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stiction::host::step {
namespace {

constexpr double highest_speed = 1e4;  // rad/s, beyond what any cam turns

// What a contact is pressed by where the carousel is turned by `turned`, rad, m.
double pressed(const Contact& contact, const StepMechanism& mechanism, const StepLoad& load, double psi,
               double turned) {
  const double nearer = -load.preload * (contact.normal * sim::in_direction(1.0, -psi)).real();
  return nearer - contact.gap - mechanism.arm * contact.push * turned;
}

// The turn of the carousel that balances `torque`, by bisection: the contacts' torque falls with it.
double balanced(const ContactSet& set, const StepMechanism& mechanism, const StepLoad& load, double torque) {
  const auto given = [&](double turned) {
    double sum = 0.0;
    for (const Contact& contact : set.contacts)
      sum += std::max(0.0, pressed(contact, mechanism, load, set.psi, turned)) * load.stiffness * mechanism.arm *
             contact.push;
    return sum;
  };
  double low = -1e-2, high = 1e-2;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (given(middle) > torque ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

void add_force(StepForces& forces, const StepMechanism& mechanism, const StepLoad& load, const Contact& contact,
               double force, Point& sum) {
  forces.contacts.push_back({contact, force,
                             hertz_pressure(force, mechanism.roller_width, mechanism.roller_radius, contact.curvature,
                                            load.cam, load.roller)});
  forces.input_torque += force * cross(contact.place, contact.normal);
  sum += force * contact.normal;
}

template <class Holds>
double highest(Holds holds) {
  if (!holds(0.0)) return 0.0;
  double low = 0.0, high = 1.0;
  while (high < highest_speed && holds(high)) low = high, high *= 2.0;
  if (high >= highest_speed) return infinity;
  for (int k = 0; k < 30; ++k) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace

double hertz_pressure(double force, double width, double radius, double curvature, const Material& cam,
                      const Material& roller) {
  const double soft =
      (1.0 - cam.poisson * cam.poisson) / cam.modulus + (1.0 - roller.poisson * roller.poisson) / roller.modulus;
  return std::sqrt(std::max(0.0, force / (std::numbers::pi * width) * (1.0 / radius + curvature) / soft));
}

StepForces forces_at(const StepMechanism& mechanism, const StepLift& lift, const StepLoad& load,
                     const ContactSet& contacts) {
  StepForces forces;
  forces.psi = contacts.psi;
  const LiftState state = lift.at(contacts.psi);
  const double sense = mechanism.against ? -1.0 : 1.0;
  const double against = state.speed > 0.0 ? load.torque : state.speed < 0.0 ? -load.torque : 0.0;
  forces.output_torque = sense * (load.inertia * load.speed * load.speed * state.acceleration + against);
  Point sum;
  if (load.stiffness > 0.0) {
    const double turned = balanced(contacts, mechanism, load, forces.output_torque);
    for (const Contact& contact : contacts.contacts) {
      const double force = load.stiffness * std::max(0.0, pressed(contact, mechanism, load, contacts.psi, turned));
      if (force > 0.0 || contact.needed) add_force(forces, mechanism, load, contact, force, sum);
    }
  } else {
    const int way = forces.output_torque > 0.0 ? 1 : -1;
    const Contact* carrying = forces.output_torque == 0.0 ? nullptr : contacts.pushing(way);
    for (const Contact& contact : contacts.contacts)
      if (contact.needed)
        add_force(forces, mechanism, load, contact,
                  &contact == carrying ? forces.output_torque / (mechanism.arm * contact.push) : 0.0, sum);
  }
  forces.bearing = sim::magnitude(sum);
  return forces;
}

ForcePeaks peaks_of(const std::vector<StepForces>& forces, double speed) {
  ForcePeaks peaks;
  peaks.least_force = infinity;
  for (const StepForces& at : forces) {
    peaks.output_torque = std::max(peaks.output_torque, std::fabs(at.output_torque));
    peaks.input_torque = std::max(peaks.input_torque, std::fabs(at.input_torque));
    peaks.bearing = std::max(peaks.bearing, at.bearing);
    for (const ContactForce& each : at.contacts) {
      if (each.contact.needed) peaks.least_force = std::min(peaks.least_force, each.force);
      if (each.force > peaks.force) peaks.force = each.force, peaks.force_psi = at.psi;
      if (each.pressure <= peaks.pressure) continue;
      peaks.pressure = each.pressure;
      peaks.pressure_psi = at.psi;
      peaks.pressure_angle = each.contact.pressure_angle();
    }
  }
  peaks.input_power = peaks.input_torque * speed;
  return peaks;
}

double speed_for_pressure(const StepMechanism& mechanism, const StepLift& lift, StepLoad load,
                          const std::vector<ContactSet>& sets) {
  if (!load.largest_pressure) return infinity;
  return highest([&](double speed) {
    load.speed = speed;
    return std::none_of(sets.begin(), sets.end(), [&](const ContactSet& set) {
      const StepForces forces = forces_at(mechanism, lift, load, set);
      return std::any_of(forces.contacts.begin(), forces.contacts.end(),
                         [&](const ContactForce& each) { return each.pressure > *load.largest_pressure; });
    });
  });
}

double speed_before_lift_off(const StepMechanism& mechanism, const StepLift& lift, StepLoad load,
                             const std::vector<ContactSet>& sets) {
  if (!(load.stiffness > 0.0) || !(load.preload > 0.0)) return 0.0;
  return highest([&](double speed) {
    load.speed = speed;
    return std::all_of(sets.begin(), sets.end(), [&](const ContactSet& set) {
      const StepForces forces = forces_at(mechanism, lift, load, set);
      return std::all_of(forces.contacts.begin(), forces.contacts.end(),
                         [](const ContactForce& each) { return !each.contact.needed || each.force > 0.0; });
    });
  });
}

}  // namespace stiction::host::step
