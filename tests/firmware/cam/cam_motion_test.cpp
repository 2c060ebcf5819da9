// Ways into, between and out of curves, one by one; what is refused; and the states of engaging and switching,
// explored.
#include "stiction/motion/cam_motion.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>
#include <vector>

#include "tests/firmware/cam/cam_bench.hpp"
#include "tests/support/figure.hpp"

namespace stiction {
namespace {

using test::limits;
using test::raw_position;

const MotionLimits shaft = limits(1.0, 10.0, 200.0), no_phasing = limits(0.2, 2.0, 40.0);
const MotionLimits axis_limits = limits(25.0, 400.0, 20000.0);
const CamMotion::Config axis_config = CamMotion::Config::of(axis_limits, shaft, no_phasing, 64);

static_assert(sizeof(CamMotion) <= 512);
static_assert(CamTable::header_size + 256 * CamTable::segment_size + CamTable::checksum_size <= 12 * 1024);

TEST(CamMotion, IsSmall) {
  test::figure("cam motion: state of an axis, tables aside", fmt::format("{} bytes (bound 512)", sizeof(CamMotion)));
  test::figure("cam motion: table of 256 segments",
               fmt::format("{} bytes (bound 12288)",
                           CamTable::header_size + 256 * CamTable::segment_size + CamTable::checksum_size));
}

// An axis behind a virtual master, with two cams, one that runs once, and a gear.
class Machine {
 public:
  Machine() : master(VirtualMaster::Config::of(shaft)), axis(axis_config), watch(axis_limits) {
    static const auto first = test::test_cam(test::rise_and_return("3-4-5", 1.0));
    static const auto second = test::test_cam(test::rise_and_return("modified_sine", 0.8));
    sim::cam::Cam rise{.name = "a", .periodic = false};
    rise.segments = {{.length = 1.0, .stroke = 1.0, .law = "3-4-5"}};
    static const auto single = test::test_cam(rise);
    // Of an endless slave, but followed once: at its end it has a speed.
    sim::cam::Cam throwing{.name = "a", .periodic = true, .modulo = 1.0};
    throwing.segments = {{
                             .length = 0.5,
                             .stroke = 0.4,
                             .law = "hermite_septic",
                         },
                         {
                             .length = 0.5,
                             .stroke = 0.6,
                             .law = "hermite_septic",
                         }};
    throwing.segments[0].end.speed = 1.0;
    throwing.segments[1].end.speed = 1.2;
    static const auto thrown = test::test_cam(throwing);
    prepare(cam, {.table = &first->table});
    prepare(other, {.table = &second->table, .slave_offset = raw_position(0.1)});
    prepare(once, {.table = &single->table, .periodic = false});
    prepare(speeding, {.table = &thrown->table, .periodic = false});
    prepare(gear, {.ratio = GearRatio(355, 113), .rise = raw_position(1.0)});
    truth = first.get();
    master.start({});
    axis.start(raw_position(0.3));
  }

  static void prepare(CamCurve& curve, const CamCurve::Config& config) {
    ASSERT_EQ(CamCurve::prepare(config, curve), CamRefusal::none);
  }

  MotionPoint tick(bool valid = true) {
    const MotionPoint point = axis.step(master.step(), valid);
    watch.see(point);
    return point;
  }
  void run(double seconds) {
    for (int k = 0; k < static_cast<int>(seconds * test::rate); ++k) tick();
  }
  void turn(double speed) {
    ASSERT_TRUE(master.run(test::master_speed(speed)));
    while (!master.at_speed()) tick();
  }
  void expect_smooth() const {
    EXPECT_LE(watch.position_jump, test::position_unit);
    EXPECT_LE(watch.over_velocity, 0.0);
    EXPECT_LE(watch.over_acceleration, 0.0);
    EXPECT_LE(watch.over_jerk, 0.0);
  }
  double at() const { return test::position_of(axis.point().position); }
  double x() const { return test::cycles_of(master.point().position); }

