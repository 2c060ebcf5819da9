// Three-phase commutation of a synchronous linear motor (Mendricky 2006, 3.6, 3.9, 3.12): phase k carries
// i sin(phi + k 2 pi / 3), phi = 2 pi x / pole-pair pitch, so that the force is 3/2 K_F i at every position.
#pragma once

#include <array>

#include "stiction/number/fixed.hpp"

namespace stiction {

template <class S>
struct Commutation {
  using Sine = typename S::Sine;
  using Current = typename S::Current;

  // sin(phi + k 2 pi / 3), k = 0, 1, 2; the third follows from the sum being zero.
  static constexpr std::array<Sine, 3> phases(typename S::Angle angle) {
    const Sine a = S::sine(angle);
    const Sine b = S::sine(S::third_of_turn_after(angle));
    SaturationCounter none;  // the roundings of a and b may add up to a bit beyond 1
    return {a, b, narrow<Sine>(-(a + b), none)};
  }

  // The set currents of the phases; their sum is zero. `amplitude`: of the current, A; `phase`: sines of the three
  // phases, from phases(); `saturations`: counts currents that exceed the format.
  static constexpr std::array<Current, 3> phase_currents(Current amplitude, const std::array<Sine, 3>& phase,
                                                         SaturationCounter& saturations) {
    const auto a = narrow<Current>(amplitude * phase[0], saturations);
    const auto b = narrow<Current>(amplitude * phase[1], saturations);
    return {a, b, saturated_difference(opposite(a), b, saturations)};
  }

  // The amplitude that makes the same force: 2/3 of the sum of i_k sin(phi + k 2 pi / 3). `current`: of the three
  // phases, A; `phase`: their sines, from phases(); `saturations`: counts results that exceed the format.
  static constexpr Current amplitude(const std::array<Current, 3>& current, const std::array<Sine, 3>& phase,
                                     SaturationCounter& saturations) {
    const auto sum = narrow<typename S::CurrentSum>(
        current[0] * phase[0] + current[1] * phase[1] + current[2] * phase[2], saturations);
    return narrow<Current>(sum * S::two_thirds(), saturations);
  }
};

}  // namespace stiction
