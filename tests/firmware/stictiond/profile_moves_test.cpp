// Moves to a target (pp) as a controller on CAN and a PLC on Modbus ask for them: the handshake of CiA 402, limits,
// halt, new targets on the way.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "firmware/stictiond/run.hpp"
#include "tests/firmware/stictiond/served_table.hpp"
#include "tests/hal/modbus_support.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

using hal::can::Pdo;
constexpr std::uint16_t on = controlword::enable_operation, offer = on | controlword::new_set_point_bit;
constexpr std::uint16_t at_once = offer | controlword::at_once_bit;

// X enabled in pp over CAN, slowly: 0.1 m/s, 1 m/s^2 up, 2 m/s^2 down.
class ProfileMoves : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(table.enable(0));
    table.cycle([&] { table.mode(0, OperationMode::profile_position, on); });
    auto& x = table.programme.remote()[0];
    const auto speed = [](double v) { return *machine::to_signal<FixedSignals::Velocity>(v); };
    x.ask_velocity(speed(0.1));
    x.ask_acceleration(speed(1.0 * period));
    x.ask_deceleration(speed(2.0 * period));
    ASSERT_EQ(x.mode(), OperationMode::profile_position);
  }
  bool shows(std::uint16_t bit) const { return (table.statusword(0) & bit) != 0; }
  // Cycles with nothing sent until the target is reached.
  int run(int most = 5000) {
    int k = 0;
    for (; k < most && !shows(statusword::target_bit); ++k) table.cycle();
    return k;
  }

  static constexpr double period = 62.5e-6;
  ServedTable table;
};

TEST_F(ProfileMoves, AreAcknowledgedMadeWithinTheirLimitsAndReported) {
  double fastest = 0.0, off = 0.0;
  table.before_tick = [&] {
    fastest = std::max(fastest, std::abs(table.set_velocity(0)));
    off = std::max(off, std::abs(table.set_position(0) - table.position(0)));
  };
  EXPECT_FALSE(shows(statusword::acknowledge_bit));
  table.cycle([&] { table.target(0, 0.05, offer); });
  EXPECT_TRUE(shows(statusword::acknowledge_bit));
  EXPECT_FALSE(shows(statusword::target_bit));
  table.cycle([&] { table.target(0, 0.05, on); });
  EXPECT_FALSE(shows(statusword::acknowledge_bit));
  const int cycles = run();
  // 40 mm at 0.1 m/s, its ramps of 0.1 s and 0.05 s, 16 ms of jerk.
  EXPECT_NEAR((cycles + 2) * 1e-3, 0.4 + 0.075 + 0.016, 0.01);
  EXPECT_NEAR(table.position(0), 0.05, 10e-6);
  EXPECT_NEAR(fastest, 0.1, 1e-6);
  EXPECT_LT(off, 20e-6);
  EXPECT_EQ(table.loop.fault(0), Fault::none);
  figure("profile move of 40 mm at 0.1 m/s: following error", fmt::format("{:.2f} um (bound 20 um)", off * 1e6));
}

TEST_F(ProfileMoves, BeyondTheTravelAreNotTaken) {
  table.cycle([&] { table.target(0, 0.5, offer); });
  EXPECT_FALSE(shows(statusword::acknowledge_bit));
  EXPECT_TRUE(shows(statusword::limit_bit));
  for (int k = 0; k < 100; ++k) table.cycle();
  EXPECT_NEAR(table.set_position(0), 0.09, 1e-6);
  table.cycle([&] { table.target(0, 0.5, on); });
  EXPECT_FALSE(shows(statusword::limit_bit));
}

TEST_F(ProfileMoves, WaitForTheOneBeforeUnlessToldAtOnce) {
  table.cycle([&] { table.target(0, 0.07, offer); });
  table.cycle([&] { table.target(0, 0.07, on); });
  table.cycle([&] { table.target(0, 0.08, offer); });
  EXPECT_TRUE(shows(statusword::acknowledge_bit));
  double least = 1.0;
  table.before_tick = [&] { least = std::min(least, table.set_position(0)); };
  for (int k = 0; k < 100; ++k) table.cycle([&] { table.target(0, 0.08, on); });
  EXPECT_TRUE(shows(statusword::acknowledge_bit)) << "no room for another one";
  run();
  EXPECT_NEAR(least, 0.07, 1e-9);
  EXPECT_NEAR(table.position(0), 0.08, 10e-6);

  table.cycle([&] { table.target(0, 0.05, offer); });
  for (int k = 0; k < 100; ++k) table.cycle([&] { table.target(0, 0.05, on); });
  least = 1.0;
  table.cycle([&] { table.target(0, 0.085, at_once); });
  run();
  EXPECT_NEAR(table.position(0), 0.085, 10e-6);
  EXPECT_GT(least, 0.06);
}

TEST_F(ProfileMoves, CountFromTheTargetBeforeWhereRelative) {
  for (int i = 0; i < 3; ++i) {
    table.cycle([&] { table.target(0, -0.01, offer | controlword::relative_bit); });
    table.cycle([&] { table.target(0, -0.01, on); });
    run();
  }
  EXPECT_NEAR(table.position(0), 0.06, 11e-6);
}

TEST_F(ProfileMoves, HaltAndGoOn) {
  table.cycle([&] { table.target(0, 0.0, offer); });
  for (int k = 0; k < 300; ++k) table.cycle([&] { table.target(0, 0.0, on); });
  for (int k = 0; k < 200; ++k) table.cycle([&] { table.target(0, 0.0, on | controlword::halt_bit); });
  EXPECT_EQ(table.set_velocity(0), 0.0);
  EXPECT_TRUE(shows(statusword::target_bit)) << "it has halted";
  const double halted = table.position(0);
  EXPECT_GT(halted, 0.05);
  table.cycle([&] { table.target(0, 0.0, on); });
  EXPECT_FALSE(shows(statusword::target_bit));
  run();
  EXPECT_NEAR(table.position(0), 0.0, 10e-6);
}

