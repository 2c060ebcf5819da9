// The program as its users call it: exit codes, messages, what is written and what is not.
#include "tests/host/cli/program.hpp"

namespace stiction::test {
namespace {

TEST_F(Cli, RefusesABadMachineFileWithPlaceFindingAndExpectation) {
  const std::string run = "simulate circle --out result --machine ";
  expect_refused(run + machine_with("mass = \"225 kg\"", "mass = \"225 A\""),
                 "axis.X.mass: found \"225 A\" (dimension A, not kg); expected a value greater than 0 kg");
  expect_refused(run + machine_with("mass = \"225 kg\"", "mass = \"-225 kg\""),
                 "axis.X.mass: found \"-225 kg\"; expected a value greater than 0 kg");
  expect_refused(run + machine_with("mass = \"225 kg\"", "masss = \"225 kg\""), "did you mean \"mass\"?");
  expect_refused(run + machine_with("mass = \"225 kg\"", ""), "axis.X.mass");
  expect_refused(run + machine_with("slow_period = \"1 ms\"", "slow_period = \"1.1 ms\""),
                 "timing.slow_period: found \"1.1 ms\"; expected a multiple of fast_period, 0.0625 ms");
  expect_refused(run + machine_with("schema = \"stiction.machine/1\"", "schema = \"other/1\""), "m.toml:");
}

TEST_F(Cli, RefusesAFeedThatAnAxisCannotAccelerate) {
  expect_refused("simulate circle --machine mcfv5050ln --feed '79 m/min' --radius '50 mm' --out result",
                 "feed: found 79 m/min, v^2/R = 34.67 m/s^2 at R = 50 mm; expected at most 20 m/s^2");
  expect_refused("simulate circle --machine mcfv5050ln --feed '100 m/min' --out result",
                 "feed: found 100 m/min; expected above 0 and at most 80 m/min");
  expect_refused("simulate circle --machine mcfv5050ln --radius '300 mm' --out result", "radius: found 300 mm");
}

TEST_F(Cli, RefusesBadUsage) {
  expect_refused("", "command: found none; expected one of simulate, compare, machine");
  expect_refused("simulate", "experiment: found none; expected one of circle, constant-velocity");
  expect_refused("simulate square --machine mcfv5050ln", "experiment: found 'square'; expected one of circle");
  expect_refused("simulate circle", "--machine: found none; expected MACHINE, shipped machine by name");
  expect_refused("simulate circle --machine nowhere", "found no such machine");
  expect_refused("simulate circle --machine mcfv5050ln --feed 16", "--feed: found '16' (no unit)");
  expect_refused("simulate circle --machine mcfv5050ln --friction stribeck", "--friction: found 'stribeck'");
  expect_refused("simulate circle --machine mcfv5050ln --direction left", "--direction: found 'left'");
  expect_refused("simulate circle --machine mcfv5050ln --signals float", "float");
  expect_refused("simulate circle --machine mcfv5050ln --log x.csv --friction all",
                 "expected one run: one friction model, one feed and one direction");
  expect_refused("simulate circle --machine mcfv5050ln --set axis.X.mas='1 kg'", "--set axis.X.mas");
  expect_refused("simulate circle --machine mcfv5050ln --radios '90 mm'", "--radios");
  expect_refused("simulate impact --machine mcfv5050ln --bogus", "--bogus");
  expect_refused("compare --reference square --machine mcfv5050ln", "--reference: found 'square'; expected circle");
  expect_refused("compare --machine mcfv5050ln",
                 "found neither --reference nor LOG; expected either --reference circle or a measured log");
}

TEST_F(Cli, RefusesAMachineWithoutThePartThatAnExperimentNeeds) {
  expect_refused("simulate impact --machine stick-slip-feed --out result",
                 "found a feed drive and no axis; expected a machine with a table [axis.NAME]");
  expect_refused("simulate circle --machine stick-slip-feed --out result", "found a feed drive and no axis");
  expect_refused("simulate feed-cutting --machine mcfv5050ln --out result",
                 "found axes and no feed drive; expected a machine with a table [feed_drive]");
}

TEST_F(Cli, RefusesFeedsAndEquationsThatFeedCuttingDoesNotKnow) {
  const std::string run = "simulate feed-cutting --machine stick-slip-feed ";
  expect_refused(run + "--equations wrong",
                 "--equations: found 'wrong'; expected one or several of: corrected, printed");
  expect_refused(run + "--feed '0 mm/min'", "--feed: found '0 mm/min'; expected feeds above zero");
  expect_refused(run + "--feed '60 mm'", "--feed: found '60 mm'");
  expect_refused(run + "--set feed_drive.carriage.mas='3 kg'", "did you mean \"mass\"?");
  expect_refused(run + "--friction lugre", "--friction");
  expect_refused(run + "--set feed_drive.speed_controller.gain=90", "the motor's loops are unstable");
}

TEST_F(Cli, FeedCuttingPrintsItsFiguresByTheContract) {
  const auto result =
      stiction("simulate feed-cutting --machine stick-slip-feed --feed '60 mm/min' --equations corrected --json");
  ASSERT_EQ(result.code, 0) << result.error;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["schema"], "stiction.feed-cutting/1");
  EXPECT_EQ(json["machine"], "stick-slip-feed");
  EXPECT_NEAR(json["results"]["jump_corrected_at_60_mm_per_min_um"].get<double>(), 281.0, 3.0);
  EXPECT_FALSE(json["results"].contains("jumps_printed_at_60_mm_per_min"));
  // Of the prototype's figures only the critical feed at zeta 0.1 differs: see its finding.
  for (const auto& [key, holds] : json["holds"].items())
    EXPECT_EQ(holds.get<bool>(), key != "critical_beta_at_zeta_0.1") << key;
}

TEST_F(Cli, RefusesAGainThatTheNumberFormatCannotHold) {
  expect_refused("simulate circle --machine mcfv5050ln --set axis.X.position_controller.gain='2000 1/s'",
                 "axis.X.position_controller.gain: found 2000 1/s; expected at most 1024 1/s in magnitude");
}

TEST_F(Cli, StopsAnUnstableLoopWithItsFaultAndKeepsTheTrace) {
  const auto result =
      stiction("simulate circle --machine mcfv5050ln --set axis.X.velocity_controller.gain='9000 A s/m' --log t.csv");
  EXPECT_EQ(result.code, 1);
  EXPECT_NE(result.error.find("axis X: fault 7 'limit cycle' at "), std::string::npos) << result.error;
  EXPECT_NE(result.error.find("its trace is in t.csv"), std::string::npos) << result.error;
  const auto trace = content(work() / "t.csv");
  ASSERT_NE(trace.find("t[s],X.x_set[m],"), std::string::npos);
  // The last row is that of the fault.
  const auto last = trace.substr(trace.rfind('\n', trace.size() - 2) + 1);
  EXPECT_NE(last.find(",7,"), std::string::npos) << last;
}

TEST_F(Cli, KeepsTheTraceOfAFaultInTheResultFolder) {
  const auto result =
      stiction("simulate circle --machine mcfv5050ln --set axis.Y.position_controller.gain='700 1/s' --out r");
  EXPECT_EQ(result.code, 1);
  EXPECT_TRUE(fs::exists(work() / "r/trace.csv"));
  EXPECT_EQ(nlohmann::json::parse(content(work() / "r/result.json"))["axis"], "Y");
}

TEST_F(Cli, PrintsTheCircleAsJsonAndNothingElse) {
  const auto result =
      stiction("simulate circle --machine mcfv5050ln --feed '16 m/min, 24 m/min' --friction lugre,classical --json");
  EXPECT_EQ(result.code, 0) << result.error;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["schema"], "stiction.circle/1");
  EXPECT_EQ(json["machine"], "mcfv5050ln");
  EXPECT_EQ(json["signals"], "fixed");
  EXPECT_NEAR(json["radius_m"].get<double>(), 0.09, 1e-12);
  ASSERT_EQ(json["rows"].size(), 8u);  // 2 axes, 2 models, 2 feeds
  for (const auto& row : json["rows"]) {
    EXPECT_GT(row["peak_error_um"].get<double>(), 1.0);
    EXPECT_TRUE(row.contains("measured"));
    EXPECT_TRUE(row["published_simulation"].contains("current_A"));
  }
  EXPECT_TRUE(nothing_written());
}

