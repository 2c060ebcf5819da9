// The commands that read and write logs, as their users call them.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "host/log/csv_log.hpp"
#include "host/log/read_log.hpp"
#include "host/log/text_file.hpp"

namespace stiction::host {
namespace {

namespace fs = std::filesystem;

struct Outcome {
  int code;
  std::string out, error;
};

class LogCommands : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / fmt::format("stiction-log-cli-{}", ::getpid());
    fs::create_directories(folder_ / "work");
  }
  void TearDown() override { fs::remove_all(folder_); }

  Outcome stiction(const std::string& arguments) const {
    const auto command = fmt::format("cd '{0}/work' && '{1}' {2} >'{0}/out' 2>'{0}/error'", folder_.string(),
                                     STICTION_PROGRAM, arguments);
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text_file(folder_ / "out"),
            read_text_file(folder_ / "error")};
  }
  std::string done(const std::string& arguments) const {
    const auto result = stiction(arguments);
    EXPECT_EQ(result.code, 0) << arguments << "\n" << result.error;
    return result.out;
  }
  fs::path work() const { return folder_ / "work"; }

  // Bad input: exit 2, the message on standard error only, nothing written beside the inputs.
  void expect_refused(const std::string& arguments, const std::string& message) const {
    const auto files = [&] { return std::distance(fs::directory_iterator(work()), fs::directory_iterator()); };
    const auto before = files();
    const auto result = stiction(arguments);
    EXPECT_EQ(result.code, 2) << arguments;
    EXPECT_NE(result.error.find(message), std::string::npos) << arguments << "\n" << result.error;
    EXPECT_EQ(result.out, "") << arguments;
    EXPECT_EQ(files(), before) << arguments;
  }

 private:
  fs::path folder_;
};

const std::string plain = "t[s],x_set[m],x[m],i[A]\n0,0,0,0\n0.001,0.00001,0,1\n0.002,0.00003,0.00001,1\n";

TEST_F(LogCommands, ConvertGoesToMatAndBack) {
  write_text_file(work() / "run.csv", "# machine: none\n" + plain);
  for (const auto* level : {"5", "7.3"}) {
    done(fmt::format("convert run.csv run.mat --mat {}", level));
    done("convert run.mat again.csv");
    EXPECT_EQ(read_text_file(work() / "again.csv"),
              "# machine: none\nt[s],x_set[m],x[m],i[A]\n0,0,0,0\n0.001,1e-05,0,1\n0.002,3e-05,1e-05,1\n");
  }
}

TEST_F(LogCommands, ConvertWritesNothingFromBadInput) {
  write_text_file(work() / "bad.csv", "t[s],x[m],i[A]\n0,0,0\n0.001,nan,0\n");
  write_text_file(work() / "run.csv", plain);
  write_text_file(work() / "scope.csv",
                  "Name\tProject\nStartRecord\t1\n\nName\tPos\tName\tCur\nSampleTime[ms]\t1\tSampleTime[ms]\t1\n\n"
                  "0\t1,5\t0\t2\n1\t1,6\t1\t3\n");
  write_text_file(work() / "map.toml",
                  "schema = \"stiction.mapping/1\"\n[[channel]]\nfrom = \"Pos\"\nto = \"x\"\nunit = \"mm\"\n"
                  "[[channel]]\nfrom = \"Cur\"\nto = \"i\"\nunit = \"A\"\n");
  expect_refused("convert bad.csv out.csv", "bad.csv:3: column 2, x[m]: found 'nan'; expected a finite number");
  expect_refused("convert none.csv out.csv", "none.csv: found no such file; expected a log");
  expect_refused("convert run.csv out.txt", "found 'out.txt'; expected a name that ends in .csv or .mat");
  expect_refused("convert run.csv out.mat --mat 4", "--mat: found '4'");
  expect_refused("convert scope.csv out.csv", "a TwinCAT Scope export with the channels 'Pos', 'Cur'; expected --map");
  expect_refused("convert scope.csv out.csv --map map.toml", "map.toml:6");
  expect_refused("convert scope.csv out.csv --map map.toml", "amperes = \"peak\" or amperes = \"rms\"");
  expect_refused("convert scope.csv out.csv --map none.toml", "none.toml: found no such file; expected a mapping file");
}

TEST_F(LogCommands, ConvertMapsAScopeExport) {
  write_text_file(work() / "scope.csv",
                  "Name\tProject\nStartRecord\t1\n\nName\tPos\tName\tCur\nSampleTime[ms]\t1\tSampleTime[ms]\t1\n\n"
                  "0\t1,5\t0\t2\n1\t1,6\t1\t3\n");
  write_text_file(work() / "map.toml",
                  "schema = \"stiction.mapping/1\"\n[[channel]]\nfrom = \"Pos\"\nto = \"x\"\nunit = \"mm\"\n"
                  "[[channel]]\nfrom = \"Cur\"\nto = \"i\"\nunit = \"A\"\namperes = \"peak\"\n");
  done("convert scope.csv out.csv --map map.toml");
  EXPECT_NE(read_text_file(work() / "out.csv").find("t[s],x[m],i[A]\n0,0.0015,2\n0.001,0.0016,3\n"), std::string::npos);
}

