// The drives in health: they switch on, follow circles without a false alarm, stop, home.
#include "hal/drive_loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "tests/support/drive_bench.hpp"
#include "tests/support/figure.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

using S = FixedSignals;

static_assert(hal::WiredBackend<hal::FaultyBackend<hal::SimulatedBackend<S>>>);
static_assert(hal::BrakeBackend<hal::FaultyBackend<hal::SimulatedBackend<S>>>);
static_assert(!hal::WiredBackend<hal::SimulatedBackend<S>>);

sim::Machine table(const std::string& noise = "5 nm") {
  return cross_table({"axis.*.encoder.velocity=estimated", "axis.*.encoder.noise=" + noise});
}

class CircleInHealth : public ::testing::TestWithParam<std::tuple<double, std::string>> {};

TEST_P(CircleInHealth, GivesNoFault) {
  const auto [feed, noise] = GetParam();
  const auto machine = table(noise);
  DriveBench<> bench(machine, drive_setup(machine));
  ASSERT_TRUE(bench.enable());
  bench.move({.feed = feed / 60.0});
  const double lap = 2.0 * 3.14159265 * 0.09 / (feed / 60.0);
  bench.run(static_cast<int>(std::min(1.3 * lap, 3.0 + lap) / bench.period));
  EXPECT_TRUE(bench.events.empty()) << name_of(bench.events.front().event.fault);
  EXPECT_TRUE(bench.loop.all_in(DriveState::operation_enabled));
}

INSTANTIATE_TEST_SUITE_P(DriveLoop, CircleInHealth,
                         ::testing::Combine(::testing::Values(3.2, 8.0, 16.0, 24.0, 48.0),
                                            ::testing::Values("0 nm", "5 nm", "50 nm")));

}  // namespace
}  // namespace stiction::test
