// The speed pulse as it is tuned: laps in the lanes of a batch are the laps of the drive, and the search finds what the
// optimiser of one lap after the other found.
#include "host/tune/pulse_tuning.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "host/simulate/circle.hpp"
#include "host/simulate/quadrant_run.hpp"
#include "host/tune/lap_errors.hpp"
#include "tests/support/figure.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

sim::CircleSettings circle_at(double metres_per_minute) {
  sim::CircleSettings circle;
  circle.feed = metres_per_minute / 60.0;
  return circle;
}

machine::Machine with_pulse(machine::Machine machine, std::size_t axis, double amplitude) {
  machine::PulseCompensationParameters pulse;
  pulse.amplitude = pulse.final_amplitude = amplitude;
  pulse.rise_until = 1e-3;
  pulse.flat_until = 10.0;
  pulse.fall_until = 20.0;
  pulse.delay = 4e-3;
  pulse.duration = 25e-3;
  machine.axes[axis].friction_compensation = {CompensationKind::pulse, pulse, {}, {}, {}};
  return machine;
}

// The signals of the firmware round where those of the batch do not: a current of 2^-18 A and less, which moves an axis
// by nanometres.
TEST(LapErrors, of_a_batch_are_those_of_the_drive) {
  constexpr double rounding = 0.05e-6;  // m
  const auto circle = circle_at(24.0);
  for (const std::size_t axis : {0U, 1U}) {
    std::vector<machine::Machine> machines;
    for (const double amplitude : {0.0, 0.3e-3, 0.6e-3, 1.2e-3})
      machines.push_back(with_pulse(cross_table(), axis, amplitude));
    const auto errors = host::last_lap_errors(machines, axis, circle, 2);
    ASSERT_EQ(errors.size(), machines.size());
    for (std::size_t k = 0; k < machines.size(); ++k)
      EXPECT_NEAR(errors[k], host::run_quadrants(machines[k], axis, circle, 2).peak_error.back(), rounding) << k;
    // Whoever else is in the batch.
    EXPECT_EQ(host::last_lap_errors({&machines[1], 1}, axis, circle, 2).front(), errors[1]);
  }
}

// Set-points that come late by an effect are the control run's alone: the firmware's signals, to the bit.
TEST(LapErrors, of_an_axis_that_no_batch_runs_are_the_control_runs) {
  auto machine = with_pulse(cross_table(), 0, 0.6e-3);
  machine.axes[0].effects.push_back({"master_delay", {{"delay", {1e-3}}}});
  const auto circle = circle_at(48.0);
  EXPECT_EQ(host::last_lap_errors({&machine, 1}, 0, circle, 1).front(),
            host::run_quadrants(machine, 0, circle, 1).peak_error.back());
}

TEST(LapErrors, are_refused_beyond_the_axis) {
  const auto machine = cross_table();
  EXPECT_THROW(host::last_lap_errors({&machine, 1}, 0, circle_at(1000.0), 1), host::InfeasibleMotion);
}

// NLopt's Nelder-Mead from two starts left 1.20 um of 7.7 um in 250 laps.
TEST(PulseTuning, finds_what_an_optimiser_finds_in_laps_one_by_one) {
  const auto tuning = host::tune_pulse(cross_table(), 0, circle_at(16.0));
  figure("quadrant error of X at 16 m/min: off, best speed pulse",
         fmt::format("{:.2f}, {:.2f} um", tuning.error_off * 1e6, tuning.error * 1e6));
  EXPECT_LE(tuning.error, 1.25e-6);
  EXPECT_GE(tuning.error_off, 7e-6);
  EXPECT_LE(tuning.evaluations, 500);
}

}  // namespace
}  // namespace stiction::test
