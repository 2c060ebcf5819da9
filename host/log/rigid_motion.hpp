// Mass, friction and delay of the effort from a log as it is, without differentiating its position.
//
// The equation of motion, effort = mass x'' + viscous x' + coulomb sgn x' + root sgn x' |x'|^(1/2) + offset (and
// friction that falls near standstill or builds up over a distance), is multiplied by a smooth window and integrated
// over it; by parts the derivatives move to the window (M. Shinbrot, Trans. ASME 79, 1957). So an encoder of coarse
// counts is averaged, not differentiated, any unit of length will do, and the effort may be taken earlier or later by
// any time. The window is the shortest whose acceleration is above the noise of the position. Uncertainties are those
// of a delete-one jackknife over parts of the record, which holds what the model lacks as far as it differs between
// them.
#pragma once

#include <optional>
#include <vector>

#include "host/log/log.hpp"

namespace stiction::host {

struct RigidMotion {
  double mass = 0.0, mass_error = 0.0;    // effort per acceleration, at the delay 0 or `at`
  double delay = 0.0, delay_error = 0.0;  // s: the effort is recorded late by so much against the position
  double rest_ratio = 1.0;                // unexplained variance without a delay over that with the best one
  // What friction takes, by the effort's and the speed's magnitudes; negative: it drives.
  double friction_power = 0.0;
  double friction_power_error = 0.0;
  double mass_by_rest = 0.0;  // error of the mass if all that is unexplained went with the acceleration
  double explained = 0.0;     // of the variance of the effort by all columns
  double window = 0.0;        // s
};

// Longest delay that is looked for, s.
inline constexpr double longest_delay = 0.06;

// `log`: even; `axis`: of it; `effort`: its values in any unit, as long as t; `at`: s, the delay of the effort that the
// mass is taken at. None: too short, no motion, or an acceleration within the noise of the position in every window.
std::optional<RigidMotion> rigid_motion(const Log& log, const AxisLog& axis, const std::vector<double>& effort,
                                        double at = 0.0);

}  // namespace stiction::host
