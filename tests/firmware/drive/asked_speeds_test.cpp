// Speeds that a bus asks for: ramps, ends of the travel, halts, and what is no number.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/firmware/drive/asked_axis.hpp"

namespace stiction::test {
namespace {

using enum DriveState;

TEST(Speeds, AreReachedByTheProfilesRampsAndKeptToTheMachinesLimits) {
  auto a = enabled_in(OperationMode::profile_velocity, -0.4);
  a.remote.ask_acceleration(si<FixedSignals::Velocity>(2.0 * tick));
  a.remote.ask_deceleration(si<FixedSignals::Velocity>(4.0 * tick));
  a.remote.ask_speed(si<FixedSignals::Velocity>(0.5));
  double fastest = 0.0, step = 0.0;
  int up = 0;
  for (; up < 10'000 && !a.shows(statusword::target_bit); ++up) {
    a.step();
    step = std::max(step, a.step_of_speed());
  }
  EXPECT_NEAR(up * tick, 0.25 + 64 * tick, 5 * tick);
  EXPECT_LE(step, 2.0 * tick + 1e-8);
  a.remote.ask_speed({});
  int down = 0;
  for (; down < 10'000 && a.set_speed != 0.0; ++down) a.step();
  EXPECT_NEAR(down * tick, 0.125 + 64 * tick, 5 * tick);
  a.remote.ask_speed(si<FixedSignals::Velocity>(-7.5));
  for (int i = 0; i < 20'000; ++i) {
    a.step();
    fastest = std::max(fastest, std::abs(a.set_speed));
  }
  EXPECT_LE(fastest, ServedAxis::most_speed + 1e-9);
  EXPECT_NEAR(a.x, -end, 1e-9);
  EXPECT_EQ(machine::to_si(a.remote.speed()), -ServedAxis::most_speed);
}

// A deceleration that is made smaller in motion does not carry the axis beyond its end.
TEST(Speeds, BrakeBeforeTheEndWhateverIsAskedOnTheWay) {
  auto a = enabled_in(OperationMode::profile_velocity);
  a.remote.ask_speed(si<FixedSignals::Velocity>(1.0));
  while (a.x < 0.3) a.step();
  a.remote.ask_deceleration(si<FixedSignals::Velocity>(0.5 * tick));
  a.run(20'000);
  EXPECT_NEAR(a.x, end, 1e-9);
}

TEST(Speeds, HaltByTheQuickRampWhereTheCodeSaysSo) {
  StopCodes codes;
  codes.halt = 2;
  ServedAxis a(codes);
  ASSERT_TRUE(a.enable());
  a.remote.ask(OperationMode::profile_velocity);
  a.remote.ask_deceleration(si<FixedSignals::Velocity>(1.0 * tick));
  a.stream(64, 0.0);
  EXPECT_TRUE(a.shows(statusword::target_bit));
  a.stream(1000, 0.2);
  a.remote.ask(on_word | controlword::halt_bit);
  int ticks = 0;
  for (; ticks < 4000 && a.set_speed != 0.0; ++ticks) a.step();
  EXPECT_NEAR(ticks * tick, 0.2 / ServedAxis::quick_deceleration, 66 * tick);
  a.step();
  EXPECT_TRUE(a.shows(statusword::target_bit)) << "it has halted";
  a.remote.ask_speed({});
  a.remote.ask(controlword::disable_voltage);
  a.run(3);
  EXPECT_FALSE(a.shows(statusword::target_bit)) << "without power no speed is reached";
}

TEST(Speeds, WithoutAZeroHaveNoEnds) {
  auto a = enabled_in(OperationMode::profile_velocity, 0.0, HomingMethod::here);
  a.remote.ask_speed(si<FixedSignals::Velocity>(1.0));
  a.run(16'000);
  EXPECT_GT(a.x, 0.9);
  a.remote.ask_speed(si<FixedSignals::Velocity>(-1.0));
  a.run(40'000);
  EXPECT_LT(a.x, -0.9);
  EXPECT_FALSE(a.shows(statusword::limit_bit));
}

TEST(Speeds, OfBeforeDoNotMoveAModeThatIsTakenLater) {
  auto a = enabled_in(OperationMode::profile_velocity);
  a.remote.ask_speed(si<FixedSignals::Velocity>(0.2));
  a.run(500);
  a.remote.ask(OperationMode::profile_position);
  a.run(3000);
  a.remote.ask(OperationMode::profile_velocity);
  const double at = a.x;
  a.run(3000);
  EXPECT_EQ(a.remote.mode(), OperationMode::profile_velocity);
  EXPECT_NEAR(a.x, at, 1e-9);
}

TEST(Speeds, OfAProfileThatAreNoNumberAreRefusedAndTheOneBeforeHolds) {
  auto a = enabled_in(OperationMode::profile_velocity);
  a.stream(2000, 0.1);
  a.remote.offer_speed({}, false);
  a.run(ServedAxis::cycle_ticks + 1);
  EXPECT_EQ(a.remote.refusal(), Refusal::no_number);
  EXPECT_TRUE(a.shows(statusword::warning_bit));
  EXPECT_NEAR(a.set_speed, 0.1, 4e-9);  // a unit of velocity
  a.stream(2 * ServedAxis::cycle_ticks, 0.1);
  EXPECT_FALSE(a.shows(statusword::warning_bit));
}

}  // namespace
}  // namespace stiction::test
