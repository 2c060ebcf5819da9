// cst: an axis of a mass without friction, integrated in double precision, is given currents and forces from outside.
#include "stiction/drive/torque_mode.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "tests/firmware/drive/served_axis.hpp"

namespace stiction::test {
namespace {

constexpr std::uint16_t torque_on = controlword::enable_operation;
constexpr double per_ampere = ServedAxis::acceleration_of_current, highest_current = ServedAxis::most_current;

ServedAxis in_torque_mode(double at = 0.0, HomingMethod method = HomingMethod::none) {
  ServedAxis a({}, method, at);
  EXPECT_TRUE(a.enable());
  a.torque = 0.0;
  a.remote.ask(OperationMode::cyclic_torque);
  a.remote.ask(torque_on);
  a.stream(64, 0.0);
  EXPECT_EQ(a.remote.mode(), OperationMode::cyclic_torque);
  EXPECT_TRUE(a.shows(statusword::follows_bit));
  return a;
}

// What the axis reached while it was given currents.
struct Reached {
  double farthest = 0.0, fastest = 0.0, largest_current = 0.0, largest_step = 0.0;  // m, m/s, A, A a tick
};
Reached drive_it(ServedAxis& a, int ticks, double current, double load = 0.0) {
  Reached r;
  a.load = load;
  a.torque = current;
  double before = a.current;
  for (int i = 0; i < ticks; ++i) {
    a.stream(1, 0.0);
    r.farthest = std::max(r.farthest, std::abs(a.x));
    r.fastest = std::max(r.fastest, std::abs(a.v));
    r.largest_current = std::max(r.largest_current, std::abs(a.current));
    r.largest_step = std::max(r.largest_step, std::abs(a.current - before));
    before = a.current;
  }
  return r;
}

TEST(TorqueMode, MakesTheAccelerationOfItsCurrent) {
  for (const double current : {10.0, -25.0}) {
    auto a = in_torque_mode();
    const auto r = drive_it(a, 320, current);  // 20 ms
    // The slope takes a cycle and the current's own rise, 1 ms each at most.
    EXPECT_NEAR(a.v, current * per_ampere * 320 * tick, std::abs(current) * per_ampere * 2e-3);
    EXPECT_NEAR(a.current, current, 1e-5);
    EXPECT_LE(r.largest_step, highest_current / 16.0 + 1e-5) << "6087h";
    EXPECT_FALSE(a.shows(statusword::limit_bit));
    EXPECT_EQ(a.drive.fault(), Fault::none);
  }
}

TEST(TorqueMode, HoldsTheSpeedOfTheMotorAgainstForcesFromOutside) {
  for (const double load : {0.0, 20.0, -20.0})
    for (const double sign : {1.0, -1.0}) {
      auto a = in_torque_mode(0.0, HomingMethod::here);  // its zero is not known: no ends
      const auto r = drive_it(a, 8000, sign * highest_current, sign * load);
      // The proportional law needs load / gain, and an eighth of a percent for the tick of delay.
      EXPECT_LE(r.fastest, ServedAxis::most_speed + std::max(load, 0.0) / 600.0 + 2e-3);
      EXPECT_GE(r.fastest, ServedAxis::most_speed - 20.0 / 600.0 - 1e-3);
      EXPECT_TRUE(a.shows(statusword::limit_bit));
      EXPECT_EQ(a.drive.fault(), Fault::none);
      // Without a current it goes on, and is still held.
      EXPECT_LE(drive_it(a, 4000, 0.0, sign * std::abs(load)).fastest,
                ServedAxis::most_speed + std::abs(load) / 600.0 + 2e-3);
    }
}

TEST(TorqueMode, StopsAtTheEndsWhateverIsAskedFor) {
  for (const double sign : {1.0, -1.0})
    for (const double current : {40.0, 3.0, 0.0})
      for (const double load : {0.0, 10.0})
        for (const double from : {0.0, 0.4, 0.4999}) {
          SCOPED_TRACE(::testing::Message() << sign << " " << current << " A, load " << load << " from " << from);
          auto a = in_torque_mode(sign * from);
          const auto r = drive_it(a, 32'000, sign * current, sign * load);
          // What pushes against the position law at the end: current / (gain k / tick) = 10 A / (600 A s/m * 31 1/s).
          EXPECT_LE(r.farthest, ServedAxis::end + 0.6e-3);
          if (current + load > 0.0) {
            EXPECT_NEAR(sign * a.x, ServedAxis::end, 3e-3);
            EXPECT_TRUE(a.shows(statusword::limit_bit));
            EXPECT_NEAR(a.v, 0.0, 1e-3);
          }
          EXPECT_EQ(a.drive.fault(), Fault::none);
          // And back.
          a.load = 0.0;
          drive_it(a, 1600, sign * -5.0);
          EXPECT_LT(sign * a.x, ServedAxis::end - 5e-3);
        }
}

TEST(TorqueMode, BrakesBeforeAnEndThoughAWeakerCurrentIsAskedFor) {
  auto a = in_torque_mode();
  drive_it(a, 2400, 20.0);
  EXPECT_NEAR(a.v, 1.2, 0.05);
  const auto r = drive_it(a, 40'000, -0.5);
  EXPECT_LE(r.farthest, ServedAxis::end + 1e-4);
  EXPECT_EQ(a.drive.fault(), Fault::none);
}

TEST(TorqueMode, BeyondAnEndGoesBackAndNotFurtherOut) {
  for (const double sign : {1.0, -1.0})
    for (const double beyond : {1e-6, 5e-3}) {
      auto a = in_torque_mode(sign * (ServedAxis::end + beyond));
      EXPECT_NEAR(sign * a.x, ServedAxis::end + beyond, 1e-6) << "nothing moves it by itself";
      const auto r = drive_it(a, 8000, sign * 30.0);
      EXPECT_LE(r.farthest, ServedAxis::end + beyond + 1e-5);
      EXPECT_TRUE(a.shows(statusword::limit_bit));
      drive_it(a, 2400, sign * -5.0);
      EXPECT_LT(sign * a.x, ServedAxis::end - 5e-3);
      EXPECT_EQ(a.drive.fault(), Fault::none);
    }
}

TEST(TorqueMode, KeepsToTheLargestTorqueAndBrakesEarlierForIt) {
  auto a = in_torque_mode();
  a.remote.ask_most_torque(si<FixedSignals::Current>(2.0));
  const auto r = drive_it(a, 80'000, 40.0);
  EXPECT_LE(r.largest_current, 2.0 + 1e-5);
  EXPECT_LE(r.farthest, ServedAxis::end + 1e-3);
  EXPECT_TRUE(a.shows(statusword::limit_bit));
  EXPECT_GT(r.fastest, 0.3);
  EXPECT_EQ(a.drive.fault(), Fault::none);
}

TEST(TorqueMode, MissesItsTargetsAsTheOtherCyclicModes) {
  auto a = in_torque_mode();
  drive_it(a, 800, 10.0);
  EXPECT_GT(a.v, 0.15);
  double largest = 0.0;
  for (int i = 0; i < 4 * ServedAxis::cycle_ticks; ++i) {
    a.step();
    largest = std::max(largest, a.step_of_speed());
  }
  EXPECT_EQ(a.drive.fault(), Fault::set_points_lost);
  for (int i = 0; i < 2000; ++i) {
    a.step();
    largest = std::max(largest, a.drive.powered() ? a.step_of_speed() : 0.0);
  }
  EXPECT_EQ(a.drive.state(), DriveState::fault);
  EXPECT_LE(largest, ServedAxis::acceleration * tick);
  EXPECT_NEAR(a.v, 0.0, 1e-3);
}

TEST(TorqueMode, OfASourceWithoutCyclesHoldsItsCurrent) {
  ServedAxis a;
  EXPECT_TRUE(a.remote.ask(controlword::shutdown, CommandSource::modbus));
  for (const auto word : {controlword::switch_on, controlword::enable_operation}) {
    a.run(200);
    EXPECT_TRUE(a.remote.ask(word, CommandSource::modbus));
  }
  a.remote.ask(OperationMode::cyclic_torque);
  a.run(200);
  a.remote.ask_torque(si<FixedSignals::Current>(1.0));
  a.run(2000);
  EXPECT_NEAR(a.current, 1.0, 1e-5);
  EXPECT_EQ(a.drive.fault(), Fault::none);
  // A mode of before asks for nothing in the next one.
  a.remote.ask(OperationMode::cyclic_position);
  a.run(3000);
  EXPECT_EQ(a.remote.mode(), OperationMode::cyclic_position);
  a.remote.ask(OperationMode::cyclic_torque);
  a.run(200);
  EXPECT_NEAR(a.current, 0.0, 1e-5);
}

TEST(TorqueMode, ShowsWhatIsAskedForAndItsLimits) {
  auto a = in_torque_mode();
  a.remote.ask_torque(si<FixedSignals::Current>(3.0));
  a.remote.ask_most_torque(si<FixedSignals::Current>(20.0));
  EXPECT_EQ(machine::to_si(a.remote.torque()), 3.0);
  EXPECT_EQ(machine::to_si(a.remote.most_torque()), 20.0);
  EXPECT_EQ(machine::to_si(a.remote.rated_torque()), highest_current);
  a.remote.ask_most_torque(si<FixedSignals::Current>(200.0));
  EXPECT_EQ(machine::to_si(a.remote.most_torque()), highest_current);
  a.remote.ask_most_torque({});
  EXPECT_GT(a.remote.most_torque(), FixedSignals::Current{}) << "the least that there is";
  EXPECT_LE(drive_it(a, 100, 5.0).largest_current - 1e-5, 3.0);
}

// Alone, where no axis gets: what the law makes of places and speeds. 600 A s/m.
TEST(TorqueMode, GivesTheSpeedOfEachPlace) {
  using S = FixedSignals;
  const auto current_at = [](const TorqueMode::Config& config, double x, double begin = 0.0) {
    TorqueMode mode(config);
    mode.start(config.most, si<S::Position>(begin));
    return machine::to_si(mode.step(config.most, {si<S::Position>(x), {}, true}));
  };
  auto slow = ServedAxis::torque_config();
  slow.speed = si<S::Velocity>(0.02);
  slow.deceleration = si<S::Velocity>(2.0 * tick);
  EXPECT_NEAR(current_at(slow, 0.0), 12.0, 1e-3) << "0.02 m/s, far from the ends";
  EXPECT_NEAR(current_at(slow, -100.0), 12.0, 1e-3);
  EXPECT_NEAR(current_at(slow, 0.4991), 12.0, 1e-3) << "the proportional law allows more";
  EXPECT_NEAR(current_at(slow, 0.4999), 600.0 * 1e-4 / 512 / tick, 0.01) << "31 1/s of 0.1 mm";
  EXPECT_NEAR(current_at(slow, 200.0), -12.0, 1e-3) << "back to where it is held";
  // On the curve of 2 m/s^2: v^2 = 2 a (x - a / (2 k^2)), k = 31.25 1/s.
  auto fast = slow;
  fast.speed = si<S::Velocity>(0.5);
  fast.gain = si<S::VelocityGain>(60.0);
  EXPECT_NEAR(current_at(fast, 0.48), 60.0 * std::sqrt(2.0 * 2.0 * (0.02 - 1.0 / 31.25 / 31.25)), 0.02);
}

TEST(TorqueMode, AddsTheOffsetOf60B2h) {
  auto a = in_torque_mode();
  for (int i = 0; i < 100; ++i) {
    a.remote.ask_offsets({}, si<FixedSignals::Current>(2.0));
    a.torque = 3.0;
    a.stream(1, 0.0);
  }
  EXPECT_NEAR(a.current, 5.0, 1e-5);
}

// A halt brakes from the speed that the axis has and holds it; then the current comes back.
TEST(TorqueMode, HaltsFromTheSpeedOfTheAxisAndGoesOn) {
  auto a = in_torque_mode();
  drive_it(a, 800, 10.0);
  const double v = a.v;
  a.remote.ask(torque_on | controlword::halt_bit);
  a.stream(1, 0.0);
  EXPECT_NEAR(a.set_speed, v, 2.0 * ServedAxis::acceleration * tick);
  a.stream(1600, 0.0);
  EXPECT_FALSE(a.shows(statusword::limit_bit));
  EXPECT_EQ(a.set_speed, 0.0);
  EXPECT_EQ(a.drive.state(), DriveState::operation_enabled);
  a.remote.ask(torque_on);
  drive_it(a, 320, 10.0);
  EXPECT_NEAR(a.current, 10.0, 1e-5);
}

TEST(LargestTorque, HoldsInEveryModeWhileTheDriveFollowsAndShowsIt) {
  ServedAxis a;
  ASSERT_TRUE(a.enable());
  a.stream(64, 0.0);
  a.remote.ask_most_torque(si<FixedSignals::Current>(1.0));
  a.jammed = true;  // so that the cascade asks for all that there is
  double largest = 0.0;
  for (int i = 0; i < 400; ++i) {
    a.stream(1, 0.05);
    if (i > 0) largest = std::max(largest, std::abs(a.current));
  }
  EXPECT_NEAR(largest, 1.0, 1e-5);
  EXPECT_TRUE(a.shows(statusword::limit_bit));
  // A stop has all of it.
  a.remote.ask(controlword::quick_stop);
  a.run(20);
  EXPECT_GT(std::abs(a.current), 1.5);
}

}  // namespace
}  // namespace stiction::test
