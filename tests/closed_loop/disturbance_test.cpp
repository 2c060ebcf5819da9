// The loop under forces and limits: what an engineer would try on the first day.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hal/simulated/simulated_backend.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/support/closed_loop.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

using Backend = hal::SimulatedBackend<FixedSignals>;
constexpr std::array<double, 2> origin{0.0, 0.0};
auto standstill = [](double) { return std::array<sim::AxisSetPoint, 2>{}; };

double error_of(const AxisSignals<FixedSignals>& s) { return machine::to_si(s.e); }

// 150 N on X and back to standstill: the integral part takes the force over. What is left is less than the encoder's
// and the quantizer's resolution lets the control see, half of 1 um.
TEST(Disturbance, OfAConstantForceIsTakenOverByTheIntegralPart) {
  const auto machine = cross_table();
  Backend backend(machine, origin);
  backend.plant(0).set_external_force(150.0);
  const auto trace = record(backend, machine, 16000, standstill, [](auto&, int) {});
  ASSERT_EQ(trace.size(), 32000u);
  double peak = 0.0;
  for (std::size_t i = 0; i < trace.size(); i += 2) peak = std::max(peak, std::abs(error_of(trace[i])));
  EXPECT_GT(peak, 1e-6);
  EXPECT_LT(std::abs(error_of(trace[trace.size() - 2])), 0.6e-6);
  // Motor and friction share the force: the motor at least what is beyond the Coulomb level of 90 N.
  EXPECT_LT(machine::to_si(trace[trace.size() - 2].i_set), -(150.0 - 90.0) / 94.0);
}

TEST(Limits, HoldCurrentBackAndSayItWithoutAFault) {
  const auto machine = cross_table({"axis.X.supervision.following_error=100 mm"});
  Backend backend(machine, origin);
  // 7000 N is more than 70 A * 94 N/A = 6580 N can hold.
  const auto trace = record(backend, machine, 400, standstill,
                            [&](auto&, int i) { backend.plant(0).set_external_force(i < 200 ? 7000.0 : 0.0); });
  ASSERT_EQ(trace.size(), 800u);
  bool limiting = false;
  for (std::size_t i = 0; i < trace.size(); i += 2) {
    limiting = limiting || trace[i].limiting.current;
    EXPECT_LE(std::abs(machine::to_si(trace[i].i_set)), 70.0);
    EXPECT_EQ(trace[i].fault, Fault::none);
  }
  EXPECT_TRUE(limiting);
  EXPECT_FALSE(trace[1].limiting.current);
}

TEST(Faults, OfOneAxisStopBothAndLatch) {
  const auto machine = cross_table({"axis.Y.supervision.following_error=20 um"});
  Backend backend(machine, origin);
  const auto configs = configurations<FixedSignals>(machine);
  hal::ControlLoop loop(backend, std::span<const AxisConfig<FixedSignals>>(configs), ticker_of(machine));
  const std::array<SetPoint<FixedSignals>, 2> set{};
  for (int i = 0; i < 20; ++i) loop.tick(set);
  backend.plant(1).set_external_force(20000.0);
  for (int i = 0; i < 1600; ++i) loop.tick(set);
  EXPECT_EQ(loop.axes()[1].fault(), Fault::following_error);
  EXPECT_EQ(loop.axes()[0].fault(), Fault::none);
  // The power stage of X is off with that of Y: its current is gone.
  EXPECT_EQ(backend.plant(0).current()[0], 0.0);
  EXPECT_EQ(backend.plant(1).current()[0], 0.0);
  EXPECT_GT(loop.axes()[1].fault_time_ns(), 20 * 62500);
}

// A velocity gain beyond the stability limit (x11.5) runs away into a fault instead of going on.
TEST(Faults, StopALoopThatAGainMakesUnstable) {
  const auto machine = cross_table({"axis.X.velocity_controller.gain=12000 A s/m"});
  Backend backend(machine, origin);
  const auto trace = record(backend, machine, 16000, standstill,
                            [&](auto&, int i) { backend.plant(0).set_external_force(i > 100 ? 150.0 : 0.0); });
  ASSERT_LT(trace.size(), 32000u);
  EXPECT_NE(trace[trace.size() - 2].fault, Fault::none);
}

}  // namespace
}  // namespace stiction::test
