// What the effects of one axis do in the steps of its plant: forces on the carriage, and the play in front of the
// encoder. What they change in the plant's parameters is done before, by plant_axis().
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "sim/plant/effects/effects.hpp"

namespace stiction::sim {

template <class E>
concept ForceOnCarriage = requires(const E& effect, const CarriageState& state) {
  effect.force(state);
};

namespace detail {
template <class Table>
struct ForcesOf;
template <class... E>
struct ForcesOf<std::tuple<E...>> {
  template <class... Forces>
  static std::variant<Forces...> variant_of(std::tuple<Forces...>);
  using type = decltype(variant_of(
      std::tuple_cat(std::declval<std::conditional_t<ForceOnCarriage<E>, std::tuple<E>, std::tuple<>>>()...)));
};
}  // namespace detail

// Any effect that is a force on the carriage.
using ForceEffect = detail::ForcesOf<EffectTable>::type;

class ActingEffects {
 public:
  // `axis` as plant_axis() returns it, at rest at `position` (m). Throws EffectError.
  ActingEffects(const Axis& axis, Body body, double position) : step_(body.step), follower_(position) {
    for_each_effect([&]<class E>() {
      if constexpr (ForceOnCarriage<E>)
        for (const auto& parameters : effects_of<E>(axis)) forces_.emplace_back(E(parameters, body));
    });
    for (const auto& parameters : effects_of<Backlash>(axis)) play_.emplace(parameters, position);
  }

  bool any() const { return !forces_.empty() || play_; }

  // Forces on the carriage during one step, N, positive in +x: those that are friction, and the others.
  struct Forces {
    double applied = 0.0;
    double friction = 0.0;
  };
  // From position (m) and velocity (m/s) at the beginning of the step.
  Forces advance(double position, double velocity) {
    const CarriageState state{position, velocity, direction_.advance(velocity, step_)};
    Forces sum;
    for (const ForceEffect& effect : forces_)
      std::visit([&]<class E>(const E& e) { (E::is_friction ? sum.friction : sum.applied) += e.force(state); }, effect);
    return sum;
  }

  // The carriage is at `position` (m) at the end of a step.
  void follow(double position) {
    closed_ = !play_ || play_->advance(position);
    follower_ = play_ ? play_->follower() : position;
  }
  double follower() const { return follower_; }  // m, the position behind the play
  bool closed() const { return closed_; }        // whether it moved with the carriage in the last step

 private:
  double step_;
  std::vector<ForceEffect> forces_;
  FrictionDirection direction_;
  std::optional<Backlash> play_;
  double follower_;
  bool closed_ = true;
};

}  // namespace stiction::sim
