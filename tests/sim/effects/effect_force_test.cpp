// What each effect puts on the carriage, against its definition (its page), with its signs. The carriage is held at
// constant speed by a servo whose mean force is that of the resistance within 1e-4 N.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tuple>

#include "sim/effects/force_ripple/force_ripple.hpp"
#include "sim/effects/friction_asymmetry/friction_asymmetry.hpp"
#include "sim/effects/given_force.hpp"
#include "sim/effects/stribeck/stribeck.hpp"
#include "sim/effects/viscous_nonlinear/viscous_nonlinear.hpp"
#include "tests/sim/effects/effect_plant.hpp"

namespace stiction::sim::test {
namespace {

constexpr double servo = 2e-3;  // N

machine::Effect one(const std::string& name, machine::KeyedValues values) { return {name, std::move(values)}; }

TEST(EffectForce, AConstantForcePushesTowardsPlusXInBothDirections) {
  const machine::AxisModel axis = with_effects({one("constant_force", {{"force", {7.0}}})});
  for (const double v : {0.05, -0.05}) EXPECT_NEAR(effect_force(axis, v), 7.0, servo) << v;
}

TEST(EffectForce, AConstantForceMovesAFreeCarriageTowardsPlusX) {
  machine::AxisModel axis = with_effects({one("constant_force", {{"force", {7.0}}})});
  axis.friction = acting<CoulombViscous<>>({});
  AxisPlant plant(timing, axis, 0.0, 1);
  for (int k = 0; k < 16000; ++k) plant.advance_tick();
  EXPECT_NEAR(plant.velocity(), 7.0 / 50.0, 1e-9);  // F t / m after 1 s
}

TEST(EffectForce, ASpringPullsTowardsItsNeutralPosition) {
  const machine::AxisModel axis = with_effects({one("position_spring", {{"stiffness", {120.0}}, {"neutral", {0.1}}})});
  // At 0.3 m, moving 12.5 mm while it is measured and as much before.
  for (const double v : {0.05, -0.05}) {
    const double mean_position = 0.3 + v * 1.5 * 4000 * tick;
    EXPECT_NEAR(effect_force(axis, v, 0.3), -120.0 * (mean_position - 0.1), servo + 1e-2) << v;
  }
  EXPECT_LT(effect_force(axis, 0.05, 0.3), 0.0);
  EXPECT_GT(effect_force(axis, 0.05, -0.3), 0.0);
}

TEST(GivenForce, ActsAsTheEffectOfTheSameEquationWhileItIsThere) {
  machine::AxisModel axis = with_effects({}), twin = axis;
  twin.effects.push_back(one("position_spring", {{"stiffness", {120.0}}, {"neutral", {0.1}}}));
  {
    const GivenForce spring([](const CarriageState& s) { return -120.0 * (s.position - 0.1); });
    axis.effects.push_back(spring.effect());
    const GivenForce other([](const CarriageState&) { return 1.0; });  // which the axis does not have
    AxisPlant given(timing, axis, 0.3, 1), built_in(timing, twin, 0.3, 1);
    for (int k = 0; k < 1000; ++k) {
      given.advance_tick();
      built_in.advance_tick();
      ASSERT_EQ(given.velocity(), built_in.velocity()) << k;
    }
    EXPECT_LT(given.velocity(), 0.0);
  }
  EXPECT_THROW(AxisPlant(timing, axis, 0.3, 1), EffectError);
}

TEST(EffectForce, ARippleFollowsItsHarmonicsInPosition) {
  const ForceRipple ripple({0.072, {3.0, -1.0, 0.5}, {0.4, 2.0, -0.25}}, {50.0, 1e-5});
  for (int k = -50; k <= 50; ++k) {
    const double x = 0.0037 * k, a = 2.0 * std::numbers::pi * x / 0.072;
    const double expected = 3.0 * std::cos(a) + 0.4 * std::sin(a) - std::cos(2 * a) + 2.0 * std::sin(2 * a) +
                            0.5 * std::cos(3 * a) - 0.25 * std::sin(3 * a);
    EXPECT_NEAR(ripple.force({x, 0.1, 1.0}), expected, 1e-12);
  }
}

TEST(EffectForce, ARippleActsOnTheCarriageWithItsSign) {
  // While it is measured the carriage creeps on by 0.25 to 0.5 mm, over which the ripple is straight within 1e-3 N.
  const machine::AxisModel axis =
      with_effects({one("force_ripple", {{"pitch", {0.072}}, {"cosine", {3.0}}, {"sine", {2.0}}})});
  for (const double start : {0.072, 0.018, -0.05}) {
    const double angle = 2.0 * std::numbers::pi * (start + 1e-3 * 1.5 * 4000 * tick) / 0.072;
    EXPECT_NEAR(effect_force(axis, 1e-3, start), 3.0 * std::cos(angle) + 2.0 * std::sin(angle), servo + 1e-3) << start;
  }
}

TEST(EffectForce, FrictionThatRisesLessThanLinearlyOpposesTheMotion) {
  const machine::AxisModel axis = with_effects({one("viscous_nonlinear", {{"force", {12.0}}, {"velocity", {0.05}}})});
  for (const double v : {0.01, 0.05, 0.2}) {
    const double friction = 12.0 * (1.0 - std::exp(-v / 0.05));
    EXPECT_NEAR(effect_force(axis, v), -friction, servo) << v;
    EXPECT_NEAR(effect_force(axis, -v), friction, servo) << v;
  }
}

TEST(EffectForce, FrictionOfTheLoadIsItsShareOfTheWeightInBothDirections) {
  machine::AxisModel axis = with_effects({one("load_dependent_friction", {{"coefficient", {0.2}}})});
  EXPECT_NEAR(effect_force(axis, 0.05), 0.0, servo);  // nothing to carry
  axis.gravity.emplace();
  axis.gravity->force = 60.0;
  axis.gravity->counterweight = 20.0;
  for (const double v : {0.05, -0.05}) EXPECT_NEAR(effect_force(axis, v), v > 0.0 ? -8.0 : 8.0, servo) << v;
}

// F = m a + c m_load a: what is in front of the teeth is accelerated without them.
TEST(EffectForce, FrictionOfTheLoadGrowsWithTheForceThatAcceleratesIt) {
  machine::AxisModel axis = with_effects({one("load_dependent_friction", {{"coefficient", {0.2}}})});
  axis.friction = acting<CoulombViscous<>>({});
  axis.motor_mass = 10.0;  // of 50 kg
  AxisPlant plant(timing, axis, 0.0, 1);
  for (int k = 0; k < 8000; ++k) {
    plant.command({3.0, 0.0, 0.0}, true);  // 30 N
    plant.advance_tick();
  }
  const double before = plant.velocity();
  for (int k = 0; k < 8000; ++k) plant.advance_tick();
  EXPECT_NEAR((plant.velocity() - before) / (8000 * tick), 30.0 / (50.0 + 0.2 * 40.0), 1e-6);
}

TEST(EffectForce, StribeckFrictionFallsWithSpeedAndOpposesTheMotion) {
  const machine::AxisModel axis = with_effects({one("stribeck", {{"break_away", {9.0}}, {"velocity", {0.02}}})});
  for (const double v : {0.002, 0.02, 0.03, 0.2}) {
    const double friction = 9.0 * std::exp(-(v / 0.02) * (v / 0.02));
    EXPECT_NEAR(effect_force(axis, v), -friction, servo) << v;
    EXPECT_NEAR(effect_force(axis, -v), friction, servo) << v;
  }
}

TEST(EffectForce, APositiveAsymmetryIsMoreFrictionInPlusXAndLessInMinusX) {
  const machine::AxisModel axis = with_effects({one("friction_asymmetry", {{"coulomb", {4.0}}, {"viscous", {30.0}}})});
  const machine::AxisModel plain = force_axis();
  for (const double v : {0.01, 0.1}) {
    EXPECT_NEAR(force_at(axis, v), (20.0 + 4.0) + (100.0 + 30.0) * v, servo) << v;
    EXPECT_NEAR(force_at(axis, -v), -((20.0 - 4.0) + (100.0 - 30.0) * v), servo) << v;
    EXPECT_NEAR(force_at(plain, v), 20.0 + 100.0 * v, servo) << v;
  }
}

TEST(EffectForce, TheFrictionForceOfThePlantHoldsFrictionEffectsButNoOthers) {
  const machine::AxisModel axis =
      with_effects({one("friction_asymmetry", {{"coulomb", {4.0}}}), one("constant_force", {{"force", {50.0}}})});
  AxisPlant plant(timing, axis, 0.0, 1);
  for (int k = 0; k < 4000; ++k) plant.advance_tick();
  EXPECT_GT(plant.velocity(), 0.01);
  EXPECT_NEAR(plant.friction_force(), 24.0 + 100.0 * plant.velocity(), 1e-6);
}

class Mismatch : public testing::TestWithParam<const char*> {
 protected:
  machine::AxisModel axis_with(std::vector<machine::Effect> effects) const {
    machine::AxisModel axis = with_effects(std::move(effects));
    axis.friction.use = GetParam();
    return axis;
  }
  bool is_parabolic() const { return std::string(GetParam()) == "parabolic"; }
};

TEST_P(Mismatch, OfCoulombShiftsEverySteadyFrictionByItsDifference) {
  const double change = is_parabolic() ? 26.0 : 26.0 - 20.0;  // the root law has no Coulomb level in the file
  const machine::AxisModel axis = axis_with({one("coulomb_mismatch", {{"coulomb", {26.0}}})});
  // The break speed of the linear ramp rises with the level: mu_v (v - v_0) falls by as much.
  const double ramp = std::string(GetParam()) == "linear_ramp" ? 100.0 * 6.0 / 12000.0 : 0.0;
  for (const double v : {0.05, 0.2}) {
    EXPECT_NEAR(effect_force(axis, v), -change + ramp, servo) << v;
    EXPECT_NEAR(effect_force(axis, -v), change - ramp, servo) << v;
  }
}

TEST_P(Mismatch, OfViscousFrictionChangesEverySlope) {
  const machine::AxisModel axis = axis_with({one("viscous_mismatch", {{"viscous", {140.0}}})});
  const double before = is_parabolic() ? 0.0 : 100.0;
  const double break_velocity = std::string(GetParam()) == "linear_ramp" ? 20.0 / 12000.0 : 0.0;
  for (const double v : {0.05, 0.2})
    EXPECT_NEAR(effect_force(axis, v), -(140.0 - before) * (v - break_velocity), servo) << v;
}

INSTANTIATE_TEST_SUITE_P(EveryFrictionModel, Mismatch,
                         testing::Values("coulomb_viscous", "classical", "linear_ramp", "parabolic", "lugre",
                                         "maxwell_slip"),
                         [](const auto& model) { return std::string(model.param); });

TEST(MassMismatch, AcceleratesByTheTrueMass) {
  machine::AxisModel axis = with_effects({one("mass_mismatch", {{"mass", {40.0}}})});
  axis.friction = acting<CoulombViscous<>>({});
  AxisPlant plant(timing, axis, 0.0, 1);
  plant.command({1.0, 0.0, 0.0}, true);
  for (int k = 0; k < 1600; ++k) plant.advance_tick();
  EXPECT_NEAR(plant.velocity(), 10.0 / 40.0 * 0.1, 1e-12);
}

TEST(EffectForce, EffectsAddUp) {
  const machine::AxisModel axis =
      with_effects({one("constant_force", {{"force", {7.0}}}), one("constant_force", {{"force", {-3.0}}}),
                    one("stribeck", {{"break_away", {9.0}}, {"velocity", {1.0}}})});
  EXPECT_NEAR(effect_force(axis, 0.05), 4.0 - 9.0 * std::exp(-0.05 * 0.05), servo);
}

// No effect may move a carriage that stands, or keep it moving: after a push it comes to rest and stays.
TEST(EffectForce, AtStandstillNothingChatters) {
  const std::vector<machine::Effect> effects{one("stribeck", {{"break_away", {15.0}}, {"velocity", {1e-3}}}),
                                             one("friction_asymmetry", {{"coulomb", {8.0}}, {"viscous", {50.0}}}),
                                             one("viscous_nonlinear", {{"force", {30.0}}, {"velocity", {1e-9}}})};
  for (const auto& effect : effects)
    for (const char* model : {"classical", "linear_ramp", "parabolic", "lugre", "maxwell_slip"}) {
      machine::AxisModel axis = with_effects({effect});
      axis.friction.use = model;
      AxisPlant plant(timing, axis, 0.0, 1);
      plant.set_external_force(60.0);
      for (int k = 0; k < 800; ++k) plant.advance_tick();
      plant.set_external_force(0.0);
      // The contact springs of lugre and maxwell_slip leave it swinging at 200 rad/s, damped by the viscous friction
      // alone: 1/e in a second.
      for (int k = 0; k < 160000; ++k) plant.advance_tick();
      const double rest = plant.position();
      double fastest = 0.0;
      for (int k = 0; k < 1600; ++k) {
        plant.advance_tick();
        fastest = std::max(fastest, std::abs(plant.velocity()));
      }
      // Two models hold nothing at standstill and creep under the 8 N of the asymmetry as under any force: the linear
      // ramp at 8 N / (12000 - 50) N s/m, the parabolic one at (8 N / 300 N)^3 m/s.
      const bool asymmetric = effect.name == "friction_asymmetry";
      const bool creeps = asymmetric && (std::string(model) == "linear_ramp" || std::string(model) == "parabolic");
      const double allowed = creeps ? 0.68e-3 : 1e-6;
      EXPECT_LT(fastest, allowed) << effect.name << " with " << model;
      EXPECT_LT(std::abs(plant.position() - rest), allowed * 0.1) << effect.name << " with " << model;
    }
}

// Pushed to and fro by less than friction, over many cycles, no friction effect gives more work than it takes.
TEST(EffectForce, FrictionEffectsTakeWorkOverEveryCycleOfMotion) {
  const Body body{50.0, tick / 4.0};
  const Stribeck stribeck({9.0, 0.02}, body);
  const ViscousNonlinear nonlinear({12.0, 0.05}, body);
  const FrictionAsymmetry asymmetry({4.0, 0.0}, body);
  for (const double amplitude : {0.1e-6, 1e-6, 20e-6, 1e-3}) {
    SlidingDirection direction;
    double work_stribeck = 0.0, work_nonlinear = 0.0, work_asymmetry = 0.0;
    const double w = 2.0 * std::numbers::pi * 10.0;
    const int cycle = static_cast<int>(std::lround(0.1 / body.step));
    for (int k = 0; k < 20 * cycle; ++k) {
      const double t = k * body.step, v = amplitude * w * std::cos(w * t);
      const CarriageState state{amplitude * std::sin(w * t), v, direction.advance(v, body.step)};
      if (k < 10 * cycle) continue;  // until the cycle repeats
      work_stribeck += stribeck.force(state) * v * body.step;
      work_nonlinear += nonlinear.force(state) * v * body.step;
      work_asymmetry += asymmetry.force(state) * v * body.step;
    }
    EXPECT_LT(work_stribeck, 0.0) << amplitude;
    EXPECT_LT(work_nonlinear, 0.0) << amplitude;
    EXPECT_NEAR(work_asymmetry, 0.0, 1e-3 * 4.0 * amplitude) << amplitude;
  }
}

TEST(PlantWithoutEffects, IsToTheBitThatWithAnEffectOfNoStrength) {
  for (const char* model : {"coulomb_viscous", "classical", "linear_ramp", "parabolic", "lugre", "maxwell_slip"}) {
    machine::AxisModel plain = force_axis();
    plain.friction.use = model;
    plain.encoder.mount = machine::EncoderMountParameters{0.5, 2000.0, 0.05};
    const machine::AxisModel none =
        with_effects({one("constant_force", {{"force", {0.0}}}), one("backlash", {{"width", {0.0}}})}, plain);
    AxisPlant a(timing, plain, 0.1, 1), b(timing, none, 0.1, 1);
    for (int k = 0; k < 3200; ++k) {
      const double u = 8.0 * std::sin(0.01 * k);
      for (AxisPlant* plant : {&a, &b}) {
        plant->command({u, 0.0, 0.0}, true);
        plant->advance_tick();
      }
      ASSERT_EQ(a.position(), b.position()) << model << k;
      ASSERT_EQ(a.velocity(), b.velocity()) << model << k;
      ASSERT_EQ(a.friction_force(), b.friction_force()) << model << k;
      ASSERT_NEAR(a.encoder_position(), b.encoder_position(), 1e-16) << model << k;
    }
  }
}

}  // namespace
}  // namespace stiction::sim::test
