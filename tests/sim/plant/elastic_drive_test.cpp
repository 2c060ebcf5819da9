// An elastic shaft between motor and load with what real gears have: a load in two parts, an error that is periodic in
// the turns of the shafts, a stiffness that falls as it warms, friction on both sides. Truth is closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "tests/sim/effects/effect_plant.hpp"

namespace stiction::sim::test {
namespace {

constexpr double turn = 2.0 * std::numbers::pi;

// A motor of 20 kg, at a shaft of 1 rad per 0.1 m behind a gear of 3, and a load of 30 kg.
machine::AxisModel elastic_axis() {
  machine::AxisModel axis = force_axis();
  axis.friction = acting<CoulombViscous<>>({});
  axis.motor_mass = 20.0;
  axis.load_mass = 30.0;
  axis.motor_coordinate = {machine::AxisKind::rotary, 0.1 / 3.0};
  axis.transmission.emplace();
  axis.transmission->ratio = 3.0;
  axis.transmission->stiffness = 2e5;
  axis.transmission->damping = 60.0;
  return axis;
}

// A stiff servo on the motor's own position and speed, which turns it steadily.
class Servo {
 public:
  Servo(AxisPlant& plant, const machine::AxisModel& axis)
      : plant_(plant), axis_(axis), set_(plant.motor_position()), before_(set_) {}

  void tick(double speed) {
    set_ += speed * test::tick;
    const double now = plant_.motor_position(), rate = (now - before_) / test::tick;
    before_ = now;
    sum_ += 50.0 * (set_ - now) * test::tick;
    const double force = 2e6 * (set_ - now + sum_) + 2e4 * (speed - rate);
    plant_.command({force / axis_.motor.force_constant, 0.0, 0.0}, true);
    plant_.advance_tick();
  }

