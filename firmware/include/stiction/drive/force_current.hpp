// The current that makes an axis' force, whichever loop controls it: of one winding, of three phases, or, where no
// current is measured, the set one.
#pragma once

#include "stiction/control/commutation.hpp"
#include "stiction/drive/axis.hpp"

namespace stiction {

// `config`: of the axis; `feedback`: of this tick; `measured`: the newest position that is known, in the place of one
// that did not come; `set`: the set current of the last tick; `commutation`: electrical
// angle at the encoder's zero; `saturations`: counts results that exceed the format.
template <class S>
constexpr typename S::Current force_current(const AxisConfig<S>& config, const Feedback<S>& feedback,
                                            typename S::Position measured, typename S::Current set, Turn commutation,
                                            SaturationCounter& saturations) {
  if (config.current_loop == CurrentLoop::direct) return feedback.current[0];
  if (config.current_loop == CurrentLoop::none) return set;
  const auto x = feedback.position_valid ? feedback.position : measured;
  const auto phases = Commutation<S>::phases(S::turned(S::angle(x, config.inverse_pole_pair_pitch), commutation));
  return Commutation<S>::amplitude(feedback.current, phases, saturations);
}

}  // namespace stiction
