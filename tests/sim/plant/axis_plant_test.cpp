// The whole axis: inverter, motor, carriage and encoder in their connection.
#include "sim/plant/axis_plant.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/plant/friction/classical.hpp"
#include "sim/plant/friction/coulomb_viscous.hpp"
#include "sim/plant/friction/parameters.hpp"

namespace stiction::sim {
namespace {

constexpr machine::Timing timing{62.5e-6, 1e-3};
constexpr double tick = 62.5e-6;
constexpr double step = tick / plant_steps_per_tick;

// A force source of 10 N/V on 4 kg without friction, dead time and encoder errors.
machine::AxisModel plain_axis() {
  machine::AxisModel axis;
  axis.name = "x";
  axis.mass = 4.0;
  axis.motor.model = machine::MotorModel::force;
  axis.motor.force_constant = 10.0;
  axis.inverter = {0.0, 10.0, 1.0};
  axis.friction = acting<CoulombViscous<>>({});
  return axis;
}
machine::AxisModel with_friction(machine::FrictionParameters friction) {
  auto axis = plain_axis();
  axis.friction = std::move(friction);
  return axis;
}

void advance(AxisPlant& plant, int ticks) {
  for (int i = 0; i < ticks; ++i) plant.advance_tick();
}

TEST(AxisPlant, StandsWhereItWasPutUntilAForceActs) {
  AxisPlant plant(timing, plain_axis(), 0.25, 1);
  advance(plant, 100);
  EXPECT_EQ(plant.position(), 0.25);
  EXPECT_EQ(plant.velocity(), 0.0);
}

TEST(AxisPlant, AcceleratesByForceOverMassFromTheCommandedTickOn) {
  AxisPlant plant(timing, plain_axis(), 0.0, 1);
  plant.command({2.0, 0.0, 0.0}, true);
  for (int n = 1; n <= 1000; ++n) {
    plant.advance_tick();
    const double t = n * tick;
    ASSERT_NEAR(plant.velocity(), 5.0 * t, 1e-12);
    ASSERT_NEAR(plant.position(), 2.5 * t * t, 1e-13) << "the mean of old and new velocity is exact here";
    ASSERT_EQ(plant.motor_force(), 20.0);
  }
}

TEST(AxisPlant, TheVoltageArrivesAfterExactlyTheDeadTime) {
  for (int steps = 0; steps <= 11; ++steps) {
    auto axis = plain_axis();
    axis.inverter.dead_time = steps * step;
    AxisPlant plant(timing, axis, 0.0, 1);
    plant.command({}, true);
    advance(plant, 5);
    // Two voltages, a tick each: the second must replace the first after the same delay.
    plant.command({2.0, 0.0, 0.0}, true);
    plant.advance_tick();
    plant.command({-1.0, 0.0, 0.0}, true);
    for (int n = 2; n <= 8; ++n) {
      plant.advance_tick();
      const double t = n * tick - steps * step;  // since the first voltage acts
      const double first = std::clamp(t, 0.0, tick), second = std::max(0.0, t - tick);
      ASSERT_NEAR(plant.velocity(), 5.0 * first - 2.5 * second, 1e-15) << steps << " steps, tick " << n;
    }
  }
}

TEST(AxisPlant, TheDcLinkLimitsEachVoltageInBothSigns) {
  for (const double sign : {1.0, -1.0}) {
    AxisPlant plant(timing, plain_axis(), 0.0, 1);
    plant.command({sign * 35.0, 0.0, 0.0}, true);
    plant.advance_tick();
    EXPECT_EQ(plant.motor_force(), sign * 100.0);
  }
}

TEST(AxisPlant, AnExternalForceActsInItsOwnDirectionWithAndWithoutThePowerStage) {
  for (const bool enabled : {true, false}) {
    AxisPlant plant(timing, plain_axis(), 0.0, 1);
    plant.command({}, enabled);
    plant.set_external_force(-8.0);
    advance(plant, 160);
    EXPECT_NEAR(plant.velocity(), -8.0 / 4.0 * 160 * tick, 1e-14);
    plant.set_external_force(0.0);
    const double v = plant.velocity();
    advance(plant, 10);
    EXPECT_EQ(plant.velocity(), v);
  }
}

TEST(AxisPlant, WithoutFrictionTheWorkOfTheForcesIsTheKineticEnergy) {
  AxisPlant plant(timing, plain_axis(), 0.0, 1);
  double work = 0.0, before = 0.0;
  for (int n = 0; n < 4000; ++n) {
    const double u = 3.0 * std::sin(0.01 * n), external = 5.0 * std::cos(0.017 * n);
    plant.command({u, 0.0, 0.0}, true);
    plant.set_external_force(external);
    plant.advance_tick();
    work += (10.0 * u + external) * (plant.position() - before);
    before = plant.position();
    ASSERT_NEAR(work, 0.5 * 4.0 * plant.velocity() * plant.velocity(), 1e-12) << n;
  }
}

TEST(AxisPlant, FrictionForceIsTheRestOfTheBalanceAndOpposesTheMotion) {
  AxisPlant plant(timing, with_friction(acting<CoulombViscous<>>({6.0, 2.0})), 0.0, 1);
  plant.command({4.0, 0.0, 0.0}, true);
  advance(plant, 100);
  const double v = plant.velocity();
  ASSERT_GT(v, 0.0);
  EXPECT_NEAR(plant.friction_force(), 6.0 + 2.0 * v, 1e-9);  // m dv / h: 1e-17 m/s of rounding * 4 kg / 15.6 us
  plant.command({-4.0, 0.0, 0.0}, true);
  advance(plant, 400);
  ASSERT_LT(plant.velocity(), 0.0);
  EXPECT_NEAR(plant.friction_force(), -6.0 + 2.0 * plant.velocity(), 1e-9);
}

TEST(AxisPlant, StickingTheFrictionEqualsTheAppliedForceAndTheVelocityIsZeroToTheBit) {
  AxisPlant plant(timing, with_friction(acting<Classical<>>({20.0, 1.2, 0.0})), 0.1, 1);
  plant.command({1.5, 0.0, 0.0}, true);
  plant.set_external_force(8.0);
  advance(plant, 1000);
  EXPECT_EQ(plant.velocity(), 0.0);
  EXPECT_EQ(plant.position(), 0.1);
  EXPECT_EQ(plant.friction_force(), 23.0);
}

TEST(AxisPlant, SwitchedOffCoastsWithoutCurrentAndForce) {
  auto axis = plain_axis();
  axis.motor = {};
  axis.motor.model = machine::MotorModel::synchronous;
  axis.motor.phase_resistance = 1.8;
  axis.motor.phase_inductance = 18e-3;
  axis.motor.mutual_inductance = 1.8e-3;
  axis.motor.emf_constant = axis.motor.phase_force_constant = 62.8;
  axis.motor.force_constant = 94.2;
  axis.motor.pole_pair_pitch = 0.072;
  axis.inverter = {0.125e-3, 300.0, 40.0};
  AxisPlant plant(timing, axis, 0.0, 1);
  plant.command({0.0, 50.0, -50.0}, true);
  advance(plant, 50);
  ASSERT_NE(plant.velocity(), 0.0);
  ASSERT_NE(plant.current()[1], 0.0);
  plant.command({0.0, 50.0, -50.0}, false);
  EXPECT_EQ(plant.current(), PhaseValues{}) << "at once, not after the dead time";
  const double v = plant.velocity();
  advance(plant, 100);
  EXPECT_EQ(plant.velocity(), v);
  EXPECT_EQ(plant.motor_force(), 0.0);
}

TEST(AxisPlant, SwitchedOnAgainItDoesNotReplayVoltagesFromBefore) {
  auto axis = plain_axis();
  axis.inverter.dead_time = 3 * tick;
  AxisPlant plant(timing, axis, 0.0, 1);
  plant.command({5.0, 0.0, 0.0}, true);
  advance(plant, 2);  // still on their way
  plant.command({5.0, 0.0, 0.0}, false);
  plant.advance_tick();
  plant.command({}, true);
  advance(plant, 20);
  EXPECT_EQ(plant.velocity(), 0.0);
}

TEST(AxisPlant, UnknownFrictionModelIsRefused) {
  auto axis = plain_axis();
  axis.friction.use = "none_such";
  EXPECT_THROW(AxisPlant(timing, axis, 0.0, 1), std::invalid_argument);
}

TEST(EncoderParameters, ReadsTheNearestIncrement) {
  auto axis = plain_axis();
  axis.encoder.increment = 1e-6;
  for (const double x : {0.0, 0.4e-6, 0.6e-6, -0.4e-6, -0.6e-6, 0.1234567, -0.1234567}) {
    AxisPlant plant(timing, axis, x, 1);
    EXPECT_NEAR(plant.read_encoder(), 1e-6 * std::round(x / 1e-6), 1e-16) << x;
  }
}

TEST(EncoderParameters, WithoutIncrementAndNoiseReadsTheRider) {
  AxisPlant plant(timing, plain_axis(), 0.1234567890123, 1);
  EXPECT_EQ(plant.read_encoder(), 0.1234567890123);
  EXPECT_EQ(plant.encoder_velocity(), 0.0);
}

TEST(EncoderParameters, NoiseIsNormalOfTheGivenWidth) {
  auto axis = plain_axis();
  axis.encoder.noise = 3e-9;
  AxisPlant plant(timing, axis, 0.5, 20060);
  constexpr int n = 100000;
  double sum = 0.0, squares = 0.0, fourth = 0.0, lagged = 0.0, before = 0.0;
  for (int i = 0; i < n; ++i) {
    const double z = (plant.read_encoder() - 0.5) / 3e-9;
    sum += z;
    squares += z * z;
    fourth += z * z * z * z;
    lagged += z * before;
    before = z;
  }
  // Five standard errors of each moment; 0.5 m ends at 1.1e-16 m, 4e-8 of the width.
  EXPECT_NEAR(sum / n, 0.0, 5.0 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 1.0, 5.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(fourth / n, 3.0, 5.0 * std::sqrt(96.0 / n));
  EXPECT_NEAR(lagged / n, 0.0, 5.0 / std::sqrt(n)) << "white";
}

TEST(EncoderParameters, NoiseRepeatsWithItsSeedAndOnlyWithIt) {
  auto axis = plain_axis();
  axis.encoder.noise = 1e-9;
  AxisPlant a(timing, axis, 0.0, 7), b(timing, axis, 0.0, 7), c(timing, axis, 0.0, 8);
  int equal = 0;
  for (int i = 0; i < 100; ++i) {
    const double reading = a.read_encoder();
    EXPECT_EQ(reading, b.read_encoder());
    equal += reading == c.read_encoder();
  }
  EXPECT_EQ(equal, 0);
}

TEST(EncoderParameters, NoiseIsAddedBeforeTheIncrement) {
  auto axis = plain_axis();
  axis.encoder.increment = 1e-8;
  axis.encoder.noise = 3e-8;
  AxisPlant plant(timing, axis, 0.0, 5);
  for (int i = 0; i < 1000; ++i) {
    const double increments = plant.read_encoder() / 1e-8;
    ASSERT_NEAR(increments, std::round(increments), 1e-9);
  }
}

TEST(EncoderParameters, OnItsMountLagsAnAcceleratedCarriageByItsStaticDeflection) {
  auto axis = plain_axis();
  axis.encoder.mount = machine::EncoderMountParameters{0.5, 2000.0, 0.05};
  AxisPlant plant(timing, axis, 0.0, 1);
  plant.command({8.0, 0.0, 0.0}, true);  // 20 m/s^2
  advance(plant, 1000);                  // 62 ms, 39 decay constants
  const double w = 2.0 * 3.14159265358979323846 * 2000.0;
  EXPECT_NEAR(plant.encoder_position() - plant.position(), -20.0 / (w * w), 1e-15);
  EXPECT_NEAR(plant.encoder_velocity(), plant.velocity(), 1e-11);
}

}  // namespace
}  // namespace stiction::sim