 private:
  AxisPlant& plant_;
  const machine::AxisModel& axis_;
  double set_, before_, sum_ = 0.0;
};

// Speed of the load over the motor's force at `frequency` (Hz), in steady state.
std::complex<double> measured_answer(const machine::AxisModel& axis, double frequency) {
  AxisPlant plant(timing, axis, 0.0, 1);
  const double omega = turn * frequency;
  std::complex<double> speed{};
  const int settle = 48000, count = 16000;
  for (int k = 0; k < settle + count; ++k) {
    plant.command({std::cos(omega * k * tick), 0.0, 0.0}, true);
    if (k >= settle) speed += plant.velocity() * std::polar(1.0, -omega * k * tick);
    plant.advance_tick();
  }
  // The force is held over a tick, half of it late.
  return speed / (10.0 * count / 2.0) / std::polar(1.0, -0.5 * omega * tick);
}

TEST(ElasticDrive, ThreeMassesAnswerTheMotorAsAChainOfSpringsDoes) {
  machine::AxisModel axis = elastic_axis();
  const double f0 = 60.0, zeta = 0.04, ratio = 0.6, w = turn * f0;
  axis.effects = {
      {"structural_resonance",
       {{"frequency", {f0}}, {"damping_ratio", {zeta}}, {"mass_ratio", {ratio}}, {"motor_measured", {1.0}}}}};
  const double near = ratio * 30.0, far = 30.0 - near, k = w * w * ratio * far, d = 2.0 * zeta * k / w;
  for (const double f : {5.0, 17.0, 40.0, 75.0}) {
    const std::complex<double> s(0.0, turn * f);
    // What hangs behind is like a mass; motor and load are joined by the shaft.
    const auto behind = (k + d * s) / (s * s), load = near + far * behind / (far + behind);
    const auto shaft = (2e5 + 60.0 * s) / (s * s);
    const auto expected = shaft / (s * (20.0 * load + shaft * (20.0 + load)));
    EXPECT_LT(std::abs(measured_answer(axis, f) - expected), 0.01 * std::abs(expected)) << f << " Hz";
  }
}

TEST(ElasticDrive, APartOfTheLoadBehindTheRestIsTheOneModeBesideAShaft) {
  machine::AxisModel axis = elastic_axis();
  axis.effects = {{"structural_resonance", {{"frequency", {60.0}}, {"damping_ratio", {0.1}}, {"mass_ratio", {0.5}}}}};
  try {
    AxisPlant plant(timing, axis, 0.0, 1);
    FAIL() << "accepted";
  } catch (const EffectError& error) {
    EXPECT_NE(std::string(error.what()).find("motor_measured = 1"), std::string::npos) << error.what();
  }
}

// Frequency (Hz) with which the load swings before a heavy motor, which is pushed at `from` (s), from ten crossings.
double held_frequency(const machine::AxisModel& axis, double from) {
  AxisPlant plant(timing, axis, 0.0, 1);
  double before = 0.0, first = 0.0, time = 0.0;
  int crossings = 0;
  while (crossings < 11) {
    // The push takes out the drift of both together with a second one that is as long.
    plant.set_external_force(time >= from && time < from + 2e-3 ? 100.0 : 0.0);
    plant.command({0.0, 0.0, 0.0}, true);
    plant.advance_tick();
    time += tick;
    const double now = plant.velocity();
    if (time > from + 4e-3 && before < 0.0 && now >= 0.0) {
      const double at = time - tick * now / (now - before);
      if (crossings++ == 0) first = at;
      if (crossings == 11) return 10.0 / (at - first);
    }
    before = now;
  }
  return 0.0;
}

TEST(ElasticDrive, AWarmShaftHasLostItsShareOfTheStiffness) {
  machine::AxisModel axis = elastic_axis();
  axis.motor_mass = 3e6;  // as good as held
  axis.mass = axis.motor_mass + 30.0;
  axis.transmission->damping = 0.0;
  axis.transmission->stiffness_loss = 0.36;
  axis.transmission->warming_time = 2.0;
  const double cold = std::sqrt(2e5 / 30.0) / turn;
  // Ten periods are 0.8 s; behind ten time constants it has 0.64 of its stiffness, 0.8 of its frequency.
  EXPECT_NEAR(held_frequency(axis, 20.0) / cold, 0.8, 0.001);
  // Once it has lost a part: in the middle of those ten periods, by the exponential law.
  const double middle = 1.0 + 0.5 * 10.0 / (0.92 * cold);
  EXPECT_NEAR(held_frequency(axis, 1.0) / cold, std::sqrt(1.0 - 0.36 * (1.0 - std::exp(-middle / 2.0))), 0.004);
}

// Slowly turned, the load is ahead of the motor by the waves of all three shafts.
TEST(ElasticDrive, TheLoadIsAheadByTheErrorOfTheTransmission) {
  machine::AxisModel axis = elastic_axis();
  auto& transmission = *axis.transmission;
  transmission.damping = 2000.0;  // the start is over soon
  transmission.motor_error = {{20e-6, 2.0, 0.5}};
  transmission.gear_ratio = 1.5;
  transmission.gear_error = {{15e-6, 7.0, -1.0}};
  transmission.output_error = {{40e-6, 1.0, 0.2}};
  const auto ahead = [](double motor, double load) {
    return 20e-6 * std::sin(2.0 * 30.0 * motor + 0.5) + 15e-6 * std::sin(7.0 * 1.5 * 10.0 * load - 1.0) +
           40e-6 * std::sin(10.0 * load + 0.2);
  };
  AxisPlant plant(timing, axis, 0.0, 1);
  EXPECT_NEAR(plant.position() - plant.motor_position(), ahead(plant.motor_position(), 0.0), 1e-6);
  Servo servo(plant, axis);
  double worst = 0.0;
  for (int k = 0; k < 96000; ++k) {
    servo.tick(0.02);
    if (k < 32000) continue;
    worst = std::max(
        worst, std::fabs(plant.position() - plant.motor_position() - ahead(plant.motor_position(), plant.position())));
  }
  // What the load's inertia takes: 30 kg at waves of 105 rad/m and 0.02 m/s over the stiffness is 1e-8 m.
  EXPECT_LT(worst, 1e-6);
}

// Coulomb friction and LuGre's at both ends: at steady speed the motor's force is the sum of both, and the shaft
// carries what the load's is.
TEST(ElasticDrive, FrictionOfMotorAndLoadActTogether) {
  machine::AxisModel axis = elastic_axis();
  axis.friction = acting<LuGre<>>({30.0, 1.3, 80.0, 5e-3, 1e6, 0.1});
  axis.motor_friction.emplace();
  static_cast<machine::FrictionParameters&>(*axis.motor_friction) = acting<CoulombViscous<>>({12.0, 40.0});
  AxisPlant plant(timing, axis, 0.0, 1);
  const double speed = 0.2;
  Servo servo(plant, axis);
  double force = 0.0, wind = 0.0;
  int n = 0;
  for (int k = 0; k < 64000; ++k) {
    servo.tick(speed);
    if (k < 48000) continue;
    force += plant.motor_force();
    wind += plant.motor_position() - plant.position();
    ++n;
  }
  const double of_load = 30.0 * (1.0 + 0.3 * std::exp(-std::pow(speed / 5e-3, 2.0))) + 80.0 * speed;
  EXPECT_NEAR(force / n, of_load + 12.0 + 40.0 * speed, 0.2);
  EXPECT_NEAR(wind / n, of_load / 2e5, 2e-6);
}

}  // namespace
}  // namespace stiction::sim::test
