// Motors (Mendricky 2006, 3.1-3.14) against the closed forms of their windings.
#include "sim/plant/motor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace stiction::sim {
namespace {

constexpr double step = 15.625e-6;
constexpr double two_pi = 2.0 * std::numbers::pi;

// 1FN1-126-5AF71 (Tab 3.1).
machine::MotorParameters linear_motor() {
  machine::MotorParameters motor;
  motor.model = machine::MotorModel::synchronous;
  motor.phase_resistance = 1.8;
  motor.phase_inductance = 18e-3;
  motor.mutual_inductance = 1.8e-3;
  motor.emf_constant = 62.8;
  motor.phase_force_constant = 62.8;
  motor.force_constant = 94.2;
  motor.pole_pair_pitch = 0.072;
  return motor;
}

PhaseValues phases(double amplitude, double x) {
  PhaseValues values;
  for (std::size_t k = 0; k < 3; ++k)
    values[k] = amplitude * std::sin(two_pi * x / 0.072 + static_cast<double>(k) * two_pi / 3.0);
  return values;
}

TEST(Winding, TakesTheExactStepForAnyStep) {
  for (const double h : {1e-7, 15.625e-6, 1e-3, 0.5}) {
    const Winding<double> winding(1.8, 18e-3, h);
    double i = 3.0;
    for (int n = 1; n <= 50; ++n) {
      i = winding.advance(i, 90.0);
      const double decay = std::exp(-1.8 / 18e-3 * h * n);
      ASSERT_NEAR(i, 3.0 * decay + 50.0 * (1.0 - decay), 1e-12) << h << ", " << n;
    }
  }
}

TEST(DcMotor, StepResponseIsThatOfResistanceAndInductance) {
  DcMotor motor(linear_motor(), step);
  for (int n = 1; n <= 2000; ++n) {
    const double before = motor.current()[0];
    const double force = motor.advance({90.0, 0.0, 0.0}, 0.0, 0.0);
    const double i = 50.0 * (1.0 - std::exp(-100.0 * step * n));
    ASSERT_NEAR(motor.current()[0], i, 1e-11);
    ASSERT_NEAR(force, 94.2 * 0.5 * (before + motor.current()[0]), 1e-10) << "mean of the step";
  }
  EXPECT_EQ(motor.current()[1], 0.0);
  EXPECT_EQ(motor.current()[2], 0.0);
}

TEST(DcMotor, BackEmfTakesItsPartOfTheVoltage) {
  DcMotor motor(linear_motor(), step);
  for (int n = 0; n < 64000; ++n) motor.advance({90.0, 0.0, 0.0}, 0.0, 0.5);  // 100 time constants
  EXPECT_NEAR(motor.current()[0], (90.0 - 62.8 * 0.5) / 1.8, 1e-10);
}

TEST(DcMotor, TwoInParallelCarryTwiceTheCurrentOfOneAtEveryInstant) {
  auto pair = linear_motor();
  pair.count = 2;
  DcMotor one(linear_motor(), step), two(pair, step);
  for (int n = 0; n < 1000; ++n) {
    const PhaseValues u{80.0 * std::sin(0.01 * n), 0.0, 0.0};
    const double v = 0.2 * std::cos(0.003 * n);
    const double force = one.advance(u, 0.0, v);
    ASSERT_NEAR(two.advance(u, 0.0, v), 2.0 * force, 1e-9);
    ASSERT_NEAR(two.current()[0], 2.0 * one.current()[0], 1e-11);
  }
}

TEST(SynchronousMotor, CommutatedCurrentsMakeThreeHalvesOfTheForceConstantAtEveryPosition) {
  for (double x = -0.1; x < 0.1; x += 0.00137) {
    SynchronousMotor motor(linear_motor(), step);
    double force = 0.0;
    for (int n = 0; n < 40000; ++n) force = motor.advance(phases(1.8 * 30.0, x), x, 0.0);  // 69 time constants
    for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(motor.current()[k], phases(30.0, x)[k], 1e-10);
    ASSERT_NEAR(force, 1.5 * 62.8 * 30.0, 1e-8) << x;
  }
}

TEST(SynchronousMotor, AtStandstillIsTheDcEquivalentWithTheInductanceLessTheMutualOne) {
  auto equivalent = linear_motor();
  equivalent.phase_inductance = 18e-3 - 1.8e-3;
  DcMotor dc(equivalent, step);
  SynchronousMotor motor(linear_motor(), step);
  const double x = 0.0123;
  for (int n = 0; n < 3000; ++n) {
    const double u = 100.0 * std::sin(0.02 * n);
    ASSERT_NEAR(motor.advance(phases(u, x), x, 0.0), dc.advance({u, 0.0, 0.0}, x, 0.0), 1e-9) << n;
  }
}

TEST(SynchronousMotor, TheMeanOfThePhaseVoltagesHasNoEffect) {
  SynchronousMotor plain(linear_motor(), step), shifted(linear_motor(), step);
  double x = 0.0;
  for (int n = 0; n < 3000; ++n, x += 0.5 * step) {
    auto u = phases(50.0, x);
    const double force = plain.advance(u, x, 0.5);
    for (double& value : u) value += 200.0 * std::cos(0.05 * n);
    ASSERT_NEAR(shifted.advance(u, x, 0.5), force, 1e-9) << n;
    for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(shifted.current()[k], plain.current()[k], 1e-11);
    ASSERT_NEAR(shifted.current()[0] + shifted.current()[1] + shifted.current()[2], 0.0, 1e-11) << "star point";
  }
}

TEST(SynchronousMotor, ShortedAndPushedItBrakesByTheForceOfItsImpedance) {
  // i_k = -K_E v / |Z| sin(.. - arg Z), Z = R + j w (L - M): F = -3/2 K_F K_E v R / |Z|^2.
  constexpr double v = 1.0, omega = two_pi * v / 0.072;
  SynchronousMotor motor(linear_motor(), step);
  double x = 0.0, force = 0.0;
  for (int n = 0; n < 40000; ++n, x += v * step) force = motor.advance({}, x, v);
  const double impedance = std::norm(std::complex<double>(1.8, omega * 16.2e-3));
  const double expected = -1.5 * 62.8 * 62.8 * v * 1.8 / impedance;
  // The EMF is held at each step's middle: (w h)^2 / 24 = 8e-8 of it, and as much of the mean force.
  EXPECT_NEAR(force, expected, 5e-7 * std::abs(expected));
}

TEST(SynchronousMotor, AtSpeedTheEmfOfACommutatedCurrentIsMechanicalPower) {
  // Energy over many whole turns: electrical power in = losses + F v (the field's energy returns).
  constexpr double v = 0.8;
  SynchronousMotor motor(linear_motor(), step);
  double x = 0.0, input = 0.0, loss = 0.0, work = 0.0;
  const int turn = 5760;  // 72 mm at 0.8 m/s: 90 ms
  for (int n = 0; n < 12 * turn; ++n, x += v * step) {
    const auto u = phases(120.0, x + 0.5 * v * step);
    const auto before = motor.current();
    const double force = motor.advance(u, x, v);
    if (n < 2 * turn) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const double i = 0.5 * (before[k] + motor.current()[k]);
      input += u[k] * i * step;
      loss += 1.8 * i * i * step;
    }
    work += force * v * step;
  }
  EXPECT_NEAR(input, loss + work, 1e-6 * input);
  EXPECT_GT(work, 0.0);
}

