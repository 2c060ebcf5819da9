// A PLC that engages a cam, switches the table, phases and disengages: over Modbus registers and over the objects of
// CANopen, in the drive's own time. Truth is the motion in double precision at the place that the master shows.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "firmware/stictiond/objects.hpp"
#include "tests/firmware/stictiond/cam_files.hpp"
#include "tests/firmware/stictiond/served_objects.hpp"

namespace stiction::test {
namespace {

using Cam = ServedTable::Cam;

// Both have their begin where the axis is.
CamFiles& files() {
  static CamFiles made;
  return made;
}
Cam two_tables(const std::string& speed = "130 rpm") {
  static const std::vector<std::string> tables{files().add(linear_cam(20e-3, 0.09)),
                                               files().add(linear_cam(12e-3, 0.085, "modified_sine"))};
  return {tables, "virtual", speed};
}

enum State : unsigned { busy = 1, active = 2, in_sync = 4, waiting = 8, aborted = 16, known = 32 };
enum CommandNumber { engage = 1, leave = 2, cancel = 3, phase = 4 };

class ServedCam : public Objects, public ::testing::WithParamInterface<bool> {
 protected:
  explicit ServedCam(const Cam& cam = two_tables(), const std::vector<std::string>& settings = {})
      : Objects(settings, true, cam), registers(table.configuration.machine, table.configuration.setup) {
    table.before_tick = [this] { watch(); };
  }

  static bool over_can() { return GetParam(); }

  // A value by the name of its register: its words to the register, or its object over SDO. False: refused.
  bool write(const std::string& name, double value, std::size_t axis = 0) {
    if (!over_can()) return write_words(name, value, axis);
    for (const auto& object : drive::object_table())
      if (object.source == drive::ObjectSource::command && name == object.of) {
        const double unit = drive::value_of(object.unit, 1e-9);
        const auto& type = drive::row_of(object.type);
        SdoClient node(static_cast<unsigned>(axis) + 1,
                       [this](const hal::can::Frame& frame) { return server->answer(frame, now_ns); });
        return node.set(object.index, object.sub, std::llround(value / unit), type.bytes) == 0;
      }
    ADD_FAILURE() << name;
    return false;
  }
  double read(const std::string& name, std::size_t axis = 0) {
    const auto all = registers.map().registers();
    std::vector<double> values(all.size());
    registers.put_values(server->loop().latest(), values);
    const std::string wanted = table.configuration.names[axis] + "." + name;
    for (std::size_t k = 0; k < all.size(); ++k)
      if (all[k].name == wanted && all[k].table == hal::RegisterTable::input) return values[k];
    ADD_FAILURE() << name;
    return 0.0;
  }
  bool shows(unsigned bits) { return (static_cast<unsigned>(read("cam_state")) & bits) == bits; }

  // Milliseconds until it is so.
  template <class Condition>
  int run_until(Condition condition, int most = 5000) {
    int k = 0;
    for (; k < most && !condition(); ++k) step();
    EXPECT_LT(k, most);
    return k;
  }
  void step(int count = 1) {
    for (int k = 0; k < count; ++k) cycles(1);
  }

  bool enable_in(int mode, std::size_t axis = 0) {
    EXPECT_TRUE(write("mode_of_operation", mode, axis));
    for (const int word : {6, 7, 15}) {
      EXPECT_TRUE(write("controlword", word, axis));
      step(20);
    }
    return table.powered(axis) && read("mode", axis) == mode;
  }
  bool command(int number) {
    const bool taken = write("cam_command", number);
    step(2);
    return taken;
  }
  // The place of the axis where the `motion` is at the master, m.
  double off(std::size_t motion, double phase_offset = 0.0) {
    const auto& m = files().motions[motion];
    const auto& at = table.cam->master().reading().point.position;
    const double phase = std::ldexp(static_cast<double>(at.phase), -64) + phase_offset;
    const double expected = m.curve((phase - std::floor(phase)) * m.cam.cycle());
    return table.set_position(0) - expected;
  }

  // From tick to tick: nothing jumps, and the limits of the axis hold.
  void watch() {
    const double x = table.set_position(0), v = machine::to_si(table.loop.drive(0).set_velocity());
    if (table.powered(0) && was_powered) {
      constexpr double tick = 62.5e-6, most = 20.0, rounding = 0x1p-27;
      largest_change = std::max(largest_change, std::abs(v - last_v) / tick);
      EXPECT_LE(std::abs(v - last_v), most * tick + rounding);
      EXPECT_NEAR(x - last_x, 0.5 * (v + last_v) * tick, 20e3 * tick * tick * tick / 12 + 1e-12);
    }
    was_powered = table.powered(0);
    last_x = x;
    last_v = v;
  }

  drive::ModbusRegisters registers;
  bool was_powered = false;
  double last_x = 0.0, last_v = 0.0, largest_change = 0.0;

 private:
  bool write_words(const std::string& name, double value, std::size_t axis) {
    const auto& map = registers.map();
    const std::string wanted = table.configuration.names[axis] + "." + name;
    for (const auto& r : map.registers()) {
      if (r.name != wanted || r.table != hal::RegisterTable::holding) continue;
      std::vector<std::uint16_t> words(static_cast<std::size_t>(hal::words_of(r.type)));
      hal::put_words(r.type, value / r.scale, words);
      const auto meant = map.writes_of(r.address, words, true);
      if (!std::holds_alternative<std::vector<hal::RegisterWrite>>(meant)) return false;
      for (const auto& write : std::get<std::vector<hal::RegisterWrite>>(meant))
        drive::ask(std::get<drive::MotionWrite>(registers.meaning_of(write)), period(), table.programme.remote()[axis],
                   CommandSource::modbus);
      return true;
    }
    ADD_FAILURE() << name;
    return false;
  }
};

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
  step(4000);
  ASSERT_NEAR(off(1, 0.1), 0.0, 2e-9);

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
