// Effects between the drive's voltage and the carriage: force constant, saturation, elastic mode; those of the other
// axis and of the drive's own gains.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/configuration/double_signals.hpp"
#include "hal/simulated/simulated_backend.hpp"
#include "sim/effects/force_saturation/force_saturation.hpp"
#include "tests/sim/effects/effect_plant.hpp"

namespace stiction::sim::test {
namespace {

machine::AxisModel frictionless(machine::AxisModel axis) {
  axis.friction = acting<CoulombViscous<>>({});
  return axis;
}

// Motor force (N) after `volt` has been commanded for a while.
double force_of_voltage(const machine::AxisModel& axis, double volt) {
  AxisPlant plant(timing, axis, 0.0, 1);
  for (int k = 0; k < 4; ++k) {
    plant.command({volt, 0.0, 0.0}, true);
    plant.advance_tick();
  }
  return plant.motor_force();
}

TEST(ForceConstantMismatch, TheMotorHasTheTrueConstantAndTheDriveKeepsTheFiles) {
  machine::AxisModel axis = with_effects({{"force_constant_mismatch", {{"force_constant", {11.0}}}}});
  EXPECT_NEAR(force_of_voltage(axis, 2.0), 22.0, 1e-12);
  EXPECT_EQ(drive_axis(axis).motor.force_constant, 10.0);
}

TEST(ForceConstantMismatch, OfThreeWindingsTheWholeMotorHasItAndTheEmfFollows) {
  machine::AxisModel axis = force_axis();
  axis.motor.model = machine::MotorModel::synchronous;
  axis.motor.phase_force_constant = 62.8;
  axis.motor.emf_constant = 60.0;
  axis.motor.force_constant = 94.0;
  axis.effects = {{"force_constant_mismatch", {{"force_constant", {1.5 * 64.0}}}}};
  const auto motor = plant_axis(axis).motor;
  EXPECT_NEAR(motor.phase_force_constant, 64.0, 1e-12);
  EXPECT_NEAR(motor.force_constant, 96.0, 1e-12);
  EXPECT_NEAR(motor.emf_constant, 60.0 * 64.0 / 62.8, 1e-12);
}

TEST(ForceSaturation, TheForceFollowsTheHyperbolicTangentOfTheCurrentInBothSigns) {
  const machine::AxisModel axis = with_effects({{"force_saturation", {{"current", {20.0}}}}});
  for (const double volt : {0.01, 3.0, 15.0, 60.0, -3.0, -60.0})
    EXPECT_NEAR(force_of_voltage(axis, volt), 10.0 * 20.0 * std::tanh(volt / 20.0), 1e-9) << volt;
  const ForceSaturation law({20.0}, axis);
  for (const double force : {1.0, 100.0, -190.0}) EXPECT_NEAR(law.of_linear(law.linear_for(force)), force, 1e-9);
}

// Amplitude and phase of the measured part's acceleration over the motor's force against
//   (w^2 + 2 zeta w s) / (M (s^2 + 2 zeta w s + w^2))
// where the motor drives the other part, and 1 / (m + o g / (o + g)) where it drives this one: m and o the masses,
// g = (k + d s) / s^2 the mass that the spring is like.
void expect_two_masses_on_a_spring(bool motor_measured) {
  const double f0 = 60.0, zeta = 0.05, ratio = 0.3, w = 2.0 * std::numbers::pi * f0;
  machine::AxisModel axis = frictionless(with_effects({{"structural_resonance",
                                                        {{"frequency", {f0}},
                                                         {"damping_ratio", {zeta}},
                                                         {"mass_ratio", {ratio}},
                                                         {"motor_measured", {motor_measured ? 1.0 : 0.0}}}}}));
  for (const double f : {5.0, 30.0, 60.0, 90.0}) {
    AxisPlant plant(timing, axis, 0.0, 1);
    const double omega = 2.0 * std::numbers::pi * f;
    std::complex<double> force{}, speed{};
    // 1 s to settle; then whole periods.
    const int settle = 16000, count = 16000;
    for (int k = 0; k < settle + count; ++k) {
      plant.command({std::cos(omega * k * tick), 0.0, 0.0}, true);
      if (k >= settle) speed += plant.velocity() * std::polar(1.0, -omega * k * tick);
      if (k >= settle) force += 10.0 * std::cos(omega * k * tick) * std::polar(1.0, -omega * (k + 0.5) * tick);
      plant.advance_tick();
    }
    const std::complex<double> s(0.0, omega);
    const double own = ratio * axis.mass, other = axis.mass - own;
    const auto spring = own * other / axis.mass * (w * w + 2.0 * zeta * w * s) / (s * s);
    const auto expected = motor_measured
                              ? 1.0 / (s * (own + other * spring / (other + spring)))
                              : (w * w + 2.0 * zeta * w * s) / (axis.mass * s * (s * s + 2.0 * zeta * w * s + w * w));
    const auto found = speed / (10.0 * count / 2.0);
    // The force is held over a tick, half of it late.
    const auto held = expected * std::polar(1.0, -0.5 * omega * tick);
    EXPECT_LT(std::abs(found - held), 0.01 * std::abs(held)) << f << " Hz";
  }
}
TEST(StructuralResonance, TheLoadAnswersTheMotorAsTwoMassesOnASpringDo) { expect_two_masses_on_a_spring(false); }
TEST(StructuralResonance, TheMotorsPartAnswersAsWithABodyOnASpringBehindIt) { expect_two_masses_on_a_spring(true); }

TEST(StructuralResonance, MotionAndFrictionOfASteadyPassAreThoseOfTheWholeAxis) {
  const machine::AxisModel axis = with_effects(
      {{"structural_resonance", {{"frequency", {80.0}}, {"damping_ratio", {0.2}}, {"mass_ratio", {0.4}}}}});
  // 50 N against 20 N and 100 N s/m: 0.3 m/s, reached within e^-10 after ten time constants M/viscous.
  AxisPlant pushed(timing, axis, 0.0, 1);
  for (int k = 0; k < 80000; ++k) {
    pushed.command({5.0, 0.0, 0.0}, true);
    pushed.advance_tick();
  }
  EXPECT_NEAR(pushed.velocity(), 0.3, 2e-5);
  EXPECT_NEAR(pushed.friction_force(), 50.0, 0.01);
  AxisPlant plant(timing, frictionless(axis), 0.0, 1);
  for (int k = 0; k < 16000; ++k) {
    plant.command({0.5, 0.0, 0.0}, true);
    plant.advance_tick();
  }
  EXPECT_NEAR(plant.velocity(), 5.0 / 50.0, 1e-4);  // F t / M after 1 s, and what the decayed swing left
}

machine::Machine two_axes(double coupling_on_first) {
  machine::Machine machine;
  machine.axes = {frictionless(force_axis()), frictionless(force_axis())};
  machine.axes[1].name = "y";
  machine.axes[0].effects = {{"cross_axis_coupling", {{"mass", {coupling_on_first}}}}};
  return machine;
}

TEST(CrossAxisCoupling, TheOtherAxisAccelerationPushesTheCarriageTowardsPlusX) {
  const auto machine = two_axes(5.0);
  hal::SimulatedBackend<machine::DoubleSignals> backend(machine, std::array{0.0, 0.0});
  std::array<Command<machine::DoubleSignals>, 2> command;
  for (auto& c : command) c.enable = true;
  command[1].voltage[0].value = 8.0;  // 80 N on 50 kg
  for (int k = 0; k <= 1600; ++k) {
    backend.wait_for_tick();
    backend.write(command);
  }
  // Over 0.1 s but for the one tick by which it comes late: 5 kg times 1.6 m/s^2 on 50 kg.
  EXPECT_NEAR(backend.plant(1).velocity(), 1.6 * 0.1, 1e-9);
  EXPECT_NEAR(backend.plant(0).velocity(), 5.0 * 1.6 / 50.0 * (0.1 - tick), 1e-9);
  EXPECT_EQ(two_axes(0.0).axes.size(), 2u);
}

TEST(ControllerGainMismatch, ChangesTheDriveAloneAndOnlyWhatIsGiven) {
  machine::AxisModel axis = force_axis();
  axis.position_controller.gain = 80.0;
  axis.velocity_controller = {600.0, 5e-3};
  axis.effects = {{"controller_gain_mismatch", {{"velocity_gain", {570.0}}, {"velocity_integral_time", {6e-3}}}}};
  const auto drive = drive_axis(axis);
  EXPECT_EQ(drive.position_controller.gain, 80.0);
  EXPECT_EQ(drive.velocity_controller.gain, 570.0);
  EXPECT_EQ(drive.velocity_controller.integral_time, 6e-3);
  EXPECT_EQ(plant_axis(axis).velocity_controller.gain, 600.0);
  axis.encoder.velocity = machine::VelocitySource::estimated;
  axis.max_velocity = 1.0;
  const auto with = machine::configure_axis<machine::DoubleSignals>(timing, drive_axis(axis));
  axis.effects.clear();
  const auto without = machine::configure_axis<machine::DoubleSignals>(timing, axis);
  EXPECT_NEAR(with.velocity.proportional.value / without.velocity.proportional.value, 570.0 / 600.0, 1e-12);
  EXPECT_EQ(with.position_gain.value, without.position_gain.value);
}

TEST(ControllerGainMismatch, IsRefusedWithoutAnyGainAndForAControllerThatIsNotThere) {
  machine::AxisModel axis = force_axis();
  axis.effects = {{"controller_gain_mismatch", {}}};
  EXPECT_THROW(drive_axis(axis), EffectError);
  axis.effects = {{"controller_gain_mismatch", {{"current_gain", {30.0}}}}};
  EXPECT_THROW(drive_axis(axis), EffectError);
}

}  // namespace
}  // namespace stiction::sim::test
