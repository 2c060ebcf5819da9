// A current at its limit against one whose smooth tops are rounded by a converter of few bits, by arithmetic.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/identify/suitability.hpp"
#include "host/log/log.hpp"
#include "tests/host/identify/campaign.hpp"

namespace stiction::test {
namespace {

constexpr double increment = 0.1;  // A

// Two sines, cut at `limit` (A), in increments.
host::Log in_increments(double limit) {
  host::Log log;
  log.source = "few bits";
  log.period = 1e-3;
  auto& axis = log.axes.emplace_back();
  for (int k = 0; k < 6000; ++k) {
    const double t = 1e-3 * k, turn = 2.0 * std::numbers::pi * t;
    const double i = 8.0 * std::sin(2.0 * turn) + 3.0 * std::sin(5.0 * turn);
    log.t.push_back(t);
    axis.x.push_back(0.01 * std::sin(2.0 * turn));
    axis.i.push_back(increment * std::round(std::clamp(i, -limit, limit) / increment));
  }
  return log;
}

std::size_t longest_top(const host::Log& log) {
  const auto& current = log.axes.front().i;
  const double largest = std::abs(*std::ranges::max_element(current, {}, [](double i) { return std::abs(i); }));
  std::size_t longest = 0, now = 0;
  for (const double i : current) longest = std::max(longest, now = std::abs(i) == largest ? now + 1 : 0);
  return longest;
}

}  // namespace

TEST(Saturation, IsNoRoundedTop) {
  const auto log = in_increments(100.0);
  EXPECT_GE(longest_top(log), 10u);
  const auto axis = bench_machine("lugre").axes.front();
  EXPECT_NO_THROW(host::refuse_saturation(log, log.axes.front(), axis));
  const auto marked = host::saturated(log.axes.front(), axis);
  EXPECT_EQ(std::count(marked.begin(), marked.end(), true), 0);
}

// Seven increments below its tops of 10.7 A.
TEST(Saturation, IsATopThatIsCutOff) {
  const auto log = in_increments(10.0);
  const auto axis = bench_machine("lugre").axes.front();
  EXPECT_THROW(host::refuse_saturation(log, log.axes.front(), axis), host::LogError);
  const auto marked = host::saturated(log.axes.front(), axis);
  EXPECT_GT(std::count(marked.begin(), marked.end(), true), 50);
}

}  // namespace stiction::test
