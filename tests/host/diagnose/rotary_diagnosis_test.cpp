// A rotary axis is diagnosed as the same axis written as a linear one, and its verdict is in its own units.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <string_view>

#include "host/diagnose/diagnose.hpp"
#include "host/diagnose/verdict/verdict_json.hpp"
#include "host/log/own_units.hpp"
#include "host/simulate/commissioning.hpp"
#include "sim/machine_file.hpp"
#include "tests/support/rotary_joint.hpp"

namespace stiction::host {
namespace {

// An encoder that is fine enough for the drive to estimate speeds from, and a drive that follows without lag.
constexpr double counts = 1048576.0;
const std::string without_lag = "axis.J.feedforward.velocity=1";

const std::string counted = fmt::format("axis.J.encoder.counts={}", counts);

machine::Machine joint() { return sim::parse_machine("joint.toml", test::rotary_joint, {{}, {counted, without_lag}}); }

machine::Machine joint_on_circle(double radius) {
  const double increment = 2.0 * std::numbers::pi * radius / counts;
  return sim::parse_machine("joint.toml", test::joint_on_circle(radius),
                            {{}, {fmt::format("axis.J.encoder.increment={} m", increment), without_lag}});
}

machine::Machine joint_of_an_unknown_controller() {
  auto text = test::rotary_joint;
  const auto begin = text.find("[axis.J.position_controller]"), end = text.find("[axis.J.friction]");
  text.replace(begin, end - begin, "[axis.J.controller]\nstructure = \"unknown\"\n");
  return sim::parse_machine("joint.toml", text, {{}, {counted}});
}

// Of records of a joint with half as much Coulomb friction again as in the file, compared with `machine`, which is the
// joint or its linear axis on a circle.
Verdict verdict_of(const machine::Machine& machine) {
  auto true_machine = joint();
  const auto coordinate = true_machine.axes[0].coordinate;
  DiagnoseInput input;
  input.machine = machine;
  input.next_measurement = false;
  true_machine.axes[0].effects.push_back({"coulomb_mismatch", {{"coulomb", {0.06 / coordinate.radius}}}});
  for (auto& record : record_commissioning(true_machine, 0, 1)) {
    if (!machine.axes[0].coordinate.rotary()) record.log.axes[0] = as_linear(std::move(record.log.axes[0]), coordinate);
    (record.held_out ? input.held_out : input.logs).push_back(std::move(record.log));
  }
  return diagnose(input);
}

TEST(RotaryDiagnosis, HasTheBitsOfTheLinearAxisOnItsCircleInItsOwnUnits) {
  const double radius = joint().axes[0].coordinate.radius;
  const auto turned = verdict_of(joint()), moved = verdict_of(joint_on_circle(radius));
  EXPECT_EQ(turned.baseline.force_rms, moved.baseline.force_rms);
  EXPECT_EQ(turned.extended.force_rms, moved.extended.force_rms);
  ASSERT_EQ(turned.findings.size(), moved.findings.size());
  ASSERT_FALSE(turned.findings.empty());
  EXPECT_EQ(turned.findings[0].effect.name(), "coulomb_mismatch");
  for (std::size_t k = 0; k < turned.findings.size(); ++k) {
    EXPECT_EQ(turned.findings[k].effect, moved.findings[k].effect);
    EXPECT_EQ(turned.findings[k].values, moved.findings[k].values);
  }
  const auto& own = turned.findings[0].parameters.at(0);
  EXPECT_EQ(own.name(), "coulomb_N_m");
  EXPECT_EQ(own.values.at(0), radius * moved.findings[0].parameters.at(0).values.at(0));
  EXPECT_NEAR(own.values.at(0), 0.06, 0.002);

  const auto json = verdict_json(turned);
  EXPECT_EQ(json.at("baseline").at("force_rms_N_m").get<double>(), radius * turned.baseline.force_rms);
  EXPECT_TRUE(json.at("baseline").contains("position_error_rms_urad"));
  const auto text = verdict_text(turned);
  for (const std::string_view linear : {" N rms", " um", " mm"})
    EXPECT_EQ(text.find(linear), std::string::npos) << text;
}

TEST(RotaryDiagnosis, JudgesNoCommandAndNoClosedLoopOfAControllerThatIsNotKnown) {
  const auto verdict = verdict_of(joint_of_an_unknown_controller());
  ASSERT_FALSE(verdict.findings.empty());
  EXPECT_EQ(verdict.findings[0].effect.name(), "coulomb_mismatch");
  EXPECT_FALSE(verdict.baseline.position_error_rms);
  EXPECT_FALSE(verdict.baseline.command_rms);
  EXPECT_EQ(verdict.closed_loop_withheld, "The controller of axis J is not known");
}

}  // namespace
}  // namespace stiction::host
