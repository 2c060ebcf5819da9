// Two buses before one drive: whose word counts, what becomes of the axes when a commander is gone, and that all of
// them see one position.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "firmware/stictiond/run.hpp"
#include "tests/firmware/stictiond/served_table.hpp"
#include "tests/hal/modbus_support.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

using hal::can::Pdo;
constexpr std::uint16_t enabled_word = controlword::enable_operation;

drive::MotionWrite modbus_word(std::uint16_t word) { return {0, drive::MotionWrite::What::controlword, double(word)}; }

void over_modbus(ServedTable& table, const drive::MotionWrite& write) {
  drive::ask(write, table.configuration.machine.timing.fast_period, table.programme.remote()[write.axis]);
}

TEST(Commanders, OfCanAndModbusAreWatchedByDefault) {
  const ServedTable table({"drive.can_server.commander_timeout=0.5 s", "drive.modbus_server.address=127.0.0.1:0"});
  const auto remote = drive::remote_axes(table.configuration).front();
  EXPECT_EQ(remote.owner.timeout_ticks[1], 8000U);
  EXPECT_EQ(remote.owner.timeout_ticks[2], 16000U);
  EXPECT_EQ(remote.owner.reaction, AbortReaction::fault);
  EXPECT_EQ(machine::CanServerSetup{}.commander_timeout, 0.5);
  EXPECT_EQ(machine::ModbusServerSetup{}.commander_timeout, 1.0);
}

// drive.md: a move over Modbus whose client is gone ran on for 4836 s.
TEST(Commanders, GoneOnModbusInMidMoveAreFault53AndRest) {
  ServedTable table({"drive.modbus_server.address=127.0.0.1:0", "drive.modbus_server.commander_timeout=0.1 s"});
  using What = drive::MotionWrite::What;
  for (const int word : {6, 7, 15}) {
    over_modbus(table, modbus_word(static_cast<std::uint16_t>(word)));
    for (int i = 0; i < 20; ++i) table.cycle();
  }
  over_modbus(table, {0, What::mode, 1.0});
  for (int i = 0; i < 3; ++i) table.cycle();
  over_modbus(table, {0, What::target, -0.1});
  over_modbus(table, {0, What::velocity, 0.1});
  over_modbus(table, modbus_word(0x1f));
  table.cycle();
  EXPECT_NE(table.statusword(0) & statusword::acknowledge_bit, 0);
  // 0.1 s of silence, and 10 ms of the ramp from 0.1 m/s.
  int cycles = 0;
  for (; cycles < 3000 && (cycles < 50 || table.set_velocity(0) != 0.0); ++cycles) table.cycle();
  EXPECT_NEAR(cycles, 110, 3);
  EXPECT_EQ(table.loop.fault(0), Fault::commander_lost);
  for (int i = 0; i < 200; ++i) table.cycle();
  EXPECT_FALSE(table.powered(0));
  const auto lines = table.said();
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines[0].find("fault 53 'commander lost'"), std::string::npos) << lines[0];
}

TEST(Commanders, OnCanMayBeHeardByTheirHeartbeatAlone) {
  for (const int node : {0x7f, 0x7e}) {
    ServedTable table({"drive.can_server.commander_timeout=0.1 s", "drive.can_server.heartbeat_node=127"});
    ASSERT_TRUE(table.enable(0));
    table.cycle([&] { table.mode(0, OperationMode::profile_position, enabled_word); });
    hal::can::Frame heartbeat;
    heartbeat.id = 0x700u + static_cast<unsigned>(node);
    heartbeat.size = 1;
    heartbeat.data[0] = 5;
    for (int k = 0; k < 500; ++k)
      table.cycle([&] {
        if (k % 50 == 0) table.frames.take(table.loop.now_ns(), heartbeat, table.programme.remote());
      });
    EXPECT_EQ(table.loop.fault(0), node == 0x7f ? Fault::none : Fault::commander_lost);
  }
}

TEST(Commanders, AStopOverModbusEndsAStreamThatGoesOnEnabling) {
  ServedTable table;
  ASSERT_TRUE(table.enable(0));
  EXPECT_EQ(table.programme.remote()[0].owner().owner(), CommandSource::can);
  const double begin = table.position(0);
  const auto stream = [&](int from, int to) {
    for (int k = from; k < to; ++k) table.cycle([&] { table.target(0, begin + smooth(20e-3, (k + 1) / 500.0)); });
  };
  stream(0, 250);
  over_modbus(table, modbus_word(0x06));
  stream(250, 600);
  EXPECT_FALSE(table.powered(0));
  EXPECT_EQ(table.loop.fault(0), Fault::none);
  EXPECT_EQ(table.loop.state(0), DriveState::ready_to_switch_on);
  EXPECT_GT(table.frames.counts().refused, 300U);
  const auto lines = table.said();
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines[0].find("its commander is none and a stop of Modbus holds it"), std::string::npos) << lines[0];
  // A frame with offsets moves nothing either, and a walk by CAN is refused until Modbus lifts its stop.
  EXPECT_FALSE(table.enable(0));
  over_modbus(table, modbus_word(15));
  EXPECT_TRUE(table.enable(0));
}

