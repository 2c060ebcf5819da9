// Held-out records of another state of the machine (a workpiece, another day's offset, another day's oil) are told from
// a cause: what changed is said with its size, and what is in both sets of records is found all the same.
#include <gtest/gtest.h>

#include <cmath>

#include "host/diagnose/diagnose.hpp"
#include "host/diagnose/verdict/verdict_json.hpp"
#include "host/report/diagnosis_finding.hpp"
#include "host/simulate/commissioning.hpp"
#include "sim/machine_file.hpp"

namespace stiction::test {
namespace {

machine::Machine shipped(const std::string& name) {
  return sim::read_machine(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/" + name + ".toml");
}

// Training records of one machine, held-out records of another; the file is the first one without its effects.
host::Verdict diagnosed(const machine::Machine& training, const machine::Machine& held_out) {
  host::DiagnoseInput input;
  input.machine = training;
  input.machine.axes.front().effects.clear();
  input.closed_loop = input.next_measurement = false;
  for (auto& record : host::record_commissioning(training, 0, 1))
    if (!record.held_out) input.logs.push_back(std::move(record.log));
  for (auto& record : host::record_commissioning(held_out, 0, 2))
    if (record.held_out) input.held_out.push_back(std::move(record.log));
  return host::diagnose(input);
}

void expect_changed(const host::Verdict& verdict, const std::string& effect, double training, double held_out) {
  ASSERT_EQ(verdict.changed.size(), 1U) << host::verdict_json(verdict).dump(1);
  const auto& changed = verdict.changed.front();
  EXPECT_EQ(changed.effect.name(), effect);
  EXPECT_GT(changed.standard_error, 0.0);
  EXPECT_NEAR(changed.held_out - changed.training, held_out - training, 3.0 * changed.standard_error);
  EXPECT_LT(3.0 * changed.standard_error, std::abs(held_out - training));
}

TEST(ChangedBetween, AWorkpieceIsSaidAndTheRippleOfBothIsFound) {
  auto training = shipped("mcfv5050ln");
  training.axes.front().effects = {{"force_ripple", {{"pitch", {0.024}}, {"cosine", {12.0}}, {"sine", {0.0}}}}};
  auto held_out = training;
  held_out.axes.front().mass *= 1.08;
  const auto verdict = diagnosed(training, held_out);
  expect_changed(verdict, "mass_mismatch", training.axes.front().mass, held_out.axes.front().mass);
  ASSERT_EQ(verdict.findings.size(), 1U);
  EXPECT_EQ(verdict.findings.front().effect.name(), "force_ripple");
  const auto json = host::verdict_json(verdict);
  EXPECT_EQ(json.at("changed").at(0).at("parameter"), "mass_kg");
  EXPECT_NE(host::diagnosis_sentence(verdict).find("different state of the machine: mass "), std::string::npos);
}

// In the units of a joint: N m.
TEST(ChangedBetween, AnotherDaysOffsetIsSaidInTheUnitsOfTheAxis) {
  const auto training = shipped("servo-joint");
  auto held_out = training;
  held_out.axes.front().effects = {{"constant_force", {{"force", {4.0}}}}};
  const auto verdict = diagnosed(training, held_out);
  ASSERT_EQ(verdict.changed.size(), 1U) << host::verdict_json(verdict).dump(1);
  EXPECT_EQ(verdict.changed.front().effect.name(), "constant_force");
  EXPECT_EQ(verdict.changed.front().unit, "N m");
  EXPECT_TRUE(verdict.findings.empty());
}

TEST(ChangedBetween, TheSameStateIsNotCalledAnotherOne) {
  for (const auto* name : {"mcfv5050ln", "servo-joint", "vertical-axis"}) {
    const auto machine = shipped(name);
    EXPECT_TRUE(diagnosed(machine, machine).changed.empty()) << name;
  }
}

}  // namespace
}  // namespace stiction::test
