// What a gear or screw adds is named by its name, on shipped axes with and without a weight.
#include <gtest/gtest.h>

#include <string>

#include "host/diagnose/diagnose.hpp"
#include "host/simulate/commissioning.hpp"
#include "sim/machine_file.hpp"

namespace stiction::host {
namespace {

Verdict verdict_of(const std::string& machine, const machine::Effect& hidden) {
  DiagnoseInput input;
  input.machine = sim::read_machine(STICTION_SOURCE_DIR "/firmware/machine/shipped/" + machine + ".toml", {});
  input.next_measurement = false;
  auto true_machine = input.machine;
  true_machine.axes[0].effects.push_back(hidden);
  for (auto& record : record_commissioning(true_machine, 0, 1))
    (record.held_out ? input.held_out : input.logs).push_back(std::move(record.log));
  return diagnose(input);
}

class LoadDependentFriction : public testing::TestWithParam<const char*> {};

TEST_P(LoadDependentFriction, IsNamedWithItsCoefficient) {
  const auto verdict = verdict_of(GetParam(), {"load_dependent_friction", {{"coefficient", {0.15}}}});
  ASSERT_FALSE(verdict.findings.empty());
  const auto& first = verdict.findings.front();
  EXPECT_EQ(first.effect.name(), "load_dependent_friction");
  const auto& coefficient = first.parameters.front();
  ASSERT_EQ(coefficient.key, "coefficient");
  EXPECT_NEAR(coefficient.values.front(), 0.15, 3.0 * coefficient.standard_errors.front())
      << coefficient.standard_errors.front();
  EXPECT_LT(coefficient.standard_errors.front(), 0.03);
  EXPECT_EQ(named_causes(verdict.findings), 1U);
}

INSTANTIATE_TEST_SUITE_P(Machines, LoadDependentFriction,
                         testing::Values("vertical-axis", "servo-joint", "screw-linear-scale", "belt-axis"),
                         [](const auto& each) {
                           std::string name = each.param;
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

}  // namespace
}  // namespace stiction::host
