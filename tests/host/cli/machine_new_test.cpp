// Machine files that are made of logs, by the command as its users call it.
#include "tests/host/cli/program.hpp"
#include "tests/support/moved_axis.hpp"

namespace stiction::test {
namespace {

// A log by hand, as a drive writes it: laps at four speeds of 80 kg with 20 N and 150 N s/m, at 35 N/V.
void write_moved(const fs::path& file, const MovedAxis& axis) {
  std::ofstream out(file);
  const auto log = moved(axis);
  const auto& channels = log.axes[0];
  out << (axis.rotary ? "t[s],x_set[rad],x[rad],u[V]\n" : "t[s],x_set[m],x[m],u[V]\n");
  for (std::size_t k = 0; k < log.t.size(); ++k)
    out << fmt::format("{},{},{},{}\n", log.t[k], channels.x_set[k], channels.x[k], channels.u[k]);
}

// What it takes to begin: a log, and what a volt or an ampere makes.
TEST_F(Cli, MakesAMachineFileOfALogAndAForceConstant) {
  write_moved(work() / "laps.csv", {.volts = true});
  const auto made = stiction("machine new --from-log laps.csv --force-constant '35 N/V' --out made.toml");
  ASSERT_EQ(made.code, 0) << made.error;
  EXPECT_EQ(made.error, "");
  EXPECT_EQ(stiction("machine --check made.toml").code, 0);
  const auto result = stiction("identify laps.csv --machine made.toml --json");
  ASSERT_EQ(result.code, 0) << result.error;
  const auto parameters = nlohmann::json::parse(result.out)["parameters"];
  EXPECT_NEAR(parameters["mass_kg"]["value"], 80.0, 0.8);
  const auto text = content(work() / "made.toml");
  EXPECT_NE(text.find(fmt::format("mass = \"{:.6g} kg\"", parameters["mass_kg"]["value"].get<double>())),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("from the log laps.csv: 95 % from"), std::string::npos);
}

TEST_F(Cli, MakesAMachineFileOfTheLogOfAJoint) {
  write_moved(work() / "joint.csv", {.rotary = true,
                                     .mass = 5e-3,
                                     .coulomb = 0.02,
                                     .viscous = 0.01,
                                     .moment = 0.4,
                                     .per_unit = 0.1,
                                     .increment = 1e-3,
                                     .speeds = {0.5, 1.1, 2.3, 4.1},
                                     .stroke = 1.5,
                                     .acceleration = 60.0,
                                     .volts = true});
  ASSERT_EQ(stiction("machine new --from-log joint.csv --torque-constant '0.1 N m/V' --axis J --out made.toml").code,
            0);
  EXPECT_EQ(stiction("machine check made.toml").code, 0);
  const auto result = stiction("identify joint.csv --machine made.toml --json");
  ASSERT_EQ(result.code, 0) << result.error;
  EXPECT_NEAR(nlohmann::json::parse(result.out)["parameters"]["gravity_moment_N_m"]["value"], 0.4, 0.02);
}

TEST_F(Cli, NamesWhatLogAndSheetContradict) {
  write_moved(work() / "laps.csv", {.volts = true});
  const auto made =
      stiction("machine new --from-log laps.csv --force-constant '35 N/V' --load '120 kg' --out made.toml");
  ASSERT_EQ(made.code, 0) << made.error;
  EXPECT_NE(made.error.find("note: mass of the load without motor and transmission: the sheet's 120 kg and the"),
            std::string::npos)
      << made.error;
  EXPECT_NE(content(work() / "made.toml").find("mass = \"120 kg\""), std::string::npos);
}

TEST_F(Cli, RefusesLogsThatMakeNoMachine) {
  write_moved(work().parent_path() / "laps.csv", {.volts = true});
  expect_refused("machine new --from-log none.csv --force-constant '35 N/V'", "found no such file; expected a log");
  expect_refused("machine new --from-log ../laps.csv --force-constant '94 N/A'",
                 "found the voltage u alone and a motor's constant per ampere; expected a constant per volt");
  expect_refused("machine new --from-log ../laps.csv --torque-constant '1 N m/V' --kind rotary",
                 "--kind: found \"rotary\"; expected \"linear\", from the log laps.csv");
  expect_refused("machine new --from-log ../laps.csv", "--force-constant: found none; expected force constant");
  expect_refused("machine new --columns 't[s],x[m]'", "--columns: found \"t[s],x[m]\"; expected none without");
  write_moved(work().parent_path() / "slow.csv", {.speeds = {0.02}, .acceleration = 0.02, .volts = true});
  expect_refused("machine new --from-log ../slow.csv --force-constant '35 N/V'",
                 "--load: found none, and the log slow.csv does not determine it (");
}

}  // namespace
}  // namespace stiction::test
