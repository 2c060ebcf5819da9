// The experiments on a rotary axis against those on the same axis written as a linear one.
#include <gtest/gtest.h>

#include <algorithm>

#include "host/simulate/experiments.hpp"
#include "host/simulate/frequency_response.hpp"
#include "host/simulate/machine_needs.hpp"
#include "sim/machine_file.hpp"
#include "tests/support/rotary_joint.hpp"

namespace stiction::host {
namespace {

struct Twins {
  static constexpr int counts = 1 << 22;
  machine::Machine joint = sim::parse_machine("joint.toml", test::rotary_joint_of(counts));
  double radius = joint.axes[0].coordinate.radius;
  machine::Machine circle = sim::parse_machine("joint.toml", test::joint_on_circle(radius, counts));
};

sim::ExperimentResult result_on(const char* experiment, const machine::Machine& machine) {
  const auto row =
      std::ranges::find_if(experiments(), [&](const Experiment& each) { return std::string(each.name) == experiment; });
  return run_experiment(*row, {machine, {"lugre"}});
}

const sim::Figure* figure(const sim::ExperimentResult& result, const std::string& begin) {
  for (const auto& each : result.figures)
    if (each.name.starts_with(begin)) return &each;
  return nullptr;
}

TEST(RotaryExperiments, AStepOfTorqueMovesAJointByTheAngleOfItsCircle) {
  const Twins twins;
  const auto turned = result_on("impact", twins.joint), moved = result_on("impact", twins.circle);
  const auto *angle = figure(turned, "peak_deviation"), *way = figure(moved, "peak_deviation");
  ASSERT_NE(angle, nullptr);
  EXPECT_EQ(angle->unit, "urad");
  EXPECT_DOUBLE_EQ(angle->value * twins.radius, way->value);
  const auto *torque = figure(turned, "resting_friction"), *force = figure(moved, "resting_friction");
  EXPECT_EQ(torque->unit, "N m");
  EXPECT_DOUBLE_EQ(torque->value, force->value * twins.radius);
  EXPECT_EQ(turned.charts[0].y_label, "deviation at the encoder, urad");
}

TEST(RotaryExperiments, AConstantSpeedTakesTheVoltageOfTheCircle) {
  Twins twins;
  // The same speeds on both, which are chosen in the axis' own unit otherwise.
  for (const double speed : {0.5, 2.0})
    for (auto* machine : {&twins.joint, &twins.circle})
      machine->steady_friction_references.push_back({.axis = "J", .velocity = speed * twins.radius, .current = 1.0});
  const auto turned = result_on("constant-velocity", twins.joint), moved = result_on("constant-velocity", twins.circle);
  ASSERT_EQ(turned.figures.size(), moved.figures.size());
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NE(turned.figures[k].name.find("_deg_per_s"), std::string::npos) << turned.figures[k].name;
    // Starts differ: the source's two metres a second squared mean nothing to a joint.
    EXPECT_NEAR(turned.figures[k].value, moved.figures[k].value, 1e-4 * moved.figures[k].value);
  }
  EXPECT_EQ(turned.charts[0].x_label, "speed, deg/s");
}

TEST(RotaryExperiments, AResponseIsRecordedInAngles) {
  const Twins twins;
  FrequencyResponsePlan plan;
  plan.machine = twins.joint;
  plan.passes = 1;
  const auto log = run_frequency_response(plan);
  EXPECT_TRUE(log.axes[0].rotary);
  const auto [least, most] = std::ranges::minmax(log.axes[0].x);
  EXPECT_LT(most - least, 6.2832);
  EXPECT_GT(most - least, 1.0);
}

TEST(RotaryExperiments, WhatNeedsALengthSaysSo) {
  const Twins twins;
  for (const char* command : {"circle", "l-shape", "presliding", "tune-friction"}) {
    auto needs = needs_of(command);
    needs.least_axes = 1;
    const auto missing = what_is_missing(twins.joint, needs);
    ASSERT_TRUE(missing) << command;
    EXPECT_NE(missing->find("found the rotary axis J; expected linear axes"), std::string::npos) << *missing;
  }
}

}  // namespace
}  // namespace stiction::host
