// Between the typed parameters of an effect and the values by key that a machine file, a verdict or a fit has.
#pragma once

#include <fmt/format.h>

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "firmware/machine/model/effect.hpp"
#include "firmware/machine/model/value_table.hpp"

namespace stiction::sim {

// Values that an effect cannot have, alone or on this axis.
using EffectError = machine::ValueError;

// Every key of the effect with its value; no key for an optional one that has none.
template <class E>
machine::Effect effect_of(const typename E::Parameters& parameters) {
  return {std::string(E::name), machine::keyed(parameters, E::parameters)};
}

// A key that is left out takes its default. Throws EffectError as machine::check_values() does and where E::check()
// refuses the values together.
template <class E>
typename E::Parameters parameters_of(const machine::KeyedValues& values) {
  static const machine::ValueTable table{E::name, E::text, E::several, machine::keys_of(E::parameters)};
  machine::check_values(table, values);
  auto parameters = machine::typed(values, E::parameters);
  if constexpr (requires { E::check(parameters); }) E::check(parameters);
  return parameters;
}

}  // namespace stiction::sim
