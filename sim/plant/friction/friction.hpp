// The table of friction laws. A new law is one header beside this one and one row here: the machine file's keys, the
// command line, the plant, identification and diagnosis take everything from it.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "firmware/machine/model/value_table.hpp"
#include "sim/plant/friction/classical.hpp"
#include "sim/plant/friction/coulomb_viscous.hpp"
#include "sim/plant/friction/curve.hpp"
#include "sim/plant/friction/dahl.hpp"
#include "sim/plant/friction/elasto_plastic.hpp"
#include "sim/plant/friction/linear_ramp.hpp"
#include "sim/plant/friction/lugre.hpp"
#include "sim/plant/friction/maxwell_slip.hpp"
#include "sim/plant/friction/parabolic.hpp"

namespace stiction::sim {

// Any friction law, in the order in which reports show them.
using FrictionModel = std::variant<CoulombViscous<>, Classical<>, LinearRamp<>, Parabolic<>, LuGre<>, Dahl<>,
                                   ElastoPlastic<>, MaxwellSlip<>, Curve<>>;

// Calls visit.operator()<Law>() for each law of the table, in order.
template <class Visit, std::size_t Index = 0>
constexpr void for_each_friction_model(Visit&& visit) {
  if constexpr (Index < std::variant_size_v<FrictionModel>) {
    using Law = std::variant_alternative_t<Index, FrictionModel>;
    static_assert(FrictionLaw<Law>);
    visit.template operator()<Law>();
    for_each_friction_model<Visit, Index + 1>(static_cast<Visit&&>(visit));
  }
}

// Between a law's own parameters and those of a machine file.
template <FrictionLaw Law>
typename Law::Parameters parameters_of(const machine::KeyedValues& values) {
  return machine::typed<typename Law::Parameters>(values, Law::parameters);
}
template <FrictionLaw Law>
machine::KeyedValues values_of(const typename Law::Parameters& parameters) {
  return machine::keyed(parameters, Law::parameters);
}

// The parameters of the law `Law` in an axis' file. Throws std::out_of_range where the file has no such table.
template <FrictionLaw Law>
typename Law::Parameters parameters_of(const machine::FrictionParameters& friction) {
  return parameters_of<Law>(friction.models.at(std::string(Law::name)));
}

// Gives a machine the table of the law `Law` with these parameters; which law acts stays.
template <FrictionLaw Law>
void set_parameters(machine::FrictionParameters& friction, const typename Law::Parameters& parameters) {
  friction.models[std::string(Law::name)] = values_of<Law>(parameters);
}

// A machine's friction whose only law, acting, is `Law`.
template <FrictionLaw Law>
machine::FrictionParameters acting(const typename Law::Parameters& parameters) {
  machine::FrictionParameters friction{std::string(Law::name), {}};
  set_parameters<Law>(friction, parameters);
  return friction;
}

// visit.operator()<Law>(parameters) for the law in use, with its parameters. Throws std::invalid_argument where no law
// of the table has that name.
template <class Visit>
auto with_law_in_use(const machine::FrictionParameters& friction, Visit&& visit) {
  using Result = decltype(visit.template operator()<CoulombViscous<>>(CoulombViscousParameters{}));
  std::function<Result()> chosen;
  for_each_friction_model([&]<class Law>() {
    if (Law::name == friction.use)
      chosen = [&] { return visit.template operator()<Law>(parameters_of<Law>(friction)); };
  });
  if (!chosen) throw std::invalid_argument("friction: there is no law \"" + friction.use + "\"");
  return chosen();
}

// The law in use, at rest, acting on `body`.
FrictionModel make_friction(const machine::FrictionParameters& friction, Body body);

// Friction of steady sliding, N, at `velocity` (m/s) with the contact pushing in `direction` (-1 to 1): see
// FrictionLaw.
using SteadyFriction = std::function<double(double velocity, double direction)>;
SteadyFriction steady_friction(const machine::FrictionParameters& friction);

// Of the law in use.
std::optional<Contact> contact_of(const machine::FrictionParameters& friction);
double coulomb_of(const machine::FrictionParameters& friction);  // N
double viscous_of(const machine::FrictionParameters& friction);  // N s/m
void set_coulomb(machine::FrictionParameters& friction, double coulomb);
void set_viscous(machine::FrictionParameters& friction, double viscous);

// The force (N) of the contact at each of these displacements (m) from rest, reached in straight steps,
// rate-independent; empty for a law without a contact.
std::vector<double> contact_force(const machine::FrictionParameters& friction,
                                  const std::vector<double>& displacements);

// The contact of the law in use drawn out by `factor`, its level kept. Does nothing for a law without a contact.
void stretch_contact(machine::FrictionParameters& friction, double factor);

// The tables of keys, for whoever opens a machine file.
std::vector<machine::ValueTable> friction_tables();

}  // namespace stiction::sim