TEST_F(ProfileMoves, NeedNoCyclesAndEndInAControlledStop) {
  table.cycle([&] { table.target(0, 0.0, offer); });
  for (int k = 0; k < 300; ++k) table.cycle();
  EXPECT_EQ(table.loop.fault(0), Fault::none);
  table.cycle([&] { table.mode(0, OperationMode::profile_position, controlword::quick_stop); });
  for (int k = 0; k < 300; ++k) table.cycle();
  EXPECT_FALSE(table.powered(0));
  EXPECT_EQ(table.loop.fault(0), Fault::none);
  EXPECT_GT(table.position(0), 0.06);
}

TEST_F(ProfileMoves, GiveWayToAnotherModeWhenTheyStand) {
  table.cycle([&] { table.target(0, 0.08, offer); });
  table.cycle([&] { table.mode(0, OperationMode::cyclic_position, on); });
  EXPECT_EQ(table.programme.remote()[0].mode(), OperationMode::profile_position);
  for (int k = 0; k < 1000 && table.programme.remote()[0].mode() != OperationMode::cyclic_position; ++k)
    table.cycle([&] { table.target(0, 0.08, on); });
  EXPECT_NEAR(table.set_position(0), 0.08, 1e-9);
  for (int k = 0; k < 100; ++k) table.cycle([&] { table.target(0, 0.08, on); });
  EXPECT_EQ(table.loop.fault(0), Fault::none);
}

// A PLC by pymodbus: the server in its thread, the loop in logical time between the PLC's requests.
class Plc {
 public:
  explicit Plc(bool allowed) : setup_(table_.configuration.setup) {
    setup_.modbus_server.emplace();
    setup_.modbus_server->address = "127.0.0.1:0";
    setup_.modbus_server->motion_allowed = allowed;
    publisher_.emplace(table_.configuration.machine, setup_, drive::KeptParameters{});
  }
  std::string ask(const std::string& operations) {
    const auto said = output_of(pymodbus(fmt::format("client tcp {} {}", publisher_->server().port(), operations)));
    publisher_->serve();
    return said;
  }
  void run(int cycles) {
    for (int k = 0; k < cycles; ++k) {
      table_.cycle();
      const double period = table_.configuration.machine.timing.fast_period;
      publisher_->take_motion(
          [&](const drive::MotionWrite& asked) { drive::ask(asked, period, table_.programme.remote()[asked.axis]); });
      drive::show_to_clients(table_.loop, table_.programme, period, *publisher_);
    }
  }
  ServedTable& table() { return table_; }

 private:
  ServedTable table_;
  machine::DriveSetup setup_;
  std::optional<drive::ModbusPublisher> publisher_;
};

// Registers of X: controlword 100, mode 101, target 102 in 10 nm, velocity 104 in um/s, accelerations 106 and 108 in
// mm/s^2; statusword at input 100.
TEST(ProfileMovesOverModbus, AreMadeForAPlc) {
  if (!has_pymodbus()) GTEST_SKIP() << "pymodbus is not installed";
  Plc plc(true);
  auto& table = plc.table();
  for (const char* word : {"6", "7", "15"}) {
    EXPECT_EQ(plc.ask(fmt::format("write:100:{},1", word)), "done\n");
    plc.run(100);
  }
  EXPECT_EQ(table.loop.state(0), DriveState::operation_enabled);
  // 50 mm = 5 000 000 = 76 * 65536 + 19264; 0.2 m/s = 200 000 = 3 * 65536 + 3392; 2 m/s^2 and 4 m/s^2. All in one
  // request, the controlword's bit 4 among them.
  EXPECT_EQ(plc.ask("write:100:31,1,76,19264,3,3392,0,2000,0,4000"), "done\n");
  double fastest = 0.0;
  table.before_tick = [&] { fastest = std::max(fastest, std::abs(table.set_velocity(0))); };
  plc.run(2);
  EXPECT_EQ(std::stoi(plc.ask("input:100:1")) & 0x1427, 0x1027) << "acknowledged, on its way";
  EXPECT_EQ(plc.ask("write:100:15"), "done\n");
  plc.run(600);
  EXPECT_EQ(std::stoi(plc.ask("input:100:1")) & 0x1427, 0x0427) << "reached";
  EXPECT_NEAR(fastest, 0.2, 1e-6);
  EXPECT_NEAR(table.position(0), 0.05, 10e-6);
  EXPECT_EQ(plc.ask("holding:102:8"), "76 19264 3 3392 0 2000 0 4000\n");
  figure("profile move by pymodbus: position from target",
         fmt::format("{:.2f} um (bound 10 um)", std::abs(table.position(0) - 0.05) * 1e6));
}

TEST(ProfileMovesOverModbus, AreRefusedWhereMotionIsNotAllowedOrBeyondTheAxis) {
  if (!has_pymodbus()) GTEST_SKIP() << "pymodbus is not installed";
  Plc forbidden(false);
  EXPECT_EQ(forbidden.ask("write:102:76,19264 write:100:31"), "exception 1\nexception 1\n");
  forbidden.run(10);
  EXPECT_FALSE(forbidden.table().powered(0));
  Plc plc(true);
  // 2 m/s of an axis with 80 m/min; no acceleration.
  EXPECT_EQ(plc.ask("write:104:30,33920 write:106:0,0"), "exception 3\nexception 3\n");
}

}  // namespace
}  // namespace stiction::test
