// `stiction identify` as its users call it: exit codes, messages, what is written and what is not.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "host/log/csv_log.hpp"
#include "tests/host/identify/campaign.hpp"

namespace stiction::test {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

class IdentifyCommand : public ::testing::Test {
 protected:
  struct Outcome {
    int code;
    std::string out, error;
  };

  void SetUp() override {
    folder_ = fs::temp_directory_path() / fmt::format("stiction-identify-{}", ::getpid());
    fs::create_directories(folder_ / "work");
    const auto log = simulated(bench_machine("lugre"), constant_speeds({0.02, 0.1, 0.2}, 0.4, 0.0));
    host::write_csv_log(folder_ / "run.csv", log);
    auto swapped = log;
    for (double& i : swapped.axes.front().i) i = -i;
    host::write_csv_log(folder_ / "swapped.csv", swapped);
    std::ofstream(folder_ / "table.csv")
        << "v[m/min],i[A]\n0.5,1.02\n1,1.05\n2,1.14\n4,1.31\n8,1.66\n12,2.02\n16,2.38\n"
           "-0.5,-1.01\n-1,-1.05\n-2,-1.13\n-4,-1.32\n-8,-1.67\n-12,-2.02\n-16,-2.37\n";
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Runs `stiction identify ARGUMENTS` in an empty folder beside the files.
  Outcome identify(const std::string& arguments) {
    const auto out = folder_ / "out", error = folder_ / "error";
    const int status = std::system(fmt::format("cd '{}' && '{}' identify {} >'{}' 2>'{}'", (folder_ / "work").string(),
                                               STICTION_PROGRAM, arguments, out.string(), error.string())
                                       .c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(out), content(error)};
  }
  void expect_refused(const std::string& arguments, const std::string& message) {
    const auto outcome = identify(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.error;
    EXPECT_NE(outcome.error.find(message), std::string::npos) << outcome.error;
    EXPECT_TRUE(outcome.out.empty()) << outcome.out;
    EXPECT_TRUE(fs::is_empty(folder_ / "work"));
  }
  fs::path folder_;
};

TEST_F(IdentifyCommand, json_has_the_documented_schema) {
  const auto outcome = identify("../run.csv --machine mcfv5050ln --json --out result");
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json.at("schema"), "stiction.identification/1");
  EXPECT_EQ(json.at("axis"), "X");
  const auto& mass = json.at("parameters").at("mass_kg");
  EXPECT_NEAR(mass.at("value").get<double>(), 225.0, 2.25);
  EXPECT_LE(mass.at("ci95").at(0).get<double>(), mass.at("ci95").at(1).get<double>());
  for (const auto& open : json.at("not_determined")) EXPECT_TRUE(open.is_string());
  for (const char* file : {"identified.toml", "report.html", "result.json"})
    EXPECT_TRUE(fs::exists(folder_ / "work" / "result" / file)) << file;
}

TEST_F(IdentifyCommand, bad_input_ends_with_2_and_leaves_nothing) {
  expect_refused("../swapped.csv --machine mcfv5050ln --out result", "sign of one of them is swapped");
  expect_refused("../nowhere.csv --machine mcfv5050ln --out result", "nowhere.csv");
  expect_refused("../run.csv --machine nobody --out result", "no such machine");
  expect_refused("../run.csv --machine mcfv5050ln --axis Z --out result", "expected an axis of mcfv5050ln: X, Y");
  expect_refused("../run.csv --machine mcfv5050ln --friction best --out result", "coulomb_viscous or lugre");
  expect_refused("../run.csv --machine mcfv5050ln --amperes mean --out result", "expected peak or rms");
  expect_refused("../run.csv --machine emps --out result", "found neither the motor's force nor its voltage");
}

TEST_F(IdentifyCommand, a_table_must_say_how_its_amperes_were_read) {
  expect_refused("../table.csv --machine mcfv5050ln --axis X --out result", "--amperes peak or --amperes rms");
  const auto peak = identify("../table.csv --machine mcfv5050ln --axis X --amperes peak --json --out result");
  ASSERT_EQ(peak.code, 0) << peak.error;
  const auto rms = identify("../table.csv --machine mcfv5050ln --axis X --amperes rms --json");
  const auto coulomb = [](const Outcome& o) {
    return nlohmann::json::parse(o.out).at("parameters").at("coulomb_N").at("value").get<double>();
  };
  EXPECT_NEAR(coulomb(rms) / coulomb(peak), std::sqrt(2.0), 1e-9);
}

}  // namespace
}  // namespace stiction::test
