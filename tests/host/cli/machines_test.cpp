// The program on machines of several kinds: what each can do, and what it is told where it cannot.
#include <map>

#include "tests/host/cli/program.hpp"

namespace stiction::test {
namespace {

// Whatever a machine cannot serve is bad input with one sentence, never a failure or a signal.
TEST_F(Cli, EveryExperimentRunsOnEachShippedMachineOrSaysWhatItNeeds) {
  const std::map<std::string, std::map<std::string, std::string>> refused{
      {"mcfv5050ln", {{"feed-cutting", "found axes and no feed drive; expected a machine with a table [feed_drive]"}}},
      {"emps",
       {{"l-shape",
         "found axis X alone; expected a machine with exactly two axes: one is at standstill while the other moves"},
        {"presliding", "found axis X with parameters of coulomb_viscous; expected parameters of a friction model"},
        {"friction-lag", "makes sense for: lugre"},
        {"break-away", "makes sense for: lugre"},
        {"stick-slip", "makes sense for: lugre, classical"},
        {"feed-cutting", "found axes and no feed drive"}}},
      {"screw-motor-encoder",
       {{"l-shape", "found axis X alone; expected a machine with exactly two axes"},
        {"feed-cutting", "found axes and no feed drive"}}},
      {"screw-linear-scale",
       {{"l-shape", "found axis X alone; expected a machine with exactly two axes"},
        {"feed-cutting", "found axes and no feed drive"}}},
      {"stick-slip-feed", {}}};
  for (const auto& [machine, sentences] : refused)
    for (const std::string experiment :
         {"circle", "constant-velocity", "impact", "l-shape", "presliding", "friction-lag", "break-away", "stick-slip",
          "feed-cutting", "frequency-response", "commissioning --out ../logs"}) {
      const auto command = fmt::format("simulate {} --machine {}", experiment, machine);
      const bool feed_drive = machine == "stick-slip-feed";
      if (feed_drive && experiment != "feed-cutting") {
        expect_refused(command, machine + ".toml: found a feed drive and no axis; expected a machine with");
      } else if (const auto sentence = sentences.find(experiment); sentence != sentences.end()) {
        expect_refused(command, sentence->second);
        expect_refused(command, machine + ".toml: found ");
      } else {
        const auto result = stiction(command);
        EXPECT_EQ(result.code, 0) << command << "\n" << result.error;
      }
    }
}

TEST_F(Cli, EveryOtherCommandSaysWhatItNeedsOfAMachine) {
  ASSERT_EQ(stiction("simulate commissioning --machine emps --out ../logs").code, 0);
  expect_refused("compare --reference circle --machine emps", "emps.toml: found no row [[reference.circle]]; expected");
  for (const char* command : {"identify --reference circle --out result", "diagnose --reference circle --out result"}) {
    expect_refused(fmt::format("{} --machine emps", command),
                   "emps.toml: found axis X alone; expected a machine with exactly two axes");
    expect_refused(fmt::format("{} --machine {}", command, machine_without("circle = [", "# Tab 5.1")),
                   "m.toml: found no row [[reference.circle]]; expected at least one");
  }
  for (const char* command : {"compare", "inspect", "identify", "diagnose", "tune-friction", "simulate replay --from"})
    expect_refused(fmt::format("{} ../logs/circle.csv --machine stick-slip-feed", command),
                   "stick-slip-feed.toml: found a feed drive and no axis; expected a machine with a table [axis.NAME]");
  expect_refused("simulate frequency-response --machine emps --loop current --out result",
                 "emps.toml: found no current controller on axis X alone; expected an axis with");
  expect_refused("simulate impact --machine mcfv5050ln --axis Z", "--axis: found 'Z'; expected an axis of mcfv5050ln");
  expect_refused("simulate commissioning --machine emps --axis Y --out result", "expected an axis of emps: X");
}

// Axes with motors of their own kind: what each experiment measures is its motor's.
TEST_F(Cli, ExperimentsStayWithinWhatTheAxisCanDo) {
  const auto json = [&](const std::string& command) {
    const auto result = stiction(command + " --json");
    EXPECT_EQ(result.code, 0) << result.error;
    return nlohmann::json::parse(result.out);
  };
  // 12 m/min at most.
  const auto speeds = json("simulate constant-velocity --machine emps");
  for (const auto& [key, value] : speeds["results"].items()) EXPECT_EQ(key.find("_16_m"), std::string::npos) << key;
  // A step of a quarter of 10 V times 35.15 N/V; its proportional velocity loop does not take it back.
  const auto impact = json("simulate impact --machine emps");
  EXPECT_GT(impact["results"]["peak_deviation_coulomb_viscous_um"], 10.0);
  EXPECT_FALSE(impact["results"].contains("return_time_coulomb_viscous_ms"));
  EXPECT_NE(impact["findings"].dump().find("no integral part"), std::string::npos);
  // The other axis of the cross table.
  const auto y = json("simulate impact --machine mcfv5050ln --axis Y --friction lugre");
  const auto x = json("simulate impact --machine mcfv5050ln --friction lugre");
  EXPECT_LT(y["results"]["peak_deviation_lugre_um"], 0.8 * x["results"]["peak_deviation_lugre_um"].get<double>());
  expect_refused("simulate l-shape --machine mcfv5050ln --set axis.Y.travel='100 mm'",
                 "l-shape: found a path with a way of 1");
}

// Few reversals: what the search does not try on such a record may be a shape outside of the vocabulary.
TEST_F(Cli, DiagnosesALogOfOneLap) {
  for (const char* friction : {"maxwell_slip", "classical"}) {
    ASSERT_EQ(stiction(fmt::format("simulate circle --machine mcfv5050ln --friction {} --log lap.csv "
                                   "--set axis.X.friction.lugre.viscous='700 N s/m'",
                                   friction))
                  .code,
              0);
    EXPECT_EQ(stiction("diagnose lap.csv --machine mcfv5050ln --axis X").code, 0) << friction;
  }
}

// The order of commands in README: the shipped file agrees with the log of its own simulation.
TEST_F(Cli, NamesNothingInTheLogOfTheFilesOwnCircle) {
  ASSERT_EQ(stiction("simulate circle --machine mcfv5050ln --feed '16 m/min' --log run.csv").code, 0);
  for (const char* axis : {"X", "Y"}) {
    const auto result = stiction(fmt::format("diagnose run.csv --machine mcfv5050ln --axis {} --json", axis));
    ASSERT_EQ(result.code, 0) << result.error;
    const auto verdict = nlohmann::json::parse(result.out);
    EXPECT_TRUE(verdict["findings"].empty()) << axis << ": " << verdict["findings"].dump(2);
    EXPECT_LT(verdict["baseline"]["force_rms_N"], 0.1) << axis;  // of forces of 150 and 400 N rms
  }
  // The mass too is that of the file: 224.5 kg, were the current read with the drive's 94 N/A.
  const auto result = stiction("identify run.csv --machine mcfv5050ln --axis X --json");
  ASSERT_EQ(result.code, 0) << result.error;
  const auto identified = nlohmann::json::parse(result.out);
  EXPECT_NEAR(identified["parameters"]["mass_kg"]["value"], 225.0, 0.1);
}

// Its velocity controller sees the motor, the records the table: of the drive's gains nothing can be said.
TEST_F(Cli, NamesNothingInTheRecordsOfAnElasticScrewWithAScale) {
  ASSERT_EQ(stiction("simulate commissioning --machine screw-linear-scale --out records").code, 0);
  const auto result = stiction(
      "diagnose records/circle.csv records/speeds.csv --holdout records/other-circle.csv --machine screw-linear-scale "
      "--json");
  ASSERT_EQ(result.code, 0) << result.error;
  const auto verdict = nlohmann::json::parse(result.out);
  EXPECT_TRUE(verdict["findings"].empty()) << verdict["findings"].dump(2);
  EXPECT_NE(verdict["notes"].dump().find("sees a different encoder than the recorded one"), std::string::npos);
}

// What is too small to be told in an exact log is not what a machine has.
TEST_F(Cli, NamesWhatTheFileLacksInALogWithoutNoise) {
  ASSERT_EQ(stiction("simulate circle --machine mcfv5050ln --feed '16 m/min' --log run.csv "
                     "--set axis.X.friction.lugre.coulomb='95 N'")
                .code,
            0);
  const auto result = stiction("diagnose run.csv --machine mcfv5050ln --axis X --json");
  ASSERT_EQ(result.code, 0) << result.error;
  const auto verdict = nlohmann::json::parse(result.out);
  ASSERT_FALSE(verdict["findings"].empty());
  EXPECT_EQ(verdict["findings"][0]["effect"], "coulomb_mismatch") << verdict["findings"].dump(2);
  EXPECT_NEAR(verdict["findings"][0]["parameters"]["coulomb_N"], 95.0, 0.5);
}

TEST_F(Cli, EachAxisKeepsItsOwnFrictionModelUnlessOneIsNamed) {
  const auto run = [&](const std::string& more) {
    const auto result =
        stiction("simulate circle --machine mcfv5050ln --json --set axis.Y.friction.use=classical " + more);
    EXPECT_EQ(result.code, 0) << result.error;
    return nlohmann::json::parse(result.out)["rows"];
  };
  const auto own = run(""), lugre = run("--friction lugre"), classical = run("--friction classical");
  EXPECT_EQ(own[0]["friction"], "X lugre, Y classical");
  EXPECT_EQ(own[0]["peak_error_um"], lugre[0]["peak_error_um"]);
  EXPECT_EQ(own[1]["peak_error_um"], classical[1]["peak_error_um"]);
  EXPECT_NE(own[1]["peak_error_um"], lugre[1]["peak_error_um"]);
  // The published simulation that an axis is compared with is that of its own model.
  EXPECT_EQ(own[1]["published_simulation"], classical[1]["published_simulation"]);
}

// A circle's axes know nothing of each other: alone each drives the same sine.
TEST_F(Cli, OneAxisDrivesASineInPlaceOfTheCircle) {
  const auto json = [&](const std::string& command) {
    const auto result = stiction(command + " --json");
    EXPECT_EQ(result.code, 0) << command << "\n" << result.error;
    return nlohmann::json::parse(result.out);
  };
  const auto one = machine_of_one_axis();
  const auto circle = json("simulate circle --machine mcfv5050ln --friction lugre --feed '16 m/min'");
  const auto sine = json("simulate circle --friction lugre --feed '16 m/min' --machine " + one);
  EXPECT_EQ(circle["motion"], "circle");
  EXPECT_EQ(sine["motion"], "sine");
  ASSERT_EQ(sine["rows"].size(), 1u);
  EXPECT_TRUE(sine["circular_errors"].empty());
  for (const char* key :
       {"axis", "peak_error_um", "peak_error_quantised_um", "peak_current_A", "measured", "published_simulation"})
    EXPECT_EQ(sine["rows"][0][key], circle["rows"][0][key]) << key;
  EXPECT_NEAR(sine["rows"][0]["frequency_Hz"], 16.0 / 60.0 / (2.0 * 3.14159265 * 0.09), 1e-6);

  // As fast and as far as a small axis can: 12 m/min and 250 mm; its motor is driven by a voltage.
  const auto small = json("simulate circle --machine emps");
  EXPECT_DOUBLE_EQ(small["rows"][0]["feed_m_per_min"], 8.0);
  EXPECT_GT(small["rows"][0]["peak_voltage_V"], 1.0);
  EXPECT_FALSE(small["rows"][0].contains("peak_current_A"));
  EXPECT_NE(stiction("simulate circle --machine emps").out.find("sine of axis X with the amplitude"),
            std::string::npos);
  EXPECT_EQ(json("compare --reference circle --machine " + one)["machines"][0]["published_agreement"]["cells"], 20);
  expect_refused("simulate circle --machine emps --direction both", "the sine of one axis has no direction");
  expect_refused("simulate circle --machine emps --radius '1 nm'", "radius: found 1e-06 mm, at 0.0016 m/min a lap of");
}

// One shape for one machine and for several; a folder holds what --json prints of its machine.
TEST_F(Cli, ComparesAnyNumberOfMachinesInOneShape) {
  const auto json = [&](const std::string& machines, const std::string& more) {
    const auto result =
        stiction("compare --reference circle --friction lugre --json --machine " + machines + " --out " + more);
    EXPECT_EQ(result.code, 0) << result.error;
    return nlohmann::json::parse(result.out);
  };
  const auto second = machine_of_one_axis();
  const auto one = json("mcfv5050ln", "alone"), both = json("mcfv5050ln," + second, "both");
  EXPECT_EQ(one["schema"], "stiction.compare/1");
  ASSERT_EQ(one["machines"].size(), 1u);
  ASSERT_EQ(both["machines"].size(), 2u);
  EXPECT_EQ(one["machines"][0], both["machines"][0]);
  EXPECT_EQ(both["machines"][1]["machine"], "one");
  EXPECT_EQ(nlohmann::json::parse(content(work() / "alone/result.json")), one);
  EXPECT_EQ(nlohmann::json::parse(content(work() / "both/mcfv5050ln/result.json")), one);
  EXPECT_EQ(nlohmann::json::parse(content(work() / "both/one/result.json"))["machines"][0], both["machines"][1]);
}

TEST_F(Cli, ComparesNoMachineTwice) {
  expect_refused("compare --reference circle --machine mcfv5050ln,mcfv5050ln --out twice",
                 "--machine: found mcfv5050ln twice; expected different names");
}

TEST_F(Cli, ReadmesOrderOfCommandsServesOneAxis) {
  for (const std::string& machine : {std::string("emps"), machine_of_one_axis()}) {
    for (const char* command :
         {"simulate circle --log run.csv --machine ", "inspect run.csv --machine ",
          "identify run.csv --out identified --machine ", "simulate replay --from run.csv --machine ",
          "compare run.csv --machine ", "diagnose run.csv --out verdict --machine ",
          "tune-friction run.csv --no-pulse --out tuned --machine ",
          "tune-friction --no-pulse --out tuned --machine "}) {
      const auto result = stiction(command + machine);
      EXPECT_EQ(result.code, 0) << command << machine << "\n" << result.error;
    }
    for (const char* made : {"identified/identified.toml", "verdict/extended.toml", "tuned/tuned.toml"}) {
      EXPECT_EQ(content(work() / made).find("[[expected]]"), std::string::npos) << made;
      EXPECT_EQ(stiction(std::string("simulate circle --machine ") + made).code, 0) << made;
    }
  }
}

TEST_F(Cli, LimitsTheJerkOfThePathWithStandstill) {
  const auto run = [&](const std::string& more) {
    const auto result = stiction("simulate l-shape --machine mcfv5050ln --friction lugre --json " + more);
    EXPECT_EQ(result.code, 0) << result.error;
    return nlohmann::json::parse(result.out);
  };
  const auto steps = run(""), limited = run("--jerk '40 m/s^3'");
  EXPECT_NEAR(limited["results"]["standing_current_lugre_A"], steps["results"]["standing_current_lugre_A"], 0.1);
  EXPECT_NE(limited["results"]["opposite_direction_error_lugre_um"],
            steps["results"]["opposite_direction_error_lugre_um"]);
  // A jerk that no tick can show is none.
  EXPECT_EQ(run("--jerk '1e300 m/s^3'")["results"]["opposite_direction_error_lugre_um"],
            run("--jerk '1e20 m/s^3'")["results"]["opposite_direction_error_lugre_um"]);
  EXPECT_EQ(limited["expected"].contains("standing_current_lugre_A"), false) << "without jerk limit it was found";
  EXPECT_TRUE(steps["holds"]["opposite_direction_error_lugre_um"].get<bool>());
  const std::string command = "simulate l-shape --machine mcfv5050ln --jerk ";
  expect_refused(command + "'40 m/s^2'", "--jerk: found '40 m/s^2' (dimension");
  expect_refused(command + "'0 m/s^3'", "--jerk: found '0 m/s^3'; expected a jerk above zero");
  expect_refused(command + "'5 m/s^3'", "--jerk: found 5 m/s^3; expected at least 8.889 m/s^3");
  expect_refused("simulate impact --machine mcfv5050ln --jerk '40 m/s^3'", "--jerk");
}

}  // namespace
}  // namespace stiction::test
