#include "sim/plant/friction/friction.hpp"

#include <memory>
#include <utility>

#include "sim/plant/friction/laws.hpp"

namespace stiction::sim {
namespace {

// Parameters of the law in use, changed by `change(Law, parameters)`.
template <class Change>
void change_law(machine::FrictionParameters& friction, Change&& change) {
  friction.models[friction.use] = with_law_in_use(friction, [&]<class Law>(typename Law::Parameters p) {
    change.template operator()<Law>(p);
    return values_of<Law>(p);
  });
}

constexpr Body any_body{1.0, 1.0};  // for what does not depend on it

}  // namespace

FrictionModel make_friction(const machine::FrictionParameters& friction, Body body) {
  return with_law_in_use(friction,
                         [&]<class Law>(const typename Law::Parameters& p) -> FrictionModel { return Law(p, body); });
}

SteadyFriction steady_friction(const machine::FrictionParameters& friction) {
  return with_law_in_use(friction, []<class Law>(const typename Law::Parameters& p) -> SteadyFriction {
    return [law = std::make_shared<const Law>(p, any_body)](double velocity, double direction) {
      return law->steady_force(velocity, direction);
    };
  });
}

std::optional<Contact> contact_of(const machine::FrictionParameters& friction) {
  return with_law_in_use(friction,
                         []<class Law>(const typename Law::Parameters& p) { return Law(p, any_body).contact(); });
}

double coulomb_of(const machine::FrictionParameters& friction) {
  return with_law_in_use(friction, []<class Law>(const typename Law::Parameters& p) { return Law::coulomb(p); });
}

double viscous_of(const machine::FrictionParameters& friction) {
  return with_law_in_use(friction, []<class Law>(const typename Law::Parameters& p) { return Law::viscous(p); });
}

void set_coulomb(machine::FrictionParameters& friction, double coulomb) {
  change_law(friction, [coulomb]<class Law>(typename Law::Parameters& p) { Law::set_coulomb(p, coulomb); });
}

void set_viscous(machine::FrictionParameters& friction, double viscous) {
  change_law(friction, [viscous]<class Law>(typename Law::Parameters& p) { Law::set_viscous(p, viscous); });
}

std::vector<double> contact_force(const machine::FrictionParameters& friction,
                                  const std::vector<double>& displacements) {
  return with_law_in_use(friction, [&]<class Law>(const typename Law::Parameters& p) {
    std::vector<double> force;
    if constexpr (ContactLaw<Law>) {
      Law law(Law::rate_independent(p), any_body);
      double reached = 0.0;
      for (const double x : displacements) force.push_back(law.move_contact(x - std::exchange(reached, x)));
    }
    return force;
  });
}

void stretch_contact(machine::FrictionParameters& friction, double factor) {
  change_law(friction, [factor]<class Law>(typename Law::Parameters& p) {
    if constexpr (ContactLaw<Law>) Law::stretch(p, factor);
  });
}

std::vector<machine::ValueTable> friction_tables() {
  std::vector<machine::ValueTable> tables;
  for_each_friction_model([&]<class Law>() {
    tables.push_back({Law::name, Law::label, false, machine::keys_of(Law::parameters)});
  });
  return tables;
}

}  // namespace stiction::sim
