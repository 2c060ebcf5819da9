// Fits to records without noise, and to what they must notice.
#include "host/identify/friction_fit.hpp"

#include <gtest/gtest.h>

#include "host/identify/identification.hpp"
#include "sim/plant/friction/friction.hpp"
#include "sim/plant/friction/lugre.hpp"
#include "sim/plant/friction/parameters.hpp"
#include "tests/host/identify/campaign.hpp"

namespace stiction::host {
namespace {

std::vector<Log> records(const machine::Machine& machine) {
  std::vector<Log> logs;
  for (const auto& trajectory : test::commissioning()) logs.push_back(test::simulated(machine, trajectory));
  return logs;
}

TEST(FrictionFit, without_noise_gives_the_parameters_of_the_simulated_axis) {
  const auto machine = test::bench_machine("lugre");
  const auto result = identify_logs(records(machine), machine.axes.front(), {"lugre", Amperes::amplitude, {}});
  for (const auto& truth : test::truths_of(machine.axes.front())) {
    if (truth.value == 0.0) continue;
    const auto* found = result.find(truth.name);
    ASSERT_NE(found, nullptr) << truth.name;
    // What is left is the plant's own step: friction acts up to 16 us late against the recorded force.
    EXPECT_NEAR(found->value / truth.value, 1.0, truth.name == "damping_ratio" ? 1e-2 : 1e-3) << truth.name;
  }
}

TEST(FrictionFit, finds_stribecks_fall_of_the_friction) {
  auto machine = test::bench_machine("lugre");
  auto& friction = machine.axes.front().friction;
  auto lugre = sim::parameters_of<sim::LuGre<>>(friction);
  lugre.static_ratio = 1.4;
  lugre.stribeck_velocity = 5e-3;
  sim::set_parameters<sim::LuGre<>>(friction, lugre);
  std::vector<Log> logs = records(machine);
  logs.push_back(test::simulated(machine, test::constant_speeds({1e-3, 2e-3, 4e-3, 7e-3, 12e-3}, 0.3, 0.5e-3)));
  std::vector<Log> noisy;
  for (std::size_t k = 0; k < logs.size(); ++k) noisy.push_back(test::with_noise(logs[k], {}, 40 + k));
  const auto result = identify_logs(noisy, machine.axes.front(), {"lugre", Amperes::amplitude, {}});
  ASSERT_NE(result.find("static_ratio"), nullptr);
  ASSERT_NE(result.find("stribeck_velocity_m_per_s"), nullptr);
  // 1 % of current noise is 8 N a sample, 9 % of the Coulomb level.
  EXPECT_NEAR(result.find("static_ratio")->value, 1.4, 0.03);
  EXPECT_NEAR(result.find("stribeck_velocity_m_per_s")->value, 5e-3, 0.5e-3);
  EXPECT_NEAR(result.find("coulomb_N")->value, 90.0, 1.0);
}

// What shapes its contact is the file's, its length and level are found. LuGre's contact creeps where this one is
// elastic.
TEST(FrictionFit, a_law_whose_contact_has_one_length_is_fitted_by_its_own_contact) {
  for (const char* law : {"dahl", "elasto_plastic"}) {
    const auto machine = test::bench_machine(law);
    auto expected = machine.axes.front();
    sim::stretch_contact(expected.friction, 2.0);  // the file from which the fit begins
    const auto result = identify_logs(records(machine), expected, {law, Amperes::amplitude, {}});
    EXPECT_EQ(result.friction, law);
    const auto contact = sim::contact_of(machine.axes.front().friction);
    ASSERT_NE(result.find("stiffness_N_per_m"), nullptr) << law;
    EXPECT_NEAR(result.find("stiffness_N_per_m")->value / contact->stiffness, 1.0, 1e-2) << law;
    EXPECT_NEAR(result.find("coulomb_N")->value / contact->level, 1.0, 2e-3) << law;
    EXPECT_LT(result.residual_rms, 0.01 * contact->level) << law;
  }
}

TEST(FrictionFit, lugres_contact_is_fitted_where_the_law_has_none_of_one_length) {
  for (const char* law : {"maxwell_slip", "lugre"}) {
    const auto machine = test::bench_machine(law);
    EXPECT_FALSE(has_contact_of_one_length(machine.axes.front().friction)) << law;
    for (const char* wanted : {"", law})
      EXPECT_EQ(identify_logs(records(machine), machine.axes.front(), {wanted, Amperes::amplitude, {}}).friction,
                "lugre");
  }
}

// A contact where there is none took part of the mass and of the slope: of 24 records of an axis that sticks rigidly
// the intervals of the mass held the truth in 58 %. Whoever expects a contact asks for it.
TEST(FrictionFit, a_file_that_sticks_rigidly_gets_a_contact_only_where_it_is_asked_for) {
  for (const char* law : {"classical", "curve"}) {
    const auto machine = test::bench_machine(law);
    for (const char* wanted : {"", law, "lugre"})
      EXPECT_EQ(identify_logs(records(machine), machine.axes.front(), {wanted, Amperes::amplitude, {}}).friction,
                std::string_view(wanted) == "lugre" ? "lugre" : "coulomb_viscous")
          << law << wanted;
  }
}

TEST(FrictionFit, lugres_contact_does_not_fit_one_that_is_elastic_up_to_break_away) {
  const auto machine = test::bench_machine("elasto_plastic");
  const auto& axis = machine.axes.front();
  const auto own = identify_logs(records(machine), axis, {"elasto_plastic", Amperes::amplitude, {}});
  const auto lugre = identify_logs(records(machine), axis, {"lugre", Amperes::amplitude, {}});
  EXPECT_LT(10.0 * own.residual_rms, lugre.residual_rms);
}

TEST(FrictionFit, maxwell_slip_elements_sum_to_the_coulomb_level) {
  const auto machine = test::bench_machine("maxwell_slip");
  const auto result = identify_logs(records(machine), machine.axes.front(), {"lugre", Amperes::amplitude, {}});
  ASSERT_FALSE(result.elements.empty());
  double level = 0.0, displacement = 0.0;
  for (const auto& element : result.elements) level += element.level;
  // The fit's slip distances are a grid, those of the truth lie between.
  EXPECT_NEAR(level, 90.0, 0.9);
  // Tab 5.3 B, scaled by 0.9: 54 N at 6.3 um.
  double force = 0.0;
  displacement = 6.3e-6;
  for (const auto& element : result.elements) force += std::min(element.stiffness * displacement, element.level);
  EXPECT_NEAR(force, 54.0, 3.0);
}

TEST(FrictionFit, a_log_read_in_rms_is_the_amplitudes_root_2) {
  const auto machine = test::bench_machine("lugre");
  auto logs = records(machine);
  for (auto& log : logs)
    for (double& i : log.axes.front().i) i /= std::numbers::sqrt2;
  const auto result = identify_logs(logs, machine.axes.front(), {"lugre", Amperes::rms, {}});
  EXPECT_NEAR(result.find("mass_kg")->value, 225.0, 0.3);
}

TEST(InitialValues, are_within_a_third_of_the_truth) {
  const auto machine = test::bench_machine("lugre");
  const auto result = identify_logs(records(machine), machine.axes.front(), {"lugre", Amperes::amplitude, {}});
  // By hand, at a reversal: viscous friction and the acceleration's part are in the step.
  EXPECT_NEAR(result.initial.coulomb.value_or(0.0), 90.0, 30.0);
  EXPECT_NEAR(result.initial.viscous.value_or(0.0), 500.0, 100.0);
  EXPECT_NEAR(result.initial.mass.value_or(0.0), 225.0, 10.0);
}

}  // namespace
}  // namespace stiction::host
