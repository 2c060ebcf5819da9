// A drive's modes of cam and gear without a bus: set-points in the drive's formats, curves that are put to a request in
// its tick, masters that are measured, faults.
#include "stiction/drive/cam_mode.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "stiction/drive/remote_cam.hpp"
#include "tests/firmware/cam/cam_mode_bench.hpp"

namespace stiction::test {
namespace {

using S = FixedSignals;
const auto tick_rate = S::rate(62'500);

TEST(CamSetPoint, IsTheMotionInTheDrivesUnitsToHalfAUnit) {
  std::mt19937_64 draw(3);
  std::uniform_real_distribution<double> speeds(-7.9, 7.9), accelerations(-500.0, 500.0);
  for (int k = 0; k < 10'000; ++k) {
    const double v = speeds(draw), a = accelerations(draw);
    const auto set = cam_set_point({123, raw_velocity(v), raw_acceleration(a)}, tick_rate);
    ASSERT_TRUE(set.valid);
    EXPECT_EQ(set.position.raw(), 123);
    ASSERT_NEAR(static_cast<double>(set.velocity.raw()), std::ldexp(v, 28), 0.51);
    ASSERT_NEAR(static_cast<double>(set.acceleration.raw()), std::ldexp(a, 22), 0.51);
  }
  EXPECT_FALSE(cam_set_point({0, raw_velocity(8.1), 0}, tick_rate).valid);
  EXPECT_FALSE(cam_set_point({0, 0, raw_acceleration(-513.0)}, tick_rate).valid);
  constexpr std::int64_t most = std::int64_t{1} << 60;
  EXPECT_TRUE(cam_set_point({most - 1, 0, 0}, tick_rate).valid);
  for (const std::int64_t position : {most, -most}) {
    const auto set = cam_set_point({position, 0, 0}, tick_rate);
    EXPECT_FALSE(set.valid);
    EXPECT_EQ(set.position.raw(), 0);
  }
}

TEST(CamCurve, RescaledInATickIsTheOnePreparedBesideIt) {
  const auto cam = test_cam(rise_and_return("modified_sine", 0.03));
  CamCurve base;
  ASSERT_EQ(CamCurve::prepare({.table = &cam->table}, base), CamRefusal::none);
  for (const double scale : {1.0, -0.5, 3.25, 1e-3}) {
    CamCurve::Config config{
        .table = &cam->table, .ratio = GearRatio(3, 7), .slave_scale = std::llround(scale * 0x1p32)};
    CamCurve prepared, rescaled;
    ASSERT_EQ(CamCurve::prepare(config, prepared), CamRefusal::none);
    ASSERT_EQ(CamCurve::rescale(base, config, rescaled), CamRefusal::none);
    EXPECT_EQ(rescaled.config().rise, prepared.config().rise);
    EXPECT_NEAR(static_cast<double>(rescaled.peaks().bend), static_cast<double>(prepared.peaks().bend),
                2.0 + std::abs(scale));
    for (std::uint64_t phase = 0; phase < 100; ++phase) {
      const MasterPosition at{4, phase * (UINT64_MAX / 100)};
      const auto a = prepared.slopes(at), b = rescaled.slopes(at);
      EXPECT_EQ(a.position, b.position);
      EXPECT_EQ(a.slope, b.slope);
      EXPECT_EQ(a.bend, b.bend);
    }
  }
  CamCurve none;
  EXPECT_EQ(CamCurve::rescale(base, {.table = &cam->table, .slave_scale = INT64_MAX}, none), CamRefusal::scale);
}

TEST(CamCurve, RescaledIsThatOfItsOwnTableAndRunsOnceWhereEitherDoes) {
  const auto cam = test_cam(rise_and_return("3-4-5", 0.03)), other = test_cam(rise_and_return("3-4-5", 0.02));
  CamCurve endless, once, curve;
  ASSERT_EQ(CamCurve::prepare({.table = &cam->table}, endless), CamRefusal::none);
  ASSERT_EQ(CamCurve::prepare({.table = &cam->table, .periodic = false}, once), CamRefusal::none);
  EXPECT_EQ(CamCurve::rescale(endless, {.table = &other->table}, curve), CamRefusal::scale);
  ASSERT_EQ(CamCurve::rescale(endless, {.table = &cam->table}, curve), CamRefusal::none);
  EXPECT_FALSE(curve.outside({1, 0}));
  ASSERT_EQ(CamCurve::rescale(endless, {.table = &cam->table, .periodic = false}, curve), CamRefusal::none);
  EXPECT_TRUE(curve.outside({1, 0}));
  ASSERT_EQ(CamCurve::rescale(once, {.table = &cam->table}, curve), CamRefusal::none);
  EXPECT_TRUE(curve.outside({1, 0}));
}

// A line of 24 m a cycle, scaled by 2^16, rises by more than 2^20 m and has no bend; the third derivative of a motion
// of 1 m is what passes 2^21 m first.
TEST(CamCurve, RefusesTheSameScalesInATickAndBesideIt) {
  sim::cam::Cam line{.name = "a", .periodic = true, .modulo = 24.0};
  line.segments = {{.length = 1.0, .stroke = 24.0, .law = "linear"}};
  for (const auto& cam : {line, rise_and_return("modified_sine", 1.0)}) {
    const auto made = test_cam(cam);
    CamCurve base, curve;
    ASSERT_EQ(CamCurve::prepare({.table = &made->table}, base), CamRefusal::none);
    for (const std::int64_t scale : {std::int64_t{1} << 48, -(std::int64_t{1} << 48)}) {
      const CamCurve::Config config{.table = &made->table, .slave_scale = scale};
      EXPECT_EQ(CamCurve::prepare(config, curve), CamRefusal::scale);
      EXPECT_EQ(CamCurve::rescale(base, config, curve), CamRefusal::scale);
    }
  }
}

// A position of an axis as a master whose cycle is 1.2 m, exact to 2^-58 of a cycle.
TEST(CamMaster, MeasuredIsWhereItsAxisIs) {
  CamMaster::Config config;
  config.measured = true;
  config.cycle = Span::of(raw_position(1.2));
  config.estimator.bits = 3;
  config.estimator.jump = std::int64_t{1} << 58;
  const double cycle = position_of(raw_position(1.2));
  for (const double place : {0.0, 0.3, 1.2, -0.3, -2.5, 100.7}) {
    CamMaster master(config);
    int known_from = 0;
    for (int k = 0; k < 200; ++k) {
      const auto& reading = master.see(raw_position(place), true);
      if (!reading.valid) known_from = k + 1;
    }
    EXPECT_NEAR(cycles_of(master.reading().point.position), place / cycle, 1e-12);
    EXPECT_EQ(known_from, 127) << "16 times 8 ticks";
    EXPECT_FALSE(master.see(0, false).valid);
    EXPECT_FALSE(master.see(raw_position(place), true).valid) << "it has to be known for a while again";
    EXPECT_FALSE(master.run(1)) << "nobody drives it from here";
  }
}

TEST(CamMaster, ThatJumpsIsAtOnceWhereItJumpedTo) {
  CamMaster::Config config;
  config.measured = true;
  config.cycle = Span::of(raw_position(1.0));
  config.estimator.bits = 3;
  config.estimator.jump = std::int64_t{1} << 58;
  CamMaster master(config);
  for (int k = 0; k < 200; ++k) master.see(raw_position(0.125), true);
  const auto& reading = master.see(raw_position(0.625), true);
  EXPECT_TRUE(reading.valid) << "it is the slave that is to see the jump";
  EXPECT_EQ(cycles_of(reading.point.position), 0.625);
  EXPECT_EQ(reading.point.velocity, 0);
}

TEST(CamMaster, VirtualIsHeldToItsLimitAndRestsWhereItDoesNotTurn) {
  CamMaster master(CamMaster::Config{.virtual_master = VirtualMaster::Config::of(limits(1.2, 5.0, 50.0))});
  EXPECT_TRUE(master.at_rest());
  const auto turn = [&](double speed) {
    EXPECT_TRUE(master.run(master_speed(speed)));
    EXPECT_FALSE(master.at_rest());
    for (int k = 0; k < 20'000; ++k) master.step();
    return velocity_of(master.reading().point.velocity);
  };
  EXPECT_NEAR(turn(1.0), 1.0, 1e-9);
  EXPECT_FALSE(master.at_rest()) << "it has its speed, which is not zero";
  EXPECT_NEAR(turn(7.0), 1.2, 1e-9);
  EXPECT_NEAR(turn(-7.0), -1.2, 1e-9);
  EXPECT_EQ(turn(0.0), 0.0);
  EXPECT_TRUE(master.at_rest());
}

TEST_F(ACamMode, ExchangesTheTableItFollowsWhereTheCycleBegins) {
  // Both begin and end at 0 and rest there.
  const auto other = test_cam(rise_and_return("3-4-5", 0.02));
  CamMode::Table made;
  ASSERT_EQ(CamCurve::prepare({.table = &other->table}, made.curve), CamRefusal::none);
  made.high = raw_position(0.02);
  EXPECT_EQ(mode.exchange(1, &made), CamRefusal::not_enabled) << "it follows nothing";
  EXPECT_EQ(mode.exchange(2, &made), CamRefusal::unknown_table);
  VirtualMaster master(VirtualMaster::Config::of(limits(1.2, 5.0, 50.0)));
  master.start({});
  ASSERT_EQ(mode.command(CamCommand::engage, false, true), CamRefusal::none);
  master.run(master_speed(1.0));
  const auto run_to = [&](double cycles) {
    while (cycles_of(master.point().position) < cycles) mode.step({master.step(), true});
  };
  const auto off = [&](const CamMode::Table& table) {
    return mode.point().position - table.curve.slopes(master.point().position).position;
  };
  run_to(2.3);
  EXPECT_EQ(mode.table(), 1);
  EXPECT_TRUE(mode.as_its_table());
  ASSERT_EQ(mode.exchange(1, &made), CamRefusal::none);
  EXPECT_EQ(mode.exchange(1, &made), CamRefusal::not_enabled) << "one waits";
  run_to(2.99);
  EXPECT_TRUE(mode.exchanging());
  EXPECT_EQ(off(tables[0]), 0);
  EXPECT_EQ(mode.exchanged(1), nullptr);
  run_to(3.3);
  EXPECT_FALSE(mode.exchanging());
  EXPECT_EQ(mode.exchanged(1), &made);
  EXPECT_EQ(mode.table(), 1);
  EXPECT_EQ(off(made), 0);
  ASSERT_EQ(mode.exchange(1, nullptr), CamRefusal::none);
  run_to(4.3);
  EXPECT_EQ(off(tables[0]), 0);
}

TEST_F(ACamMode, ExchangesNoTableBeyondTravelOrLimits) {
  const auto far = test_cam(rise_and_return("3-4-5", 0.09)), fast = test_cam(rise_and_return("3-4-5", 0.5));
  CamMode::Table beyond_travel, beyond_limits;
  ASSERT_EQ(CamCurve::prepare({.table = &far->table}, beyond_travel.curve), CamRefusal::none);
  ASSERT_EQ(CamCurve::prepare({.table = &fast->table}, beyond_limits.curve), CamRefusal::none);
  beyond_travel.high = raw_position(0.11);
  VirtualMaster master(VirtualMaster::Config::of(limits(1.2, 5.0, 50.0)));
  master.start({});
  ASSERT_EQ(mode.command(CamCommand::engage, false, true), CamRefusal::none);
  for (int k = 0; k < 2000; ++k) mode.step({master.step(), true});
  ASSERT_EQ(mode.table(), 1);
  EXPECT_EQ(mode.exchange(1, &beyond_travel), CamRefusal::beyond_travel);
  EXPECT_EQ(mode.exchange(1, &beyond_limits), CamRefusal::beyond_limits);
  EXPECT_FALSE(mode.exchanging());
}

TEST_F(ACamMode, SaysOfAMasterWhichFaultItIs) {
  struct Case {
    MasterReading reading;
    Fault fault;
  };
  const MasterPosition half{0, std::uint64_t{1} << 62};
  for (const auto& [reading, fault] :
       {Case{{{}, false}, Fault::master_lost}, Case{{{{}, raw_velocity(1.3), 0}, true}, Fault::master_too_fast},
        Case{{{{}, 0, raw_acceleration(5.5)}, true}, Fault::master_too_fast},
        Case{{{half, 0, 0}, true}, Fault::synchronisation_lost}}) {
    mode.start(S::Position{});
    ASSERT_EQ(mode.command(CamCommand::engage, false, true), CamRefusal::none);
    for (int k = 0; k < 20; ++k) mode.step({});
    ASSERT_TRUE(mode.status().in_sync);
    EXPECT_EQ(mode.fault(), Fault::none);
    mode.step(reading);
    EXPECT_EQ(mode.fault(), fault) << name_of(mode.fault());
    EXPECT_FALSE(mode.status().active);
    mode.start(S::Position{});
    EXPECT_EQ(mode.fault(), Fault::none);
  }
}

TEST_F(ACamMode, RefusesWhatCannotBeAndKeepsWhatIsFollowed) {
  ASSERT_EQ(mode.command(CamCommand::engage, false, true), CamRefusal::none);
  for (int k = 0; k < 20; ++k) mode.step({});
  ASSERT_EQ(mode.table(), 1);
  const auto refused = [&](CamRefusal reason) {
    EXPECT_EQ(mode.command(CamCommand::engage, false, true), reason);
    for (int k = 0; k < 20; ++k) mode.step({});
    EXPECT_EQ(mode.refusal(), reason);
    EXPECT_TRUE(mode.status().in_sync);
    EXPECT_EQ(mode.table(), 1);
    mode.asked() = {};
  };
  mode.asked().table = 2;
  refused(CamRefusal::unknown_table);
  mode.asked().table = 0;
  refused(CamRefusal::unknown_table);
  mode.asked().slave_scale = std::int64_t{100} << 32;
  refused(CamRefusal::beyond_travel);
  mode.asked().slave_offset = raw_position(0.08);
  refused(CamRefusal::beyond_travel);
  mode.asked().slave_offset = raw_position(-0.11);
  refused(CamRefusal::beyond_travel);
  mode.asked().slave_scale = std::int64_t{-4} << 32;
  refused(CamRefusal::beyond_travel);
  mode.asked().slave_scale = INT64_MAX;
  refused(CamRefusal::scale);
  mode.asked().numerator = 100;
  refused(CamRefusal::beyond_limits);
}

// Where the positions of a curve are not those of the axis, or nothing says where the travel ends, no track leaves it.
TEST_F(ACamMode, FindsATrackBeyondTheTravelOnlyWhereItKnowsBoth) {
  mode.asked().slave_offset = raw_position(0.08);
  EXPECT_EQ(mode.command(CamCommand::engage, false, true), CamRefusal::beyond_travel);
  EXPECT_EQ(mode.command(CamCommand::engage, false, false), CamRefusal::none);
  mode.asked().slave_relative = true;
  EXPECT_EQ(mode.command(CamCommand::engage, false, true), CamRefusal::none);
}

// A table that goes on by 0.03 m each cycle leaves the travel at a time that only its master knows.
TEST_F(ACamMode, TakesATableThatGoesOn) {
  sim::cam::Cam rise{.name = "a", .periodic = true, .modulo = 0.03};
  rise.segments = {{.length = 1.0, .stroke = 0.03, .law = "3-4-5"}};
  const auto endless = test_cam(rise);
  ASSERT_EQ(CamCurve::prepare({.table = &endless->table}, tables[0].curve), CamRefusal::none);
  mode.asked().slave_offset = raw_position(0.08);
  EXPECT_EQ(mode.command(CamCommand::engage, false, true), CamRefusal::none);
}

TEST_F(ACamMode, BeginsOnACurveOrSaysWhyNot) {
  CamCurve steep, fits;
  ASSERT_EQ(CamCurve::prepare({.table = &cam->table, .slave_scale = std::int64_t{100} << 32}, steep), CamRefusal::none);
  ASSERT_EQ(CamCurve::prepare({.table = &cam->table}, fits), CamRefusal::none);
  EXPECT_EQ(mode.begin(steep, {}), CamRefusal::beyond_limits);
  EXPECT_EQ(mode.refusal(), CamRefusal::beyond_limits);
  EXPECT_FALSE(mode.status().active);
  EXPECT_EQ(mode.begin(fits, {}), CamRefusal::none);
  EXPECT_TRUE(mode.status().active);
}

TEST_F(ACamMode, DropsWhatWaitsByACommandAndByAFault) {
  const auto waits = [&] {
    mode.step({});
    return mode.status().waiting;
  };
  mode.asked().trigger = CamTrigger::next_cycle;
  ASSERT_EQ(mode.command(CamCommand::engage, false, true), CamRefusal::none);
  EXPECT_TRUE(waits());
  EXPECT_EQ(mode.command(CamCommand::none, false, true), CamRefusal::none);
  EXPECT_TRUE(waits()) << "no command does nothing";
  EXPECT_EQ(mode.command(CamCommand::cancel, false, true), CamRefusal::none);
  EXPECT_FALSE(waits());
  mode.refuse(CamRefusal::not_enabled);
  EXPECT_EQ(mode.command(CamCommand::none, false, true), CamRefusal::not_enabled) << "nor to what it says";
  ASSERT_EQ(mode.command(CamCommand::engage, false, true), CamRefusal::none);
  EXPECT_TRUE(waits());
  mode.step({{}, false});
  EXPECT_EQ(mode.fault(), Fault::master_lost);
  EXPECT_EQ(mode.refusal(), CamRefusal::none);
  EXPECT_EQ(mode.table(), 0);
  EXPECT_FALSE(waits());
}

// A gear of 0.1 m a cycle that is not relative has a place for each of its master's, to which a distance leads.
TEST_F(ACamMode, ComesToThePlaceOfAGearInADistanceOfItsMaster) {
  VirtualMaster master(VirtualMaster::Config::of(limits(1.2, 5.0, 50.0)));
  mode.asked().gear_way = raw_position(0.1);
  mode.asked().slave_offset = raw_position(0.01);
  mode.asked().approach = CamApproach::distance;
  mode.asked().distance = raw_position(0.25);
  ASSERT_EQ(mode.command(CamCommand::engage, true, true), CamRefusal::none);
  master.run(master_speed(0.5));
  const auto run_to = [&](double x) {
    while (cycles_of(master.point().position) < x) mode.step({master.step(), true});
  };
  run_to(0.24);
  EXPECT_TRUE(mode.status().active);
  EXPECT_FALSE(mode.status().in_sync);
  run_to(0.26);
  EXPECT_TRUE(mode.status().in_sync);
  EXPECT_EQ(mode.table(), 0);
  run_to(0.7);
  EXPECT_NEAR(position_of(mode.point().position), 0.01 + 0.1 * cycles_of(master.point().position), 1e-9);
}

// More requests than curves have places.
TEST_F(ACamMode, HasAPlaceForEachCurveHoweverOftenItIsAsked) {
  VirtualMaster master(VirtualMaster::Config::of(limits(1.2, 5.0, 50.0)));
  master.run(master_speed(1.0));
  Watch watch(config.motion.slave);
  std::mt19937_64 draw(5);
  for (int k = 0; k < 200'000; ++k) {
    if (draw() % 300 == 0) {
      mode.asked().slave_offset = raw_position(0.01 * static_cast<double>(draw() % 5));
      mode.asked().trigger = draw() % 3 == 0 ? CamTrigger::next_cycle : CamTrigger::at_once;
      mode.command(CamCommand::engage, false, true);
    }
    mode.step({master.step(), true});
    watch.see(mode.point());
  }
  EXPECT_LE(watch.position_jump, position_unit);
  EXPECT_LE(watch.speed_jump, velocity_unit);
  EXPECT_LE(watch.over_velocity, velocity_unit);
  EXPECT_LE(watch.over_acceleration, acceleration_unit);
}

TEST_F(ACamMode, IsLeftByAHaltAndNotTakenUpAgain) {
  CamMaster master(CamMaster::Config{.virtual_master = VirtualMaster::Config::of(limits(1.2, 5.0, 50.0))});
  RemoteCam remote;
  EXPECT_FALSE(remote.attached());
  // Without a master it stands, and has nothing to say.
  remote.start(S::Position::from_raw(5));
  EXPECT_TRUE(remote.at_rest());
  EXPECT_EQ(remote.step(false, true).position.raw(), 5);
  EXPECT_FALSE(remote.refused());
  EXPECT_EQ(remote.fault(), Fault::none);
  EXPECT_EQ(remote.bits(), 0);
  remote.command(CamCommand::engage, OperationMode::cam, true, true);
  remote.attach(mode, master);
  remote.start(S::Position{});
  remote.command(CamCommand::engage, OperationMode::cyclic_position, true, true);
  EXPECT_EQ(mode.refusal(), CamRefusal::not_enabled);
  remote.command(CamCommand::engage, OperationMode::cam, false, true);
  EXPECT_EQ(mode.refusal(), CamRefusal::not_enabled);
  EXPECT_TRUE(remote.refused());
  remote.command(CamCommand::engage, OperationMode::cam, true, true);
  EXPECT_FALSE(remote.refused());
  ASSERT_TRUE(master.run(master_speed(1.0)));
  const auto run = [&](int count, bool stops) {
    for (int k = 0; k < count; ++k) {
      master.step();
      remote.step(stops, true);
    }
  };
  run(20'000, false);
  EXPECT_EQ(remote.bits(), statusword::target_bit | statusword::follows_bit);
  EXPECT_EQ(remote.ends(), 0u) << "the first cycle takes the master more than a second";
  run(10'000, false);
  EXPECT_EQ(remote.ends(), 1u);
  run(1, true);
  EXPECT_EQ(remote.bits(), 0);
  run(10'000, true);
  EXPECT_TRUE(remote.at_rest());
  run(10'000, false);
  EXPECT_TRUE(remote.at_rest());
  // Nor is what waits when it is halted.
  mode.asked().trigger = CamTrigger::next_cycle;
  remote.command(CamCommand::engage, OperationMode::cam, true, true);
  run(1, false);
  ASSERT_TRUE(mode.status().waiting);
  run(1, true);
  EXPECT_FALSE(mode.status().waiting);
  run(20'000, false);
  EXPECT_TRUE(remote.at_rest());
}

// What is engaged during a halt, at once or later, is left in the next tick.
TEST_F(ACamMode, IsEngagedByNothingDuringAHalt) {
  CamMaster master(CamMaster::Config{.virtual_master = VirtualMaster::Config::of(limits(1.2, 5.0, 50.0))});
  RemoteCam remote;
  remote.attach(mode, master);
  remote.start(S::Position{});
  remote.command(CamCommand::engage, OperationMode::cam, true, true);
  ASSERT_TRUE(master.run(master_speed(1.0)));
  const auto run = [&](int count, bool stops) {
    for (int k = 0; k < count; ++k) {
      master.step();
      remote.step(stops, true);
    }
  };
  run(20'000, false);
  for (const auto trigger : {CamTrigger::next_cycle, CamTrigger::at_once}) {
    run(3, true);
    mode.asked().trigger = trigger;
    remote.command(CamCommand::engage, OperationMode::cam, true, true);
    run(10'000, true);
    EXPECT_TRUE(remote.at_rest());
    EXPECT_FALSE(mode.status().active);
    EXPECT_FALSE(mode.status().waiting);
    mode.asked().trigger = CamTrigger::at_once;
    remote.command(CamCommand::engage, OperationMode::cam, true, true);
    run(20'000, false);
    ASSERT_TRUE(mode.status().in_sync);
  }
}

}  // namespace
}  // namespace stiction::test
