// Spring-like, rate-independent displacement before sliding, of all friction or of a share of it.
// With `distance` alone the contact of the law in use is drawn out to that distance: the law stays, with its Stribeck
// effect and its damping. With `stiffness` too, the law is replaced by Maxwell-slip elements with its Coulomb and
// viscous values. Their curve of first loading is Dahl's (1968) with the exponent n that reaches 90 % of Coulomb after
// `distance`,
//   dF/ds = stiffness (1 - F/F_C)^n,  F(distance) = 0.9 F_C,
// which holds between an elastic-plastic line (stiffness times distance = 0.9 F_C, n = 0) and a long tail.
// With a `share` below 1, of surfaces that are not alike (a seal beside a guide): the law in use has the rest of the
// Coulomb friction, at its own distance, and such elements in parallel have the share; without `stiffness` of the shape
// of the law's contact.
#pragma once

#include <array>
#include <optional>

#include "firmware/machine/model/machine.hpp"
#include "firmware/machine/model/parameter.hpp"
#include "sim/effects/carriage_state.hpp"
#include "sim/plant/friction/maxwell_slip.hpp"

namespace stiction::sim {

class PreslidingHysteresis {
 public:
  struct Parameters {
    std::optional<double> stiffness;
    double distance = 0.0;
    double share = 1.0;
  };
  static constexpr std::string_view name = "presliding_hysteresis";
  static constexpr std::string_view text = "spring-like, rate-independent displacement before sliding";
  static constexpr bool several = false;
  static constexpr std::array<machine::Parameter<Parameters>, 3> parameters{{
      {"stiffness",
       "N/m",
       machine::positive(),
       &Parameters::stiffness,
       {},
       "stiffness at the beginning of a displacement; left out: of the curve of the friction in use, drawn out"},
      {"distance",
       "m",
       machine::positive(),
       &Parameters::distance,
       {},
       "displacement to 90 % of Coulomb friction, or of the share"},
      {"share",
       "1",
       {0.0, 1.0, true},
       &Parameters::share,
       1.0,
       "of Coulomb friction that has this distance; the rest keeps its own"},
  }};
  static constexpr bool is_friction = true;
  // stiffness * distance, in units of Coulomb friction.
  static constexpr machine::Range sharpness{0.9, 1000.0};

  // Throws EffectError where Coulomb friction does not fit (see sharpness).
  static void change(const Parameters& p, machine::AxisModel& plant);

  // The contact of a share beside that of the law in use; none of all friction, which change() has made.
  // `p`: its keys; `body`: the carriage; `axis`: as change() leaves it.
  PreslidingHysteresis(const Parameters& p, Body body, const machine::AxisModel& axis);

  // One step at the velocity of `state`, which is held over it.
  void advance(const CarriageState& state) {
    if (contact_) force_ = -contact_->move_contact(state.velocity);
  }
  double force(const CarriageState&) const { return force_; }

 private:
  std::optional<MaxwellSlip<double>> contact_;
  double force_ = 0.0;  // N
};

// The elements of that curve: its polygon of tangents at 0, 10, .. 90 and 98 % of Coulomb friction, so that initial
// stiffness, the point at 90 % and Coulomb friction are exact. Throws EffectError beyond `sharpness`. `coulomb` in N,
// `distance` in m.
MaxwellSlipParameters presliding_elements(double coulomb, double stiffness, double distance);

}  // namespace stiction::sim
