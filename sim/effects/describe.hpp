// An effect's descriptor from its class, which has its name, its keys and its law, and from its facts.
//
// The law may be:
//   static void change(const Parameters&, Axis&)             the plant's own parameters; the drive keeps the file's
//   class with force(const CarriageState&), is_friction      a force on the carriage in each step (N, positive in +x);
//                                                            with advance(const CarriageState&), one that remembers
//   static void change_drive(const Parameters&, Axis&)       the drive's parameters; the plant keeps the file's
//   static void check(const Parameters&)                     whether the values go together
//   static void check_axis(const Parameters&, const Axis&)   whether an axis can have it
// What acts at a place of its own (between motor and carriage, on what is measured) the plant looks up by its class,
// see acting_effects.hpp.
#pragma once

#include <memory>
#include <utility>

#include "sim/effects/effect_descriptor.hpp"
#include "sim/effects/effect_values.hpp"

namespace stiction::sim {

template <class E>
concept ForceOnCarriage = requires(const E& effect, const CarriageState& state) {
  effect.force(state);
};

namespace detail {

template <class E>
class ForceOf : public CarriageForce {
 public:
  template <class... Arguments>
  explicit ForceOf(const Arguments&... arguments) : effect_(arguments...) {}

  void advance(const CarriageState& state) override {
    if constexpr (requires { effect_.advance(state); }) effect_.advance(state);
  }
  double force(const CarriageState& state) const override { return effect_.force(state); }

 private:
  E effect_;
};

template <class E>
std::unique_ptr<CarriageForce> make_force(const machine::KeyedValues& values, Body body,
                                          const machine::AxisModel& axis) {
  const auto parameters = parameters_of<E>(values);
  if constexpr (std::is_constructible_v<E, const typename E::Parameters&, Body, const machine::AxisModel&>)
    return std::make_unique<ForceOf<E>>(parameters, body, axis);
  else
    return std::make_unique<ForceOf<E>>(parameters, body);
}

template <class E>
EffectLaw law_of() {
  using Parameters = typename E::Parameters;
  EffectLaw law;
  law.check = [](const machine::KeyedValues& values) { parameters_of<E>(values); };
  if constexpr (requires(const Parameters& p, const machine::AxisModel& axis) { E::check_axis(p, axis); })
    law.check_axis = [](const machine::KeyedValues& values, const machine::AxisModel& axis) {
      E::check_axis(parameters_of<E>(values), axis);
    };
  if constexpr (requires(const Parameters& p, machine::AxisModel& axis) { E::change(p, axis); })
    law.change = [](const machine::KeyedValues& values, machine::AxisModel& plant) {
      E::change(parameters_of<E>(values), plant);
    };
  if constexpr (requires(const Parameters& p, machine::AxisModel& axis) { E::change_drive(p, axis); })
    law.change_drive = [](const machine::KeyedValues& values, machine::AxisModel& drive) {
      E::change_drive(parameters_of<E>(values), drive);
    };
  if constexpr (ForceOnCarriage<E>) {
    law.make_force = make_force<E>;
    law.is_friction = E::is_friction;
  }
  return law;
}

}  // namespace detail

template <class E>
EffectDescriptor described(EffectFacts facts) {
  return {std::move(facts), {E::name, E::text, E::several, machine::keys_of(E::parameters)}, detail::law_of<E>(), {}};
}

}  // namespace stiction::sim
