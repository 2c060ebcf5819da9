// A PLC that engages a cam, switches the table, phases and disengages: over Modbus registers and over the objects of
// CANopen, in the drive's own time. Truth is the motion in double precision at the place that the master shows.
#include "tests/firmware/stictiond/served_cam.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stiction::test {
namespace {

INSTANTIATE_TEST_SUITE_P(Bus, ServedCam, ::testing::Bool(),
                         [](const auto& bus) { return std::string(bus.param ? "CANopen" : "Modbus"); });

TEST_P(ServedCam, IsEngagedSwitchedPhasedAndLeft) {
  ASSERT_TRUE(enable_in(-1));
  EXPECT_FALSE(shows(busy));
  ASSERT_TRUE(write("master_speed", 130.0 / 60.0));
  run_until([&] { return std::abs(read("master_velocity") - 130.0 / 60.0) < 1e-5; });

  ASSERT_TRUE(write("cam_table", 1));
  ASSERT_TRUE(command(engage));
  EXPECT_EQ(read("cam_refusal"), 0.0);
  EXPECT_TRUE(shows(busy));
  run_until([&] { return shows(active | in_sync); });
  EXPECT_EQ(read("cam_followed"), 1.0);
  for (int k = 0; k < 500; ++k) {
    step();
    ASSERT_NEAR(off(0), 0.0, 2e-9);
  }
  EXPECT_TRUE(table.statusword(0) & statusword::target_bit);
  EXPECT_TRUE(table.statusword(0) & statusword::follows_bit);
  const double ends = read("cam_ends");
  step(1000);
  EXPECT_NEAR(read("cam_ends") - ends, 130.0 / 60.0, 1.0);

  // The second table, where the next cycle begins.
  ASSERT_TRUE(write("cam_table", 2));
  ASSERT_TRUE(write("cam_trigger", 3));
  ASSERT_TRUE(command(engage));
  run_until([&] { return read("cam_followed") == 2.0 && shows(in_sync); });
  for (int k = 0; k < 500; ++k) {
    step();
    ASSERT_NEAR(off(1), 0.0, 2e-9);
  }

  ASSERT_TRUE(write("cam_phase", 0.1));
  ASSERT_TRUE(command(phase));
  run_until([&] { return !table.cam->mode(0).phasing(); }, 8000);
  for (int k = 0; k < 500; ++k) {
    step();
    ASSERT_NEAR(off(1, 0.1), 0.0, 2e-9);
  }

  ASSERT_TRUE(command(leave));
  run_until([&] { return !shows(busy); });
  EXPECT_EQ(read("cam_followed"), 0.0);
  EXPECT_EQ(machine::to_si(table.loop.drive(0).set_velocity()), 0.0);
  EXPECT_EQ(table.loop.fault(0), Fault::none);
  EXPECT_TRUE(table.powered(0));
  EXPECT_GT(largest_change, 1.0) << "m/s^2: it has moved";
}

TEST_P(ServedCam, ThatCannotBeIsRefusedWithAReasonAndNothingMoves) {
  ASSERT_TRUE(enable_in(-1));
  const double stands = table.set_position(0);
  const auto refused = [&](int reason) {
    EXPECT_TRUE(command(engage));
    step(200);
    EXPECT_EQ(read("cam_refusal"), reason);
    EXPECT_TRUE(table.statusword(0) & statusword::limit_bit);
    EXPECT_FALSE(shows(active));
    EXPECT_EQ(table.set_position(0), stands);
  };
  ASSERT_TRUE(write("cam_table", 3));
  refused(8);
  ASSERT_TRUE(write("cam_table", 1));
  ASSERT_TRUE(write("gear_numerator", 20));
  refused(3);
  ASSERT_TRUE(write("gear_numerator", 1));
  ASSERT_TRUE(write("cam_slave_scale", 20.0));
  refused(10);
  ASSERT_TRUE(write("cam_slave_scale", 1.0));
  ASSERT_TRUE(write("cam_slave_offset", 0.5));
  refused(10);
  // 30 mm in 5 ms.
  ASSERT_TRUE(write("cam_slave_offset", -0.03));
  ASSERT_TRUE(write("cam_approach", 1));
  ASSERT_TRUE(write("cam_time", 5e-3));
  refused(4);
  ASSERT_TRUE(write("cam_time", 0.5));
  ASSERT_TRUE(command(engage));
  run_until([&] { return shows(in_sync); });
  EXPECT_EQ(read("cam_refusal"), 0.0);
  EXPECT_NEAR(table.set_position(0), 0.06, 1e-9);
  EXPECT_FALSE(write("cam_trigger", 5)) << "no such number";
  EXPECT_FALSE(write("cam_command", 9));
}

TEST_P(ServedCam, OfAnAxisThatIsNotEnabledInItsModeIsRefused) {
  ASSERT_TRUE(write("cam_command", engage));
  step(5);
  EXPECT_EQ(read("cam_refusal"), 9.0);
  EXPECT_FALSE(shows(busy));
}

TEST_P(ServedCam, IsLeftForAHaltAndForADifferentMode) {
  ASSERT_TRUE(enable_in(-1));
  ASSERT_TRUE(write("master_speed", 1.0));
  ASSERT_TRUE(command(engage));
  run_until([&] { return shows(in_sync); });
  step(300);
  ASSERT_TRUE(write("controlword", 0x10f));
  run_until([&] { return !shows(busy); });
  EXPECT_TRUE(table.powered(0));
  ASSERT_TRUE(write("controlword", 0x0f));
  step(500);
  EXPECT_FALSE(shows(active)) << "not by itself";
  ASSERT_TRUE(command(engage));
  run_until([&] { return shows(in_sync); });
  step(150);
  ASSERT_TRUE(write("mode_of_operation", 1));
  run_until([&] { return read("mode") == 1.0; });
  EXPECT_FALSE(shows(busy));
  EXPECT_EQ(machine::to_si(table.loop.drive(0).set_velocity()), 0.0);
}

// Each word that stops, along the cam where that takes no more than the ramp: the acceleration comes and goes with a
// limited jerk, where a ramp has all of its own at once; the place stays one of the curve.
struct StopWord {
  std::uint16_t word;
  DriveState to;
};
constexpr std::array<StopWord, 4> stop_words{{{0x10f, DriveState::operation_enabled},
                                              {0x02, DriveState::switch_on_disabled},
                                              {0x06, DriveState::ready_to_switch_on},
                                              {0x07, DriveState::switched_on}}};

struct Stop {
  int ticks = 0;
  double largest_acceleration = 0.0, largest_change = 0.0;  // m/s^2, and of it from tick to tick
  double lowest = 1.0, highest = -1.0;                      // m
};

class StoppedCam : public ServedCam {
 protected:
  explicit StoppedCam(const std::vector<std::string>& settings = {}) : ServedCam(two_tables(), settings) {}

