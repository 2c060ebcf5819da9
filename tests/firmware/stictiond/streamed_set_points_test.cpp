// Target positions that a motion controller sends each cycle (csp): followed, bridged, lost, refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/firmware/stictiond/served_table.hpp"
#include "tests/support/figure.hpp"
#include "tests/support/loop_cost.hpp"

namespace stiction::test {
namespace {

using hal::can::Pdo;

// Streams 20 mm in half a second; a cycle for which `silent` says so gets nothing. Ends at a fault.
void stream(ServedTable& table, int cycles, const std::function<bool(int)>& silent = {}) {
  const double begin = table.position(0);
  for (int k = 0; k < cycles && table.loop.fault(0) == Fault::none; ++k) {
    const bool sends = !silent || !silent(k);
    table.cycle([&] {
      if (sends) table.target(0, begin + smooth(20e-3, (k + 1) / 500.0));
    });
  }
}

TEST(StreamedSetPoints, AreFollowedOneCycleLateWithoutASingleAllocation) {
  ServedTable table;
  ASSERT_TRUE(table.enable(0));
  const double begin = table.position(0);
  double off_set = 0.0, off = 0.0, target_before = begin;
  const auto before = allocator_calls;
  for (int k = 0; k < 600; ++k) {
    const double target = begin + smooth(20e-3, (k + 1) / 500.0);
    table.target(0, target);
    for (auto& axis : table.programme.remote()) axis.begin_cycle();
    table.tick();
    off_set = std::max(off_set, std::abs(table.set_position(0) - target_before));
    off = std::max(off, std::abs(table.position(0) - target_before));
    for (int i = 1; i < 16; ++i) table.tick();
    target_before = target;
  }
  EXPECT_EQ(allocator_calls, before);
  EXPECT_NE(table.statusword(0) & statusword::follows_bit, 0);
  EXPECT_EQ(table.loop.fault(0), Fault::none);
  EXPECT_LT(off_set, 1e-9);  // targets are whole nanometres
  // The following error of the cross table where friction turns and at 0.5 m/s^2.
  EXPECT_LT(off, 10e-6);
  figure("20 mm in 0.5 s in targets of 1 ms: axis off the target of the cycle before",
         fmt::format("{:.2f} um (bound 10 um)", off * 1e6));
}

TEST(StreamedSetPoints, TwoMissingCyclesAreBridgedWithoutAJerk) {
  for (const int missing : {1, 2}) {
    SCOPED_TRACE(missing);
    ServedTable table;
    ASSERT_TRUE(table.enable(0));
    double v_before = 0.0, largest_step = 0.0;
    table.before_tick = [&] {
      const double v = table.set_velocity(0);
      largest_step = std::max(largest_step, std::abs(v - v_before));
      v_before = v;
    };
    stream(table, 520, [&](int k) { return k % 50 < missing && k > 10 && k < 490; });
    EXPECT_EQ(table.loop.fault(0), Fault::none);
    EXPECT_TRUE(table.said().empty());
    // The motion's own 0.5 m/s^2 make 31 um/s a tick; targets in steps of 1 nm, taken on twice, a few um/s more.
    EXPECT_LT(largest_step, 60e-6);
  }
}

TEST(StreamedSetPoints, LostOnesAreAFaultInTheThirdCycleWhereverTheMotionIs) {
  double longest = 0.0;
  for (const int from : {3, 100, 250, 400, 510}) {
    SCOPED_TRACE(from);
    ServedTable table;
    ASSERT_TRUE(table.enable(0));
    int cycles = 0;
    stream(table, 600, [&](int k) {
      if (k >= from) ++cycles;
      return k >= from;
    });
    EXPECT_EQ(table.loop.fault(0), Fault::set_points_lost);
    EXPECT_EQ(cycles, 3);
    EXPECT_TRUE(table.powered(0) || from > 500) << "a controlled stop of a motion";
    const auto lines = table.said();
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_NE(lines[0].find("axis 0: fault 52 'set-points lost' while serving"), std::string::npos) << lines[0];
    const double at = table.position(0);
    for (int k = 0; k < 1500; ++k) table.cycle();
    EXPECT_FALSE(table.powered(0));
    longest = std::max(longest, std::abs(table.position(0) - at));
    // Nothing moves, and no reset is taken, as long as no target comes; bristles swing by a nanometre.
    const double rest = table.position(0);
    table.programme.remote()[0].ask(controlword::fault_reset);
    for (int k = 0; k < 500; ++k) table.cycle();
    EXPECT_EQ(table.loop.fault(0), Fault::set_points_lost);
    EXPECT_LT(std::abs(table.position(0) - rest), 10e-9);
    // With targets the axis is reset and follows again.
    for (const std::uint16_t word : {controlword::disable_voltage, controlword::fault_reset})
      for (int k = 0; k < 5; ++k) table.cycle([&] { table.target(0, table.position(0), word); });
    EXPECT_EQ(table.loop.fault(0), Fault::none);
    EXPECT_TRUE(table.enable(0));
    stream(table, 600);
    EXPECT_EQ(table.loop.fault(0), Fault::none);
  }
  figure("set-points lost at 80 mm/s and less: way to rest", fmt::format("{:.2f} mm (bound 0.6 mm)", longest * 1e3));
  EXPECT_LT(longest, 0.6e-3);  // v^2 / (2 * 10 m/s^2) and what the carriage swings out
}

TEST(StreamedSetPoints, AFaultOfOneAxisStopsTheOther) {
  ServedTable table;
  ASSERT_TRUE(table.enable(0));
  for (int i = 0; i < 100 && table.loop.state(1) != DriveState::operation_enabled; ++i)
    table.cycle([&] {
      table.target(0, table.set_position(0));
      table.target(1, table.set_position(1), controlword_to_enable(table.loop.state(1)));
    });
  ASSERT_TRUE(table.powered(1));
  for (int k = 0; k < 3; ++k) table.cycle([&] { table.target(1, table.set_position(1)); });
  EXPECT_EQ(table.loop.fault(0), Fault::set_points_lost);
  for (int k = 0; k < 300; ++k) table.cycle([&] { table.target(1, table.set_position(1)); });
  EXPECT_FALSE(table.powered(0) || table.powered(1));
}

struct Refused {
  const char* name;
  std::function<std::int32_t(ServedTable&)> target;
};

TEST(StreamedSetPoints, ThatCannotBeAreAFaultInTheirTick) {
  const std::vector<Refused> cases{
      {"no number", [](ServedTable&) { return std::numeric_limits<std::int32_t>::min(); }},
      {"beyond the travel's end", [](ServedTable&) { return std::numeric_limits<std::int32_t>::max(); }},
      // 80 m/min are 1.33 mm a cycle.
      {"1.4 mm further", [](ServedTable& t) { return ServedTable::units(t.set_position(0) + 1.4e-3); }},
      {"1.4 mm back", [](ServedTable& t) { return ServedTable::units(t.set_position(0) - 1.4e-3); }},
      // 20 m/s^2 are 20 um from one cycle to the next, of which twice and target_window are taken.
      {"a step of 60 um", [](ServedTable& t) { return ServedTable::units(t.set_position(0) + 60e-6); }},
  };
  for (const auto& c : cases) {
    SCOPED_TRACE(c.name);
    ServedTable table;
    ASSERT_TRUE(table.enable(0));
    stream(table, 20);
    ASSERT_EQ(table.loop.fault(0), Fault::none);
    const std::int32_t wrong = c.target(table);
    table.send(Pdo::target, 0, {.controlword = controlword::enable_operation, .target = wrong});
    for (auto& axis : table.programme.remote()) axis.begin_cycle();
    table.tick();
    EXPECT_EQ(table.loop.fault(0), Fault::set_point);
    EXPECT_TRUE(table.powered(0)) << "a controlled stop";
    const double at = table.position(0);
    for (int i = 1; i < 16; ++i) table.tick();
    for (int k = 0; k < 1000; ++k) table.cycle();
    EXPECT_FALSE(table.powered(0));
    EXPECT_LT(std::abs(table.position(0) - at), 50e-6);  // from 2 mm/s by the ramp, and bristles
  }
}

TEST(StreamedSetPoints, OfOneCycleMayBeAtMaxVelocity) {
  ServedTable table({"drive.axis.X.positive_end=200 mm"});
  ASSERT_TRUE(table.enable(0));
  // Up to 1.3 m/s in 0.1 s; the way beyond 0.2 m is a fault.
  double x = table.position(0), v = 0.0;
  int k = 0;
  for (; k < 400 && table.loop.fault(0) == Fault::none; ++k) {
    v = std::min(v + 0.013, 1.3);
    x += v * 1e-3;
    table.cycle([&] { table.target(0, x); });
  }
  EXPECT_EQ(table.loop.fault(0), Fault::set_point);
  EXPECT_NEAR(x, 0.2, 1.4e-3);
}

// Where the controller begins elsewhere the axis does not jump there.
TEST(StreamedSetPoints, BeginWhereTheAxisStandsOrAreRefused) {
  ServedTable table;
  for (int i = 0; i < 100 && table.loop.fault(0) == Fault::none; ++i)
    table.cycle([&] { table.target(0, 0.0, controlword_to_enable(table.loop.state(0))); });
  EXPECT_EQ(table.loop.fault(0), Fault::set_point);
  EXPECT_NEAR(table.position(0), 0.09, 1e-6);
}

TEST(StreamedSetPoints, CarryOffsetsThatAreForgottenWithThem) {
  ServedTable table;
  ASSERT_TRUE(table.enable(0));
  const double here = table.set_position(0);
  const auto held = [&](int cycles, bool offsets) {
    for (int k = 0; k < cycles; ++k)
      table.cycle([&] {
        table.target(0, here);
        // 10 mm/s and a twentieth of 70 A.
        if (offsets) table.send(Pdo::offsets, 0, {.velocity_offset = 10'000, .torque_offset = 50});
      });
  };
  held(5, false);
  const double current = machine::to_si(table.loop.loop().signals()[0].i_set);
  held(1, true);
  EXPECT_NEAR(table.set_velocity(0), 10e-3, 1e-6);
  EXPECT_EQ(table.set_position(0), here);
  EXPECT_GT(machine::to_si(table.loop.loop().signals()[0].i_set) - current, 3.0);
  held(2, false);
  EXPECT_NEAR(table.set_velocity(0), 10e-3, 1e-6);
  held(2, false);
  EXPECT_EQ(table.set_velocity(0), 0.0);
}

TEST(ControllerFrames, MoveNothingWhereMotionIsNotAllowed) {
  ServedTable table({}, false);
  const double begin = table.position(0);
  EXPECT_FALSE(table.enable(0));
  for (int k = 0; k < 100; ++k) table.cycle([&] { table.target(0, begin + k * 1e-5); });
  EXPECT_EQ(table.statusword(0) & statusword::state_bits, statusword::of(DriveState::switch_on_disabled));
  EXPECT_EQ(table.position(0), begin);
  EXPECT_EQ(table.frames.counts().taken, 0U);
  EXPECT_EQ(table.frames.counts().refused, 200U);
  const auto lines = table.said();
  ASSERT_EQ(lines.size(), 2U) << "one line a controlword";
  EXPECT_NE(lines[1].find("controlword 0x000f"), std::string::npos) << lines[1];
}

TEST(ControllerFrames, OfAnotherLengthNodeOrModeAreNotTaken) {
  ServedTable table;
  ASSERT_TRUE(table.enable(0));
  const double here = table.set_position(0);
  for (int k = 0; k < 2500; ++k)
    table.cycle([&] {
      table.target(0, here);
      auto frame = encode_pdo(Pdo::target, 1, {.controlword = 0, .target = 0});
      frame.size = static_cast<std::uint8_t>(k % 6);
      table.frames.take(table.loop.now_ns(), frame, table.programme.remote());
      frame = encode_pdo(Pdo::target, 77, {.controlword = 0, .target = 0});
      table.frames.take(table.loop.now_ns(), frame, table.programme.remote());
      table.send(Pdo::mode, 0, {.controlword = 0, .mode = 2});
    });
  EXPECT_EQ(table.loop.state(0), DriveState::operation_enabled);
  EXPECT_EQ(table.frames.counts().wrong_size, 2500U);
  EXPECT_EQ(table.frames.counts().refused, 2500U);
  EXPECT_EQ(table.said().size(), 3U) << "one a second";
}

}  // namespace
}  // namespace stiction::test
