// The table of friction laws. A new law is one header beside this one and one row here: the machine file's keys, the
// command line, the plant, identification and diagnosis take everything from it.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <variant>

#include "firmware/machine/model/machine.hpp"
#include "sim/plant/friction/classical.hpp"
#include "sim/plant/friction/coulomb_viscous.hpp"
#include "sim/plant/friction/curve.hpp"
#include "sim/plant/friction/dahl.hpp"
#include "sim/plant/friction/elasto_plastic.hpp"
#include "sim/plant/friction/linear_ramp.hpp"
#include "sim/plant/friction/lugre.hpp"
#include "sim/plant/friction/maxwell_slip.hpp"
#include "sim/plant/friction/parabolic.hpp"
#include "sim/plant/friction/parameters.hpp"

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

}  // namespace stiction::sim