TEST(SynchronousMotor, TwoInParallelCarryTwiceTheCurrentOfOne) {
  auto pair = linear_motor();
  pair.count = 2;
  SynchronousMotor one(linear_motor(), step), two(pair, step);
  double x = 0.0;
  for (int n = 0; n < 1000; ++n, x += 0.7 * step) {
    const double force = one.advance(phases(70.0, x), x, 0.7);
    ASSERT_NEAR(two.advance(phases(70.0, x), x, 0.7), 2.0 * force, 1e-9);
  }
}

TEST(Motors, SwitchedOffCarryNoCurrent) {
  DcMotor dc(linear_motor(), step);
  SynchronousMotor synchronous(linear_motor(), step);
  dc.advance({50.0, 0.0, 0.0}, 0.0, 0.0);
  synchronous.advance({50.0, -20.0, 0.0}, 0.0, 0.0);
  dc.switch_off();
  synchronous.switch_off();
  EXPECT_EQ(dc.current(), PhaseValues{});
  EXPECT_EQ(synchronous.current(), PhaseValues{});
}

TEST(ForceSource, GivesItsForceAtOnce) {
  machine::MotorParameters motor;
  motor.model = machine::MotorModel::force;
  motor.force_constant = 35.15;
  ForceSource source(motor, step);
  EXPECT_EQ(source.advance({-4.0, 0.0, 0.0}, 0.1, 1.0), -4.0 * 35.15);
}

}  // namespace
}  // namespace stiction::sim
