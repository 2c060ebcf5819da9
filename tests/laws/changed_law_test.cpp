// The programme is compiled over a LuGre law whose Stribeck curve is exp(-|v/v_s|), Tustin's, in place of the Gaussian
// (CMakeLists.txt). Below, that curve is written out by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "host/diagnose/diagnose.hpp"
#include "host/identify/identification.hpp"
#include "host/simulate/commissioning.hpp"
#include "host/tune/friction_tuning.hpp"
#include "sim/machine_file.hpp"
#include "sim/plant/friction/laws.hpp"
#include "tests/host/identify/simulated_log.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

constexpr double coulomb = 90.0, static_ratio = 1.4, viscous = 500.0, stribeck_velocity = 5e-3;  // N, 1, N s/m, m/s

double tustin(double speed) {
  return coulomb * (1.0 + (static_ratio - 1.0) * std::exp(-speed / stribeck_velocity)) + viscous * speed;
}

machine::Machine machine_with_fall() {
  auto machine = sim::read_machine(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml",
                                   {{}, {"axis.X.friction.use=lugre", "axis.X.encoder.velocity=estimated"}});
  auto& friction = machine.axes.front().friction;
  auto lugre = sim::parameters_of<sim::LuGre<>>(friction);
  lugre.coulomb = coulomb;
  lugre.static_ratio = static_ratio;
  lugre.viscous = viscous;
  lugre.stribeck_velocity = stribeck_velocity;
  sim::set_parameters<sim::LuGre<>>(friction, lugre);
  return machine;
}

std::vector<host::Log> records() {
  std::vector<host::Log> logs;
  const auto machine = machine_with_fall();
  for (const auto& trajectory : commissioning()) logs.push_back(simulated(machine, trajectory));
  logs.push_back(simulated(machine, constant_speeds({1e-3, 2e-3, 4e-3, 7e-3, 12e-3}, 0.3, 0.5e-3)));
  return logs;
}

TEST(ChangedLaw, ActsInThePlant) {
  const auto machine = machine_with_fall();
  const auto& axis = machine.axes.front();
  constexpr double step = 15.625e-6;
  auto model = sim::make_friction(axis.friction, {axis.mass, step});
  for (const double speed : {2e-3, 5e-3, 15e-3}) {
    double force = 0.0;
    for (double x = 0.0; x < 1e-3; x += speed * step)
      force = std::visit([&](auto& law) { return (speed - law.advance(speed, 0.0)) * axis.mass / step; }, model);
    EXPECT_NEAR(force, tustin(speed), 2e-3 * tustin(speed)) << speed << " m/s";
  }
}

TEST(ChangedLaw, IsWhatTheIdentificationFits) {
  const auto machine = machine_with_fall();
  const auto result =
      host::identify_logs(records(), machine.axes.front(), {"lugre", host::Amperes::amplitude, {}, false});
  const auto value = [&](const char* name) {
    const auto* found = result.find(name);
    EXPECT_NE(found, nullptr) << name;
    return found == nullptr ? NAN : found->value;
  };
  figure("changed law: Stribeck velocity identified",
         std::to_string(1e3 * value("stribeck_velocity_m_per_s")) + " mm/s (5)");
  EXPECT_NEAR(value("stribeck_velocity_m_per_s"), stribeck_velocity, 0.02 * stribeck_velocity);
  EXPECT_NEAR(value("static_ratio"), static_ratio, 0.01);
  EXPECT_NEAR(value("coulomb_N"), coulomb, 0.3);
}

TEST(ChangedLaw, IsWhatTheDiagnosisExpects) {
  host::DiagnoseInput input;
  input.machine = machine_with_fall();
  input.closed_loop = input.next_measurement = false;
  for (auto& record : host::record_commissioning(input.machine, 0, 1))
    (record.held_out ? input.held_out : input.logs).push_back(std::move(record.log));
  const auto verdict = host::diagnose(input);
  for (const auto& finding : verdict.findings) ADD_FAILURE() << finding.effect.name();
  // What noise leaves is 3 N rms; a Gaussian curve in place of this one leaves up to 8 N at 7 mm/s.
  EXPECT_FALSE(verdict.unexplained.signature.has_value());
}

TEST(ChangedLaw, IsWhatTheCompensationLearns) {
  const auto machine = machine_with_fall();
  const auto& axis = machine.axes.front();
  // Slow strokes that slide beyond the longest presliding element of the drive, 1.8 mm.
  const std::vector<host::Log> logs{
      simulated(machine, constant_speeds({2e-3, 3e-3, 4e-3, 6e-3, 8e-3, 12e-3}, 1.0, 8e-3)),
      simulated(machine, sim::circle(16.0 / 60.0, 2.0))};
  const auto tuned = host::tune_friction(logs, axis).friction;
  const double level = std::accumulate(tuned.level.begin(), tuned.level.end(), 0.0);
  const double newtons = axis.motor.force_constant;
  for (std::size_t k = 0; k < tuned.speed.size(); ++k) {
    if (tuned.speed[k] < 2e-3 || tuned.speed[k] > 12e-3) continue;
    EXPECT_NEAR(newtons * (level + tuned.forward[k]), tustin(tuned.speed[k]), 2.0) << tuned.speed[k] << " m/s";
  }
}

}  // namespace
}  // namespace stiction::test
