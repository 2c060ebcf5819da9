// Records that cannot tell two causes apart; the proposed trajectory is then run with the hidden effect, and the
// diagnosis of both names the right one alone.
#include "host/diagnose/next_measurement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>

#include "host/diagnose/diagnose.hpp"
#include "host/diagnose/verdict_json.hpp"
#include "host/simulate/commissioning.hpp"
#include "sim/experiment/commissioning_path.hpp"
#include "sim/machine/machine_file.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

// As the demonstration has it.
sim::Machine machine() {
  return sim::read_machine(
      std::string(STICTION_SOURCE_DIR) + "/sim/machine/shipped/mcfv5050ln.toml",
      {{}, {"axis.X.encoder.velocity=estimated", "axis.X.encoder.noise=2 nm", "axis.X.motor.force_constant=94.2 N/A"}});
}

host::Log set_points(const char* name, const sim::Trajectory& path) {
  host::Log log;
  log.source = name;
  log.period = 1e-3;
  auto& axis = log.axes.emplace_back();
  axis.axis = "X";
  for (int k = 0; k * log.period < path.duration; ++k) {
    const auto point = path.at(k * log.period);
    log.t.push_back(k * log.period);
    axis.x_set.push_back(point.position);
    axis.v_set.push_back(point.velocity);
    axis.a_set.push_back(point.acceleration);
  }
  axis.x = axis.x_set;
  return log;
}

struct Case {
  const char* name;
  std::vector<sim::Effect> hidden;
  const char* rival;
  sim::Trajectory training, held_out;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  all.push_back({"few reversals",
                 {{"presliding_hysteresis", {{"stiffness", {1.2e6}}, {"distance", {300e-6}}}}},
                 "coulomb_mismatch",
                 sim::constant_speeds({0.02, 0.1, 0.2}, 0.5, 2e-3),
                 sim::constant_speeds({0.03, 0.07, 0.15}, 0.5, 2e-3)});
  all.push_back({"no slow speeds",
                 {{"stribeck", {{"break_away", {35.0}}, {"velocity", {10e-3}}}}},
                 "viscous_nonlinear",
                 sim::constant_speeds({0.025, 0.05, 0.1, 0.2, 0.3}, 0.4, 2e-3),
                 sim::constant_speeds({0.03, 0.07, 0.15, 0.25}, 0.5, 2e-3)});
  all.push_back({"one acceleration",
                 {{"force_saturation", {{"current", {12.0}}}}},
                 "mass_mismatch",
                 sim::constant_speeds({0.05, 0.1, 0.2, 0.3}, 0.2, 2e-3),
                 sim::constant_speeds({0.07, 0.15, 0.25}, 0.2, 2e-3)});
  all.push_back({"one speed",
                 {{"viscous_mismatch", {{"viscous", {650.0}}}}},
                 "coulomb_mismatch",
                 sim::constant_speeds({0.2, 0.2, 0.2, 0.2, 0.2, 0.2}, 0.4, 2e-3),
                 sim::constant_speeds({0.21, 0.21, 0.21, 0.21}, 0.5, 2e-3)});
  return all;
}

TEST(NextMeasurement, explore) {
  const auto file = machine();
  for (const auto& c : cases()) {
    auto real = file;
    real.axes.front().effects = c.hidden;
    host::DiagnoseInput input;
    input.machine = file;
    input.closed_loop = false;
    input.logs = {host::record_set_points(real, 0, set_points("training", c.training), 1)};
    input.held_out = {host::record_set_points(real, 0, set_points("held out", c.held_out), 2)};
    auto verdict = host::diagnose(input);
    std::cout << "=== " << c.name << "\n" << host::verdict_text(verdict) << "\n";
    if (!verdict.next) continue;
    std::cout << host::verdict_json(verdict)["next_measurement"].dump(1) << "\n";
    if (!verdict.next->log) continue;
    input.logs.push_back(host::record_set_points(real, 0, *verdict.next->log, 3));
    verdict = host::diagnose(input);
    std::cout << "--- with the proposed\n" << host::verdict_text(verdict) << "\n";
  }
}

}  // namespace
}  // namespace stiction::test
