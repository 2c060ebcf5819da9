// The columns of an elastic mode against the closed loop of a machine that has it: what its simulation leaves on the
// way of a machine that has none.
#include "host/diagnose/record/elastic_mode.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "host/diagnose/record/effect_response.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/diagnose/record/record_rows.hpp"
#include "host/diagnose/record/replay_setup.hpp"
#include "sim/effects/effect_values.hpp"
#include "sim/effects/structural_resonance/structural_resonance.hpp"
#include "tests/support/figure.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::host {
namespace {

// X of the cross table; `sliding`: with a thousandth of a newton of friction.
machine::Machine one_axis(bool sliding) {
  auto machine = test::cross_table();
  machine.axes.resize(1);
  auto& axis = machine.axes.front();
  if (sliding) axis = with_viscous(with_coulomb(axis, 1e-3), 1.0);
  axis.effects.clear();
  axis.encoder.increment = axis.encoder.noise = axis.position_controller.increment = 0.0;
  return machine;
}

// Moves of some millimetres whose accelerations reach up to 60 Hz.
Log ordered() {
  Log log;
  log.source = "moves";
  log.period = 1e-3;
  log.axes.resize(1);
  auto& axis = log.axes.front();
  for (int k = 0; k < 4000; ++k) {
    const double t = k * log.period;
    double x = 0.0;
    for (const double hz : {1.3, 7.1, 23.0, 57.0})
      x += 0.02 / (hz * hz) * (1.0 - std::cos(2.0 * std::numbers::pi * hz * t));
    log.t.push_back(t);
    axis.x_set.push_back(x * std::min(1.0, t));
    axis.x.push_back(axis.x_set.back());
    axis.i.push_back(0.0);
  }
  return log;
}

double share_missed(const ElasticMode& mode, bool sliding) {
  const auto machine = one_axis(sliding);
  const auto& axis = machine.axes.front();
  const std::vector<Log> logs{ordered()};
  const auto settings = signals_in(host::RowBand::usual, logs);
  const auto motion = without_noise(machine, 0, logs).motion;
  if (motion.empty()) return INFINITY;
  const auto rows = rows_of(motion, axis, settings);
  EffectResponse response(machine, 0, logs, settings, FrictionAlong::simulated_motion);
  const auto effect = sim::effect_of<sim::StructuralResonance>(
      {mode.frequency, mode.damping_ratio, mode.mass_ratio, mode.motor_measured ? 1 : 0});
  const Eigen::VectorXd wanted = rows.stacked([&](const Motion& m) { return response(m, effect); });
  const Eigen::VectorXd found = rows.stacked([&](const Motion& m) {
    auto columns = mode_columns_in_loop(mode, axis, m, friction_along(axis, m));
    if (columns.size() > 1)
      for (std::size_t i = 0; i < columns[0].size(); ++i) columns[0][i] += columns[1][i] / mode.mass_ratio;
    return columns[0];
  });
  return (found - wanted).norm() / wanted.norm();
}

}  // namespace

TEST(ElasticMode, ColumnsAreWhatTheClosedLoopLeaves) {
  struct Case {
    ElasticMode mode;
    bool sliding;
  };
  // The drive of this machine does not stand modes between motor and encoder below 250 Hz.
  for (const auto& [mode, sliding] : {Case{{120.0, 0.1, 0.6, true}, false}, Case{{120.0, 0.1, 0.6, true}, true},
                                      Case{{300.0, 0.1, 0.6, true}, true}, Case{{300.0, 0.1, 0.6, false}, true}}) {
    const double missed = share_missed(mode, sliding);
    test::figure(fmt::format("mode of {:g} Hz {}{}: columns off the closed loop", mode.frequency,
                             mode.motor_measured ? "of a body behind the carriage" : "between motor and encoder",
                             sliding ? ", without friction" : ""),
                 fmt::format("{:.1f} % rms (bound 15 %)", 100.0 * missed));
    EXPECT_LT(missed, 0.15) << mode.frequency;
  }
}

}  // namespace stiction::host
