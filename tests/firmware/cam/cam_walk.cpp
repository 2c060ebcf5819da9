// The modes of cam and gear walked: every state, controlword and motion, against the tables of IEC 61800-7-201. A
// program of its own, as each case is an axis of its own.
#include <gtest/gtest.h>

#include <string>

#include "stiction/drive/cam_mode.hpp"
#include "tests/firmware/cam/cam_bench.hpp"
#include "tests/firmware/drive/state_walk.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

// An axis behind a virtual master, in the mode of cam or gear. The cam goes to and fro by 20 mm, the gear as far as the
// axis is asked to.
class CoupledAxis {
 public:
  CoupledAxis(OperationMode mode, double speed) {
    axis.remote.cam().attach(cam_mode, master);
    EXPECT_TRUE(axis.enable());
    axis.remote.ask(mode);
    run(64);
    EXPECT_EQ(axis.remote.mode(), mode);
    auto& asked = cam_mode.asked();
    asked.slave_relative = true;
    asked.master_relative = true;
    asked.gear_way = std::llround(0x1p40 * 0.2);
    // In the middle of the rise of a 3-4-5 cam, whose slope is 1.875 times its stroke over 0.4 of a cycle.
    const double slope = mode == OperationMode::gear ? 0.2 : 0.04 * 1.875 / 0.4;
    EXPECT_TRUE(master.run(std::llround(std::ldexp(speed / slope * tick, 64))));
    if (speed != 0.0) run(2200);
    axis.remote.ask(CamCommand::engage);
    const auto there = [&] { return cam_mode.status().in_sync && std::abs(axis.set_speed) > std::abs(speed) - 1e-5; };
    for (int k = 0; k < 20'000 && !there(); ++k) run(1);
    EXPECT_TRUE(there()) << static_cast<int>(cam_mode.refusal());
  }
  CoupledAxis(const CoupledAxis&) = delete;
  CoupledAxis& operator=(const CoupledAxis&) = delete;
  ~CoupledAxis() = default;

  void run(int count) {
    for (int k = 0; k < count; ++k) {
      master.step();
      axis.step();
    }
  }

  ServedAxis axis{};

 private:
  static MotionLimits master_limits() { return limits(1.2, 20.0, 3e3); }

  struct Table {
    std::unique_ptr<TestCam> cam = [] {
      sim::cam::Cam motion{.name = "a", .start = -0.02};
      motion.segments = {{.length = 0.4, .stroke = 0.04, .law = "3-4-5"},
                         {.length = 0.1},
                         {.length = 0.4, .stroke = -0.04, .law = "3-4-5"},
                         {.length = 0.1}};
      return test_cam(motion);
    }();
    std::array<CamMode::Table, 1> tables{};
    CamMode::Config config;

    Table() {
      EXPECT_EQ(CamCurve::prepare({.table = &cam->table}, tables[0].curve), CamRefusal::none);
      tables[0].low = raw_position(-0.02);
      tables[0].high = raw_position(0.02);
      config.motion = CamMotion::Config::of(limits(ServedAxis::most_speed, ServedAxis::acceleration, 80e3),
                                            master_limits(), limits(0.1, 1.0, 10.0), 1024);
      config.rate = FixedSignals::rate(tick_ns);
      config.low = si<FixedSignals::Position>(-ServedAxis::end);
      config.high = si<FixedSignals::Position>(ServedAxis::end);
      config.stops = {Span::of(raw_acceleration(ServedAxis::slow_deceleration)),
                      Span::of(raw_acceleration(ServedAxis::quick_deceleration))};
    }
  };
  static const Table& table() {
    static const Table made;
    return made;
  }

  CamMaster master{CamMaster::Config{.virtual_master = VirtualMaster::Config::of(master_limits())}};

 public:
  CamMode cam_mode{table().config, table().tables};
};

TEST(StateWalk, TheModesOfCamAndGearAreAsTheStandardsTables) {
  int cases = 0;
  double largest = 0.0;
  for (const auto mode : {OperationMode::cam, OperationMode::gear})
    for (const double speed : walked_speeds)
      for (const auto state : walked_states)
        for (std::uint16_t word = 0; word < 0x200; ++word) {
          if ((word & 0x60) != 0) continue;
          SCOPED_TRACE(::testing::Message() << "state " << static_cast<int>(state) << " mode " << static_cast<int>(mode)
                                            << " speed " << speed << " word " << word);
          CoupledAxis coupled(mode, speed);
          auto& a = coupled.axis;
          ASSERT_NEAR(std::abs(a.set_speed), std::abs(speed), 1e-4);
          if (state != operation_enabled) {
            a.remote.ask(state == quick_stop_active ? controlword::quick_stop : controlword::disable_voltage);
            coupled.run(state == quick_stop_active ? 1 : 2);
            if (state == ready_to_switch_on || state == switched_on) a.remote.ask(controlword::shutdown);
            if (state != quick_stop_active) coupled.run(2);
            if (state == switched_on) a.remote.ask(controlword::switch_on);
            if (state == DriveState::fault) a.trip = Fault::clock_jump;
            if (state != quick_stop_active) coupled.run(2);
            a.trip = Fault::none;
          }
          ASSERT_EQ(a.drive.state(), state);
          const auto& row = way_of(state, row_of(word).word);
          const bool reset = state == DriveState::fault && (word & controlword::fault_reset_bit) != 0;
          const auto to = reset ? way_of(switch_on_disabled, row_of(word).word).to : row.to;
          const bool was_powered = a.drive.powered();
          a.remote.ask(word);
          // Along the cam a stop takes up to six times as long as its ramp, of 640 ticks.
          for (int i = 0; i < 4200; ++i) {
            const bool before = a.drive.powered();
            coupled.run(1);
            if (before && a.drive.powered()) largest = std::max(largest, a.step_of_speed());
            ASSERT_FALSE(row.ramp && before && !a.drive.powered() && std::abs(a.v) > 2e-3) << "tick " << i;
          }
          ASSERT_LE(largest, largest_step);
          const bool coasts = !was_powered && speed != 0.0;
          ASSERT_EQ(a.drive.state(), to == operation_enabled && coasts ? switched_on : to) << name_of(a.drive.fault());
          const bool halts = a.drive.state() == operation_enabled && (word & controlword::halt_bit) != 0;
          ASSERT_TRUE(!halts || a.set_speed == 0.0) << "halt";
          const bool goes_on = state == operation_enabled && to == operation_enabled && !halts;
          ASSERT_EQ(coupled.cam_mode.status().active, goes_on) << "left, and not taken up again by itself";
          ++cases;
        }
  EXPECT_EQ(cases, 2 * 3 * 6 * 128);
  figure("states, controlwords and motions in the modes of cam and gear that lead where the standard says",
         std::to_string(cases) + " of " + std::to_string(2 * 3 * 6 * 128) + " (bound all)");
  figure("cam and gear walked: largest change of the set speed in a tick, over max_acceleration",
         std::to_string(largest / (ServedAxis::acceleration * tick)) + " (bound 1.00001)");
}

}  // namespace
}  // namespace stiction::test
