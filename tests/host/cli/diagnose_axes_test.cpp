// `stiction diagnose` of several axes, from a file with wrong masses, and of a test signal that cannot act.
#include <fstream>
#include <sstream>

#include "tests/host/cli/program.hpp"

namespace stiction::test {
namespace {

using json = nlohmann::ordered_json;

class DiagnoseAxes : public Cli {
 protected:
  // A log of both axes of the cross table at 1 kHz, from the simulation's own circle.
  void make_record() {
    ASSERT_EQ(stiction("simulate circle --machine mcfv5050ln --feed '16 m/min' --direction ccw --log run.csv").code, 0);
  }
  json verdict_of(const std::string& arguments) {
    const auto result = stiction("diagnose " + arguments + " --json");
    EXPECT_EQ(result.code, 0) << result.error;
    return result.code == 0 ? json::parse(result.out) : json();
  }
};

TEST_F(DiagnoseAxes, JudgesEachAxisThatLogAndMachineShare) {
  make_record();
  const auto both = verdict_of("run.csv --machine mcfv5050ln --out both");
  ASSERT_TRUE(both.contains("axes"));
  EXPECT_FALSE(both.contains("baseline"));
  for (const char* axis : {"X", "Y"}) {
    ASSERT_TRUE(both["axes"].contains(axis));
    const auto& verdict = both["axes"][axis];
    EXPECT_EQ(verdict["status"], "agrees") << verdict["status_reason"];
    EXPECT_LT(verdict["baseline"]["force_rms_N"], 1.25 * verdict["noise_floor_N"].get<double>());
    EXPECT_TRUE(fs::exists(work() / "both" / fmt::format("report_{}.html", axis)));
  }
  EXPECT_NE(content(work() / "both/report.html").find("report_Y.html"), std::string::npos);
  const auto one = verdict_of("run.csv --machine mcfv5050ln --axis Y");
  EXPECT_FALSE(one.contains("axes"));
  EXPECT_EQ(one["baseline"], both["axes"]["Y"]["baseline"]);
}

// Half of the mass: the file explains little of the force. It is diagnosed all the same, though not by its name: on a
// circle, of one frequency, a mass is a spring as well, or a force over the position. From identified values it is the
// machine again.
TEST_F(DiagnoseAxes, StartsFromIdentifiedValues) {
  make_record();
  const std::string file = "run.csv --machine mcfv5050ln --axis X --set axis.X.mass='90 kg'";
  const auto as_it_is = verdict_of(file);
  EXPECT_FALSE(as_it_is["findings"].empty());
  EXPECT_FALSE(as_it_is.contains("identified"));
  const auto identified = verdict_of(file + " --identify --out start");
  ASSERT_FALSE(identified["identified"].empty());
  double mass = 0.0;
  for (const auto& each : identified["identified"])
    if (each["name"] == "mass_kg") mass = each["value"];
  EXPECT_NEAR(mass, 225.0, 4.5);
  EXPECT_LT(identified["baseline"]["force_rms_N"], 0.2 * as_it_is["baseline"]["force_rms_N"].get<double>());
  EXPECT_NE(identified["notes"].front().get<std::string>().find("identified from the training logs"),
            std::string::npos);
  EXPECT_EQ(content(work() / "start/extended.toml").find("\"90 kg\""), std::string::npos);
}

TEST_F(DiagnoseAxes, WithholdsTheClosedLoopOfATestSignalWithoutAnInput) {
  make_record();
  std::istringstream lines(content(work() / "run.csv"));
  std::ofstream changed(work() / "test.csv");
  bool header = true;
  for (std::string line; std::getline(lines, line);) {
    const bool comment = line.starts_with('#');
    changed << line << (comment ? "" : header ? ",X.u_inject[V]" : ",1.5") << "\n";
    header = header && comment;
  }
  changed.close();
  const auto verdict = verdict_of("test.csv --machine mcfv5050ln --axis X");
  EXPECT_FALSE(verdict["baseline"].contains("position_error_rms_um"));
  EXPECT_NE(verdict["closed_loop_withheld"].get<std::string>().find("found X.u_inject[V]"), std::string::npos);
  EXPECT_NE(verdict["status"], "agrees");
  const auto compared = stiction("compare test.csv --machine mcfv5050ln --json");
  ASSERT_EQ(compared.code, 0) << compared.error;
  const auto rows = json::parse(compared.out)["machines"][0]["rows"];
  EXPECT_TRUE(rows[0].contains("withheld"));
  EXPECT_FALSE(rows[0].contains("position_difference_rms_um"));
  EXPECT_TRUE(rows[1].contains("position_difference_rms_um"));
}

}  // namespace
}  // namespace stiction::test