TEST_F(LogCommands, InspectPrintsTextAndJson) {
  write_text_file(work() / "run.csv", plain);
  EXPECT_NE(done("inspect run.csv").find("3 samples at 1 ms"), std::string::npos);
  const auto json = nlohmann::json::parse(done("inspect run.csv --json"));
  EXPECT_EQ(json["schema"], "stiction.inspection/1");
  EXPECT_EQ(json["axes"][0]["channels"].size(), 3u);
  EXPECT_FALSE(json["axes"][0]["determinable"].empty());
  expect_refused("inspect none.csv", "none.csv: found no such file; expected a log");
  expect_refused("inspect run.csv --machine mcfv5050ln", "expected --axis with one of: X, Y");
  done("inspect run.csv --machine mcfv5050ln --axis X");
}

// The simulated circle as a log, replayed with its own model and with another one.
TEST_F(LogCommands, ReplayAndCompareALogOfTheCircle) {
  done("simulate circle --machine mcfv5050ln --log circle.csv");
  const auto text = done("simulate replay --from circle.csv --machine mcfv5050ln --log again.csv --json");
  const auto json = nlohmann::json::parse(text);
  EXPECT_EQ(json["schema"], "stiction.replay/1");
  EXPECT_LT(json["results"]["position_difference_rms_X_lugre_um"].get<double>(), 1e-3);
  EXPECT_LT(json["results"]["current_difference_rms_X_lugre_A"].get<double>(), 1e-3);
  const auto again = read_log(work() / "again.csv");
  EXPECT_EQ(again.axes.size(), 2u);
  EXPECT_EQ(again.axes[0].x.size(), read_log(work() / "circle.csv").t.size());
  const auto other = nlohmann::json::parse(
      done("compare circle.csv --machine mcfv5050ln --friction lugre,classical --out compared --json"));
  EXPECT_EQ(other["schema"], "stiction.compare/1");
  ASSERT_EQ(other["machines"].size(), 1u);
  // Two axes with the one model, then with the other.
  const auto& rows = other["machines"][0]["rows"];
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[2]["axis"], "X");
  EXPECT_EQ(rows[2]["friction"], "classical");
  EXPECT_GT(rows[2]["position_difference_rms_um"].get<double>(), 0.1);
  EXPECT_NEAR(rows[0]["position_difference_rms_um"].get<double>(),
              json["results"]["position_difference_rms_X_lugre_um"].get<double>(), 1e-9);
  EXPECT_NEAR(rows[1]["measured"]["current_rms_A"].get<double>(),
              json["results"]["current_rms_measured_Y_A"].get<double>(), 1e-9);
  EXPECT_EQ(nlohmann::json::parse(read_text_file(work() / "compared" / "result.json")), other);
  EXPECT_TRUE(fs::exists(work() / "compared" / "report.html"));
}

TEST_F(LogCommands, ReplayRefusesWhatItCannotReplay) {
  write_text_file(work() / "run.csv", plain);
  write_text_file(work() / "no_set.csv", "t[s],X.x[m],X.i[A]\n0,0,0\n0.001,0,0\n");
  const std::string machine = " --machine mcfv5050ln";
  expect_refused("simulate replay --from run.csv" + machine, "expected --axis");
  expect_refused("simulate replay --from no_set.csv" + machine, "no_set.csv: found no X.x_set[m]");
  expect_refused("simulate replay --from run.csv --axis X --friction all --log out.csv" + machine, "--log: found");
  expect_refused("simulate replay" + machine, "--from");
  expect_refused("compare run.csv --axis X --machine mcfv5050ln,mcfv5050ln", "found mcfv5050ln twice");
  expect_refused("compare" + machine, "found neither --reference nor LOG");
  expect_refused("compare run.csv --reference circle" + machine, "found --reference and LOG");
}

TEST_F(LogCommands, ExperimentsKeepTheirLogs) {
  const std::string run = " --machine mcfv5050ln --friction lugre --log run.csv";
  for (const auto* experiment : {"impact", "l-shape"}) {
    done(std::string("simulate ") + experiment + run);
    const auto log = read_log(work() / "run.csv");
    EXPECT_GT(log.t.size(), 10000u) << experiment;
    EXPECT_FALSE(log.axes[0].i.empty()) << experiment;
  }
  // One file a run.
  EXPECT_NE(done("simulate constant-velocity" + run).find("log: run-24_m_per_min.csv"), std::string::npos);
  const auto log = read_log(work() / "run-24_m_per_min.csv");
  EXPECT_NEAR(log.axes[0].v.back(), 24.0 / 60.0, 0.01);
  done("simulate stick-slip" + run);
  EXPECT_FALSE(read_log(work() / "run.csv").axes[0].force.empty());
}

TEST_F(LogCommands, ALogOfAnExperimentNeedsOneModel) {
  expect_refused("simulate impact --machine mcfv5050ln --log run.csv", "--log: found");
}

}  // namespace
}  // namespace stiction::host
