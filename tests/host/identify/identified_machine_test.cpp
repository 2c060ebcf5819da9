// identified.toml: a machine that can be simulated, with what was determined and without what was not.
#include "host/identify/identified_machine.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "sim/machine_file.hpp"
#include "sim/plant/friction/coulomb_viscous.hpp"
#include "sim/plant/friction/lugre.hpp"
#include "sim/plant/friction/parameters.hpp"
#include "tests/host/identify/campaign.hpp"

namespace stiction::host {
namespace {

class IdentifiedMachine : public ::testing::Test {
 protected:
  const std::filesystem::path shipped_ = std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml";
  const machine::Machine machine_ = sim::read_machine(shipped_);

  static Identification found(const std::vector<std::pair<std::string, double>>& values) {
    Identification result;
    result.axis = "X";
    result.sources = {"run.csv"};
    for (const auto& [name, value] : values) result.parameters.push_back({name, value, {value, value}, ""});
    return result;
  }
  std::string text_of(const Identification& result, const std::vector<std::string>& set = {}) const {
    return identified_machine(shipped_, set, machine_.axes.front(), result, "a command");
  }
  static machine::Machine read(const std::string& text, const std::string& experiment = "") {
    const auto file =
        std::filesystem::temp_directory_path() / ("stiction-identified-" + std::to_string(::getpid()) + ".toml");
    std::ofstream(file) << text;
    const auto machine = sim::read_machine(file, {experiment, {}});
    std::filesystem::remove(file);
    return machine;
  }
};

TEST_F(IdentifiedMachine, carries_what_was_determined_and_leaves_the_other_axis_alone) {
  const auto machine = read(text_of(found({{"mass_kg", 230.5},
                                           {"coulomb_N", 101.0},
                                           {"viscous_N_s_per_m", 450.0},
                                           {"static_ratio", 1.2},
                                           {"stribeck_velocity_m_per_s", 2e-3},
                                           {"stiffness_N_per_m", 9.5e5},
                                           {"damping_ratio", 0.15}})));
  const auto& axis = machine.axes.front();
  EXPECT_DOUBLE_EQ(axis.mass, 230.5);
  EXPECT_EQ(axis.friction.use, "lugre");
  const auto& lugre = sim::parameters_of<sim::LuGre<>>(axis.friction);
  EXPECT_DOUBLE_EQ(lugre.coulomb, 101.0);
  EXPECT_DOUBLE_EQ(lugre.static_ratio, 1.2);
  EXPECT_DOUBLE_EQ(lugre.stribeck_velocity, 2e-3);
  EXPECT_DOUBLE_EQ(lugre.stiffness, 9.5e5);
  // Slope and exponent of the others were not identified.
  EXPECT_FALSE(axis.friction.models.contains("linear_ramp"));
  EXPECT_FALSE(axis.friction.models.contains("parabolic"));
  EXPECT_FALSE(axis.friction.models.contains("maxwell_slip"));
  EXPECT_DOUBLE_EQ(machine.axes[1].mass, machine_.axes[1].mass);
  EXPECT_TRUE(machine.axes[1].friction.models.contains("linear_ramp"));
}

TEST_F(IdentifiedMachine, leaves_out_a_model_of_which_a_parameter_is_missing_and_names_it) {
  const auto text = text_of(found({{"coulomb_N", 101.0}, {"viscous_N_s_per_m", 450.0}}));
  const auto machine = read(text);
  const auto& friction = machine.axes.front().friction;
  EXPECT_EQ(friction.models.size(), 1u);
  EXPECT_EQ(friction.use, "coulomb_viscous");
  EXPECT_DOUBLE_EQ(machine.axes.front().mass, machine_.axes.front().mass);
  EXPECT_NE(text.find("mass: kept from the machine file, 225 kg"), std::string::npos);
  EXPECT_NE(text.find("friction.lugre: left out, not determined: static_ratio"), std::string::npos);
}

TEST_F(IdentifiedMachine, experiments_of_the_file_do_not_override_what_was_identified) {
  const auto text = text_of(found({{"mass_kg", 230.5}, {"coulomb_N", 101.0}, {"viscous_N_s_per_m", 450.0}}));
  const auto machine = read(text, "presliding");
  EXPECT_DOUBLE_EQ(machine.axes.front().mass, 230.5);
  EXPECT_DOUBLE_EQ(sim::parameters_of<sim::CoulombViscous<>>(machine.axes.front().friction).coulomb, 101.0);
}

TEST_F(IdentifiedMachine, keeps_what_the_command_line_set) {
  const auto machine = read(text_of(found({{"coulomb_N", 101.0}, {"viscous_N_s_per_m", 450.0}}),
                                    {"axis.X.velocity_controller.gain=500 A s/m"}));
  EXPECT_DOUBLE_EQ(machine.axes.front().velocity_controller.gain, 500.0);
}

TEST_F(IdentifiedMachine, with_a_mass_alone_keeps_the_files_friction_and_says_so) {
  const auto text = text_of(found({{"mass_kg", 230.5}}));
  EXPECT_NE(text.find("friction: kept from the machine file"), std::string::npos);
  const auto machine = read(text);
  EXPECT_DOUBLE_EQ(machine.axes.front().mass, 230.5);
  EXPECT_EQ(machine.axes.front().friction.use, "lugre");
}

// What it is for: the closed loop with the identified machine follows the record.
TEST_F(IdentifiedMachine, simulated_in_closed_loop_moves_like_the_axis_it_was_identified_from) {
  const auto truth = test::bench_machine("lugre");
  std::vector<Log> logs;
  for (const auto& trajectory : test::commissioning())
    logs.push_back(test::with_noise(test::simulated(truth, trajectory), {}, logs.size() + 1));
  const auto result = identify_logs(logs, truth.axes.front(), {"lugre", Amperes::amplitude, {}});
  auto identified = read(text_of(result));
  identified.axes.resize(1);
  identified.axes.front().motor.model = machine::MotorModel::dc;
  // A circle at another feed than the recorded one.
  const auto trajectory = test::circle(8.0 / 60.0, 1.0);
  const auto a = test::simulated(truth, trajectory), b = test::simulated(identified, trajectory);
  double worst = 0.0;
  for (std::size_t k = 0; k < a.t.size(); ++k) worst = std::max(worst, std::abs(a.axes[0].x[k] - b.axes[0].x[k]));
  // One increment of the position controller may come a tick earlier or later: it moves the axis by
  // up to 0.22 um (seen between the motor models, README).
  EXPECT_LT(worst, 0.25e-6);
}

}  // namespace
}  // namespace stiction::host
