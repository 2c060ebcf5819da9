// Which sliding curve data prefer, and tables of steady states.
#include "host/identify/sliding_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "host/identify/identification.hpp"
#include "tests/host/identify/campaign.hpp"

namespace stiction::host {
namespace {

// Speeds up to 0.4 m/s both ways, 1 N of noise.
SlidingData made_of(double (*friction)(double)) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  SlidingData data;
  constexpr Eigen::Index n = 600;
  data.speed.resize(n);
  data.force.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double v = 0.4 * std::pow(static_cast<double>(i / 2 + 1) / 300.0, 2.0) * (i % 2 == 0 ? 1.0 : -1.0);
    data.speed[i] = v;
    data.force[i] = std::copysign(friction(std::abs(v)), v) + 3.0 + normal(random);
  }
  data.sign = data.speed.cwiseSign();
  data.others = Eigen::MatrixXd::Ones(n, 1);
  for (std::size_t i = 0; i < n; i += 10) data.blocks.push_back({i, i + 10});
  return data;
}

struct Case {
  const char* curve;
  double (*friction)(double);
  const char* parameter;
  double value;
};
class Curves : public ::testing::TestWithParam<Case> {};
TEST_P(Curves, the_one_the_data_were_made_of_is_chosen) {
  const auto& made = GetParam();
  const auto result = choose_sliding_curve(made_of(made.friction), 1.0, {});
  EXPECT_EQ(result.curve, made.curve);
  for (const auto& p : result.parameters)
    if (p.name == made.parameter) {
      EXPECT_NEAR(p.value, made.value, 0.1 * made.value);
    }
  for (const auto& point : result.points) EXPECT_LE(point.low, point.high);
  for (const auto& point : result.measured)
    EXPECT_NEAR(point.force, std::copysign(made.friction(std::abs(point.speed)), point.speed), 8.0);
}
// A logarithm is steeper at standstill than every power that is tried: none of them has an interval that holds it.
TEST(SlidingCurve, one_whose_parameter_leaves_what_is_tried_is_not_chosen) {
  const auto result = choose_sliding_curve(made_of([](double v) { return 90.0 + 12.0 * std::log(1e-4 + v); }), 1.0, {});
  EXPECT_NE(result.curve, "power");
  for (const auto& p : result.parameters) {
    EXPECT_LE(p.interval().low, p.value) << p.name;
    EXPECT_GE(p.interval().high, p.value) << p.name;
  }
  for (const auto& point : result.points) {
    EXPECT_LE(point.low, point.force);
    EXPECT_GE(point.high, point.force);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, Curves,
    ::testing::Values(
        Case{"linear", [](double v) { return 90.0 + 500.0 * v; }, "viscous_N_s_per_m", 500.0},
        Case{"two-slope", [](double v) { return 80.0 + 900.0 * std::min(v, 0.1) + 200.0 * std::max(v - 0.1, 0.0); },
             "viscous_N_s_per_m", 900.0},
        Case{"exponential", [](double v) { return 70.0 + 60.0 * (1.0 - std::exp(-v / 0.04)) + 300.0 * v; },
             "exponential_force_N", 60.0},
        Case{"power", [](double v) { return 60.0 + 250.0 * std::sqrt(v); }, "force_at_1_m_per_s_N", 250.0}),
    [](const auto& tested) {
      std::string name = tested.param.curve;
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

// Tab 5.1 of the cross table.
constexpr const char* table =
    "v[m/min],i[A]\n0.02,0.75\n0.1,0.85\n0.5,1\n1,1.25\n3.2,1.51\n5,1.7\n8,1.77\n10,2\n16,2.19\n24,2.62\n";

TEST(SteadyTable, prefers_a_curve_that_bends_and_says_what_it_cannot_know) {
  const auto machine = test::bench_machine("lugre");
  const auto result =
      identify_table(parse_steady_table(table, "tab.csv"), machine.axes.front(), Amperes::amplitude, {});
  ASSERT_TRUE(result.curve.has_value());
  EXPECT_NE(result.curve->curve, "linear");
  // The source's own straight line beyond 0.55 m/min: 110 N, 430 N s/m.
  ASSERT_NE(result.find("coulomb_N"), nullptr);
  EXPECT_NEAR(result.find("coulomb_N")->value, 105.0, 10.0);
  EXPECT_EQ(result.find("mass_kg"), nullptr);
  EXPECT_TRUE(std::any_of(result.not_determined.begin(), result.not_determined.end(),
                          [](const auto& n) { return n.name == "mass_kg"; }));
}

TEST(SteadyTable, rms_amperes_are_scaled) {
  const auto axis = test::bench_machine("lugre").axes.front();
  const auto peak = identify_table(parse_steady_table(table, "tab.csv"), axis, Amperes::amplitude, {});
  const auto rms = identify_table(parse_steady_table(std::string("# amperes: rms\n") + table, "tab.csv"), axis, {}, {});
  EXPECT_NEAR(rms.find("coulomb_N")->value / peak.find("coulomb_N")->value, std::numbers::sqrt2, 1e-9);
}

}  // namespace
}  // namespace stiction::host
