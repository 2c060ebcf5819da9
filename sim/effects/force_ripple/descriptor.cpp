#include <array>

#include "sim/effects/describe.hpp"
#include "sim/effects/force_ripple/force_ripple.hpp"
#include "sim/effects/shared_sentences.hpp"

namespace stiction::sim::effects {

EffectDescriptor force_ripple() {
  return described<ForceRipple>({
      .order = 130,
      .title = "Force ripple (cogging)",
      .meaning = "A force varies periodically with position and does not depend on current.",
      .advice = "Compare the pitch with the pole pitch of the magnets and the lead of the screw. Most drives have a "
                "cogging compensation: pitch, amplitudes and phases are its parameters.",
      .aliases =
          {{"encoder_subdivision_error",
            "several speeds: the force of a subdivision error increases with the speed squared, cogging does not"},
           {"position_dependent_friction", "the same segment in both directions"},
           {"force_constant_ripple", "the same segment with several accelerations and in both directions"},
           {"periodic_disturbance", "a second speed, and a record at standstill"}},
      .abscissa = Abscissa::position,
      .needs = {Need::steady_stroke},
      .not_in_rows = rows::no_position,
      .hidden = {[](const machine::AxisModel&, Draw& draw) -> machine::KeyedValues {
                   constexpr std::array pitches{0.072, 0.036, 0.024, 0.0205};  // m
                   return {{"pitch", {pitches[draw.index(pitches.size())]}},
                           {"cosine", {draw.sign() * draw.between(4.0, 10.0)}},
                           {"sine", {draw.sign() * draw.between(2.0, 8.0)}}};
                 },
                 7},
  });
}

}  // namespace stiction::sim::effects
