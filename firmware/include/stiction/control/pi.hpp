// PI controller k (1 + 1 / (T_N s)) with back-calculation anti-windup (Astrom, Hagglund 2006, 3.5). The integrator is
// updated before use: I += k T/T_N e; y = k e + I. It is kept in units of the output with all bits of the product.
#pragma once

#include "stiction/number/fixed.hpp"

namespace stiction {

// Types of one controller: error, output, gains, integrator.
template <class E, class O, class P, class I, class W, class T>
struct PiTypes {
  using Error = E;
  using Output = O;
  using Proportional = P;
  using Integral = I;
  using Integrator = W;
  using Tracking = T;
};

template <class Types>
struct Pi {
  struct Config {
    typename Types::Proportional proportional{};  // k
    typename Types::Integral integral{};          // k T / T_N; 0: proportional only
    typename Types::Tracking tracking{};          // T / T_t, share of the excess taken back per tick
  };
  struct State {
    typename Types::Integrator integral{};  // I
  };
  struct Wanted {
    typename Types::Output output;  // before any limit
    bool beyond_format;             // it left the output's format
  };

  // Where the sum leaves the output's own format, track() cannot see by how much, so the integrator stands still
  // instead of winding up. `config`: gains; `state`: the integrator, changed by the step; `error`: set minus actual
  // value; `saturations`: counts results that exceed the format.
  static constexpr Wanted step(const Config& config, State& state, typename Types::Error error,
                               SaturationCounter& saturations) {
    SaturationCounter here;
    const auto integral = narrow<typename Types::Integrator>(state.integral + config.integral * error, here);
    const auto output = narrow<typename Types::Output>(config.proportional * error + integral, here);
    const bool beyond_format = here.count != 0;
    if (beyond_format)
      saturations.add(here);
    else
      state.integral = integral;
    return {output, beyond_format};
  }

  // Tells the integrator what became of the controller's output behind all limits: of `total`, the output and what was
  // added to it, `limited` was left. `config`: gains; `state`: the integrator, changed by the call; `beyond_format`: as
  // step() returned it; `saturations`: counts results that exceed the format.
  static constexpr void track(const Config& config, State& state, bool beyond_format, typename Types::Output total,
                              typename Types::Output limited, SaturationCounter& saturations) {
    if (beyond_format) return;
    const auto excess = saturated_difference(limited, total, saturations);
    state.integral = narrow<typename Types::Integrator>(state.integral + config.tracking * excess, saturations);
  }
};

}  // namespace stiction
