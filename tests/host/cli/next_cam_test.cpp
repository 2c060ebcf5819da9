// `stiction diagnose` of an axis that follows a cam: the cam that it proposes is run as its verdict says.
#include <fstream>

#include "tests/host/cli/program.hpp"

namespace stiction::test {
namespace {

using json = nlohmann::ordered_json;

constexpr const char* first_cam = R"(schema = "stiction.cam/1"
[cam.push]
cycle = "360 deg"
slave = "linear"
[[cam.push.segment]]
length = "30 deg"
[[cam.push.segment]]
length = "150 deg"
stroke = "75 mm"
law = "3-4-5"
[[cam.push.segment]]
length = "30 deg"
[[cam.push.segment]]
end = "360 deg"
stroke = "-75 mm"
law = "3-4-5"
)";

class NextCamCli : public Cli {
 protected:
  // The demonstration's X with 6 kg less on it than its file says; and as that says.
  void make_machines() {
    const auto shipped = content(fs::path(STICTION_SOURCE_DIR) / "firmware/machine/shipped/mcfv5050ln.toml");
    std::ofstream(work() / "m.toml") << shipped;
    std::ofstream(work() / "real.toml") << shipped
                                        << "\n[[axis.X.effect]]\nname = \"mass_mismatch\"\nmass = \"219 kg\"\n";
    std::ofstream(work() / "push.toml") << first_cam;
  }
  // Of `cam` on the real machine, as `log`.
  void record(const std::string& cam, const std::string& speed, int cycles, const char* log) {
    const auto done =
        stiction(fmt::format("simulate cam --machine real.toml {} --axis X --cam {} --speed '{}' "
                             "--cycles {} --log {}",
                             known, cam, speed, cycles, log));
    ASSERT_EQ(done.code, 0) << done.error;
  }
  json verdict_of(const std::string& logs) {
    const auto result = stiction(fmt::format("diagnose {} --machine m.toml {} --axis X --json", logs, known));
    EXPECT_EQ(result.code, 0) << result.error;
    return result.code == 0 ? json::parse(result.out) : json();
  }

  static constexpr const char* known =
      "--set axis.X.encoder.velocity=estimated --set 'axis.X.encoder.noise=2 nm' --set "
      "'axis.X.motor.force_constant=94.2 N/A'";
};

TEST_F(NextCamCli, TheProposedCamIsRunAsTheVerdictSays) {
  make_machines();
  record("push.toml", "33 rpm", 4, "first.csv");
  const auto before = verdict_of("first.csv --out found");
  ASSERT_TRUE(before.contains("next_measurement")) << before.dump(1);
  const auto& next = before["next_measurement"];
  ASSERT_TRUE(next.contains("cam")) << next.dump(1);
  EXPECT_EQ(next["cam"]["file"], "next_measurement_cam.toml");
  EXPECT_EQ(next["log"], "next_measurement.csv");
  ASSERT_FALSE(before["findings"][0]["confused_with"].empty());
  const auto file = content(work() / "found/next_measurement_cam.toml");
  EXPECT_NE(file.find(next["cam"]["command"].get<std::string>()), std::string::npos) << file;
  EXPECT_NE(content(work() / "found/next_measurement.csv").find("X.master[rad]"), std::string::npos);

  // The command as it is said, in the folder of the verdict.
  auto command = next["cam"]["command"].get<std::string>();
  ASSERT_TRUE(command.starts_with("stiction "));
  const auto simulated = run_shell("cd found && '{}' " + command.substr(9));
  EXPECT_EQ(simulated.code, 0) << simulated.error;
  EXPECT_TRUE(fs::exists(work() / "found/next.csv"));

  const auto record = content(work() / "found/next.csv");
  EXPECT_NE(record.find("X.master[rad]"), std::string::npos);
  EXPECT_NE(command.find(fmt::format("{} rpm", next["cam"]["master_speed_rpm"].get<double>())), std::string::npos);
}

}  // namespace
}  // namespace stiction::test
