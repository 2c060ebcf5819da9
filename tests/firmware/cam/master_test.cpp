// Masters: the virtual one against its limits and exact whole numbers, gears against 128-bit division, the estimator
// against the motion that its encoder saw.
#include "stiction/motion/master.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "stiction/motion/gear.hpp"
#include "stiction/motion/master_estimator.hpp"
#include "stiction/motion/smooth_offset.hpp"
#include "tests/firmware/cam/cam_bench.hpp"
#include "tests/firmware/number/exact.hpp"
#include "tests/support/figure.hpp"

namespace stiction {
namespace {

using test::Int128;
using test::limits;

const MotionLimits shaft_limits = limits(3.0, 20.0, 400.0);

Int128 whole(const MasterPosition& at) { return (Int128{at.cycles} << 64) + static_cast<Int128>(at.phase); }
MasterPosition position(Int128 raw) { return {static_cast<std::int64_t>(raw >> 64), static_cast<std::uint64_t>(raw)}; }

MotionPoint relative(const MasterPoint& at, const MasterPosition& zero) {
  return {(at.position - zero).raw(), at.velocity, at.acceleration};
}

TEST(MasterPosition, IsExactArithmeticOfWholeAndFraction) {
  std::mt19937_64 random(5);
  for (int k = 0; k < 100'000; ++k) {
    const Int128 a = (Int128{static_cast<std::int64_t>(random())} << 60) + static_cast<std::int64_t>(random());
    const Int128 b = (Int128{static_cast<std::int64_t>(random())} << 50) + static_cast<std::int64_t>(random());
    EXPECT_EQ(whole(position(a) + position(b)), a + b);
    EXPECT_EQ(whole(position(a) - position(b)), a - b);
    EXPECT_EQ(whole(-position(a)), -a);
    const auto small = static_cast<std::int64_t>(random());
    EXPECT_EQ(whole(MasterPosition::fine(small)), Int128{small});
    EXPECT_EQ(whole(MasterPosition::way(small)), Int128{small} << 24);
    EXPECT_EQ(MasterPosition::way(small >> 3).raw(), small >> 3);
  }
  EXPECT_EQ(whole(-position(0)), 0);
  EXPECT_EQ(position(Int128{1} << 100).raw(), (std::int64_t{1} << 62) - (std::int64_t{1} << 40));
  EXPECT_EQ(position(-(Int128{1} << 100)).raw(), -(std::int64_t{1} << 62));
}

TEST(VirtualMaster, RunsJogsReversesAndStopsWithinItsLimits) {
  std::mt19937_64 random(7);
  const auto between = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  VirtualMaster master(VirtualMaster::Config::of(shaft_limits));
  master.start({});
  test::Watch watch(shaft_limits);
  for (int k = 0; k < 2000; ++k) {
    const double speed = between(-3.0, 3.0);
    if (k % 3 == 0) {
      master.stop_at(random());
    } else {
      ASSERT_TRUE(master.run(k % 3 == 1 ? test::master_speed(speed) : 0));
    }
    const MasterPosition zero = master.point().position;
    watch.begin();  // of a different zero
    watch.see(relative(master.point(), zero));
    for (int tick = 0, ticks = static_cast<int>(between(1.0, 9000.0)); tick < ticks; ++tick)
      watch.see(relative(master.step(), zero));
  }
  EXPECT_LE(watch.position_jump, test::position_unit / 32);  // rounding of 2^-40
  EXPECT_LE(watch.over_velocity, 0.0);
  EXPECT_LE(watch.over_acceleration, 0.0);
  EXPECT_LE(watch.over_jerk, 0.0);
}

TEST(VirtualMaster, EndsAtJustTheSpeedAskedForAndDoesNotDrift) {
  VirtualMaster master(VirtualMaster::Config::of(shaft_limits));
  master.start({});
  const std::int64_t speed = test::master_speed(2.0 + 1.0 / 3.0);
  ASSERT_TRUE(master.run(speed));
  EXPECT_FALSE(master.at_speed());
  int ticks = 0;
  while (!master.at_speed()) master.step(), ++ticks;
  // A change at the acceleration with ramps of the jerk takes v/a + a/j at least.
  const double least = (2.0 + 1.0 / 3.0) / 20.0 + 20.0 / 400.0;
  EXPECT_GT(ticks / test::rate, least * 0.99);
  EXPECT_LT(ticks / test::rate, least * 3.0);
  const Int128 begin = whole(master.point().position);
  for (int k = 0; k < 5'000'000; ++k) master.step();
  EXPECT_EQ(whole(master.point().position), begin + Int128{speed} * 5'000'000);
  EXPECT_EQ(master.point().velocity, speed >> 12);
}

TEST(VirtualMaster, StopsAtItsAngleExactly) {
  std::mt19937_64 random(11);
  for (int k = 0; k < 300; ++k) {
    VirtualMaster master(VirtualMaster::Config::of(shaft_limits));
    master.start({static_cast<std::int64_t>(k) - 150, random()});
    const double speed = (k % 2 == 0 ? 1 : -1) * (0.01 + 0.0099 * k);
    ASSERT_TRUE(master.run(test::master_speed(speed)));
    for (int tick = 0; tick < 20000; ++tick) master.step();
    const std::uint64_t angle = random();
    const MasterPosition from = master.point().position;
    master.stop_at(angle);
    int ticks = 0;
    while (!master.at_speed() && ++ticks < 4'000'000) {
      const auto point = master.step();
      ASSERT_GE(point.velocity * (speed > 0 ? 1 : -1), -1) << "turned back";
    }
    EXPECT_EQ(master.point().position.phase, angle);
    EXPECT_EQ(master.point().velocity, 0);
    // The next one that can be reached: less than a cycle behind the shortest way to stop.
    const double gone = std::abs(test::position_of((master.point().position - from).raw()));
    EXPECT_LT(gone, 1.0 + std::abs(speed) * 0.6);
  }
}

TEST(VirtualMaster, AStandingOneStaysWhereItIsAskedToStop) {
  VirtualMaster master(VirtualMaster::Config::of(shaft_limits));
  master.start({3, 17});
  master.stop_at(5);
  EXPECT_FALSE(master.at_speed());
  EXPECT_EQ(master.step().position, (MasterPosition{3, 17}));
  EXPECT_TRUE(master.at_speed());
}

TEST(VirtualMaster, RefusesASpeedBeyondItsLimit) {
  VirtualMaster master(VirtualMaster::Config::of(shaft_limits));
  master.start({});
  EXPECT_FALSE(master.run(test::master_speed(3.001)));
  EXPECT_FALSE(master.run(-test::master_speed(3.001)));
  EXPECT_TRUE(master.at_speed());
  EXPECT_TRUE(master.run(test::master_speed(-2.999)));
}

// 10^9 cycles and more, forward, back, with jogs and reversals; what a tick makes of them is the same step of the
// phase.
TEST(GearRatio, DoesNotDriftIn1e9CyclesOfTheMaster) {
  std::mt19937_64 random(3);
  const GearRatio gear(355, 113), back(-355, 113);
  Int128 at = 0, furthest = 0, worst = 0;
  MasterPosition master{};
  std::int64_t steps = 0;
  const auto move = [&](Int128 way) {
    at += way;
    master = master + position(way);
    furthest = std::max(furthest, at);
    const Int128 product = at * 355, floor = product >= 0 ? product / 113 : -((-product + 112) / 113);
    const Int128 opposite = -at * 355, mirrored = opposite >= 0 ? opposite / 113 : -((-opposite + 112) / 113);
    worst = std::max({worst, whole(gear.position(master)) - floor, floor - whole(gear.position(master)),
                      whole(back.position(master)) - mirrored, mirrored - whole(back.position(master))});
    ++steps;
  };
  const auto part = [&random] { return static_cast<std::int64_t>(random() >> 1); };
  while (at < Int128{1'000'000'000} << 64) {
    move((Int128{1000} << 64) + part());
    if (steps % 7 == 0) move(-(Int128{300} << 64) - part());  // reversals
    move(part() >> 20);                                       // jogs
    move(-(part() >> 20));
  }
  while (at > 0) move(-std::min(at, (Int128{2000} << 64) + part()));
  test::figure("cam gear: 10^9 cycles forward and back, 355/113, drift",
               fmt::format("{} phases of 2^-64 cycles after {} steps (bound 0)", test::text(worst), steps));
  EXPECT_GE(furthest, Int128{1'000'000'000} << 64);
  EXPECT_EQ(worst, 0);
  EXPECT_EQ(master, MasterPosition{});
  EXPECT_EQ(gear.position(master), MasterPosition{});
}

TEST(GearRatio, TakesAnEndlessSlaveThrough1e9TurnsExactly) {
  const GearRatio gear(355, 113);
  std::int64_t off = 0;
  for (std::int64_t k = 0; k <= 3'000'000; ++k) {
    const MasterPosition slave = gear.position({113 * k, 0});  // 355 turns each time
    off += slave.phase != 0 || slave.cycles != 355 * k;
  }
  EXPECT_EQ(gear.position({113 * 3'000'000, 0}).cycles, 1'065'000'000);
  test::figure("cam gear: 1.07e9 turns of an endless slave, drift", fmt::format("{} turns off (bound 0)", off));
  EXPECT_EQ(off, 0);
}

TEST(GearRatio, GearsSpeedsToo) {
  const GearRatio gear(-355, 113);
  const MasterPoint out = gear.of({{}, 1'000'000'000, -500'000});
  EXPECT_NEAR(static_cast<double>(out.velocity), -1e9 * 355 / 113, 2.0);
  EXPECT_NEAR(static_cast<double>(out.acceleration), 5e5 * 355 / 113, 2.0);
  EXPECT_EQ(GearRatio(1, 1).position({3, 7}), (MasterPosition{3, 7}));
  EXPECT_EQ(GearRatio(1, 3).of({{3, 6}, 33, 0}).velocity, 11);
  EXPECT_EQ(GearRatio(1, 0).denominator(), 1u);
  EXPECT_EQ(gear.numerator(), -355);
  EXPECT_EQ(GearRatio(INT32_MIN, UINT16_MAX).position({65535, 0}), (MasterPosition{INT32_MIN, 0}));
  EXPECT_NEAR(static_cast<double>(GearRatio(INT32_MIN, UINT16_MAX).factor()), -0x1p63 / 65535, 2.0);
}

TEST(SmoothOffset, GoesToEachNewTargetWithinItsLimits) {
  const MotionLimits own = limits(0.5, 5.0, 100.0);
  SmoothOffset offset;
  offset.start(0);
  std::mt19937_64 random(13);
  test::Watch watch(own);
  std::int64_t target = 0;
  for (int k = 0; k < 600; ++k) {
    target = static_cast<std::int64_t>(random() >> 23) - (std::int64_t{1} << 40);
    offset.go(target);
    for (int tick = 0, ticks = k % 50 == 0 ? 600'000 : static_cast<int>(random() % 3000); tick < ticks; ++tick)
      watch.see(offset.step(own));
    if (k % 50 == 0) {
      EXPECT_FALSE(offset.busy());
      EXPECT_FALSE(offset.refused());
      EXPECT_EQ(offset.point().position, target);
    }
  }
  EXPECT_LE(watch.position_jump, test::position_unit / 32);
  EXPECT_LE(watch.over_velocity, 0.0);
  EXPECT_LE(watch.over_acceleration, 0.0);
  EXPECT_LE(watch.over_jerk, 0.0);
}

TEST(SmoothOffset, RefusesWhatNoLengthReaches) {
  const MotionLimits own = limits(1e-3, 1e-3, 1e-3);
  SmoothOffset offset;
  offset.start(5);
  offset.go(test::raw_position(1e6));
  EXPECT_TRUE(offset.busy());
  for (int k = 0; k < 200; ++k) EXPECT_EQ(offset.step(own).position, 5);
  EXPECT_FALSE(offset.busy());
  EXPECT_TRUE(offset.refused());
}

// An incremental encoder of 10 000 lines, four counts each, whose edges lie up to half a count off, on a master at
// 130/min or on its way there.
constexpr double counts = 40000.0, speed_130 = 130.0 / 60.0;

MasterPosition counted(double x) {
  const double count = std::floor(x * counts), cycles = std::floor(count / counts);
  const auto rest = static_cast<std::uint64_t>(count - cycles * counts);
  return {static_cast<std::int64_t>(cycles), static_cast<std::uint64_t>((static_cast<Int128>(rest) << 64) / 40000)};
}

struct Estimated {
  double lag = 0.0;           // s, mean
  double acceleration = 0.0;  // mean error over the acceleration, or over 1/s^2
  double noise = 0.0;         // rms of the acceleration about its mean
  double difference_noise = 0.0;
  double ahead = 0.0;  // largest error of the position at the time of the look-ahead, cycles
};

Estimated estimate(double acceleration, std::int32_t look_ahead) {
  MasterEstimator estimator({.bits = 7,
                             .half_count = static_cast<std::int64_t>(0x1p63 / counts),
                             .jump = std::int64_t{1} << 58,
                             .look_ahead = look_ahead});
  constexpr int settle = 32000, seen = 64000;
  const double start = acceleration > 0.0 ? 0.0 : speed_130;
  const auto x = [&](double t) { return start * t + acceleration * t * t / 2; };
  estimator.start(counted(0.0));
  std::mt19937_64 random(17);
  const auto seen_by_encoder = [&](double t) {
    return counted(x(t) + (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5) / counts);
  };
  MasterPosition last[2]{};
  double lag = 0.0, sum = 0.0, square = 0.0, differences = 0.0, ahead = 0.0;
  for (int k = 1; k <= settle + seen; ++k) {
    const double t = k / test::rate;
    const MasterPosition measured = seen_by_encoder(t);
    EXPECT_TRUE(estimator.step(measured));
    const MasterPosition second = measured - last[0] - (last[0] - last[1]);
    last[1] = last[0];
    last[0] = measured;
    if (k <= settle) continue;
    const MasterPoint point = estimator.point();
    const double later = t + std::ldexp(look_ahead, -16) / test::rate, speed = start + acceleration * later;
    const double error = x(later) - test::cycles_of(point.position), a = test::acceleration_of(point.acceleration);
    lag += error / speed / seen;
    ahead = std::max(ahead, std::abs(error));
    sum += a / seen;
    square += a * a / seen;
    const double difference = test::position_of(second.raw()) * test::rate * test::rate - acceleration;
    differences += difference * difference / seen;
  }
  return {lag, sum - acceleration, std::sqrt(std::max(0.0, square - sum * sum)), std::sqrt(differences), ahead};
}

TEST(MasterEstimator, DoesNotLagAtConstantSpeedNorAtConstantAcceleration) {
  const Estimated steady = estimate(0.0, 0), ramp = estimate(0.35, 0), later = estimate(0.35, 5 << 15);
  test::figure("cam master: estimator at constant speed, lag",
               fmt::format("{:.3f} us (bound 0.1 us)", std::abs(steady.lag) * 1e6));
  test::figure("cam master: estimator at constant acceleration, lag",
               fmt::format("{:.3f} us (bound 0.1 us)", std::abs(ramp.lag) * 1e6));
  test::figure("cam master: acceleration estimated, noise over that of differences",
               fmt::format("1/{:.0f} (bound 1/50)", steady.difference_noise / steady.noise));
  // What edges that are drawn leave in the mean of 4 s: a hundredth of a count at this speed is 0.1 us.
  EXPECT_LE(std::abs(steady.lag), 1e-7);
  EXPECT_LE(std::abs(ramp.lag), 1e-7);
  EXPECT_LE(std::abs(steady.acceleration), 1e-3);
  EXPECT_LE(std::abs(ramp.acceleration), 1e-3);
  EXPECT_LE(steady.noise, steady.difference_noise / 50);
  EXPECT_LE(later.ahead, 1.0 / counts);
  EXPECT_LE(std::abs(later.lag), 1e-7);
}

// With a position that is not counted nothing is left but rounding.
TEST(MasterEstimator, FollowsAnExactMasterToItsRounding) {
  MasterEstimator estimator({.bits = 5, .half_count = 0, .jump = std::int64_t{1} << 59, .look_ahead = 0});
  estimator.start({});
  // Even, so that halves of it are whole.
  const std::int64_t v0 = test::master_speed(1.0), a = std::int64_t{1} << 34;
  MasterPosition at{};
  std::int64_t v = v0;
  for (int k = 0; k < 40'000; ++k) {
    at = at + MasterPosition::fine(v + a / 2);
    v += a;
    EXPECT_TRUE(estimator.step(at));
  }
  const MasterPoint point = estimator.point();
  EXPECT_LE(std::abs((point.position - at).raw()), 1);
  EXPECT_NEAR(test::velocity_of(point.velocity), std::ldexp(static_cast<double>(v), -64) * test::rate, 1e-9);
  EXPECT_NEAR(static_cast<double>(point.acceleration), static_cast<double>(a), 1e-4 * static_cast<double>(a));
}

TEST(MasterEstimator, SaysWhereTheMasterJumps) {
  MasterEstimator estimator({.bits = 5, .half_count = 0, .jump = std::int64_t{1} << 54, .look_ahead = 0});
  estimator.start({7, 0});
  EXPECT_TRUE(estimator.step({7, std::uint64_t{1} << 54}));
  const MasterPosition before = estimator.point().position;
  EXPECT_FALSE(estimator.step({7, std::uint64_t{1} << 62}));
  EXPECT_FALSE(estimator.step({8, 0}));
  EXPECT_FALSE(estimator.step({6, std::uint64_t{1} << 63}));
  EXPECT_LT(std::abs((estimator.point().position - before).raw()), std::int64_t{1} << 31);
}

TEST(MasterPosition, OfAnEndlessAxisIsItsTurnsAndPhase) {
  constexpr auto table = EndlessPhase::config(3550000, 113);
  EndlessPhase::State state;
  EndlessPhase::step(table, state, -1);
  EXPECT_EQ(master_position(table, state), (MasterPosition{-1, std::uint64_t{0xfffde9f6} << 32}));
}

}  // namespace
}  // namespace stiction
