// What a friction law is. A law is one header: its parameters with their table of keys, and a template over the scalar
// type that advances a rigid mass. Whoever needs something of a law (plant, identification, diagnosis, compensation)
// takes it from there, so that no law is written twice.
#pragma once

#include <array>
#include <concepts>
#include <optional>
#include <string_view>

#include "firmware/machine/model/parameter.hpp"
#include "stiction/number/choice.hpp"

namespace stiction::sim {

// What a law acts on: a rigid mass advanced in fixed steps.
struct Body {
  double mass;  // kg
  double step;  // s
};

// How friction gives way before it slides.
struct Contact {
  double level;      // N, that its spring reaches in slow sliding
  double stiffness;  // N/m, at the beginning of a displacement from rest
  double distance;   // m from rest to 90 % of the level
};

// Numbers are SI. The parameters are doubles; `Scalar` is what the law computes in.
//   advance(velocity, force)            velocity one step later under `force`, the sum of all forces but friction
//   steady_force(velocity, direction)   friction of steady sliding at `velocity`, positive along it; `direction`, -1 to
//                                       1, is the way in which the contact pushes where the velocity is zero, and the
//                                       sign of the velocity elsewhere
//   contact()                           none for friction that follows the speed alone
//   coulomb, viscous                    the part of steady friction that does not depend on the speed, and its slope
//                                       at high speed, to read from the parameters and to set in them
template <class Law>
concept FrictionLaw = requires(Law law, const Law constant, typename Law::Parameters p,
                               const typename Law::Parameters read, typename Law::Scalar value) {
  { Law::name } -> std::convertible_to<std::string_view>;
  { Law::label } -> std::convertible_to<std::string_view>;
  { Law::parameters[0] } -> std::convertible_to<machine::Parameter<typename Law::Parameters>>;
  Law(read, Body{});
  { law.advance(value, value) } -> std::same_as<typename Law::Scalar>;
  { constant.steady_force(value, value) } -> std::same_as<typename Law::Scalar>;
  { constant.contact() } -> std::same_as<std::optional<Contact>>;
  { Law::coulomb(read) } -> std::same_as<double>;
  { Law::viscous(read) } -> std::same_as<double>;
  Law::set_coulomb(p, 1.0);
  Law::set_viscous(p, 1.0);
};

// A law with a contact besides:
//   move_contact(velocity)        moves the contact for one step of held velocity; returns its force at the end, which
//   is
//                                 all friction but what is viscous
//   rate_independent(parameters)  the contact alone: nothing that depends on the speed
//   stretch(parameters, factor)   draws its displacements out by `factor`, the level kept
template <class Law>
concept ContactLaw = FrictionLaw<Law> &&
    requires(Law law, typename Law::Parameters p, const typename Law::Parameters read, typename Law::Scalar value) {
  { law.move_contact(value) } -> std::same_as<typename Law::Scalar>;
  { Law::rate_independent(read) } -> std::same_as<typename Law::Parameters>;
  Law::stretch(p, 2.0);
};

}  // namespace stiction::sim