  VirtualMaster master;
  CamMotion axis;
  test::Watch watch;
  CamCurve cam, other, once, speeding, gear;
  const test::TestCam* truth = nullptr;
};

TEST(CamMotion, RampsInByDistanceWhenTheMasterMoves) {
  Machine m;
  CamRequest request{.curve = &m.cam, .approach = CamApproach::distance, .span = Span::of(raw_position(0.75))};
  ASSERT_EQ(m.axis.engage(request), CamRefusal::none);
  m.run(0.5);
  EXPECT_DOUBLE_EQ(m.at(), test::position_of(raw_position(0.3)));  // the master stands
  EXPECT_TRUE(m.axis.status().busy && m.axis.status().active && !m.axis.status().in_sync);
  m.turn(0.8);
  while (m.x() < 0.75 - 1e-4) m.tick();
  EXPECT_FALSE(m.axis.status().in_sync);
  while (m.x() < 0.75) m.tick();
  EXPECT_TRUE(m.axis.status().in_sync);
  m.run(3.0);
  EXPECT_NEAR(m.at(), test::truth(*m.truth, m.x()).position, 2e-9);
  m.expect_smooth();
}

TEST(CamMotion, AMasterThatReversesInADistanceTakesTheSlaveBackToWhereItStood) {
  for (const bool backward : {false, true}) {
    Machine m;
    CamRequest request{
        .curve = &m.cam, .approach = CamApproach::distance, .backward = backward, .span = Span::of(raw_position(0.75))};
    ASSERT_EQ(m.axis.engage(request), CamRefusal::none);
    m.turn(backward ? -0.4 : 0.4);
    m.run(0.5);
    EXPECT_NE(m.at(), test::position_of(raw_position(0.3)));
    m.turn(backward ? 0.6 : -0.6);
    m.run(4.0);
    EXPECT_DOUBLE_EQ(m.at(), test::position_of(raw_position(0.3)));
    EXPECT_TRUE(m.axis.status().active && !m.axis.status().in_sync);
    m.turn(backward ? -0.6 : 0.6);
    m.run(8.0);
    EXPECT_TRUE(m.axis.status().in_sync);
    EXPECT_NEAR(m.at(), test::truth(*m.truth, m.x()).position, 2e-9);
    m.expect_smooth();
  }
}

TEST(CamMotion, ComesInSyncInJustTheTimeAskedFor) {
  Machine m;
  m.turn(0.8);
  CamRequest request{.curve = &m.cam, .approach = CamApproach::ticks, .span = Span::of(5000)};
  ASSERT_EQ(m.axis.engage(request), CamRefusal::none);
  for (int k = 0; k < 5000; ++k) {
    m.tick();
    EXPECT_FALSE(m.axis.status().in_sync);
  }
  m.tick();
  EXPECT_TRUE(m.axis.status().in_sync);
  EXPECT_NEAR(m.at(), test::truth(*m.truth, m.x()).position, 2e-9);
  m.expect_smooth();
}

TEST(CamMotion, ARelativeCamBeginsWhereMasterAndSlaveAre) {
  Machine m;
  m.turn(0.8);
  CamRequest request{.curve = &m.cam, .master_relative = true, .slave_relative = true};
  ASSERT_EQ(m.axis.engage(request), CamRefusal::none);
  m.tick();
  const double zero = m.x();
  EXPECT_TRUE(m.axis.status().active);
  m.run(3.3);
  EXPECT_TRUE(m.axis.status().in_sync);
  EXPECT_NEAR(m.at(), 0.3 + test::truth(*m.truth, m.x() - zero).position, 2e-9);
  m.expect_smooth();
}

TEST(CamMotion, WaitsForItsTrigger) {
  const auto begins_at = [](CamRequest request, const std::function<void(Machine&)>& before = {}) {
    Machine m;
    m.turn(0.8);
    if (before) before(m);
    request.curve = &m.other;
    request.approach = CamApproach::ticks;
    request.span = Span::of(6000);
    const double from = m.x();
    EXPECT_EQ(m.axis.engage(request), CamRefusal::none);
    m.tick();
    for (int k = 0; k < 100'000 && m.axis.status().waiting; ++k) m.tick();
    EXPECT_FALSE(m.axis.status().waiting);
    EXPECT_GT(m.x(), from);
    const double begun = m.x();
    m.run(1.0);
    EXPECT_TRUE(m.axis.status().in_sync);
    m.expect_smooth();
    return begun;
  };
  constexpr double a_tick = 0.8 / test::rate * 1.001;
  const double place = begins_at({.trigger = CamTrigger::master_position, .at = {2, std::uint64_t{1} << 62}});
  EXPECT_NEAR(place, 2.25 + a_tick / 2, a_tick / 2);
  const double phase = begins_at({.trigger = CamTrigger::cam_position, .at = {0, std::uint64_t{3} << 62}});
  EXPECT_NEAR(phase - std::floor(phase), 0.75 + a_tick / 2, a_tick / 2);
  const double cycle = begins_at({.trigger = CamTrigger::next_cycle});
  EXPECT_NEAR(cycle - std::floor(cycle), a_tick / 2, a_tick / 2);
  const auto following = [](Machine& m) {
    ASSERT_EQ(m.axis.engage({.curve = &m.cam}), CamRefusal::none);
    m.run(2.0);
    ASSERT_TRUE(m.axis.status().in_sync);
  };
  const double next = begins_at({.trigger = CamTrigger::next_cycle}, following);
  EXPECT_NEAR(next - std::floor(next), a_tick / 2, a_tick / 2);
  // Both curves rise in the first 2 of 6.2; the other one is 0.1 higher and rises by 0.8, so that they are equal once
  // on the rise. Within 0.02 of it their speeds differ by less than 0.4 rad/s.
  const double agree =
      begins_at({.trigger = CamTrigger::curves_agree,
                 .tolerance = {raw_position(0.02), test::raw_velocity(2.0), test::raw_acceleration(100.0)}},
                following);
  EXPECT_GT(agree, 0.0);
}

TEST(CamMotion, ARelativeCamOfCurvesThatAgreeBeginsInTheTickBehind) {
  Machine m;
  m.turn(0.8);
  const MotionPoint any{INT64_MAX, INT64_MAX, INT64_MAX};
  ASSERT_EQ(m.axis.engage({.curve = &m.cam,
                           .trigger = CamTrigger::curves_agree,
                           .master_relative = true,
                           .slave_relative = true,
                           .tolerance = any}),
            CamRefusal::none);
  m.tick();
  EXPECT_TRUE(m.axis.status().waiting);
  m.tick();
  EXPECT_TRUE(m.axis.status().active);
  const double zero = m.x();
  m.run(3.0);
  EXPECT_NEAR(m.at(), 0.3 + test::truth(*m.truth, m.x() - zero).position, 2e-9);
  m.expect_smooth();
}

// Both have up to 76 lengths, of which a tick tries one.
TEST(CamMotion, PhasingAndARequestTakeTurnsAndBothBegin) {
  Machine m;
  m.turn(0.7);
  ASSERT_EQ(m.axis.engage({.curve = &m.cam}), CamRefusal::none);
  m.run(2.0);
  ASSERT_TRUE(m.axis.status().in_sync);
  m.axis.phase(raw_position(0.3));
  ASSERT_EQ(m.axis.engage({.curve = &m.other}), CamRefusal::none);
  int request = 0, phasing = 0;
  for (int k = 1; k <= 2 * BridgeLengths::count; ++k) {
    m.tick();
    if (request == 0 && !m.axis.status().waiting) request = k;
    if (phasing == 0 && !m.axis.phasing().plans()) phasing = k;
  }
  EXPECT_EQ(m.axis.status().refusal, CamRefusal::none);
  EXPECT_GT(request, 1);
  EXPECT_GT(phasing, 1);
  EXPECT_TRUE(m.axis.ticks_left() > 0 && m.axis.phasing().busy());
  m.run(10.0);
  EXPECT_TRUE(m.axis.status().in_sync && !m.axis.phasing().busy());
  m.expect_smooth();
}

TEST(CamMotion, SwitchesScalesAndPhasesOnTheRun) {
  Machine m;
  m.turn(0.7);
  ASSERT_EQ(m.axis.engage({.curve = &m.cam}), CamRefusal::none);
  m.run(2.0);
  ASSERT_TRUE(m.axis.status().in_sync);
  m.axis.phase(raw_position(0.3));
  m.run(10.0);
  EXPECT_FALSE(m.axis.phasing().busy());
  EXPECT_NEAR(m.at(), test::truth(*m.truth, m.x() + 0.3).position, 2e-9);
  CamCurve scaled;
  Machine::prepare(scaled, {.table = m.cam.config().table, .slave_scale = std::int64_t{3} << 30, .slave_offset = 1000});
  ASSERT_EQ(m.axis.engage({.curve = &scaled}), CamRefusal::none);
  m.run(2.0);
  EXPECT_NEAR(m.at(), 0.75 * test::truth(*m.truth, m.x() + 0.3).position, 3e-9);
  ASSERT_EQ(m.axis.engage(
                {.curve = &m.gear, .approach = CamApproach::ticks, .slave_relative = true, .span = Span::of(20000)}),
            CamRefusal::none);
  m.run(2.0);
  ASSERT_TRUE(m.axis.status().in_sync);
  const double off = m.at() - m.x() * 355 / 113;
  m.run(2.0);
  EXPECT_NEAR(m.at() - m.x() * 355 / 113, off, 1e-9);
  m.expect_smooth();
}

TEST(CamMotion, GearsInAtTheSpeedOrAtAPosition) {
  Machine m;
  m.turn(0.9);
  // The speed alone.
  ASSERT_EQ(m.axis.engage({.curve = &m.gear, .free_way = true}), CamRefusal::none);
  m.run(1.0);
  ASSERT_TRUE(m.axis.status().in_sync);
  const double off = m.at() - m.x() * 355 / 113;
  m.run(2.0);
  EXPECT_NEAR(m.at() - m.x() * 355 / 113, off, 1e-9);
  EXPECT_NEAR(test::velocity_of(m.axis.point().velocity), 0.9 * 355 / 113, 1e-6);
  // At a position: in sync when the master is at 10.5, from half a cycle before on.
  ASSERT_EQ(m.axis.leave(0), CamRefusal::none);
  m.run(1.0);
  ASSERT_TRUE(m.axis.at_rest());
  const std::int64_t sync = static_cast<std::int64_t>(m.x()) + 2;
  CamCurve at_position;
  const double here = m.at();
  Machine::prepare(at_position,
                   {.ratio = GearRatio(355, 113),
                    .slave_offset = raw_position(here + 0.5 - (static_cast<double>(sync) + 0.5) * 355 / 113),
                    .rise = raw_position(1.0)});
  ASSERT_EQ(m.axis.engage({.curve = &at_position,
                           .trigger = CamTrigger::master_position,
                           .approach = CamApproach::distance,
                           .span = Span::of(raw_position(0.5 * 355 / 113)),
                           .at = {sync, 0}}),
            CamRefusal::none);
  while (m.x() < static_cast<double>(sync) + 0.5 + 1e-4) m.tick();
  EXPECT_TRUE(m.axis.status().in_sync);
  EXPECT_NEAR(m.at(), here + 0.5 + (m.x() - static_cast<double>(sync) - 0.5) * 355 / 113, 1e-9);
  m.expect_smooth();
}

TEST(CamMotion, LeavesToStandstillToASpeedAndAtAPosition) {
  Machine m;
  m.turn(0.8);
  ASSERT_EQ(m.axis.engage({.curve = &m.cam}), CamRefusal::none);
  m.run(2.1);
  ASSERT_EQ(m.axis.leave(test::raw_velocity(3.0)), CamRefusal::none);
  m.run(1.0);
  EXPECT_FALSE(m.axis.status().busy);
  EXPECT_FALSE(m.axis.at_rest());
  const double before = m.at();
  m.run(1.0);
  EXPECT_NEAR(m.at() - before, 3.0, 1e-6);
  EXPECT_EQ(m.axis.leave(test::raw_velocity(26.0)), CamRefusal::speed);
  EXPECT_EQ(m.axis.leave(test::raw_velocity(-26.0)), CamRefusal::speed);
  ASSERT_EQ(m.axis.leave(0), CamRefusal::none);
  m.run(1.0);
  EXPECT_TRUE(m.axis.at_rest());
  ASSERT_EQ(m.axis.engage({.curve = &m.cam}), CamRefusal::none);
  m.run(3.0);
  ASSERT_TRUE(m.axis.status().in_sync);
  ASSERT_EQ(m.axis.engage({.goal = CamGoal::position, .position = raw_position(-0.4)}), CamRefusal::none);
  m.run(2.0);
  EXPECT_TRUE(m.axis.at_rest());
  EXPECT_EQ(m.axis.point().position, raw_position(-0.4));
  m.expect_smooth();
}

TEST(CamMotion, AOnceOnlyCamEndsWhereItDoesAndStopsWhereItThrows) {
  Machine m;
  m.turn(0.8);
  ASSERT_EQ(m.axis.engage(
                {.curve = &m.once, .trigger = CamTrigger::next_cycle, .master_relative = true, .slave_relative = true}),
            CamRefusal::none);
  int ends = 0;
  for (int k = 0; k < 60'000; ++k) {
    m.tick();
    ends += m.axis.status().end_of_profile;
  }
  EXPECT_EQ(ends, 1);
  EXPECT_TRUE(m.axis.at_rest());
  EXPECT_FALSE(m.axis.status().busy);
  EXPECT_NEAR(m.at(), 1.3, 2e-9);
  ASSERT_EQ(m.axis.engage({.curve = &m.speeding, .master_relative = true, .slave_relative = true}), CamRefusal::none);
  m.run(3.0);
  EXPECT_TRUE(m.axis.at_rest());
  EXPECT_GT(m.at(), 2.3);
  m.expect_smooth();
  // Where the master is outside of it already.
  ASSERT_EQ(m.axis.engage({.curve = &m.once}), CamRefusal::none);
  m.run(0.1);
  EXPECT_EQ(m.axis.status().refusal, CamRefusal::outside_profile);
  EXPECT_TRUE(m.axis.at_rest());
}

TEST(CamMotion, ATriggerThatWaitsCanBeDeletedOrReplaced) {
  Machine m;
  m.turn(0.8);
  const CamRequest waiting{.curve = &m.cam, .trigger = CamTrigger::master_position, .at = {1000, 0}};
  ASSERT_EQ(m.axis.engage(waiting), CamRefusal::none);
  m.run(0.2);
  EXPECT_TRUE(m.axis.status().waiting && m.axis.status().busy && !m.axis.status().active);
  EXPECT_FALSE(m.axis.status().command_aborted);
  m.axis.cancel();
  m.run(0.2);
  EXPECT_TRUE(m.axis.status().command_aborted);
  EXPECT_FALSE(m.axis.status().waiting || m.axis.status().busy);
  ASSERT_EQ(m.axis.engage(waiting), CamRefusal::none);
  ASSERT_EQ(m.axis.engage({.curve = &m.cam}), CamRefusal::none);
  EXPECT_TRUE(m.axis.status().command_aborted);
  m.run(2.0);
  EXPECT_TRUE(m.axis.status().in_sync);
  m.expect_smooth();
}

TEST(CamMotion, RefusesWithAReasonAndGoesOnAsBefore) {
  Machine m;
  m.turn(0.8);
  EXPECT_EQ(m.axis.engage({}), CamRefusal::scale);  // no curve
  CamCurve fast;
  Machine::prepare(fast, {.table = m.cam.config().table, .slave_scale = std::int64_t{40} << 32});
  EXPECT_EQ(m.axis.engage({.curve = &fast}), CamRefusal::beyond_limits);
  EXPECT_EQ(m.axis.engage({.goal = CamGoal::position, .approach = CamApproach::distance}), CamRefusal::moving);
  // In so few ticks no bridge keeps the limits.
  ASSERT_EQ(m.axis.engage({.curve = &m.cam, .approach = CamApproach::ticks, .span = Span::of(20)}), CamRefusal::none);
  m.run(0.1);
  EXPECT_EQ(m.axis.status().refusal, CamRefusal::no_bridge);
  EXPECT_TRUE(m.axis.at_rest());
  // Nor over so short a distance.
  ASSERT_EQ(m.axis.engage({.curve = &m.cam, .approach = CamApproach::distance, .span = Span::of(raw_position(1e-3))}),
            CamRefusal::none);
  m.run(0.1);
  EXPECT_EQ(m.axis.status().refusal, CamRefusal::no_bridge);
  ASSERT_EQ(m.axis.engage({.curve = &m.cam}), CamRefusal::none);
  m.run(2.0);
  ASSERT_TRUE(m.axis.status().in_sync);
  // A distance begins at standstill.
  ASSERT_EQ(m.axis.engage({.curve = &m.other, .approach = CamApproach::distance, .span = Span::of(raw_position(1.0))}),
            CamRefusal::none);
  m.run(0.1);
  EXPECT_EQ(m.axis.status().refusal, CamRefusal::moving);
  // A place that no length reaches.
  ASSERT_EQ(m.axis.engage({.goal = CamGoal::position, .position = raw_position(1e5)}), CamRefusal::none);
  m.run(0.1);
  EXPECT_EQ(m.axis.status().refusal, CamRefusal::no_bridge);
  EXPECT_TRUE(m.axis.status().in_sync);
  EXPECT_NEAR(m.at(), test::truth(*m.truth, m.x()).position, 2e-9);
  m.expect_smooth();
}

TEST(CamMotion, StopsWithinItsLimitsWhereTheMasterFails) {
  const auto ends_with = [](const std::function<void(Machine&)>& fail, CamFault fault) {
    for (const double after : {0.02, 0.11, 1.0}) {
      Machine m;
      m.turn(0.8);
      ASSERT_EQ(m.axis.engage({.curve = &m.cam}), CamRefusal::none);
      m.run(after);
      ASSERT_TRUE(m.axis.status().active);
      fail(m);
      EXPECT_EQ(m.axis.status().fault, fault);
      EXPECT_TRUE(m.axis.status().command_aborted);
      EXPECT_FALSE(m.axis.status().active);
      m.run(1.0);
      EXPECT_TRUE(m.axis.at_rest());
      EXPECT_EQ(m.axis.status().fault, fault);
      m.expect_smooth();
      // From there it can be engaged again.
      ASSERT_EQ(m.axis.engage({.curve = &m.cam}), CamRefusal::none);
      m.run(2.0);
      EXPECT_EQ(m.axis.status().fault, CamFault::none);
      EXPECT_TRUE(m.axis.status().in_sync);
    }
  };
  ends_with([](Machine& m) { m.tick(false); }, CamFault::master_lost);
  const auto with = [](const std::function<void(MasterPoint&)>& change) {
    return [change](Machine& m) {
      MasterPoint wrong = m.master.step();
      change(wrong);
      m.watch.see(m.axis.step(wrong));
    };
  };
  ends_with(with([](MasterPoint& p) { p.position = p.position + MasterPosition::way(1 << 20); }),
            CamFault::master_jumped);
  ends_with(with([](MasterPoint& p) { p.position.cycles += 1; }), CamFault::master_jumped);
  ends_with(with([](MasterPoint& p) { p.velocity = -p.velocity * 2; }), CamFault::master_too_fast);
  ends_with(with([](MasterPoint& p) { p.acceleration = INT64_MAX / 2; }), CamFault::master_too_fast);
  Machine m;
  ASSERT_EQ(m.axis.engage({.curve = &m.cam}), CamRefusal::none);
  m.tick(false);
  EXPECT_EQ(m.axis.status().fault, CamFault::master_lost);
  EXPECT_FALSE(m.axis.status().waiting);
  EXPECT_TRUE(m.axis.at_rest());
}

TEST(CamMotion, AxesBehindOneMasterStayTogether) {
  std::int64_t apart = 0;
  for (int stop = 0; stop < 40; ++stop) {
    Machine m;
    CamMotion second(axis_config);
    second.start(raw_position(0.7));
    m.turn(0.5);
    for (CamMotion* axis : {&m.axis, &second}) ASSERT_EQ(axis->engage({.curve = &m.cam}), CamRefusal::none);
    const auto both = [&](int ticks) {
      for (int k = 0; k < ticks; ++k) {
        const MasterPoint at = m.master.step();
        m.axis.step(at);
        second.step(at);
        if (m.axis.status().in_sync && second.status().in_sync)
          apart =
              std::max(apart, static_cast<std::int64_t>(magnitude(m.axis.point().position - second.point().position)));
      }
    };
    both(20'000 + 137 * stop);
    ASSERT_TRUE(m.axis.status().in_sync && second.status().in_sync);
    if (stop % 2 == 0) {
      ASSERT_TRUE(m.master.run(0));
    } else {
      m.master.stop_at(static_cast<std::uint64_t>(stop) << 57);
    }
    both(60'000);
    EXPECT_EQ(m.axis.point().velocity, 0);
  }
  test::figure("cam motion: two axes behind one master, any stop, phase between them",
               fmt::format("{} units of 2^-40 rad (bound 1)", apart));
  EXPECT_LE(apart, 1);
}

// Every sequence of three of what can happen, from standstill: what the discrete states are that they lead to,
// that nothing jumps on the way, and that each leads to standstill again.
class Explored {
 public:
  void explore() { from({}); }

  std::set<int> states;
  int sequences = 0, stuck = 0;
  double jump = 0.0, beyond = 0.0;

 private:
  static constexpr int events = 16;

  static void happen(Machine& m, int event) {
    const auto ramp = Span::of(9000);
    switch (event) {
      case 0:
        m.axis.engage({.curve = &m.cam});
        break;
      case 1:
        m.axis.engage({.curve = &m.other, .approach = CamApproach::ticks, .span = ramp});
        break;
      case 2:
        m.axis.engage({.curve = &m.cam, .approach = CamApproach::distance, .span = Span::of(raw_position(0.8))});
        break;
      case 3:
        m.axis.engage({.curve = &m.other, .trigger = CamTrigger::next_cycle});
        break;
      case 4:
        m.axis.engage({.curve = &m.gear, .free_way = true});
        break;
      case 5:
        m.axis.engage({.curve = &m.once, .master_relative = true, .slave_relative = true});
        break;
      case 6:
        m.axis.engage({.goal = CamGoal::position, .position = raw_position(0.2)});
        break;
      case 7:
        m.axis.engage({.curve = &m.cam, .trigger = CamTrigger::curves_agree});
        break;
      case 8:
        m.axis.cancel();
        break;
      case 9:
        m.axis.leave(0);
        break;
      case 10:
        m.axis.leave(test::raw_velocity(2.0));
        break;
      case 11:
        m.axis.phase(raw_position(0.2));
        break;
      case 12:
        m.tick(false);
        break;  // the master is lost for a tick
      case 13:
        m.master.run(test::master_speed(-0.6));
        break;
      case 14:
        m.master.run(0);
        break;
      default:
        m.axis.engage({.curve = &m.cam, .approach = CamApproach::ticks, .span = Span::of(9)});
        break;
    }
  }

  static int state_of(const Machine& m) {
    const auto& s = m.axis.status();
    return (s.active ? 1 : 0) | (s.in_sync ? 2 : 0) | (s.waiting ? 4 : 0) | (s.busy ? 8 : 0) |
           (m.axis.at_rest() ? 16 : 0) | (m.axis.phasing().busy() ? 32 : 0) | (m.axis.ticks_left() > 0 ? 64 : 0) |
           (s.fault != CamFault::none ? 128 : 0) | (s.refusal != CamRefusal::none ? 256 : 0);
  }

  void from(std::vector<int> sequence) {
    if (sequence.size() < 3)
      for (int event = 0; event < events; ++event) {
        sequence.push_back(event);
        from(sequence);
        sequence.pop_back();
      }
    else
      walk(sequence);
  }

  void walk(const std::vector<int>& sequence) {
    Machine m;
    m.master.run(test::master_speed(0.7));
    for (int k = 0; k < 6000; ++k) m.tick();
    // In the middle of bridges, and behind them.
    const int ticks[] = {sequences % 2 == 0 ? 150 : 3000, sequences % 3 == 0 ? 90 : 2000, 400};
    for (std::size_t k = 0; k < sequence.size(); ++k) {
      happen(m, sequence[k]);
      for (int tick = 0; tick < ticks[k]; ++tick) {
        m.tick();
        if (tick % 16 < 2) states.insert(state_of(m));
      }
    }
    m.axis.leave(0);
    int left = 20'000;
    while (!m.axis.at_rest() && --left > 0) m.tick();
    stuck += left == 0;
    jump = std::max(jump, m.watch.position_jump);
    beyond = std::max({beyond, m.watch.over_velocity, m.watch.over_acceleration, m.watch.over_jerk});
    ++sequences;
  }
};

TEST(CamMotion, EveryStateOfEngagingAndSwitchingHasAWayOutWithoutAJump) {
  Explored explored;
  explored.explore();
  test::figure(
      "cam motion: states of engaging and switching, explored",
      fmt::format("{} states in {} sequences; {} without a way out, jump {:.2f} units of 2^-32 rad (bounds 0, 1)",
                  explored.states.size(), explored.sequences, explored.stuck, explored.jump / test::position_unit));
  EXPECT_EQ(explored.stuck, 0);
  EXPECT_LE(explored.jump, test::position_unit);
  EXPECT_LE(explored.beyond, 0.0);
  // Following or free, bridging or not, waiting or not, phasing or not, after a fault or a refusal or without: that so
  // many are reached shows that the walk is no short one.
  EXPECT_GE(explored.states.size(), 40u);
}

}  // namespace
}  // namespace stiction
