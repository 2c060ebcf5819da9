// A friction law's own parameters and those of a machine file.
#pragma once

#include <string>

#include "firmware/machine/model/machine.hpp"
#include "firmware/machine/model/value_table.hpp"
#include "sim/plant/friction/law.hpp"

namespace stiction::sim {

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

}  // namespace stiction::sim
