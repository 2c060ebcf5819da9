// Friction from the set-points, as current: presliding by distance and a sliding curve by speed.
//  - Presliding: stop elements in parallel (Iwan 1966; Lampaert, Swevers, Al-Bender 2003), driven by the set position.
//    Each is a spring whose slider gives way, z = clamp(z + dx, +-reach). Their sum remembers every reversal inside of
//    a reversal, and is linear in the stiffnesses. The sum of stiffness times reach is the Coulomb level.
//  - Contact damping: the sum's change in a tick times a weight, the b_s z' of the LuGre contact (Canudas de Wit,
//    Olsson, Astrom, Lischinsky 1995). Without it a machine with that contact keeps 2.5 of 4 um at 8 m/min.
//  - Sliding curve: what friction has beyond the Coulomb level, a table over speed for each direction, zero at rest.
#pragma once

#include <array>
#include <cstdint>

#include "stiction/control/compensation_kind.hpp"
#include "stiction/control/delay_line.hpp"
#include "stiction/control/limit.hpp"
#include "stiction/number/choice.hpp"
#include "stiction/number/fixed.hpp"

namespace stiction {

template <class S>
struct FrictionFeedforward {
  static constexpr std::size_t element_count = compensation_element_count;
  static constexpr std::size_t speed_nodes = S::speed_nodes;

  struct Element {
    typename S::Step reach{};                  // the deflection at which it slips; 0 to half of the format
    typename S::ContactStiffness stiffness{};  // A/m
  };
  using SlidingTable = std::array<typename S::Current, speed_nodes>;
  struct Config {
    std::array<Element, element_count> elements{};  // those left at zero are none
    typename S::ContactDamping damping{};           // ticks: the change of a tick that is added
    SlidingTable forward{};                         // A over |v|, at the nodes of S::speed_place; the first is 0
    SlidingTable backward{};
    typename S::Current limit{};  // of the whole
  };
  struct State {
    std::array<typename S::Step, element_count> stretch{};
    typename S::Current contact{};
  };
  struct Terms {
    typename S::Current contact{};  // of the stop elements
    typename S::Current damping{};
    typename S::Current sliding{};
    typename S::Current sum{};  // behind the limit
  };

  // `dx`: how much further the set-point is than the one before. `config`: elements and sliding curves; `state`:
  // deflection of each element, changed by the step; `v`: set velocity, m/s; `saturations`: counts results that exceed
  // the format.
  [[gnu::always_inline]] static constexpr Terms step(const Config& config, State& state, typename S::Step dx,
                                                     typename S::Velocity v, SaturationCounter& saturations) {
    Terms terms;
    const auto bounded = S::bounded_step(dx);
    typename S::ContactSum sum{};
#pragma GCC unroll 8
    for (std::size_t k = 0; k < element_count; ++k) {
      const auto& element = config.elements[k];
      const auto z = clamped(S::add_steps(state.stretch[k], bounded), element.reach);
      state.stretch[k] = z;
      sum = cut<typename S::ContactSum>(sum + element.stiffness * z);
    }
    terms.contact = narrow<typename S::Current>(sum, saturations);
    const auto change = saturated_difference(terms.contact, state.contact, saturations);
    state.contact = terms.contact;
    terms.damping = narrow<typename S::Current>(config.damping * change, saturations);
    terms.sliding = sliding(config, v);
    terms.sum =
        clamped(saturated_sum(saturated_sum(terms.contact, terms.damping, saturations), terms.sliding, saturations),
                config.limit);
    return terms;
  }

  static constexpr typename S::Current sliding(const Config& config, typename S::Velocity v) {
    if constexpr (OneAxis<S>) {
      const bool backward = v < typename S::Velocity{};
      const auto& table = backward ? config.backward : config.forward;
      const auto [node, fraction] = S::speed_place(backward ? opposite(v) : v);
      const auto current = between<S>(table[node], table[node + 1], fraction);
      return backward ? opposite(current) : current;
    } else {  // each axis' table at a place of its own
      const auto backward = v < typename S::Velocity{};
      const auto place = S::speed_place(select(backward, opposite(v), v));
      const auto found = S::entries(backward, config.backward, config.forward, place.node);
      const auto current = between<S>(found.below, found.above, place.fraction);
      return select(backward, opposite(current), current);
    }
  }
};

}  // namespace stiction