TEST_F(Cli, AcceptsBothDirectionsAndReportsThemTogether) {
  const auto result = stiction("simulate circle --machine mcfv5050ln --direction both --json");
  const auto json = nlohmann::json::parse(result.out);
  ASSERT_EQ(json["circular_errors"].size(), 2u);
  EXPECT_TRUE(json["circular_errors"][0].contains("bidirectional_circular_error_um"));
}

TEST_F(Cli, ReplacesAnEarlierResultAndRefusesAnotherFolder) {
  const std::string run = "simulate circle --machine mcfv5050ln --feed '48 m/min' --out ";
  EXPECT_EQ(stiction(run + "r").code, 0);
  EXPECT_EQ(stiction(run + "r").code, 0);
  EXPECT_TRUE(fs::exists(work() / "r/report.html"));
  EXPECT_EQ(std::distance(fs::directory_iterator(work()), {}), 1);  // nothing half written beside it
  fs::create_directories(work() / "mine");
  std::ofstream(work() / "mine/thesis.tex") << "precious";
  const auto result = stiction(run + "mine");
  EXPECT_EQ(result.code, 2);
  EXPECT_EQ(content(work() / "mine/thesis.tex"), "precious");
}

TEST_F(Cli, WritesALogInTheLogFormat) {
  EXPECT_EQ(stiction("simulate circle --machine mcfv5050ln --feed '48 m/min' --log run.csv").code, 0);
  std::ifstream file(work() / "run.csv");
  std::string line;
  do std::getline(file, line);
  while (line.starts_with("#"));
  for (const char* column : {"t[s]", "X.x_set[m]", "X.v_set[m/s]", "X.a_set[m/s^2]", "X.x[m]", "X.v[m/s]", "X.i[A]",
                             "X.i_set[A]", "Y.x[m]", "Y.u_C[V]"})
    EXPECT_NE(("," + line + ",").find(fmt::format(",{},", column)), std::string::npos) << column;
  const auto columns = std::count(line.begin(), line.end(), ',');
  int rows = 0;
  while (std::getline(file, line)) {
    ASSERT_EQ(std::count(line.begin(), line.end(), ','), columns);
    ++rows;
  }
  EXPECT_GT(rows, 16000);  // over a second at the full 16 kHz
}

