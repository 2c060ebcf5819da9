// Effects that depend on place, time, current and the speed's past, and the error of what the encoder reads, each
// against a closed form of its definition (its page).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "sim/effects/force_map/force_map.hpp"
#include "sim/effects/position_dependent_friction/position_dependent_friction.hpp"
#include "sim/effects/thermal_drift/thermal_drift.hpp"
#include "tests/sim/effects/effect_plant.hpp"

namespace stiction::sim::test {
namespace {

constexpr double servo = 2e-3;  // N
constexpr double pi = std::numbers::pi;

machine::AxisModel frictionless(std::vector<machine::Effect> effects) {
  machine::AxisModel axis = with_effects(std::move(effects));
  axis.friction = acting<CoulombViscous<>>({});
  return axis;
}

// Moves on by `ticks` under a constant motor force of 10 N/V.
void push(AxisPlant& plant, double volt, int ticks) {
  for (int k = 0; k < ticks; ++k) {
    plant.command({volt, 0.0, 0.0}, true);
    plant.advance_tick();
  }
}

TEST(PositionDependentFriction, IsLinearBetweenItsPositionsConstantOutsideAndOpposesTheMotion) {
  const machine::AxisModel axis =
      with_effects({{"position_dependent_friction", {{"position", {0.1, 0.2, 0.4}}, {"force", {2.0, 8.0, -4.0}}}}});
  const auto level = [](double x) {
    return x < 0.1 ? 2.0 : x < 0.2 ? 2.0 + 6.0 * (x - 0.1) / 0.1 : x < 0.4 ? 8.0 - 12.0 * (x - 0.2) / 0.2 : -4.0;
  };
  // While it is measured the carriage creeps on by 0.25 to 0.5 mm.
  for (const double start : {0.0, 0.12, 0.19, 0.3, 0.45})
    for (const double v : {1e-3, -1e-3}) {
      const double expected = -level(start + v * 1.5 * 4000 * tick);
      EXPECT_NEAR(effect_force(axis, v, start), v > 0 ? expected : -expected, servo + 1e-3) << start << " " << v;
    }
}

TEST(PositionDependentFriction, RefusesListsThatAreNoProfile) {
  using P = PositionDependentFriction::Parameters;
  EXPECT_THROW(PositionDependentFriction::check(P{{}, {}}), EffectError);
  EXPECT_THROW(PositionDependentFriction::check(P{{0.0, 0.1}, {1.0}}), EffectError);
  EXPECT_THROW(PositionDependentFriction::check(P{{0.1, 0.1}, {1.0, 2.0}}), EffectError);
  EXPECT_NO_THROW(PositionDependentFriction::check(P{{0.1}, {1.0}}));
}

TEST(ForceMap, IsBilinearBetweenItsPlacesAndConstantBeyondThem) {
  const ForceMap::Parameters p{{0.1, 0.3}, {-0.2, 0.2}, {1.0, 5.0, -3.0, 9.0}};
  const ForceMap map(p, {50.0, 1e-5});
  const auto bilinear = [](double x, double v) {
    const double a = std::clamp((x - 0.1) / 0.2, 0.0, 1.0), b = std::clamp((v + 0.2) / 0.4, 0.0, 1.0);
    return (1.0 - a) * (1.0 - b) * 1.0 + (1.0 - a) * b * 5.0 + a * (1.0 - b) * -3.0 + a * b * 9.0;
  };
  for (const double x : {0.0, 0.1, 0.17, 0.3, 0.5})
    for (const double v : {-0.4, -0.2, -0.05, 0.1, 0.4}) {
      EXPECT_NEAR(map.at(x, v), bilinear(x, v), 1e-12) << x << " " << v;
      // Sliding either way, the direction is that of the velocity.
      EXPECT_NEAR(map.force({x, v, std::copysign(1.0, v)}), bilinear(x, v), 1e-12) << x << " " << v;
    }
}

TEST(ForceMap, TurnsFromOneDirectionToTheOtherWithTheContact) {
  const ForceMap map({{0.0}, {-1e-6, 1e-6}, {4.0, -4.0}}, {50.0, 1e-5});
  for (const double direction : {-1.0, -0.5, 0.0, 0.25, 1.0})
    EXPECT_NEAR(map.force({0.0, 0.0, direction}), 0.0, 1e-12) << "linear through standstill";
  for (const double direction : {-1.0, -0.5, 0.0, 0.25, 1.0})
    EXPECT_NEAR(map.force({0.0, 1e-3, direction}), -4.0 * direction, 1e-12) << direction;
}

TEST(ForceMap, ActsOnTheCarriageOfThePlant) {
  const machine::AxisModel axis =
      with_effects({{"force_map", {{"position", {-1.0, 1.0}}, {"velocity", {0.0}}, {"force", {-6.0, 6.0}}}}});
  for (const double start : {-0.5, 0.0, 0.25})
    for (const double v : {1e-3, -1e-3})
      EXPECT_NEAR(effect_force(axis, v, start), 6.0 * (start + v * 1.5 * 4000 * tick), servo + 1e-3) << start << v;
}

TEST(ForceMap, RefusesListsThatAreNoTable) {
  using P = ForceMap::Parameters;
  EXPECT_THROW(ForceMap::check(P{{}, {0.0}, {}}), EffectError);
  EXPECT_THROW(ForceMap::check(P{{0.0, 0.1}, {0.0}, {1.0}}), EffectError);
  EXPECT_THROW(ForceMap::check(P{{0.1, 0.1}, {0.0}, {1.0, 2.0}}), EffectError);
  EXPECT_THROW(ForceMap::check(P{{0.0}, {0.1, -0.1}, {1.0, 2.0}}), EffectError);
  EXPECT_NO_THROW(ForceMap::check(P{{0.0, 0.1}, {-0.1, 0.1}, {1.0, 2.0, 3.0, 4.0}}));
}

TEST(ThermalDrift, ApproachesItsChangeWithItsTimeConstantAndOpposesTheMotion) {
  const double change = 6.0, time = 0.4;
  const machine::AxisModel axis = with_effects({{"thermal_drift", {{"change", {change}}, {"time_constant", {time}}}}});
  // Mean from t1 to t2 of change (1 - e^(-t/time)).
  const double t1 = 4000 * tick, t2 = 8000 * tick;
  const double mean = change * (1.0 - time * (std::exp(-t1 / time) - std::exp(-t2 / time)) / (t2 - t1));
  // The servo follows a friction that moves on by 6 N/s with the 0.1 s of its integral's slowness: 0.02 N in the mean.
  EXPECT_NEAR(effect_force(axis, 0.05), -mean, 0.03);
  EXPECT_NEAR(effect_force(axis, -0.05), mean, 0.03);
  const ThermalDrift drift({change, time}, {50.0, 1e-5});
  for (const double t : {0.0, 0.1, 0.4, 3.0})
    EXPECT_NEAR(drift.force({0.0, 0.1, 1.0, t, 0.0}), -change * (1.0 - std::exp(-t / time)), 1e-12);
}

TEST(PeriodicDisturbance, MovesAFreeCarriageAsItsIntegral) {
  const double f = 7.0, c = 3.0, s = -2.0, w = 2.0 * pi * f;
  AxisPlant plant(
      timing, frictionless({{"periodic_disturbance", {{"frequency", {f}}, {"cosine", {c}}, {"sine", {s}}}}}), 0.0, 1);
  for (int k = 1; k <= 3200; ++k) {
    plant.advance_tick();
    const double t = k * tick;
    const double v = (c * std::sin(w * t) + s * (1.0 - std::cos(w * t))) / (w * 50.0);
    // The force is held over steps of 15.6 us: half a step late, 2 pi 7 Hz times 7.8 us = 3.4e-4, of each amplitude.
    ASSERT_NEAR(plant.velocity(), v, 3.5e-4 * 2.0 * std::hypot(c, s) / (w * 50.0)) << t;
  }
}

TEST(ForceConstantRipple, GivesTheCarriageTheWorkOfTheRippledForce) {
  const double pitch = 0.01, c = 0.2, s = -0.1, c2 = 0.05, force = 10.0;
  const machine::AxisModel axis =
      frictionless({{"force_constant_ripple", {{"pitch", {pitch}}, {"cosine", {c, c2}}, {"sine", {s, 0.0}}}}});
  AxisPlant plant(timing, axis, 0.0, 1);
  for (int k = 0; k < 400; ++k) {
    push(plant, force / 10.0, 20);
    const double x = plant.position(), a = 2.0 * pi / pitch;
    const double work =
        force * (x + c / a * std::sin(a * x) + c2 / (2 * a) * std::sin(2 * a * x) + s / a * (1.0 - std::cos(a * x)));
    ASSERT_NEAR(0.5 * 50.0 * plant.velocity() * plant.velocity(), work, 2e-3 * work) << x;
    EXPECT_EQ(plant.motor_force(), force);  // what the current shows has no ripple
  }
}

TEST(FrictionLag, IsNothingAtConstantSpeed) {
  for (const char* model : {"coulomb_viscous", "classical", "linear_ramp", "lugre", "maxwell_slip"}) {
    machine::AxisModel axis = with_effects({{"friction_lag", {{"time", {5e-3}}}}});
    axis.friction.use = model;
    EXPECT_NEAR(effect_force(axis, 0.05), 0.0, servo) << model;
  }
}

// m v' = F - mu w, time w' = v - w: a carriage pushed from rest overshoots F/mu as a second-order system does.
TEST(FrictionLag, LetsViscousFrictionFollowTheSpeedAsAFirstOrderLag) {
  const double time = 0.2, mu = 800.0, force = 8.0;
  machine::AxisModel axis = frictionless({{"friction_lag", {{"time", {time}}}}});
  set_viscous(axis.friction, mu);
  AxisPlant plant(timing, axis, 0.0, 1);
  const double decay = 0.5 / time;
  const auto turn = std::sqrt(std::complex<double>(mu / (50.0 * time) - decay * decay)).real();
  double highest = 0.0;
  for (int k = 1; k <= 8000; ++k) {
    push(plant, force / 10.0, 1);
    const double t = k * tick, e = std::exp(-decay * t);
    // w is of second order with standstill at first; v = w + time w'.
    const double w = 1.0 - e * (std::cos(turn * t) + decay / turn * std::sin(turn * t));
    const double rate = e * (decay * decay / turn + turn) * std::sin(turn * t);
    ASSERT_NEAR(plant.velocity(), force / mu * (w + time * rate), 2e-3 * force / mu) << t;
    highest = std::max(highest, plant.velocity());
  }
  EXPECT_GT(highest, 1.2 * force / mu);
}

TEST(FrictionLag, ACarriageThatStandsStaysWhereItIs) {
  for (const char* model : {"classical", "linear_ramp", "parabolic", "lugre", "maxwell_slip"}) {
    // The contact springs of lugre and maxwell_slip swing at 200 rad/s, damped by the viscous friction, which a lag
    // of 1 ms lets through.
    machine::AxisModel axis = with_effects({{"friction_lag", {{"time", {1e-3}}}}});
    axis.friction.use = model;
    AxisPlant plant(timing, axis, 0.0, 1);
    push(plant, 6.0, 800);
    push(plant, 0.0, 160000);
    const double rest = plant.position();
    push(plant, 0.0, 1600);
    EXPECT_LT(std::abs(plant.position() - rest), 1e-7) << model;
  }
}

TEST(EncoderSubdivisionError, IsReadOnTopOfThePositionAndItsSpeed) {
  const double period = 20e-6, c = 60e-9, s = -25e-9, c2 = 30e-9, a = 2.0 * pi / period;
  const machine::AxisModel axis =
      with_effects({{"encoder_subdivision_error", {{"period", {period}}, {"cosine", {c, c2}}, {"sine", {s, 0.0}}}}});
  const auto error = [&](double x) { return c * std::cos(a * x) + s * std::sin(a * x) + c2 * std::cos(2 * a * x); };
  AxisPlant plain(timing, force_axis(), 0.2, 1), plant(timing, axis, 0.2, 1);
  EXPECT_NEAR(plant.encoder_position(), 0.2 + error(0.2), 1e-15);
  for (int k = 0; k < 400; ++k) {
    push(plant, 4.0, 1);
    push(plain, 4.0, 1);
    const double x = plant.position();
    ASSERT_EQ(x, plain.position());  // the carriage itself feels nothing of it
    ASSERT_NEAR(plant.encoder_position(), x + error(x), 1e-15);
    const double slope = -a * c * std::sin(a * x) + a * s * std::cos(a * x) - 2 * a * c2 * std::sin(2 * a * x);
    ASSERT_NEAR(plant.encoder_velocity(), plant.velocity() * (1.0 + slope), 1e-12);
  }
}

}  // namespace
}  // namespace stiction::sim::test
