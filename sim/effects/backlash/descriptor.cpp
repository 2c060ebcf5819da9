#include "sim/effects/backlash/backlash.hpp"
#include "sim/effects/describe.hpp"

namespace stiction::sim::effects {

EffectDescriptor backlash() {
  return described<Backlash>({
      .order = 170,
      .title = "Lost motion (backlash)",
      .meaning = "The measured position stands while the motor moves on at a reversal.",
      .advice =
          "Check couplings, nut preload and the scale's mounting; a backlash compensation hides it at low speed only.",
      .aliases = {{"presliding_hysteresis",
                   "load at standstill: presliding has an elastic slope, play has none; a second encoder"}},
      .abscissa = Abscissa::since_reversal,
      .needs = {Need::set_points, Need::reversals},
      .not_in_rows = "cannot be told from two numbers a row: at a reversal it adds to the largest error as a softer "
                     "contact does; load the axis at standstill",
      .hidden = {[](const machine::AxisModel&, Draw& draw) -> machine::KeyedValues {
                   return {{"width", {draw.between(2e-6, 10e-6)}}};
                 },
                 {}},
  });
}

}  // namespace stiction::sim::effects