TEST(Commanders, OnADifferentBusSetNoTargetsModesOrOffsets) {
  ServedTable table;
  for (const int word : {6, 7, 15}) {
    over_modbus(table, modbus_word(static_cast<std::uint16_t>(word)));
    for (int i = 0; i < 20; ++i) table.cycle([&] { table.send(Pdo::offsets, 0, {.velocity_offset = 10'000}); });
  }
  auto& remote = table.programme.remote()[0];
  ASSERT_EQ(remote.owner().owner(), CommandSource::modbus);
  const auto refused = table.frames.counts().refused;
  EXPECT_GT(refused, 30U);
  table.mode(0, OperationMode::profile_velocity, enabled_word);
  EXPECT_EQ(table.frames.counts().refused, refused + 1);
  table.cycle();
  EXPECT_EQ(remote.mode(), OperationMode::cyclic_position);
  // A stop with a mode in it is a stop alone.
  table.mode(0, OperationMode::profile_velocity, controlword::shutdown);
  for (int i = 0; i < 100; ++i) table.cycle();
  EXPECT_FALSE(table.powered(0));
  EXPECT_EQ(remote.mode(), OperationMode::cyclic_position);
  over_modbus(table, {0, drive::MotionWrite::What::target, 0.05});
  EXPECT_NEAR(machine::to_si(remote.move().target), 0.05, 1e-11) << "nobody owns it";
  ASSERT_TRUE(table.enable(1));
  const auto before = machine::to_si(table.programme.remote()[1].move().target);
  over_modbus(table, {1, drive::MotionWrite::What::target, 0.05});
  EXPECT_EQ(machine::to_si(table.programme.remote()[1].move().target), before) << "CAN does";
}

// csv and pv: 60FFh in 1000 increments a second.
TEST(Commanders, GiveSpeedsOverCan) {
  for (const auto mode : {OperationMode::cyclic_velocity, OperationMode::profile_velocity}) {
    ServedTable table;
    ASSERT_TRUE(table.enable(0));
    table.cycle([&] { table.mode(0, mode, enabled_word); });
    const auto speeds = [&](int cycles, std::int32_t units) {
      for (int k = 0; k < cycles; ++k)
        table.cycle([&] { table.send(Pdo::speed, 0, {.controlword = enabled_word, .speed = units}); });
    };
    speeds(5, 0);
    speeds(200, -50'000);
    EXPECT_NEAR(table.set_velocity(0), -0.05, 1e-7);
    EXPECT_EQ(table.loop.fault(0), Fault::none);
    speeds(1, std::numeric_limits<std::int32_t>::min());
    table.cycle();
    const bool cyclic = mode == OperationMode::cyclic_velocity;
    EXPECT_EQ(table.loop.fault(0), cyclic ? Fault::set_point : Fault::none);
    EXPECT_EQ(table.programme.remote()[0].refusal(), cyclic ? Refusal::none : Refusal::no_number);
    EXPECT_EQ((table.statusword(0) & statusword::warning_bit) != 0, !cyclic);
  }
}

// cst on the cross table's X: 70 A, 94 N/A, 225 kg and 90 N of friction; 6071h and 6072h in thousandths.
TEST(Commanders, GiveTorquesOverCanWithinSpeedAndTravel) {
  ServedTable table({"drive.axis.X.max_motor_speed=0.3 m/s"});
  ASSERT_TRUE(table.enable(0));
  table.cycle([&] { table.mode(0, OperationMode::cyclic_torque, enabled_word); });
  double fastest = 0.0, farthest = 0.0, largest = 0.0;
  const auto torques = [&](int cycles, std::int16_t torque, std::uint16_t most) {
    for (int k = 0; k < cycles; ++k) {
      table.cycle(
          [&] { table.send(Pdo::torque, 0, {.controlword = enabled_word, .torque = torque, .most_torque = most}); });
      fastest = std::max(fastest, std::abs(table.set_velocity(0)));
      farthest = std::max(farthest, std::abs(table.position(0)));
      largest = std::max(largest, std::abs(machine::to_si(table.loop.loop().signals()[0].i_set)));
    }
  };
  torques(5, 0, 1000);
  EXPECT_NE(table.statusword(0) & statusword::follows_bit, 0);
  torques(60, 100, 1000);  // 7 A, 658 N: 2.52 m/s^2 less a rise of 1 ms
  EXPECT_NEAR(table.set_velocity(0), 2.52 * 59.5e-3, 0.02);
  EXPECT_NEAR(machine::to_si(table.loop.loop().signals()[0].i_set), 7.0, 1e-3);
  std::vector<drive::ShownAxis> shown(2);
  drive::show_on_can(table.loop, table.programme, true, shown);
  EXPECT_NEAR(shown[0].current, 7.0, 0.2);
  torques(2500, 600, 300);  // to the end, with 21 A at most
  EXPECT_LE(largest, 21.0 + 1e-3);
  EXPECT_LE(fastest, 0.31);
  EXPECT_GE(fastest, 0.25);
  EXPECT_NEAR(table.position(0), 0.25, 1e-3);
  EXPECT_LE(farthest, 0.2510);
  EXPECT_NE(table.statusword(0) & statusword::limit_bit, 0);
  EXPECT_EQ(table.loop.fault(0), Fault::none) << name_of(table.loop.fault(0));
  torques(300, -100, 1000);
  EXPECT_LT(table.position(0), 0.2);
  // Left as every other mode: it brakes.
  table.cycle([&] { table.mode(0, OperationMode::profile_velocity, enabled_word); });
  for (int i = 0; i < 100; ++i) table.cycle([&] { table.mode(0, OperationMode::profile_velocity, enabled_word); });
  EXPECT_EQ(table.programme.remote()[0].mode(), OperationMode::profile_velocity);
  EXPECT_EQ(table.set_velocity(0), 0.0);
  EXPECT_EQ(table.loop.fault(0), Fault::none);
}

TEST(Commanders, GiveATorqueOverModbusThatHolds) {
  ServedTable table({"drive.axis.X.max_motor_speed=0.3 m/s", "drive.modbus_server.address=127.0.0.1:0",
                     "drive.modbus_server.commander_timeout=0 s"});
  for (const int word : {6, 7, 15}) {
    over_modbus(table, {0, drive::MotionWrite::What::controlword, static_cast<double>(word)});
    for (int i = 0; i < 20; ++i) table.cycle();
  }
  over_modbus(table, {0, drive::MotionWrite::What::mode, 10});
  for (int i = 0; i < 5; ++i) table.cycle();
  over_modbus(table, {0, drive::MotionWrite::What::target_torque, -0.1});
  for (int i = 0; i < 60; ++i) table.cycle();
  EXPECT_NEAR(table.set_velocity(0), -2.52 * 0.06, 0.03);
  drive::PublishedAxis shown;
  shown.current = machine::to_si(table.loop.loop().signals()[0].i);
  show_asked(table.programme.remote()[0], table.configuration.machine.timing.fast_period, shown);
  EXPECT_NEAR(shown.torque, -0.1, 2e-3);
  EXPECT_NEAR(shown.target_torque, -0.1, 1e-6);
  EXPECT_NEAR(shown.max_torque, 1.0, 1e-6);
  over_modbus(table, {0, drive::MotionWrite::What::max_torque, 0.05});
  for (int i = 0; i < 20; ++i) table.cycle();
  EXPECT_NEAR(machine::to_si(table.loop.loop().signals()[0].i_set), -3.5, 1e-3);
  EXPECT_NE(table.statusword(0) & statusword::limit_bit, 0);
  EXPECT_EQ(table.loop.fault(0), Fault::none);
}

TEST(Commanders, GiveASpeedOverModbus) {
  ServedTable table;
  for (const int word : {6, 7, 15}) {
    over_modbus(table, modbus_word(static_cast<std::uint16_t>(word)));
    for (int i = 0; i < 20; ++i) table.cycle();
  }
  over_modbus(table, {0, drive::MotionWrite::What::mode, 3.0});
  for (int i = 0; i < 3; ++i) table.cycle();
  over_modbus(table, {0, drive::MotionWrite::What::target_velocity, -0.05});
  for (int i = 0; i < 200; ++i) table.cycle();
  EXPECT_NEAR(table.set_velocity(0), -0.05, 1e-7);
}

// An offset of homing shifts the coordinates: what is read anywhere is the same place.
TEST(Coordinates, OfAHomedAxisAreOneOnCanModbusLogAndTrace) {
  ServedTable table({"drive.axis.X.homing.method=here", "drive.axis.X.homing.offset=50 mm",
                     "drive.modbus_server.address=127.0.0.1:0"});
  ASSERT_TRUE(table.enable(0));
  table.cycle([&] { table.mode(0, OperationMode::homing, enabled_word); });
  table.cycle([&] { table.mode(0, OperationMode::homing, enabled_word | controlword::homing_start_bit); });
  for (int i = 0; i < 10; ++i) table.cycle();
  ASSERT_TRUE(table.loop.drive(0).referenced());
  const double encoder = machine::to_si(table.loop.loop().signals()[0].x);
  const double place = table.position(0);
  EXPECT_NEAR(place, 0.05, 1e-6);
  EXPECT_NEAR(encoder, 0.09, 1e-6);

  std::vector<drive::ShownAxis> can(2);
  drive::show_on_can(table.loop, table.programme, true, can);
  EXPECT_EQ(ServedTable::units(can[0].position), ServedTable::units(place));

  drive::ModbusPublisher publisher(table.configuration.machine, table.configuration.setup, drive::KeptParameters{});
  drive::show_to_clients(table.loop, table.programme, table.configuration.machine.timing.fast_period, publisher);
  const RawClient client(publisher.server().port());
  client.send(request({4, 0, 104, 0, 4}));
  const auto answer = client.receive();
  ASSERT_EQ(answer.size(), 17U);
  const auto number = [&](std::size_t at) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(answer[at]) << 24 | answer[at + 1] << 16 |
                                     answer[at + 2] << 8 | answer[at + 3]);
  };
  EXPECT_EQ(number(9), std::lround(place / 1e-8));
  EXPECT_EQ(number(13), std::lround(table.set_position(0) / 1e-8));

  const auto file = std::filesystem::temp_directory_path() / ("stiction-trace-" + std::to_string(::getpid()) + ".csv");
  drive::Trace trace(2, 1);
  trace.add(0, table.loop.loop().signals(), [&](std::size_t i) { return table.loop.drive(i).origin(); });
  trace.write(file, {"X", "Y"}, {});
  std::ifstream in(file);
  std::string line, row;
  std::vector<std::string> names;
  int compared = 0, in_trace = 0;
  while (std::getline(in, line)) {
    if (line.starts_with("#")) continue;
    std::stringstream cells(line);
    std::vector<std::string> fields;
    while (std::getline(cells, row, ',')) fields.push_back(row);
    if (names.empty()) {
      names = fields;
      continue;
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
      const double scale = names[i].ends_with("[mm]") ? 1e-3 : names[i].ends_with("[um]") ? 1e-6 : 1.0;
      const bool measured = names[i].starts_with("X.x["), set = names[i].starts_with("X.x_set[");
      if (!measured && !set) continue;
      const double off = std::stod(fields[i]) * scale - (measured ? place : table.set_position(0));
      EXPECT_NEAR(off, 0.0, 1e-9);
      in_trace += std::abs(off) <= 1e-9 ? 1 : 0;
      ++compared;
    }
  }
  EXPECT_EQ(compared, 2);
  std::filesystem::remove(file);

  table.loop.trip(0, Fault::clock_jump);
  table.cycle();
  std::string said;
  for (const auto& l : table.said()) said += l;
  const bool logged = said.find(fmt::format("while serving at {} nm", std::llround(place * 1e9))) != std::string::npos;
  EXPECT_TRUE(logged) << said;
  const int equal = (ServedTable::units(can[0].position) == ServedTable::units(place) ? 1 : 0) +
                    (number(9) == std::lround(place / 1e-8) ? 1 : 0) +
                    (number(13) == std::lround(table.set_position(0) / 1e-8) ? 1 : 0) + (logged ? 1 : 0) + in_trace;
  EXPECT_EQ(equal, 6);
  figure("positions of a homed axis with an offset on CAN, Modbus, in log and trace: equal to an increment",
         fmt::format("{} of 6 (bound all)", equal));
}

TEST(Coordinates, OfAnAxisThatWasNotHomedRefuseTargetsWithAReasonInTheLog) {
  ServedTable table({"drive.axis.X.homing.method=here"});
  ASSERT_TRUE(table.enable(0));
  EXPECT_NE(table.statusword(0) & statusword::unreferenced_bit, 0);
  table.cycle([&] { table.mode(0, OperationMode::profile_position, enabled_word); });
  for (int i = 0; i < 3; ++i) table.cycle();
  for (int k = 0; k < 50; ++k)
    table.cycle([&] {
      table.target(0, 0.05,
                   static_cast<std::uint16_t>(enabled_word | (k % 2 == 0 ? controlword::new_set_point_bit : 0)));
    });
  EXPECT_NEAR(table.set_position(0), 0.09, 1e-6);
  const auto lines = table.said();
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines[0].find("axis 0: found an absolute target of an axis whose zero is not known"), std::string::npos);
}

TEST(Statuswords, SayByBit9WhetherABusIsObeyed) {
  ServedTable table;
  std::vector<drive::ShownAxis> shown(2);
  drive::show_on_can(table.loop, table.programme, true, shown);
  EXPECT_NE(shown[0].statusword & statusword::remote_bit, 0);
  drive::show_on_can(table.loop, table.programme, false, shown);
  EXPECT_EQ(shown[0].statusword & statusword::remote_bit, 0);
}

}  // namespace
}  // namespace stiction::test
