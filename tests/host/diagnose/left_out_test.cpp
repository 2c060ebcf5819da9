// A cause that all logs show is named without each of them; one that a single log shows is not named without
// that one.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/diagnose/diagnose.hpp"
#include "tests/host/diagnose/synthetic_log.hpp"

namespace stiction::test {
namespace {

constexpr double noise = 6.0;  // N rms

double ripple(const Point& at) { return -12.0 * std::cos(2.0 * std::numbers::pi * at.x / 0.024); }

const host::Finding* ripple_of(const host::Verdict& verdict) {
  for (const auto& finding : verdict.findings)
    if (finding.effect.name() == "force_ripple") return &finding;
  return nullptr;
}

TEST(WithoutEachLog, ACauseOfAllLogsIsNamedEachTime) {
  host::DiagnoseInput input;
  input.machine = bench_machine();
  input.next_measurement = false;
  for (const int trajectory : {0, 1}) input.logs.push_back(synthetic_log(trajectory, {.force = ripple}, noise, 100));
  input.held_out = {synthetic_log(2, {.force = ripple}, noise, 200)};
  const auto verdict = host::diagnose(input);
  const auto* found = ripple_of(verdict);
  ASSERT_NE(found, nullptr);
  ASSERT_TRUE(found->without_each_log);
  EXPECT_EQ(found->without_each_log->searches, 2U);
  EXPECT_EQ(found->without_each_log->named, 2U);
}

// The carriage accelerates in sines, and hardly at constant speeds.
TEST(WithoutEachLog, ACauseThatOneLogShowsIsNotNamedWithoutThatOne) {
  host::DiagnoseInput input;
  input.machine = bench_machine();
  input.next_measurement = false;
  for (const int trajectory : {1, 0}) input.logs.push_back(synthetic_log(trajectory, {.mass = 227.25}, noise, 100));
  input.held_out = {synthetic_log(2, {.mass = 227.25}, noise, 200)};
  const auto verdict = host::diagnose(input);
  ASSERT_EQ(verdict.findings.size(), 1U);
  const auto& found = verdict.findings.front();
  EXPECT_EQ(found.effect.name(), "mass_mismatch");
  ASSERT_TRUE(found.without_each_log);
  EXPECT_EQ(found.without_each_log->searches, 2U);
  EXPECT_EQ(found.without_each_log->named, 1U);
}

TEST(WithoutEachLog, NothingIsLeftOutOfASingleLog) {
  host::DiagnoseInput input;
  input.machine = bench_machine();
  input.next_measurement = false;
  input.logs = {synthetic_log(1, {.force = ripple}, noise, 1)};
  input.held_out = {synthetic_log(2, {.force = ripple}, noise, 2)};
  const auto verdict = host::diagnose(input);
  const auto* found = ripple_of(verdict);
  ASSERT_NE(found, nullptr);
  EXPECT_FALSE(found->without_each_log);
}

}  // namespace
}  // namespace stiction::test
