// A machine whose friction follows the speed alone, and set-points with rests: behind a standstill its slowest motion
// tells most.
#pragma once

#include <algorithm>
#include <string>

#include "host/log/log.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {

// X of the cross table with friction that follows the speed alone.
inline machine::Machine rigid_machine() {
  auto machine = cross_table();
  machine.axes.resize(1);
  auto& axis = machine.axes.front();
  axis.friction.use = "coulomb_viscous";
  axis.effects.clear();
  axis.encoder.noise = axis.position_controller.increment = 0.0;
  axis.encoder.increment = 1e-7;
  return machine;
}

// 6 s of a `stroke` (m) to and fro, each way in `duration` (s), with 0.2 s of rest between them; a row each `period`
// (s).
inline host::Log dwelling(const std::string& source, double stroke, double duration, double period = 1e-3) {
  host::Log log;
  log.source = source;
  log.period = period;
  log.axes.resize(1);
  auto& axis = log.axes.front();
  for (int k = 0; k * period < 6.0; ++k) {
    const double t = period * k, cycle = duration + 0.2;
    const auto strokes = static_cast<int>(t / cycle);
    const double u = std::min((t - cycle * strokes) / duration, 1.0);
    const double lift = u * u * u * (10.0 + u * (6.0 * u - 15.0));
    log.t.push_back(t);
    axis.x_set.push_back(stroke * (strokes % 2 == 0 ? lift : 1.0 - lift));
    axis.x.push_back(axis.x_set.back());
    axis.i.push_back(0.0);
  }
  return log;
}

}  // namespace stiction::test