  // The stop that `word` makes of a cam at `speed` (cycles/s), `delay` ms after it is in sync.
  Stop stop(std::uint16_t word, double speed, int delay) {
    Stop made;
    EXPECT_TRUE(enable_in(-1));
    EXPECT_TRUE(write("master_speed", speed));
    run_until([&] { return std::abs(read("master_velocity") - speed) < 1e-5; });
    EXPECT_TRUE(command(engage));
    run_until([&] { return shows(in_sync); });
    step(delay);
    double before = 0.0, acceleration_before = 0.0;
    bool moving = false, seen = false;
    table.before_tick = [&] {
      const double v = machine::to_si(table.loop.drive(0).set_velocity()), x = table.set_position(0);
      const double a = (v - before) / 62.5e-6;
      moving = v != 0.0 || a != 0.0;
      if (seen && table.powered(0)) {
        ++made.ticks;
        made.largest_acceleration = std::max(made.largest_acceleration, std::abs(a));
        if (made.ticks > 1) made.largest_change = std::max(made.largest_change, std::abs(a - acceleration_before));
        made.lowest = std::min(made.lowest, x);
        made.highest = std::max(made.highest, x);
      }
      seen = true;
      before = v;
      acceleration_before = a;
    };
    EXPECT_TRUE(write("controlword", word));
    int still = 0;
    for (int k = 0; k < 5000 && still < 20; ++k) {
      step();
      still = moving ? 0 : still + 1;
    }
    table.before_tick = {};
    step(200);
    return made;
  }
};

INSTANTIATE_TEST_SUITE_P(Bus, StoppedCam, ::testing::Bool(),
                         [](const auto& bus) { return std::string(bus.param ? "CANopen" : "Modbus"); });

TEST_P(StoppedCam, BrakesAlongTheCamByEveryWordThatStops) {
  for (const auto& [word, to] : stop_words)
    for (const int delay : {50, 310}) {
      SCOPED_TRACE(::testing::Message() << std::hex << word << std::dec << " after " << delay << " ms");
      const auto made = stop(word, 1.5, delay);
      EXPECT_EQ(table.loop.state(0), to);
      EXPECT_EQ(table.loop.fault(0), Fault::none);
      EXPECT_FALSE(shows(active));
      // The ramp's deceleration, 10 m/s^2, at most; its onset within a tick is none.
      EXPECT_LE(made.largest_acceleration, 10.0 + 1e-3);
      EXPECT_LE(made.largest_change, 2.0);
      // Over the top of the cam the way leads back on it, and not further.
      EXPECT_LE(made.highest, 0.09 + 20e-3 + 1e-9);
      EXPECT_GE(made.lowest, 0.09 - 1e-9);
      write("controlword", 0);
      step(200);
    }
}

TEST_P(StoppedCam, CanBeEnabledAndEngagedAgainBehindAStop) {
  stop(0x02, 1.5, 50);
  ASSERT_TRUE(enable_in(-1));
  EXPECT_FALSE(shows(active)) << "not by itself";
  ASSERT_TRUE(command(engage));
  run_until([&] { return shows(in_sync); });
  for (int k = 0; k < 500; ++k) {
    step();
    ASSERT_NEAR(off(0), 0.0, 2e-9);
  }
}

// What the master braked would do is of no use for an axis with a fault.
TEST_P(StoppedCam, BrakesByItsRampForAFault) {
  ASSERT_TRUE(enable_in(-1));
  ASSERT_TRUE(write("master_speed", 1.5));
  ASSERT_TRUE(command(engage));
  run_until([&] { return shows(in_sync); });
  step(600);
  while (std::abs(machine::to_si(table.loop.drive(0).set_velocity())) < 0.05) step();
  table.before_tick = {};
  double before = machine::to_si(table.loop.drive(0).set_velocity());
  table.loop.trip(0, Fault::missed_deadline);
  for (int k = 0; k < 3; ++k) table.tick();
  before = machine::to_si(table.loop.drive(0).set_velocity());
  table.tick();
  const double after = machine::to_si(table.loop.drive(0).set_velocity());
  EXPECT_NEAR(std::abs(after) - std::abs(before), -10.0 * 62.5e-6, 1e-6);
}

// A quick stop in a slower one: by its ramp from there on, from 4 ms behind the first word.
TEST_P(StoppedCam, TakesTheRampOfAFasterStop) {
  ASSERT_TRUE(enable_in(-1));
  ASSERT_TRUE(write("master_speed", 1.5));
  ASSERT_TRUE(command(engage));
  run_until([&] { return shows(in_sync); });
  while (std::abs(machine::to_si(table.loop.drive(0).set_velocity())) < 0.05) step();
  ASSERT_TRUE(write("controlword", 0x07));
  step(4);
  ASSERT_TRUE(table.powered(0)) << "the way along the cam takes longer";
  ASSERT_TRUE(write("controlword", 0x02));
  step(1000);
  EXPECT_EQ(table.loop.state(0), DriveState::switch_on_disabled);
  EXPECT_EQ(table.loop.fault(0), Fault::none);
  EXPECT_FALSE(shows(active));
}

// 3.4 m/s^2 of the curve alone at this speed.
class SlowRampCam : public StoppedCam {
 protected:
  SlowRampCam() : StoppedCam({"drive.axis.X.quick_stop_deceleration=3 m/s^2"}) {}
};

INSTANTIATE_TEST_SUITE_P(Bus, SlowRampCam, ::testing::Bool(),
                         [](const auto& bus) { return std::string(bus.param ? "CANopen" : "Modbus"); });

TEST_P(SlowRampCam, LeavesACamThatAsksForMoreThanTheRamp) {
  for (const int word : {0x02, 0x06, 0x07}) {
    SCOPED_TRACE(word);
    const auto made = stop(static_cast<std::uint16_t>(word), 130.0 / 60.0, 120);
    EXPECT_EQ(table.loop.fault(0), Fault::none);
    EXPECT_FALSE(shows(active));
    EXPECT_GE(made.largest_change, 1.0) << "the onset of the ramp";
    write("controlword", 0);
    step(200);
  }
}

TEST_P(ServedCam, IsLeftAtASpeed) {
  ASSERT_TRUE(enable_in(-1));
  ASSERT_TRUE(write("master_speed", 1.0));
  ASSERT_TRUE(command(engage));
  run_until([&] { return shows(in_sync); });
  step(300);
  ASSERT_TRUE(write("cam_leave_speed", -0.01));
  ASSERT_TRUE(command(leave));
  run_until([&] { return !shows(busy); });
  EXPECT_NEAR(machine::to_si(table.loop.drive(0).set_velocity()), -0.01, 1e-6);
  step(100);
  EXPECT_NEAR(machine::to_si(table.loop.drive(0).set_velocity()), -0.01, 1e-6);
  // A halt ends that too.
  ASSERT_TRUE(write("controlword", 0x10f));
  step(300);
  EXPECT_EQ(machine::to_si(table.loop.drive(0).set_velocity()), 0.0);
  ASSERT_TRUE(write("controlword", 0x0f));
  ASSERT_TRUE(write("cam_leave_speed", 100.0));
  ASSERT_TRUE(command(leave));
  EXPECT_EQ(read("cam_refusal"), 7.0);
}

// The second cam is 5 mm lower where both rest at their begin, and 3 mm at the top, of the first's dwell.
TEST_P(ServedCam, IsSwitchedWhereTheCurvesAgree) {
  ASSERT_TRUE(enable_in(-1));
  ASSERT_TRUE(write("master_speed", 1.0));
  ASSERT_TRUE(command(engage));
  run_until([&] { return shows(in_sync); });
  ASSERT_TRUE(write("cam_table", 2));
  ASSERT_TRUE(write("cam_trigger", 4));
  ASSERT_TRUE(write("cam_tolerance", 4e-3));
  ASSERT_TRUE(write("cam_tolerance_speed", 1e-3));
  ASSERT_TRUE(write("cam_tolerance_acceleration", 5.0));
  ASSERT_TRUE(command(engage));
  step(2500);
  EXPECT_TRUE(shows(waiting)) << "nowhere do they agree so well";
  ASSERT_TRUE(write("cam_tolerance", 5.1e-3));
  ASSERT_TRUE(command(engage));
  run_until([&] { return read("cam_followed") == 2.0 && shows(in_sync); }, 2000);
  for (int k = 0; k < 200; ++k) {
    step();
    ASSERT_NEAR(off(1), 0.0, 2e-9);
  }
}

TEST_P(ServedCam, HasAMoveOnTopOfIt) {
  ASSERT_TRUE(enable_in(-1));
  ASSERT_TRUE(write("master_speed", 1.0));
  ASSERT_TRUE(command(engage));
  run_until([&] { return shows(in_sync); });
  step(100);
  ASSERT_TRUE(write("cam_superposed", 3e-3));
  ASSERT_TRUE(command(5));
  run_until([&] { return !table.cam->mode(0).superposes(); });
  for (int k = 0; k < 1000; ++k) {
    step();
    ASSERT_NEAR(off(0), 3e-3, 2e-9);
  }
  EXPECT_TRUE(shows(in_sync));
  // A halt in the middle of one ends both.
  ASSERT_TRUE(write("cam_superposed", -10e-3));
  ASSERT_TRUE(command(5));
  step(20);
  ASSERT_TRUE(write("controlword", 0x10f));
  step(1000);
  EXPECT_EQ(machine::to_si(table.loop.drive(0).set_velocity()), 0.0);
  EXPECT_FALSE(table.cam->mode(0).superposes());
}

TEST_P(ServedCam, IsLeftAtAPosition) {
  ASSERT_TRUE(enable_in(-1));
  ASSERT_TRUE(write("master_speed", 1.0));
  ASSERT_TRUE(command(engage));
  run_until([&] { return shows(in_sync); });
  step(300);
  ASSERT_TRUE(write("cam_leave_position", 0.1));
  ASSERT_TRUE(command(leave_to));
  run_until([&] { return !shows(busy); });
  EXPECT_EQ(read("cam_refusal"), 0.0);
  EXPECT_NEAR(table.set_position(0), 0.1, 1e-9);
  EXPECT_EQ(machine::to_si(table.loop.drive(0).set_velocity()), 0.0);
  step(100);
  EXPECT_NEAR(table.set_position(0), 0.1, 1e-9);
  // Where the next cycle begins, in half a second.
  ASSERT_TRUE(command(engage));
  run_until([&] { return shows(in_sync); });
  ASSERT_TRUE(write("cam_leave_position", 0.08));
  ASSERT_TRUE(write("cam_trigger", 3));
  ASSERT_TRUE(write("cam_approach", 1));
  ASSERT_TRUE(write("cam_time", 0.5));
  ASSERT_TRUE(command(leave_to));
  EXPECT_TRUE(shows(active | waiting));
  run_until([&] { return !shows(active); });
  EXPECT_LT(read("master_phase"), 0.01);
  EXPECT_NEAR(run_until([&] { return !shows(busy); }), 500, 5);
  EXPECT_NEAR(table.set_position(0), 0.08, 1e-9);
  EXPECT_EQ(read("cam_followed"), 0.0);
}

TEST_P(ServedCam, IsNotLeftForAPositionThatCannotBe) {
  ASSERT_TRUE(enable_in(-1));
  ASSERT_TRUE(write("master_speed", 1.0));
  ASSERT_TRUE(command(engage));
  run_until([&] { return shows(in_sync); });
  const auto refused = [&](int reason) {
    EXPECT_TRUE(command(leave_to));
    step(50);
    EXPECT_EQ(read("cam_refusal"), reason);
    EXPECT_TRUE(shows(in_sync));
    EXPECT_NEAR(off(0), 0.0, 2e-9);
  };
  ASSERT_TRUE(write("cam_leave_position", 2.0));
  refused(10);
  ASSERT_TRUE(write("cam_leave_position", 0.0));
  ASSERT_TRUE(write("cam_approach", 1));
  ASSERT_TRUE(write("cam_time", 5e-3));
  refused(4);
  ASSERT_TRUE(write("cam_approach", 2));
  refused(5);
}

// The whole second table on top, in the tenth of the limits that an axis leaves at first, and in four tenths.
class CamShare : public ServedCam {
 protected:
  explicit CamShare(const std::vector<std::string>& settings = {}) : ServedCam(two_tables(), settings) {}

