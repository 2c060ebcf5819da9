// A cam that moves its axis: braked along its curve, exchanged, with a second one on top, and with other axes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/firmware/cam/cam_mode_bench.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

using S = FixedSignals;

TEST_F(AMovingCam, ExchangesNothingWhileItBrakes) {
  EXPECT_EQ(mode.exchange(0, nullptr), CamRefusal::unknown_table);
  ASSERT_TRUE(mode.brake(CamStop::slow_down));
  EXPECT_EQ(mode.exchange(1, nullptr), CamRefusal::not_enabled);
}

// The tuner of cams looks at such a curve alone.
TEST_F(AMovingCam, IsItsTableWhereItIsNeitherScaledNorGearedNorShifted) {
  const auto asks = [&](const auto& change) {
    mode.asked() = {};
    change(mode.asked());
    EXPECT_EQ(mode.command(CamCommand::engage, false, true), CamRefusal::none);
    run(20'000);
    EXPECT_TRUE(mode.status().in_sync);
    return mode.as_its_table();
  };
  EXPECT_TRUE(asks([](CamMode::Asked&) {}));
  EXPECT_FALSE(asks([](CamMode::Asked& asked) { asked.slave_scale /= 2; }));
  EXPECT_FALSE(asks([](CamMode::Asked& asked) { asked.denominator = 2; }));
  EXPECT_FALSE(asks([](CamMode::Asked& asked) { asked.master_relative = true; }));
  EXPECT_FALSE(asks([](CamMode::Asked& asked) { asked.slave_relative = true; }));
  EXPECT_TRUE(asks([](CamMode::Asked&) {}));
}

TEST_F(AMovingCam, LeavesToAPlaceOfTheTravelAlone) {
  for (const double place : {-0.11, 0.11}) {
    mode.asked().leave_position = raw_position(place);
    EXPECT_EQ(mode.command(CamCommand::leave_to, false, true), CamRefusal::beyond_travel);
  }
  EXPECT_EQ(mode.command(CamCommand::leave_to, false, false), CamRefusal::none) << "of an axis that knows no travel";
}

TEST_F(AMovingCam, BrakesAlongItsCurveAndEngagesNothingMeanwhile) {
  ASSERT_TRUE(mode.brake(CamStop::slow_down));
  EXPECT_EQ(mode.command(CamCommand::engage, false, true), CamRefusal::not_enabled);
  run(1000);
  EXPECT_TRUE(mode.brake(CamStop::slow_down)) << "it does already";
  run(20'000);
  EXPECT_TRUE(mode.braked());
  mode.leave_to_rest();
  run(10);
  EXPECT_TRUE(mode.at_rest());
  mode.leave_to_rest();
  EXPECT_TRUE(mode.at_rest()) << "where it rests it has nothing to leave";
}

TEST_F(AMovingCam, DoesNotBrakeAlongACurveBeforeAnotherOrWithAPhaseOnItsWay) {
  mode.asked().trigger = CamTrigger::next_cycle;
  ASSERT_EQ(mode.command(CamCommand::engage, false, true), CamRefusal::none);
  run(1);
  ASSERT_TRUE(mode.status().waiting);
  EXPECT_FALSE(mode.brake(CamStop::slow_down));
  ASSERT_EQ(mode.command(CamCommand::cancel, false, true), CamRefusal::none);
  run(1);
  mode.asked().phase = raw_position(0.2);
  ASSERT_EQ(mode.command(CamCommand::phase, false, true), CamRefusal::none);
  run(1);
  ASSERT_TRUE(mode.phasing());
  EXPECT_FALSE(mode.brake(CamStop::slow_down));
}

TEST_F(AMovingCam, DoesNotBrakeAlongACurveBeyondTheLimitsOfTheAxis) {
  for (auto limit : {&MotionLimits::velocity, &MotionLimits::acceleration, &MotionLimits::jerk}) {
    const auto whole = config.motion.slave;
    config.motion.slave.*limit = 1;
    EXPECT_FALSE(mode.brake(CamStop::slow_down));
    config.motion.slave = whole;
  }
  EXPECT_TRUE(mode.brake(CamStop::slow_down));
}

// With a second cam on top, of a tenth of the first.
class ASecondCam : public AMovingCam {
 protected:
  ASecondCam() {
    config.second = CamMotion::Config::of(limits(0.1, 2.0, 2e3), limits(1.2, 5.0, 50.0), limits(0.1, 1.0, 10.0), 1024);
    config.superposed = config.second.slave;
    config.superposed_ramp = config.second.ramp;
    mode.asked().slave_scale = std::int64_t{1} << 28;
    EXPECT_EQ(mode.command(CamCommand::engage_second, false, true), CamRefusal::none);
    run(20'000);
    EXPECT_TRUE(mode.second_status().in_sync);
    EXPECT_EQ(mode.second_table(), 1);
  }
};

TEST_F(ASecondCam, BrakesWithTheFirstAndTakesNoCommandMeanwhile) {
  ASSERT_TRUE(mode.brake(CamStop::slow_down));
  for (const auto command : {CamCommand::leave_to, CamCommand::engage_second, CamCommand::leave_second})
    EXPECT_EQ(mode.command(command, false, true), CamRefusal::not_enabled);
  run(40'000);
  EXPECT_TRUE(mode.braked());
  EXPECT_TRUE(mode.second_status().in_sync);
  EXPECT_EQ(mode.point().velocity, 0);
}

// Neither sees the master of the machine again, which has gone on.
TEST_F(ASecondCam, IsLeftWithTheFirstWhileBothBrake) {
  ASSERT_TRUE(mode.brake(CamStop::slow_down));
  run(300);
  ASSERT_EQ(mode.command(CamCommand::leave, false, true), CamRefusal::none);
  run(20'000);
  EXPECT_TRUE(mode.at_rest());
  EXPECT_EQ(mode.fault(), Fault::none);
}

TEST_F(ASecondCam, IsNotBrakedAlongWhileItIsOnItsWay) {
  ASSERT_EQ(mode.command(CamCommand::leave_second, false, true), CamRefusal::none);
  run(20);
  ASSERT_TRUE(mode.second_status().waiting) << "one length of a bridge is tried in a tick";
  EXPECT_FALSE(mode.brake(CamStop::slow_down));
  run(80);
  ASSERT_TRUE(mode.second_status().busy);
  ASSERT_FALSE(mode.second_status().active);
  EXPECT_FALSE(mode.brake(CamStop::slow_down));
  run(20'000);
  EXPECT_FALSE(mode.second_status().busy);
  EXPECT_TRUE(mode.brake(CamStop::slow_down));
}

TEST_F(ASecondCam, GoesOnWhereTheFirstIsLeftAndIsNoTableOfItsOwn) {
  EXPECT_FALSE(mode.as_its_table()) << "it is on top";
  ASSERT_EQ(mode.command(CamCommand::leave, false, true), CamRefusal::none);
  run(20'000);
  EXPECT_FALSE(mode.status().active);
  EXPECT_TRUE(mode.second_status().in_sync);
  EXPECT_FALSE(mode.at_rest());
  EXPECT_FALSE(mode.as_its_table()) << "nothing is followed";
}

TEST_F(ASecondCam, IsNotOnTopOfAMoveWhetherItMovesOrWaits) {
  EXPECT_EQ(mode.command(CamCommand::superpose, false, true), CamRefusal::superposes);
  ASSERT_EQ(mode.command(CamCommand::leave_second, false, true), CamRefusal::none);
  run(100);
  EXPECT_FALSE(mode.second_status().active);
  EXPECT_FALSE(mode.as_its_table()) << "it is on its way to nothing";
  run(20'000);
  EXPECT_TRUE(mode.as_its_table());
  mode.asked().trigger = CamTrigger::next_cycle;
  ASSERT_EQ(mode.command(CamCommand::engage_second, false, true), CamRefusal::none);
  run(1);
  ASSERT_TRUE(mode.second_status().waiting);
  EXPECT_EQ(mode.command(CamCommand::superpose, false, true), CamRefusal::superposes);
}

TEST_F(ASecondCam, IsAFaultOfTheAxisWhereItLosesItsMaster) {
  mode.step({{}, false});
  EXPECT_EQ(mode.fault(), Fault::master_lost);
  EXPECT_FALSE(mode.second_status().active);
}

// Three axes on one curve behind one master, with ramps of their own.
class JoinedCams : public ACamMode {
 protected:
  JoinedCams() {
    for (std::size_t k = 0; k < 3; ++k) configs[k] = config;
    for (auto& each : modes) {
      if (&each != &modes[0]) each.join(modes[0]);
      each.start(S::Position{});
    }
  }
  void decelerate(double first, double second, double third) {
    const double wanted[] = {first, second, third};
    for (std::size_t k = 0; k < 3; ++k) configs[k].stops.fill(Span::of(raw_acceleration(wanted[k])));
  }
  void engage() {
    master.run(master_speed(1.0));
    for (auto& each : modes) EXPECT_EQ(each.command(CamCommand::engage, false, true), CamRefusal::none);
    for (int k = 0; k < 20'000; ++k) tick(0);
    for (const auto& each : modes) EXPECT_TRUE(each.status().in_sync);
  }
  // One after the other, as an owner of axes has them; `braking`: a bit an axis that is to brake.
  void tick(unsigned braking) {
    const MasterReading reading{master.step(), true};
    for (std::size_t k = 0; k < 3; ++k) {
      if ((braking >> k & 1u) != 0) modes[k].brake(CamStop::slow_down);
      modes[k].step(reading);
    }
    for (const std::size_t k : {1u, 2u})
      apart[k] = std::max(apart[k], std::abs(modes[k].point().position - modes[0].point().position));
  }

  VirtualMaster master{VirtualMaster::Config::of(limits(1.2, 5.0, 50.0))};
  std::array<CamMode::Config, 3> configs;
  std::array<CamMode, 3> modes{{CamMode{configs[0], tables}, CamMode{configs[1], tables}, CamMode{configs[2], tables}}};
  std::array<std::int64_t, 3> apart{};
};

TEST_F(JoinedCams, KeepTheirPhaseThroughAStopOfAllWhoeverIsSlowest) {
  decelerate(20.0, 12.0, 15.0);
  engage();
  std::mt19937_64 draw(8);
  std::int64_t most = 0;
  for (int stop = 0; stop < 40; ++stop) {
    const auto& fastest = configs[static_cast<std::size_t>(stop) % 3];
    for (auto& each : configs) each.stops = fastest.stops;
    configs[draw() % 3].stops.fill(Span::of(raw_acceleration(12.0)));
    const auto wait = static_cast<int>(draw() % 16'000);
    for (int k = 0; k < wait; ++k) tick(0);
    apart = {};
    for (int k = 0; k < 20'000; ++k) tick(7);
    most = std::max({most, apart[1], apart[2]});
    for (auto& each : modes) {
      ASSERT_TRUE(each.braked());
      each.leave_to_rest();
    }
    for (int k = 0; k < 100; ++k) tick(0);
    engage();
  }
  figure("cam mode: three axes that brake along their cams at once, phase between them",
         fmt::format("{} units of 2^-40 m in 40 stops (bound 1)", most));
  EXPECT_LE(most, 1);
}

class OneOfJoinedCams : public JoinedCams, public ::testing::WithParamInterface<double> {};

// The first of these cannot brake along its cam at all.
INSTANTIATE_TEST_SUITE_P(Slow, OneOfJoinedCams, ::testing::Values(3.0, 6.0, 9.0));

TEST_P(OneOfJoinedCams, IsNotWaitedForWhereItTakesMoreThanTwiceAsLong) {
  decelerate(20.0, 20.0, GetParam());
  engage();
  int first = 0;
  for (; !modes[0].braked() && first < 100'000; ++first) tick(7);
  CamMode alone{configs[0], tables};
  alone.start(S::Position{});
  master.run(master_speed(1.0));
  alone.command(CamCommand::engage, false, true);
  for (int k = 0; k < 20'000; ++k) alone.step({master.step(), true});
  int ticks = 0;
  for (; !alone.braked() && ticks < 100'000; ++ticks) {
    alone.brake(CamStop::slow_down);
    alone.step({master.step(), true});
  }
  EXPECT_EQ(first, ticks);
  EXPECT_EQ(apart[1], 0);
}

TEST_F(JoinedCams, BrakeAloneWhereTheOthersGoOn) {
  decelerate(20.0, 12.0, 12.0);
  engage();
  for (int k = 0; k < 100; ++k) tick(4);
  EXPECT_TRUE(modes[2].braking());
  EXPECT_FALSE(modes[0].braking());
  EXPECT_EQ(apart[1], 0);
  for (int k = 0; k < 20'000; ++k) tick(4);
  EXPECT_TRUE(modes[2].braked());
  EXPECT_TRUE(modes[0].status().in_sync);
  // Later ones go their own way.
  for (int k = 0; k < 20'000; ++k) tick(1);
  EXPECT_TRUE(modes[0].braked());
}

}  // namespace
}  // namespace stiction::test
