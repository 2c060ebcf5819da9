// The table of friction models. A new model is one header beside this one and one row here: the machine file's reader,
// the command line and the plant take name, parameters and law from it.
#pragma once

#include <string_view>
#include <tuple>
#include <variant>

#include "sim/plant/friction/classical.hpp"
#include "sim/plant/friction/coulomb_viscous.hpp"
#include "sim/plant/friction/linear_ramp.hpp"
#include "sim/plant/friction/lugre.hpp"
#include "sim/plant/friction/maxwell_slip.hpp"
#include "sim/plant/friction/parabolic.hpp"

namespace stiction::sim {

// In the order in which reports show them.
using FrictionModel = std::variant<CoulombViscous, Classical, LinearRamp, Parabolic, LuGre, MaxwellSlip>;

namespace detail {
template <class Variant>
struct ParametersOf;
template <class... Models>
struct ParametersOf<std::variant<Models...>> {
  using type = std::variant<typename Models::Parameters...>;
};
}  // namespace detail

// The parameters of any model; the alternatives stand in the order of FrictionModel.
using FrictionParameters = detail::ParametersOf<FrictionModel>::type;

// Calls visit.operator()<Model>() for each model of the table, in order.
template <class Visit, std::size_t Index = 0>
constexpr void for_each_friction_model(Visit&& visit) {
  if constexpr (Index < std::variant_size_v<FrictionModel>) {
    visit.template operator()<std::variant_alternative_t<Index, FrictionModel>>();
    for_each_friction_model<Visit, Index + 1>(static_cast<Visit&&>(visit));
  }
}

// The model itself, at rest, acting on `body`.
inline FrictionModel make_friction(const FrictionParameters& parameters, Body body) {
  return std::visit(
      [&]<class P>(const P& p) -> FrictionModel {
        FrictionModel model = CoulombViscous({}, body);
        for_each_friction_model([&]<class Model>() {
          if constexpr (std::is_same_v<typename Model::Parameters, P>) model = Model(p, body);
        });
        return model;
      },
      parameters);
}

}  // namespace stiction::sim
