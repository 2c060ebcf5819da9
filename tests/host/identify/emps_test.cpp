// The measured EMPS axis: the published recipe's parameters. The record is not part of this repository (no licence
// text); it is looked for beside it.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "host/identify/refinement.hpp"
#include "host/log/read_log.hpp"
#include "sim/machine_file.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

std::filesystem::path record() {
  if (const char* place = std::getenv("STICTION_EMPS")) return place;
  return std::filesystem::path(STICTION_SOURCE_DIR) / ".." / "shared" / "data" / "emps.csv";
}

class Emps : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(record()))
      GTEST_SKIP() << record()
                   << " is not there: fetch the EMPS record from the benchmark's site "
                      "(nonlinearbenchmark.org) and name it in $STICTION_EMPS";
    log_ = host::read_log(record());
    machine_ = sim::read_machine(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/emps.toml");
  }
  host::Identification identify(const std::string& friction) {
    return host::identify_logs({log_}, machine_.axes.front(), {friction, host::Amperes::amplitude, {}});
  }
  host::Log log_;
  machine::Machine machine_;
};

TEST_F(Emps, published_parameters_come_back) {
  const auto result = identify("coulomb_viscous");
  for (const auto& [name, published] : {std::pair{"mass_kg", 95.1089},
                                        {"viscous_N_s_per_m", 203.5034},
                                        {"coulomb_N", 20.3935},
                                        {"constant_force_N", -3.1648}}) {
    const auto* found = result.find(name);
    ASSERT_NE(found, nullptr) << name;
    const double off = std::abs(found->value / published - 1.0);
    figure(fmt::format("EMPS, published recipe: {}", name),
           fmt::format("{:.4f}, published {:.4f}: {:.2g} % off (bound 0.1 %)", found->value, published, off * 100.0));
    EXPECT_LE(off, 1e-3) << name;
  }
  figure("EMPS, published recipe: relative force error",
         fmt::format("{:.3f} %, published 4.083 %", 100.0 * result.residual_rms / result.force_rms));
  EXPECT_NEAR(100.0 * result.residual_rms / result.force_rms, 4.083, 0.001);
}

TEST_F(Emps, closed_loop_follows_the_record_as_published) {
  const auto result = identify("coulomb_viscous");
  const auto refined = host::refine_in_closed_loop({log_}, machine_, machine_.axes.front(), result,
                                                   {"coulomb_viscous", host::Amperes::amplitude, {}});
  figure("EMPS, closed loop with the published parameters: position",
         fmt::format("{:.3f} um rms off the record, published 1.61 um; refined {:.3f} um",
                     refined.position_before * 1e6, refined.position_after * 1e6));
  EXPECT_NEAR(refined.position_before, 1.61e-6, 0.02e-6);
  EXPECT_LE(refined.force_after, refined.force_before);
}

TEST_F(Emps, seven_large_reversals_do_not_determine_a_presliding_stiffness) {
  const auto result = identify("lugre");
  EXPECT_EQ(result.find("stiffness_N_per_m"), nullptr);
  EXPECT_TRUE(std::any_of(result.not_determined.begin(), result.not_determined.end(),
                          [](const auto& n) { return n.name == "stiffness_N_per_m"; }));
}

TEST_F(Emps, friction_differs_between_the_directions) {
  const auto result = identify("coulomb_viscous");
  ASSERT_NE(result.find("viscous_positive_N_s_per_m"), nullptr);
  EXPECT_LT(result.find("viscous_positive_N_s_per_m")->ci95.high, result.find("viscous_negative_N_s_per_m")->ci95.low);
}

}  // namespace
}  // namespace stiction::test
