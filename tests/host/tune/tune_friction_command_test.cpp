// `stiction tune-friction` as its users call it: what is written, what it takes away, what is refused.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "sim/machine_file.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

class TuneFrictionCommand : public ::testing::Test {
 protected:
  struct Outcome {
    int code;
    std::string out, error;
  };

  void SetUp() override {
    folder_ = fs::temp_directory_path() / fmt::format("stiction-tune-{}", ::getpid());
    fs::create_directories(folder_ / "work");
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Runs `stiction ARGUMENTS` in an empty folder.
  Outcome stiction(const std::string& arguments) {
    const auto out = folder_ / "out", error = folder_ / "error";
    const int status = std::system(fmt::format("cd '{}' && '{}' {} >'{}' 2>'{}'", (folder_ / "work").string(),
                                               STICTION_PROGRAM, arguments, out.string(), error.string())
                                       .c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(out), content(error)};
  }
  void expect_refused(const std::string& arguments, const std::string& message) {
    const auto outcome = stiction("tune-friction " + arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.error;
    EXPECT_NE(outcome.error.find(message), std::string::npos) << outcome.error;
    EXPECT_TRUE(outcome.out.empty()) << outcome.out;
  }
  fs::path folder_;
};

constexpr const char* machine = "--machine mcfv5050ln --set 'axis.*.encoder.velocity=estimated' ";

// From a log, as after a measurement; the bounds are those asked of the laws: 2 um without learning, 1 um with it, and
// 30 % of what was there before.
TEST_F(TuneFrictionCommand, takes_the_glitch_of_a_logged_circle_away) {
  const auto logged = stiction(fmt::format("simulate circle {} --feed '16 m/min' --log circle.csv", machine));
  ASSERT_EQ(logged.code, 0) << logged.error;
  const auto outcome = stiction(fmt::format(
      "tune-friction circle.csv {} --axis X --feed '8 m/min, 16 m/min' --no-pulse --json --out tuned", machine));
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  const auto results = nlohmann::json::parse(outcome.out).at("results");
  for (const char* feed : {"8", "16"}) {
    const auto peak = [&](const char* kind) {
      return results.at(fmt::format("peak_error_X_{}_{}_m_per_min_um", kind, feed)).get<double>();
    };
    figure(fmt::format("quadrant error of X at {} m/min tuned from one log: off, (b), (c)", feed),
           fmt::format("{:.2f}, {:.2f}, {:.2f} um", peak("off"), peak("friction"), peak("learning")));
    EXPECT_LE(peak("friction"), std::min(2.0, 0.3 * peak("off")));
    EXPECT_LE(peak("learning"), std::min(1.0, 0.3 * peak("off")));
  }
  const auto tuned = sim::read_machine(folder_ / "work" / "tuned" / "tuned.toml");
  ASSERT_TRUE(tuned.axes.front().friction_compensation);
  EXPECT_EQ(tuned.axes.front().friction_compensation->use, CompensationKind::learning);
  EXPECT_EQ(tuned.axes.back().friction_compensation->use, CompensationKind::off);  // as the machine file has it
  EXPECT_TRUE(fs::exists(folder_ / "work" / "tuned" / "report.html"));
}

TEST_F(TuneFrictionCommand, refuses_what_it_cannot_use_and_writes_nothing) {
  std::ofstream(folder_ / "work" / "no_current.csv") << "t[s],X.x[m]\n0,0\n0.001,0\n0.002,0\n";
  expect_refused(fmt::format("no_current.csv {} --axis X --out tuned", machine), "no_current.csv");
  expect_refused(fmt::format("{} --axis Z --out tuned", machine), "--axis: found 'Z'; expected an axis of mcfv5050ln");
  expect_refused(fmt::format("{} --show '8 m/min, 16 m/min' --out tuned", machine), "--show: found 2 feeds");
  EXPECT_FALSE(fs::exists(folder_ / "work" / "tuned"));
}

}  // namespace
}  // namespace stiction::test
