// The bands of a diagnosis by arithmetic, and what is named in the wide one alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "host/diagnose/diagnose.hpp"
#include "host/diagnose/record/record_rows.hpp"
#include "host/diagnose/record/replay_setup.hpp"
#include "tests/host/diagnose/dwelling_record.hpp"

namespace stiction::host {
namespace {

// Hz.
double end_of(RowBand band, double rate, double seconds) {
  Log log;
  log.period = 1.0 / rate;
  log.t.resize(static_cast<std::size_t>(seconds * rate));
  return end_of_band(signals_in(band, {&log, 1}));
}

}  // namespace

TEST(WideBand, EndsAtAFifthOfTheLogsRateAndWithTheMemory) {
  EXPECT_NEAR(end_of(RowBand::usual, 500.0, 30.0), 50.0, 1e-9);
  EXPECT_NEAR(end_of(RowBand::wide, 500.0, 30.0), 100.0, 1e-9);
  EXPECT_NEAR(end_of(RowBand::usual, 4000.0, 30.0), 100.0, 1e-9);
  EXPECT_NEAR(end_of(RowBand::wide, 4000.0, 30.0), 400.0, 1e-9);
  EXPECT_NEAR(end_of(RowBand::wide, 4000.0, 60.0), 200.0, 1e-9);    // 30 000 rows
  EXPECT_NEAR(end_of(RowBand::wide, 4000.0, 1200.0), 100.0, 1e-9);  // no more than the usual one
}

// The machine's friction is a fifth higher before it slides, over a speed that its axis passes within one row of the
// usual band; the record is of 500 Hz, with noise of its current.
TEST(WideBand, NamesWhatTheUsualRowsLoseBesideAStandstill) {
  DiagnoseInput input;
  input.machine = test::rigid_machine();
  input.next_measurement = false;
  auto truth = input.machine;
  truth.axes.front().effects.push_back({"stribeck", {{"break_away", {0.2 * 80.0}}, {"velocity", {1.5e-3}}}});
  const std::vector logs{test::dwelling("slow", 3e-3, 0.4, 2e-3), test::dwelling("quick", 8e-3, 0.3, 2e-3),
                         test::dwelling("other", 5e-3, 0.35, 2e-3)};
  const auto records = without_noise(truth, 0, logs).replayed;
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 5e-3);
  for (std::size_t k = 0; k < logs.size(); ++k) {
    auto record = records[k];
    record.source = logs[k].source;
    for (double& i : record.axes.front().i) i += noise(random);
    (k < 2 ? input.logs : input.held_out).push_back(record);
  }
  const auto verdict = diagnose(input);
  ASSERT_FALSE(verdict.findings.empty());
  EXPECT_EQ(verdict.findings.front().effect->name, "stribeck");
  EXPECT_TRUE(std::any_of(verdict.notes.begin(), verdict.notes.end(), [](const std::string& note) {
    return note.find("forces up to 100 Hz") != std::string::npos;
  }));
}

}  // namespace stiction::host