TEST_F(Cli, RefusesAFrequencyResponseThatCannotBeMeasured) {
  const std::string run = "simulate frequency-response --machine mcfv5050ln --out result ";
  expect_refused(run + "--speed '0.05 m/min'", "expected a speed that never crosses zero: at least 0.");
  expect_refused(run + "--speed '90 m/min'", "--speed: found '90 m/min'; expected at most 80 m/min");
  expect_refused(run + "--speed '20 m/min'", "expected at most the travel of axis X, 500 mm");
  expect_refused(run + "--amplitude '60 A'", "amplitude: found 60 A, with which axis X is held back at a limit");
  expect_refused(run + "--amplitude '3 V'", "--amplitude: found '3 V'");
  expect_refused(run + "--periods 1", "--periods: found 1; expected at least 2");
  expect_refused(run + "--axis Z", "--axis: found 'Z'; expected axes of mcfv5050ln: X, Y");
  expect_refused(run + "--loop force", "--loop: found 'force'; expected all, or some of: current, velocity, position");
  expect_refused(run + "--friction all", "--friction: found");
  expect_refused(run + "--from nowhere.csv", "nowhere.csv: found no such file; expected a log");
  expect_refused(run + "--from run.csv --speed '1 m/min'",
                 "--from: found it together with --speed; expected only one of the two");
}

TEST_F(Cli, MeasuresAFrequencyResponseFromALogAsFromItsOwnRun) {
  const auto own =
      stiction("simulate frequency-response --machine mcfv5050ln --axis X --passes 2 --log run.csv --json");
  ASSERT_EQ(own.code, 0) << own.error;
  const auto again = stiction("simulate frequency-response --machine mcfv5050ln --from run.csv --json");
  ASSERT_EQ(again.code, 0) << again.error;
  const auto first = nlohmann::json::parse(own.out), second = nlohmann::json::parse(again.out);
  EXPECT_EQ(first["schema"], "stiction.frequency-response/1");
  EXPECT_EQ(first["results"], second["results"]);
  EXPECT_GT(first["results"]["velocity_loop_phase_margin_X_deg"], 45.0);
  EXPECT_TRUE(first["expected"].contains("velocity_loop_decays_up_to_X"));
  EXPECT_TRUE(second["expected"].empty()) << "nothing is known of a measured machine";
}

TEST_F(Cli, RefusesALogWithoutATestSignal) {
  ASSERT_EQ(stiction("simulate circle --machine mcfv5050ln --feed '48 m/min' --log run.csv").code, 0);
  const auto result = stiction("simulate frequency-response --machine mcfv5050ln --from run.csv --out result");
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(
      result.error.find("run.csv: axis X: found no i_inject and no u_inject; expected a log recorded with a test"),
      std::string::npos)
      << result.error;
  EXPECT_FALSE(fs::exists(work() / "result"));
}

TEST_F(Cli, ShowsTheShippedMachinesAndTheirReference) {
  for (const char* name : {"mcfv5050ln\n", "stick-slip-feed\n"})
    EXPECT_NE(stiction("machine").out.find(name), std::string::npos) << name;
  EXPECT_NE(stiction("machine --reference").out.find("pole_pair_pitch"), std::string::npos);
  const auto sheet = stiction("machine --check mcfv5050ln");
  EXPECT_EQ(sheet.code, 0);
  EXPECT_NE(sheet.out.find("MCFV 5050 LN"), std::string::npos);
  EXPECT_EQ(stiction("machine list").out, stiction("machine").out);
  EXPECT_EQ(stiction("machine reference").out, stiction("machine --reference").out);
  EXPECT_EQ(stiction("machine check mcfv5050ln").out, sheet.out);
  EXPECT_EQ(stiction("machine list --axes mcfv5050ln").out, "X\nY\n");
  EXPECT_NE(stiction("--version").out.find(" (commit "), std::string::npos);
  for (const char* help : {"--help", "simulate --help", "simulate circle --help", "compare --help", "--version"})
    EXPECT_EQ(stiction(help).code, 0) << help;
}

}  // namespace
}  // namespace stiction::test
