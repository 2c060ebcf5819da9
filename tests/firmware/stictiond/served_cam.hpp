// A PLC before the drive's cams in the drive's own time, over Modbus registers or over the objects of CANopen.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "firmware/stictiond/objects.hpp"
#include "tests/firmware/stictiond/cam_files.hpp"
#include "tests/firmware/stictiond/served_objects.hpp"

namespace stiction::test {
using Cam = ServedTable::Cam;

// Both have their begin where the axis is.
inline CamFiles& files() {
  static CamFiles made;
  return made;
}
inline Cam two_tables(const std::string& speed = "130 rpm") {
  static const std::vector<std::string> tables{files().add(linear_cam(20e-3, 0.09)),
                                               files().add(linear_cam(12e-3, 0.085, "modified_sine"))};
  return {tables, "virtual", speed};
}

enum State : unsigned {
  busy = 1,
  active = 2,
  in_sync = 4,
  waiting = 8,
  aborted = 16,
  known = 32,
  second_busy = 64,
  second_in_sync = 128
};
enum CommandNumber { engage = 1, leave = 2, cancel = 3, phase = 4, leave_to = 6, engage_second = 7, leave_second = 8 };

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

}  // namespace stiction::test
