// Friction that grows with the load, found from the logs of a weight on an arm: J a = K (x_set - x) - G sin x - B v -
// (C + c |G sin x|) sgn v, held at standstill by as much (a worm or spur gear's loss goes with the torque at its
// teeth). Integrated here, by none of the product's plant.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/identify/identification.hpp"
#include "host/identify/own_identification.hpp"
#include "host/log/csv_log.hpp"
#include "sim/machine_file.hpp"

namespace stiction::host {
namespace {

struct Arm {
  double inertia = 0.007, gravity = 0.48, viscous = 0.04, coulomb = 0.02, coefficient = 0.2;
  double gain = 0.6;  // N m/rad, of the controller at the arm
};

// A log at 200 Hz with 4096 counts a turn, as a small servo's bus gives it.
Log record(const Arm& arm, double amplitude, double rate) {
  constexpr double step = 5e-5, turn = 2.0 * std::numbers::pi;
  constexpr int every = 100;
  const auto rounded = [](double x) { return turn / 4096.0 * std::round(x * 4096.0 / turn); };
  std::string text = "t[s],x_set[rad],x[rad],u[V]\n";
  double x = 0.0, v = 0.0;
  for (int k = 0; k < 160000; ++k) {
    const double t = k * step;
    const double set = amplitude * (std::sin(rate * t) + 0.4 * std::sin(2.7 * rate * t));
    const double moment = arm.gain * (set - rounded(x));
    if (k % every == 0)
      text += std::to_string(t) + "," + std::to_string(set) + "," + std::to_string(rounded(x)) + "," +
              std::to_string(10.0 * moment) + "\n";
    const double weight = arm.gravity * std::sin(x), level = arm.coulomb + arm.coefficient * std::abs(weight);
    const double driving = moment - weight;
    if (v == 0.0 && std::abs(driving) <= level) continue;
    const double side = v != 0.0 ? std::copysign(1.0, v) : std::copysign(1.0, driving);
    double next = v + step / arm.inertia * (driving - arm.viscous * v - level * side);
    if (next * side < 0.0) next = 0.0;
    x += 0.5 * step * (v + next);
    v = next;
  }
  return parse_csv_log(text, "arm.csv");
}

machine::AxisModel axis() {
  return sim::parse_machine("arm.toml", R"(schema = "stiction.machine/1"
name = "arm"
[timing]
fast_period = "5 ms"
slow_period = "5 ms"
[axis.J]
kind = "rotary"
inertia = "0.01 kg m^2"
travel = "360 deg"
max_velocity = "10 rad/s"
max_acceleration = "100 rad/s^2"
[axis.J.gravity]
moment = "0.4 N m"
zero = "0 deg"
[axis.J.motor]
model = "force"
torque_constant = "0.1 N m/V"
[axis.J.encoder]
counts = 4096
[axis.J.controller]
structure = "unknown"
[axis.J.friction]
use = "classical"
[axis.J.friction.classical]
coulomb = "0.02 N m"
static_ratio = 1.0
viscous = "0.04 N m s/rad"
)")
      .axes.at(0);
}

Identification identified(const Arm& arm) {
  const std::vector<Log> logs{record(arm, 1.2, 1.1), record(arm, 1.6, 2.3), record(arm, 0.9, 4.0)};
  const IdentifyOptions options{"coulomb_viscous", Amperes::amplitude, FitSettings{}, true, {}};
  return in_own_units(identify_logs(linear_logs(logs, axis()), axis(), options), axis());
}

double value(const Identification& result, const char* name) {
  const auto* found = result.find(name);
  EXPECT_NE(found, nullptr) << name;
  return found == nullptr ? NAN : found->value;
}

TEST(LoadFriction, IsFoundWhereTheFrictionRisesWithTheWeight) {
  const Arm arm;
  const auto result = identified(arm);
  EXPECT_NEAR(value(result, "inertia_kg_m2"), arm.inertia, 0.03 * arm.inertia);
  EXPECT_NEAR(value(result, "gravity_moment_N_m"), arm.gravity, 0.02 * arm.gravity);
  EXPECT_NEAR(value(result, "load_coefficient"), arm.coefficient, 0.1 * arm.coefficient);
  EXPECT_NEAR(value(result, "coulomb_N_m"), arm.coulomb, 0.2 * arm.coulomb);
  EXPECT_TRUE(std::any_of(result.notes.begin(), result.notes.end(),
                          [](const auto& note) { return note.find("rises with the load") != std::string::npos; }));
}

TEST(LoadFriction, IsNotClaimedOfOneLevel) {
  Arm arm;
  arm.coulomb = 0.08;
  arm.coefficient = 0.0;
  const auto result = identified(arm);
  EXPECT_EQ(result.find("load_coefficient"), nullptr);
  EXPECT_NEAR(value(result, "inertia_kg_m2"), arm.inertia, 0.03 * arm.inertia);
  EXPECT_NEAR(value(result, "gravity_moment_N_m"), arm.gravity, 0.02 * arm.gravity);
  EXPECT_NEAR(value(result, "coulomb_N_m"), arm.coulomb, 0.05 * arm.coulomb);
}

}  // namespace
}  // namespace stiction::host
