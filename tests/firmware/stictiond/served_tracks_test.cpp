// Switch tracks on lines: on by the place of the master in each tick, while an axis follows it.
#include "tests/firmware/stictiond/served_cam.hpp"

namespace stiction::test {
namespace {

constexpr double tick = 62.5e-6, compensation = 8e-3;  // s

class ServedTracks : public ServedCam {
 protected:
  ServedTracks()
      : ServedCam(
            two_tables(),
            {"drive.cam_switch.track1.line=5", "drive.cam_switch.track1.first=0.1", "drive.cam_switch.track1.last=0.3",
             "drive.cam_switch.track3.line=6", "drive.cam_switch.track3.first=0.9", "drive.cam_switch.track3.last=0.2",
             "drive.cam_switch.track3.on_compensation=-8 ms", "drive.cam_switch.track3.off_compensation=-8 ms",
             "drive.cam_switch.track8.line=7", "drive.cam_switch.track8.kind=duration",
             "drive.cam_switch.track8.first=0.5", "drive.cam_switch.track8.duration=20 ms"}) {
    table.before_tick = {};
  }

  bool output(std::size_t track) const { return table.simulated.outputs[track - 1]; }
  bool none() const {
    for (const bool on : table.simulated.outputs)
      if (on) return false;
    return true;
  }
  double phase() { return std::ldexp(static_cast<double>(table.cam->master().reading().point.position.phase), -64); }
  void follow() {
    ASSERT_TRUE(enable_in(-1));
    ASSERT_TRUE(write("master_speed", 2.0));
    run_until([&] { return std::abs(read("master_velocity") - 2.0) < 1e-6; });
    EXPECT_TRUE(none()) << "none follows it";
    ASSERT_TRUE(command(engage));
    run_until([&] { return shows(in_sync); });
  }
  // Whether a place is within a window of a cycle, but for a way of a tick at each edge: then either is right.
  void expect(std::size_t track, double at, double first, double last) {
    const double edge = 1.01 * 2.0 * tick, width = last - first - std::floor(last - first);
    const double beyond = at - first - std::floor(at - first);
    if (std::min({std::abs(beyond), std::abs(beyond - width), 1.0 - beyond}) < edge) return;
    EXPECT_EQ(output(track), beyond < width) << "track " << track << " at " << at;
  }
};

INSTANTIATE_TEST_SUITE_P(Bus, ServedTracks, ::testing::Bool(),
                         [](const auto& bus) { return std::string(bus.param ? "CANopen" : "Modbus"); });

TEST_P(ServedTracks, AreOnByThePlaceOfTheMasterInEachTick) {
  follow();
  const double earlier = 2.0 * compensation;
  int edges = 0;
  bool was_on = output(8);
  for (int k = 0; k < 20'000; ++k) {
    table.tick();
    expect(1, phase(), 0.1, 0.3);
    expect(3, phase(), 0.9 - earlier, 0.2 - earlier);
    expect(8, phase(), 0.5, 0.5 + 2.0 * 20e-3);
    edges += output(8) != was_on ? 1 : 0;
    was_on = output(8);
    for (const std::size_t track : {2u, 4u, 5u, 6u, 7u}) ASSERT_FALSE(output(track));
  }
  EXPECT_NEAR(edges, 5, 1) << "2.5 cycles";
}

TEST_P(ServedTracks, AreOffAtAFault) {
  follow();
  while (!output(1)) table.tick();
  table.loop.trip(1, Fault::missed_deadline);
  table.tick();
  table.tick();
  EXPECT_TRUE(none()) << "of any axis";
  for (int k = 0; k < 16'000; ++k) {
    table.tick();
    ASSERT_TRUE(none());
  }
}

TEST_P(ServedTracks, AreOffBehindAHalt) {
  follow();
  ASSERT_TRUE(write("controlword", 0x10f));
  run_until([&] { return !shows(active); });
  for (int k = 0; k < 16'000; ++k) {
    table.tick();
    ASSERT_TRUE(none());
  }
}

TEST_P(ServedTracks, AreOffWhenTheProgrammeEnds) {
  follow();
  while (!output(1)) table.tick();
  for (int k = 0; k < 16'000 && !table.programme.over(); ++k) {
    table.programme.tick(true);
    ASSERT_TRUE(none()) << k;
  }
  EXPECT_TRUE(table.programme.over());
}

}  // namespace
}  // namespace stiction::test
