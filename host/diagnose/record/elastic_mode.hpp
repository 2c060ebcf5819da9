// What an elastic mode (effect structural_resonance) makes of the motor's force. With the measured mass r M, the other
// one (1 - r) M, friction and surroundings f at the measured part and B = 1 / (w^2 + 2 zeta w s), the motor needs
// beyond a rigid axis' force M a + f
//   s^2 B (M a + f / r)                      where it drives the other part: what bends the spring,
//   -(1 - r) M a s^2 / (s^2 + r / B)         where it drives the measured one: the other one swings behind it.
// That is along the record's own motion. Along the motion that the file's simulation makes of the set-points the record
// went astray by what the mode did and the drive did against it, which is more than a correction: a velocity loop
// closes near such a mode, and sticking friction holds what the mode would move.
#pragma once

#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/identify/motion.hpp"

namespace stiction::host {

struct ElasticMode {
  double frequency = 0.0;      // Hz, of the free mode
  double damping_ratio = 0.0;  // 1
  double mass_ratio = 0.0;     // r
  bool motor_measured = false;
};

// Columns of the motor's force (N, at the motion's rate) beyond a rigid axis': what goes with the acceleration, and, of
// a motor that drives the other part, what goes with the forces at the measured one, to be weighed by 1 / r. `mode`: of
// which r is fixed where it is in the loop or behind; `axis`: whose mass M is; `motion` of the measured part; `load`:
// f, N along the motion.
std::vector<std::vector<double>> mode_columns(const ElasticMode& mode, const machine::AxisModel& axis,
                                              const Motion& motion, const std::vector<double>& load);
// The same of a `motion` that was simulated without the `mode`, in the linear control of the `axis`: P position and PI
// velocity, a current that follows. Zeros where that control does not stand the mode. `load`: as above.
std::vector<std::vector<double>> mode_columns_in_loop(const ElasticMode& mode, const machine::AxisModel& axis,
                                                      const Motion& motion, const std::vector<double>& load);

}  // namespace stiction::host
