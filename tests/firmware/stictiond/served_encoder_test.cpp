// A PLC whose axes follow a shaft's encoder on CAN (CiA 406, --master can:NODE), which nothing of the drive turns: over
// Modbus and over CANopen. Truth is the motion in double precision at the place of the shaft.
#include <functional>

#include "tests/firmware/stictiond/served_cam.hpp"

namespace stiction::test {
namespace {

constexpr int encoder_node = 5;
constexpr double counts_per_turn = 65536.0;
// m: the largest slope of the cam is 20 mm times 1.875 in 0.4 of a turn.
constexpr double step_of_encoder = 20e-3 * 1.875 / 0.4 / counts_per_turn;

class ServedEncoder : public ServedCam {
 protected:
  explicit ServedEncoder(const std::vector<std::string>& settings = {})
      : ServedCam({two_tables().tables, "can:5", "130 rpm"},
                  joined({"drive.master_encoder.interface=vcan2", "drive.master_encoder.counts_per_turn=65536",
                          "drive.master_encoder.range=16777216"},
                         settings)) {
    table.before_tick = [this] {
      turn();
      EXPECT_LT(jump(), step_of_encoder / 10.0);
    };
  }

  static std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  }

  // By how much the place of the axis is off where its speed leads, from tick to tick, m.
  double jump() {
    const double x = table.set_position(0), v = machine::to_si(table.loop.drive(0).set_velocity());
    // A stop for a fault is by the ramp of the drive.
    const bool watched = was_powered && table.loop.fault(0) == Fault::none;
    const double off = watched ? std::abs(x - last_x - 0.5 * (v + last_v) * 62.5e-6) : 0.0;
    was_powered = table.powered(0);
    last_x = x;
    last_v = v;
    return off;
  }
  // The shaft goes on by a tick; its encoder says its position each millisecond, a third of a tick before one.
  void turn() {
    constexpr double tick = 62.5e-6;
    time += tick;
    speed += std::clamp(wanted - speed, -most_acceleration * tick, most_acceleration * tick);
    turns += speed * tick;
    if (++since < 16) return;
    since = 0;
    if (!says) return;
    const double then = turns - speed * tick / 3.0;
    const auto counts = static_cast<std::int64_t>(std::floor(then * counts_per_turn)) + 16777000;
    const auto value = static_cast<std::uint32_t>(counts & 16777215);
    hal::can::Frame frame{0x180 + encoder_node, 4, {}};
    for (std::size_t k = 0; k < 4; ++k) frame.data[k] = static_cast<std::uint8_t>(value >> (8 * k));
    table.cam->take(frame, 20'833);
  }
  void emergency(std::uint16_t code) {
    hal::can::Frame frame{0x80 + encoder_node, 8, {}};
    frame.data[0] = static_cast<std::uint8_t>(code);
    frame.data[1] = static_cast<std::uint8_t>(code >> 8);
    table.cam->take(frame, 0);
  }
  bool follow() {
    if (!enable_in(-1)) return false;
    run_until([&] { return shows(known); });
    if (!write("cam_table", 1) || !command(engage)) return false;
    run_until([&] { return shows(active | in_sync); });
    return read("cam_refusal") == 0.0;
  }
  // From the motion at the shaft's own place, m.
  double off_shaft(std::size_t motion) {
    const auto& m = files().motions[motion];
    const double at = turns + 16777000.0 / counts_per_turn;
    return table.set_position(0) - m.curve((at - std::floor(at)) * m.cam.cycle());
  }
  void stops_with(Fault fault) {
    run_until([&] { return table.loop.fault(0) != Fault::none; }, 500);
    EXPECT_EQ(table.loop.fault(0), fault) << name_of(table.loop.fault(0));
    step(1500);
    EXPECT_FALSE(table.powered(0));
    EXPECT_FALSE(shows(active));
  }

  double time = 0.0, turns = 0.0, speed = 0.0, wanted = 0.0;
  double most_acceleration = 4.0;  // turns/s^2, of 5.4 that the speed lets it have
  int since = 0;
  bool says = true;
};

INSTANTIATE_TEST_SUITE_P(Bus, ServedEncoder, ::testing::Bool(),
                         [](const auto& bus) { return std::string(bus.param ? "CANopen" : "Modbus"); });

TEST_P(ServedEncoder, IsFollowedSwitchedPhasedAndLeft) {
  wanted = 0.5;
  ASSERT_TRUE(follow());
  for (int k = 0; k < 1000; ++k) {
    step();
    ASSERT_NEAR(off_shaft(0), 0.0, step_of_encoder);
  }
  wanted = 2.0;
  step(1000);
  EXPECT_NEAR(read("master_velocity"), 2.0, 0.01);
  for (int k = 0; k < 1000; ++k) {
    step();
    ASSERT_NEAR(off_shaft(0), 0.0, step_of_encoder);
  }
  ASSERT_TRUE(write("cam_table", 2));
  ASSERT_TRUE(write("cam_trigger", 3));
  ASSERT_TRUE(command(engage));
  run_until([&] { return read("cam_followed") == 2.0 && shows(in_sync); });
  for (int k = 0; k < 500; ++k) {
    step();
    ASSERT_NEAR(off_shaft(1), 0.0, step_of_encoder);
  }
  ASSERT_TRUE(write("cam_phase", 0.1));
  ASSERT_TRUE(command(phase));
  run_until([&] { return !table.cam->mode(0).phasing(); }, 8000);
  EXPECT_NEAR(off(1, 0.1), 0.0, 2e-9);
  wanted = -0.3;
  step(4000);
  EXPECT_EQ(table.loop.fault(0), Fault::none) << "the shaft turned back";
  ASSERT_TRUE(command(leave));
  run_until([&] { return !shows(busy); });
  EXPECT_TRUE(table.powered(0));
}

TEST_P(ServedEncoder, IsKnownBeforeItIsFollowed) {
  says = false;
  ASSERT_TRUE(enable_in(-1));
  EXPECT_FALSE(shows(known));
  const double stands = table.set_position(0);
  ASSERT_TRUE(command(engage));
  stops_with(Fault::master_lost);
  EXPECT_EQ(table.set_position(0), stands);
}

TEST_P(ServedEncoder, ThatFallsSilentIsLost) {
  wanted = 1.0;
  ASSERT_TRUE(follow());
  step(500);
  says = false;
  stops_with(Fault::master_lost);
}

TEST_P(ServedEncoder, ThatSaysAnErrorIsLost) {
  wanted = 1.0;
  ASSERT_TRUE(follow());
  step(500);
  emergency(0);
  step(50);
  ASSERT_EQ(table.loop.fault(0), Fault::none) << "the end of an error";
  emergency(0x5000);
  stops_with(Fault::master_lost);
}

TEST_P(ServedEncoder, ThatJumpsOrIsTooFastIsAFault) {
  wanted = 0.3;
  ASSERT_TRUE(follow());
  step(500);
  turns += 0.2;
  stops_with(Fault::synchronisation_lost);
}

TEST_P(ServedEncoder, BeyondItsSpeedIsAFault) {
  wanted = 2.0;
  ASSERT_TRUE(follow());
  step(500);
  wanted = 3.0;
  stops_with(Fault::master_too_fast);
}

TEST_P(ServedEncoder, CannotBeTurnedByAClient) {
  ASSERT_TRUE(enable_in(-1));
  write("master_speed", 1.0);
  step(500);
  EXPECT_NEAR(read("master_velocity"), 0.0, 1e-6);
}

// Frames of others, and of a wrong length, are none of its positions.
TEST_P(ServedEncoder, HearsItsOwnFramesAlone) {
  wanted = 0.5;
  ASSERT_TRUE(follow());
  for (int k = 0; k < 200; ++k) {
    step();
    for (const auto& frame :
         {hal::can::Frame{0x180 + encoder_node + 1, 4, {1, 2, 3, 4}}, hal::can::Frame{0x180 + encoder_node, 3, {}},
          hal::can::Frame{0x80 + encoder_node, 7, {1, 2}}, hal::can::Frame{0x80 + encoder_node + 1, 8, {1, 2}}})
      table.cam->take(frame, 0);
  }
  EXPECT_TRUE(shows(in_sync));
  EXPECT_EQ(table.loop.fault(0), Fault::none);
}

}  // namespace
}  // namespace stiction::test
