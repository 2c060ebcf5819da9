// Records that nobody should identify from: each is refused with what is wrong and what to record instead.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/identify/identification.hpp"
#include "tests/host/identify/campaign.hpp"

namespace stiction::host {
namespace {

class BadInput : public ::testing::Test {
 protected:
  void expect_refused(const std::vector<Log>& logs, const std::vector<std::string>& words) {
    try {
      identify_logs(logs, machine_.axes.front(), {"lugre", Amperes::amplitude, {}});
      FAIL() << "not refused";
    } catch (const LogError& error) {
      const std::string text = error.what();
      for (const auto& word : words) EXPECT_NE(text.find(word), std::string::npos) << word << " in: " << text;
    }
  }
  Log recorded(const test::Trajectory& trajectory) { return test::simulated(machine_, trajectory); }
  Log general() { return recorded(test::constant_speeds({0.02, 0.1, 0.2}, 0.4, 0.0)); }

  machine::Machine machine_ = test::bench_machine("lugre");
};

void keep(Log& log, std::size_t begin, std::size_t end) {
  const auto cut = [&](std::vector<double>& v) {
    if (!v.empty()) v = std::vector<double>(v.begin() + static_cast<long>(begin), v.begin() + static_cast<long>(end));
  };
  cut(log.t);
  for (auto& axis : log.axes)
    for (const auto& channel : log_channels) cut(axis.*channel.values);
}

TEST_F(BadInput, a_log_of_a_tenth_of_a_second) {
  auto log = general();
  keep(log, 0, 100);
  expect_refused({log}, {"constant speeds: found a log of 100 samples, 0.1 s", "expected more than", "Record"});
}

TEST_F(BadInput, a_log_of_a_second) {
  auto log = general();
  keep(log, 0, 1000);
  expect_refused({log}, {"found 1 s", "expected at least 2 s", "reversals at several speeds"});
}

TEST_F(BadInput, a_force_of_the_wrong_sign) {
  auto log = general();
  for (double& i : log.axes.front().i) i = -i;
  expect_refused({log}, {"a force that pushes where friction must brake", "sign of one of them is swapped"});
}

TEST_F(BadInput, a_log_of_another_axis) {
  auto log = general();
  log.axes.front().axis = "Y";
  expect_refused({log}, {"found channels of Y", "expected those of axis X"});
}

TEST_F(BadInput, a_log_without_current) {
  auto log = general();
  log.axes.front().u = log.axes.front().i;
  log.axes.front().i.clear();
  expect_refused({log}, {"found neither the motor's force nor its current", "F[N] or i[A]"});
}

TEST_F(BadInput, presliding_alone_leaves_out_what_it_cannot_know) {
  const auto log = test::with_noise(recorded(test::small_reversals({5e-6, 10e-6, 20e-6, 40e-6}, 2.0)), {}, 1);
  const auto result = identify_logs({log}, machine_.axes.front(), {"lugre", Amperes::amplitude, {}});
  for (const char* name : {"mass_kg", "viscous_N_s_per_m"}) {
    EXPECT_EQ(result.find(name), nullptr) << name;
    EXPECT_TRUE(std::any_of(result.not_determined.begin(), result.not_determined.end(), [&](const auto& n) {
      return n.name == name && !n.record.empty();
    })) << name;
  }
}

struct BadTable {
  const char* text;
  const char* message;
};
class BadTables : public ::testing::TestWithParam<BadTable> {};
TEST_P(BadTables, are_refused) {
  const auto machine = test::bench_machine("lugre");
  try {
    identify_table(parse_steady_table(GetParam().text, "tab.csv"), machine.axes.front(), {}, {});
    FAIL() << "not refused";
  } catch (const LogError& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().message), std::string::npos) << error.what();
  }
}
INSTANTIATE_TEST_SUITE_P(
    All, BadTables,
    ::testing::Values(BadTable{"v[m/min],i[A]\n1,1\n2,1.1\n3,1.2\n", "--amperes peak or --amperes rms"},
                      BadTable{"# amperes: mean\nv[m/min],i[A]\n1,1\n", "expected peak, amplitude or rms"},
                      BadTable{"v[m/min],F[N]\n1,90\n1,91\n2,93\n", "found 2 different speeds"},
                      BadTable{"v[m/min],F[N]\n1,-90\n2,-91\n3,-93\n",
                               "found forces with the opposite sign of the speed"},
                      BadTable{"v[m/min],F[N]\n1,90\n2\n", "tab.csv:3: found 1 fields; expected 2"},
                      BadTable{"v[m/min],F[N]\n1,x\n", "tab.csv:2: column F[N]: found 'x'; expected a number"},
                      BadTable{"v[kg],F[N]\n1,1\n", "tab.csv:1: found the column v[kg]; expected a unit like [m/s]"},
                      BadTable{"v[m/s],T[K]\n1,1\n", "found a table without forces"}));

}  // namespace
}  // namespace stiction::host
