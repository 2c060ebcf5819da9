// Effects in what is measured: play in front of the encoder, delays in the loop. And the presliding curve.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/effects/presliding_hysteresis/presliding_hysteresis.hpp"
#include "sim/effects/time_skew/time_skew.hpp"
#include "tests/sim/effects/effect_plant.hpp"

namespace stiction::sim::test {
namespace {

machine::AxisModel with_play(double width) { return with_effects({{"backlash", {{"width", {width}}}}}); }

TEST(Backlash, TheEncoderFollowsHalfAWidthBehindAndLosesTheWidthAtAReversal) {
  AxisPlant plant(timing, with_play(10e-6), 0.2, 1);
  EXPECT_EQ(plant.encoder_position(), 0.2);
  const auto push = [&](double volt, int ticks) {
    for (int k = 0; k < ticks; ++k) {
      plant.command({volt, 0.0, 0.0}, true);
      plant.advance_tick();
    }
  };
  push(4.0, 800);
  EXPECT_GT(plant.position(), 0.2 + 10e-6);
  EXPECT_NEAR(plant.encoder_position(), plant.position() - 5e-6, 1e-15);
  EXPECT_NEAR(plant.encoder_velocity(), plant.velocity(), 1e-15);
  push(0.0, 8000);  // to rest
  ASSERT_EQ(plant.velocity(), 0.0);
  const double turn = plant.position(), seen = plant.encoder_position();
  while (plant.position() > turn - 9.9e-6) {
    push(-4.0, 1);
    if (plant.position() <= turn - 9.9e-6) break;
    ASSERT_NEAR(plant.encoder_position(), seen, 1e-15);
    ASSERT_NEAR(plant.encoder_velocity(), 0.0, 1e-15);
  }
  push(-4.0, 100);
  EXPECT_NEAR(plant.encoder_position(), plant.position() + 5e-6, 1e-15);
  EXPECT_NEAR(plant.encoder_velocity(), plant.velocity(), 1e-15);
}

TEST(Backlash, TheCarriageItselfFeelsNothingOfIt) {
  AxisPlant plain(timing, force_axis(), 0.0, 1), loose(timing, with_play(10e-6), 0.0, 1);
  for (int k = 0; k < 3200; ++k) {
    for (AxisPlant* plant : {&plain, &loose}) {
      plant->command({6.0 * std::sin(0.004 * k), 0.0, 0.0}, true);
      plant->advance_tick();
    }
    ASSERT_EQ(plain.position(), loose.position());
  }
}

// In front of a heavy body the motor is free until its contact closes: x = F t^2 / 2 (1 - r) M from the middle of the
// gap on, which takes 7.1 ms here. Contacts are forces between the two, so that all of the push is in both momenta.
TEST(Backlash, AMotorIsFreeInAGapInFrontOfAHeavyBodyAndThenTheTwoShareItsPush) {
  constexpr double width = 100e-6, ratio = 0.8, force = 10.0;
  auto axis = with_effects({{"backlash", {{"width", {width}}, {"mass_ratio", {ratio}}, {"frequency", {300.0}}}}});
  set_parameters<Classical<>>(axis.friction, {0.0, 1.0, 0.0});
  AxisPlant plant(timing, axis, 0.1, 1);
  const double in_front = (1.0 - ratio) * axis.mass, closes = std::sqrt(width * in_front / force);
  int ticks = 0;
  const auto push = [&] {
    plant.command({force / axis.motor.force_constant, 0.0, 0.0}, true);
    plant.advance_tick();
    ++ticks;
  };
  while ((ticks + 1) * tick < closes) {
    push();
    const double t = ticks * tick;
    ASSERT_EQ(plant.position(), 0.1);
    ASSERT_NEAR(plant.motor_position() - 0.1, 0.5 * force / in_front * t * t, 1e-9);
  }
  EXPECT_GT(ticks, 100);
  const double before = plant.motor_position();
  while (ticks < 4000) push();
  EXPECT_GT(plant.position(), 0.1);
  // Pushed together: ahead by half a width and what the force bends the contact.
  EXPECT_NEAR(plant.motor_position() - plant.position(), 0.5 * width, 2e-6);
  EXPECT_NEAR(plant.velocity(), force * ticks * tick / axis.mass, 1e-6);
  EXPECT_GT(plant.motor_position(), before);
}

TEST(Backlash, OfAHeavyBodyIsRefusedWhereTheAxisHasAShaftOrAMode) {
  const machine::Effect gap{"backlash", {{"width", {1e-6}}, {"mass_ratio", {0.5}}}};
  const machine::Effect mode{"structural_resonance",
                             {{"frequency", {200.0}}, {"damping_ratio", {0.1}}, {"mass_ratio", {0.5}}}};
  EXPECT_THROW(AxisPlant(timing, with_effects({gap, mode}), 0.0, 1), EffectError);
  auto shaft = with_effects({gap});
  shaft.transmission.emplace().stiffness = 1e7;
  shaft.motor_mass = 10.0;
  EXPECT_THROW(AxisPlant(timing, shaft, 0.0, 1), EffectError);
}

// Ticks until a force of 10 N/V, commanded at the first tick, has moved a free carriage as far as it would have from
// the end of the delay on: x = F (t - d)^2 / 2 m.
double delay_seen(double dead_time, double loop_delay) {
  machine::AxisModel axis = with_effects({{"time_skew", {{"loop_delay", {loop_delay}}}}});
  axis.friction = acting<CoulombViscous<>>({});
  axis.inverter.dead_time = dead_time;
  AxisPlant plant(timing, axis, 0.0, 1);
  constexpr int ticks = 160;
  for (int k = 0; k < ticks; ++k) {
    plant.command({1.0, 0.0, 0.0}, true);
    plant.advance_tick();
  }
  return ticks * tick - plant.velocity() * axis.mass / 10.0;
}

TEST(TimeSkew, TheLoopDelayComesOnTopOfTheDeadTimeWhetherItFitsThePlantsStepOrNot) {
  for (const double dead_time : {0.0, 125e-6, 15.625e-6})
    for (const double loop_delay : {0.0, 15.625e-6, 20e-6, 60e-6, 62.5e-6, 0.3e-3, 1.01e-3})
      EXPECT_NEAR(delay_seen(dead_time, loop_delay), dead_time + loop_delay, 1e-12) << dead_time << " " << loop_delay;
}

TEST(TimeSkew, TheDelayOfTheRecordLeavesThePlantAsItIs) {
  const machine::AxisModel axis = with_effects({{"time_skew", {{"delay", {1e-3}}}}});
  AxisPlant plain(timing, force_axis(), 0.0, 1), late(timing, axis, 0.0, 1);
  for (int k = 0; k < 800; ++k) {
    for (AxisPlant* plant : {&plain, &late}) {
      plant->command({6.0, 0.0, 0.0}, true);
      plant->advance_tick();
    }
    ASSERT_EQ(plain.position(), late.position());
    ASSERT_EQ(plain.current()[0], late.current()[0]);
  }
  EXPECT_EQ(record_delay(axis), 1e-3);
  EXPECT_EQ(record_delay(force_axis()), 0.0);
}

// First loading of the elements: every one follows until it slips.
double first_loading(const MaxwellSlipParameters& p, double way) {
  double force = 0.0;
  for (std::size_t i = 0; i < p.level.size(); ++i) force += std::min(p.stiffness[i] * way, p.level[i]);
  return force;
}

TEST(PreslidingHysteresis, TheElementsHaveTheStiffnessTheDistanceAndTheLevelAsked) {
  for (const double sharpness : {0.9, 0.95, 1.2, 2.302585092994046, 5.0, 20.0, 300.0}) {
    const double coulomb = 20.0, stiffness = 2e7, distance = sharpness * coulomb / stiffness;
    const auto p = presliding_elements(coulomb, stiffness, distance);
    EXPECT_NEAR(first_loading(p, 1e-6 * distance) / (1e-6 * distance), stiffness, 1e-6 * stiffness) << sharpness;
    EXPECT_NEAR(first_loading(p, distance), 0.9 * coulomb, 1e-6 * coulomb) << sharpness;
    EXPECT_NEAR(first_loading(p, 1.0), coulomb, 1e-9 * coulomb) << sharpness;
  }
}

TEST(PreslidingHysteresis, BetweenThemTheCurveIsThatOfDahl) {
  // Exponent 1 has a closed form: F = F_C (1 - exp(-k s / F_C)), at 90 % where k s = ln(10) F_C. The polygon of
  // tangents lies at most 2 % of F_C outside it, beyond 90 %.
  const double coulomb = 20.0, stiffness = 2e7;
  const auto p = presliding_elements(coulomb, stiffness, std::log(10.0) * coulomb / stiffness);
  for (double s = 0.0; s < 8e-6; s += 1e-8) {
    const double curve = coulomb * (1.0 - std::exp(-stiffness * s / coulomb));
    EXPECT_GE(first_loading(p, s), curve - 1e-6);
    EXPECT_LE(first_loading(p, s), curve + 0.02 * coulomb) << s;
  }
}

TEST(PreslidingHysteresis, ReplacesTheModelInUseAndKeepsItsSteadyFriction) {
  for (const char* model : {"coulomb_viscous", "classical", "linear_ramp", "lugre", "maxwell_slip"}) {
    machine::AxisModel axis = with_effects({{"presliding_hysteresis", {{"stiffness", {1e7}}, {"distance", {5e-6}}}}});
    axis.friction.use = model;
    EXPECT_EQ(plant_axis(axis).friction.use, "maxwell_slip");
    EXPECT_NEAR(force_at(axis, 0.1), 20.0 + 100.0 * 0.1, 2e-3) << model;
  }
}

TEST(PreslidingHysteresis, TakesTheTrueCoulombLevelWhereverThatStandsInTheFile) {
  machine::AxisModel axis = with_effects({{"presliding_hysteresis", {{"stiffness", {1e7}}, {"distance", {5e-6}}}},
                                          {"coulomb_mismatch", {{"coulomb", {25.0}}}}});
  EXPECT_NEAR(force_at(axis, 0.1), 25.0 + 100.0 * 0.1, 2e-3);
}

TEST(PreslidingHysteresis, WithADistanceAloneTheLawStaysAndItsContactIsDrawnOut) {
  for (const char* model : {"lugre", "maxwell_slip"}) {
    machine::AxisModel axis = with_effects({{"presliding_hysteresis", {{"distance", {40e-6}}}}});
    axis.friction.use = model;
    const auto friction = plant_axis(axis).friction;
    EXPECT_EQ(friction.use, model);
    EXPECT_NEAR(contact_of(friction)->distance, 40e-6, 1e-9) << model;
    EXPECT_NEAR(coulomb_of(friction), coulomb_of(axis.friction), 1e-12) << model;
  }
}

// From rest the force of both parts rises as 1 - 10^(-x / distance), each to its share of the level: an exponential
// contact and, in parallel, the polygon of tangents of one, which lies up to 2 % of its level outside.
TEST(PreslidingHysteresis, OfAShareAddsUpWithTheRestOfTheFriction) {
  constexpr double level = 20.0, own = 10e-6, of_share = 200e-6, share = 0.3, speed = 200e-6;
  auto axis = with_effects({{"presliding_hysteresis", {{"distance", {of_share}}, {"share", {share}}}}});
  axis.friction.use = "lugre";
  set_parameters<LuGre<>>(axis.friction, {level, 1.0, 0.0, 0.01, level * std::log(10.0) / own, 0.0});
  AxisPlant plant(timing, axis, 0.0, 1);
  double set = 0.0;
  for (int k = 0; set < 2.0 * of_share; ++k) {
    set += speed * tick;
    const double force = 4e6 * (set - plant.position()) + 2e4 * (speed - plant.velocity());
    plant.command({force / axis.motor.force_constant, 0.0, 0.0}, true);
    plant.advance_tick();
    const auto loaded = [&](double distance) { return 1.0 - std::pow(10.0, -plant.position() / distance); };
    const double textbook = level * ((1.0 - share) * loaded(own) + share * loaded(of_share));
    ASSERT_NEAR(plant.friction_force(), textbook, 0.02 * share * level + 0.05) << plant.position();
  }
}

TEST(PreslidingHysteresis, OfAShareKeepsTheSteadyFrictionOfEachLaw) {
  for (const char* model : {"coulomb_viscous", "classical", "lugre", "maxwell_slip"}) {
    machine::AxisModel axis = with_effects({{"presliding_hysteresis", {{"distance", {5e-6}}, {"share", {0.25}}}}});
    axis.friction.use = model;
    EXPECT_EQ(plant_axis(axis).friction.use, model);
    EXPECT_NEAR(force_at(axis, 0.1), 20.0 + 100.0 * 0.1, 2e-3) << model;
  }
}

TEST(PreslidingHysteresis, OfAShareIsRefusedWhereItsStiffnessAndDistanceDoNotReachItsLevel) {
  const auto with_stiffness = [](double stiffness) {
    return with_effects(
        {{"presliding_hysteresis", {{"stiffness", {stiffness}}, {"distance", {5e-6}}, {"share", {0.25}}}}});
  };
  EXPECT_THROW(plant_axis(with_stiffness(0.8 * 5.0 / 5e-6)), EffectError);
  EXPECT_NO_THROW(plant_axis(with_stiffness(1.0 * 5.0 / 5e-6)));
}

TEST(PreslidingHysteresis, TheParabolicModelHasNoCoulombLevelForIt) {
  machine::AxisModel axis = with_effects({{"presliding_hysteresis", {{"stiffness", {1e7}}, {"distance", {5e-6}}}}});
  axis.friction.use = "parabolic";
  EXPECT_THROW(plant_axis(axis), EffectError);
}

}  // namespace
}  // namespace stiction::sim::test
