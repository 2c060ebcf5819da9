#include <cmath>

#include "sim/effects/describe.hpp"
#include "sim/effects/require_shaft.hpp"
#include "sim/effects/transmission_error/transmission_error.hpp"

namespace stiction::sim {

void PeriodicTransmissionError::check_axis(const Parameters&, const machine::AxisModel& axis) {
  require_shaft(name, axis);
}

namespace effects {

EffectDescriptor transmission_error() {
  return described<PeriodicTransmissionError>({
      .order = 260,
      .title = "Transmission error",
      .meaning = "The load is ahead of its motor and behind it in waves that return with the turns of a wheel.",
      .advice =
          "Once a turn it is an eccentric wheel, coupling or encoder ring: centre it. As often as teeth mesh it is "
          "the toothing. The remainder can be corrected by a table over the wheel's angle, or by closing the "
          "position loop on the load's encoder.",
      .aliases = {{"encoder_subdivision_error",
                   "both encoders against a third one: the reading error of an encoder stays with it"}},
      .abscissa = Abscissa::position,
      .needs = {Need::second_encoder},
      .not_in_rows = "not in two numbers per row, which know one encoder",
      .hidden = {[](const machine::AxisModel& axis, Draw& draw) -> machine::KeyedValues {
                   const double of_motor = axis.transmission ? axis.transmission->ratio : 1.0;
                   const double amplitude = draw.between(2e-4, 8e-4), phase = draw.between(0.0, 6.28);
                   return {{"per", {of_motor}},
                           {"order", {1.0 + static_cast<double>(draw.index(2))}},
                           {"cosine", {amplitude * std::cos(phase)}},
                           {"sine", {amplitude * std::sin(phase)}}};
                 },
                 {}},
  });
}

}  // namespace effects
}  // namespace stiction::sim