  double refusal_of_whole() {
    EXPECT_TRUE(enable_in(-1));
    EXPECT_TRUE(write("master_speed", 1.0));
    EXPECT_TRUE(command(engage));
    EXPECT_EQ(read("cam_refusal"), 0.0);
    run_until([&] { return shows(in_sync); });
    EXPECT_TRUE(write("cam_table", 2));
    EXPECT_TRUE(write("cam_slave_scale", 1.0));
    EXPECT_TRUE(write("cam_slave_offset", -85e-3));
    EXPECT_TRUE(command(engage_second));
    return read("cam_refusal");
  }
};
class CamShareOfFourTenths : public CamShare {
 protected:
  CamShareOfFourTenths() : CamShare({"drive.axis.X.cam.superposed_share=0.4"}) {}
};

INSTANTIATE_TEST_SUITE_P(Bus, CamShare, ::testing::Bool(),
                         [](const auto& bus) { return std::string(bus.param ? "CANopen" : "Modbus"); });
INSTANTIATE_TEST_SUITE_P(Bus, CamShareOfFourTenths, ::testing::Bool(),
                         [](const auto& bus) { return std::string(bus.param ? "CANopen" : "Modbus"); });

TEST_P(CamShare, OfATenthIsTooLittleForAWholeTable) { EXPECT_EQ(refusal_of_whole(), 3.0); }

TEST_P(CamShareOfFourTenths, TakesAWholeTableOnTop) {
  EXPECT_EQ(refusal_of_whole(), 0.0);
  run_until([&] { return shows(in_sync | second_in_sync); });
  double most = 0.0;
  for (int k = 0; k < 1500; ++k) {
    step();
    most = std::max(most, std::abs(off(0)));
  }
  EXPECT_NEAR(most, 12e-3, 5e-6) << "what the second one adds";
}

// The second table, a tenth as high and begun at 0.
class TwoCams : public ServedCam {
 protected:
  void engage_both() {
    ASSERT_TRUE(enable_in(-1));
    ASSERT_TRUE(write("master_speed", 1.0));
    ASSERT_TRUE(command(engage));
    run_until([&] { return shows(in_sync); });
    ASSERT_TRUE(write("cam_table", 2));
    ASSERT_TRUE(write("cam_slave_scale", 0.1));
    ASSERT_TRUE(write("cam_slave_offset", -8.5e-3));
    ASSERT_TRUE(command(engage_second));
    EXPECT_EQ(read("cam_refusal"), 0.0);
    run_until([&] { return shows(second_busy | second_in_sync); });
    EXPECT_EQ(read("cam_second"), 2.0);
    EXPECT_EQ(read("cam_followed"), 1.0);
  }
  // What the second one adds: from off(1) = x - m2, and off(0) = x - m1.
  double off_both() { return off(0) - (0.1 * (table.set_position(0) - off(1)) - 8.5e-3); }
};

INSTANTIATE_TEST_SUITE_P(Bus, TwoCams, ::testing::Bool(),
                         [](const auto& bus) { return std::string(bus.param ? "CANopen" : "Modbus"); });

TEST_P(TwoCams, AreTheSumOfBoth) {
  engage_both();
  double most = 0.0;
  for (int k = 0; k < 1500; ++k) {
    step();
    ASSERT_NEAR(off_both(), 0.0, 3e-9);
    most = std::max(most, std::abs(off(0)));
  }
  EXPECT_NEAR(most, 1.2e-3, 1e-6) << "what the second one adds";
  ASSERT_TRUE(command(leave_second));
  run_until([&] { return !shows(second_busy); });
  EXPECT_EQ(read("cam_second"), 0.0);
  EXPECT_TRUE(shows(in_sync));
  for (int k = 0; k < 500; ++k) {
    step();
    ASSERT_NEAR(off(0), 0.0, 2e-9);
  }
}

TEST_P(TwoCams, ShareTheirPhase) {
  engage_both();
  ASSERT_TRUE(write("cam_phase", 0.1));
  ASSERT_TRUE(command(phase));
  run_until([&] { return !table.cam->mode(0).phasing(); }, 8000);
  for (int k = 0; k < 500; ++k) {
    step();
    const double second = 0.1 * (table.set_position(0) - off(1, 0.1)) - 8.5e-3;
    ASSERT_NEAR(off(0, 0.1), second, 3e-9);
  }
}

TEST_P(TwoCams, AreNotOneOnTopOfAMove) {
  engage_both();
  ASSERT_TRUE(write("cam_superposed", 1e-3));
  ASSERT_TRUE(command(5));
  EXPECT_EQ(read("cam_refusal"), 11.0);
  ASSERT_TRUE(command(leave_second));
  run_until([&] { return !shows(second_busy); });
  ASSERT_TRUE(command(5));
  EXPECT_EQ(read("cam_refusal"), 0.0);
  ASSERT_TRUE(command(engage_second));
  EXPECT_EQ(read("cam_refusal"), 11.0);
  run_until([&] { return !table.cam->mode(0).superposes(); });
  // The curve as it is takes more than its share.
  ASSERT_TRUE(write("cam_slave_scale", 1.0));
  ASSERT_TRUE(command(engage_second));
  EXPECT_EQ(read("cam_refusal"), 3.0);
  EXPECT_TRUE(shows(in_sync));
}

TEST_P(TwoCams, BrakeTogetherAlongBoth) {
  engage_both();
  while (std::abs(machine::to_si(table.loop.drive(0).set_velocity())) < 0.03) step();
  int ticks = 0;
  ASSERT_TRUE(write("controlword", 0x02));
  step(2);
  EXPECT_TRUE(table.cam->mode(0).braking());
  for (; ticks < 1500 && table.powered(0); ++ticks) step();
  EXPECT_EQ(table.loop.state(0), DriveState::switch_on_disabled);
  EXPECT_EQ(table.loop.fault(0), Fault::none);
  EXPECT_FALSE(shows(active));
  EXPECT_FALSE(shows(second_busy));
}

TEST_P(TwoCams, AreBothLeftForAHalt) {
  engage_both();
  ASSERT_TRUE(write("controlword", 0x10f));
  run_until([&] { return !shows(busy) && !shows(second_busy); });
  EXPECT_EQ(machine::to_si(table.loop.drive(0).set_velocity()), 0.0);
  EXPECT_EQ(table.loop.fault(0), Fault::none);
}

TEST_P(ServedCam, AMasterIsHeldToItsLargestSpeed) {
  ASSERT_TRUE(enable_in(-1));
  ASSERT_TRUE(write("master_speed", -3.0));
  step(3000);
  EXPECT_NEAR(read("master_velocity"), -130.0 / 60.0, 1e-5);
}

// The master is an axis: Y follows X by a ratio of 1, in mode gear.
class ServedGear : public ServedCam {
 protected:
  ServedGear() : ServedCam({{}, "X", "0.1 m/s"}) { table.before_tick = {}; }

  void follow() {
    ASSERT_TRUE(enable_in(1, 0));
    ASSERT_TRUE(enable_in(-2, 1));
    step(50);
    ASSERT_TRUE(write("gear_way", 1.0, 1));
    ASSERT_TRUE(write("cam_options", 2, 1));
    ASSERT_TRUE(write("cam_command", engage, 1));
    step(20);
    ASSERT_EQ(read("cam_refusal", 1), 0.0);
    ASSERT_EQ(static_cast<unsigned>(read("cam_state", 1)) & (active | in_sync), unsigned{active | in_sync});
  }
  void move_master(double target, double speed) {
    ASSERT_TRUE(write("target_position", target));
    ASSERT_TRUE(write("profile_velocity", speed));
    ASSERT_TRUE(write("profile_acceleration", 1.0));
    ASSERT_TRUE(write("profile_deceleration", 1.0));
    ASSERT_TRUE(write("controlword", 0x1f));
    step(2);
    ASSERT_TRUE(write("controlword", 0x0f));
  }
};

INSTANTIATE_TEST_SUITE_P(Bus, ServedGear, ::testing::Bool(),
                         [](const auto& bus) { return std::string(bus.param ? "CANopen" : "Modbus"); });

TEST_P(ServedGear, FollowsAnAxisByItsRatio) {
  follow();
  const double apart = table.set_position(1) - table.set_position(0);
  move_master(0.04, 0.08);
  double worst = 0.0;
  for (int k = 0; k < 1200; ++k) {
    step();
    worst = std::max(worst, std::abs(table.set_position(1) - table.set_position(0) - apart));
  }
  EXPECT_NEAR(table.set_position(0), 0.04, 1e-6);
  EXPECT_NEAR(table.set_position(1) - table.set_position(0), apart, 1e-9);
  // What the estimator makes of a jerk of 1 m/s^2 in 16 ms over its 8 ticks.
  EXPECT_LT(worst, 1e-6);
  EXPECT_EQ(table.loop.fault(1), Fault::none);
}

TEST_P(ServedGear, AMasterWithoutPowerIsLost) {
  follow();
  move_master(0.04, 0.08);
  step(200);
  ASSERT_TRUE(write("controlword", 0));
  step(20);
  EXPECT_EQ(table.loop.fault(1), Fault::master_lost);
  step(1500);
  EXPECT_FALSE(table.powered(1));
}

TEST_P(ServedGear, AMasterBeyondItsSpeedIsAFault) {
  follow();
  move_master(0.02, 0.15);
  run_until([&] { return table.loop.fault(1) != Fault::none; }, 1000);
  EXPECT_EQ(table.loop.fault(1), Fault::master_too_fast);
  EXPECT_NEAR(std::abs(table.set_velocity(0)), 0.1, 2e-3);
  step(1500);
  EXPECT_FALSE(table.powered(1));
}

TEST_P(ServedGear, TheMasterItselfHasNoModeOfIt) {
  ASSERT_TRUE(enable_in(1, 0));
  write("mode_of_operation", -2);
  step(100);
  EXPECT_EQ(read("mode"), 1.0);
}

}  // namespace
}  // namespace stiction::test
