// Connections of one Modbus server beside each other, before an axis as the drive has it (remote_axis.hpp and
// servo_drive.hpp), which is shown to them a few ticks late.
#include "firmware/stictiond/modbus_clients.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "firmware/stictiond/modbus_motion.hpp"
#include "tests/firmware/drive/served_axis.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

using drive::ModbusClients;
using drive::MotionWrite;
using Verdict = ModbusClients::Verdict;

class ClientsOfAnAxis : public ::testing::Test {
 protected:
  ClientsOfAnAxis() { run(100); }

  // As the publisher hands it on. False: it is refused.
  bool write(std::uint16_t client, MotionWrite::What what, double value) {
    MotionWrite write{0, what, value};
    const auto verdict = clients.judge(client, write, shown);
    write.of_other = verdict == Verdict::pass_as_stop;
    if (verdict == Verdict::pass || verdict == Verdict::pass_as_stop) mailbox.put(std::array{write});
    return verdict != Verdict::refused;
  }
  bool word(std::uint16_t client, int value) { return write(client, MotionWrite::What::controlword, value); }

  void tick() {
    mailbox.take([&](const MotionWrite& write) { ask(write, stiction::test::tick, axis.remote); });
    axis.step();
    if (axis.ticks % 16 == 0) show_asked(axis.remote, stiction::test::tick, shown);
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) tick();
  }
  bool lead(std::uint16_t client) {
    for (const int value : {6, 7, 15}) {
      word(client, value);
      run(40);
    }
    return axis.drive.powered();
  }
  void move(std::uint16_t client) {
    EXPECT_TRUE(write(client, MotionWrite::What::mode, 3));
    run(5);  // a speed of before is none of the new mode
    EXPECT_TRUE(write(client, MotionWrite::What::target_velocity, 0.2));
    run(1000);
    EXPECT_NEAR(axis.set_speed, 0.2, 1e-6);
  }

  ServedAxis axis;
  drive::MotionMailbox mailbox;
  drive::PublishedAxis shown;
  ModbusClients clients;
};

TEST_F(ClientsOfAnAxis, AreOneAtATimeAndTheOthersAreRefused) {
  ASSERT_TRUE(lead(1));
  EXPECT_EQ(clients.owner(0), 1);
  move(1);
  const auto changes = clients.changes(0);
  EXPECT_FALSE(word(2, 15));
  EXPECT_FALSE(write(2, MotionWrite::What::target_velocity, -0.2));
  EXPECT_FALSE(write(2, MotionWrite::What::mode, 1));
  run(100);
  EXPECT_NEAR(axis.set_speed, 0.2, 1e-6);
  EXPECT_EQ(clients.changes(0), changes);
  // Given up, and then the other one's.
  EXPECT_TRUE(word(1, 0));
  axis.coasts = false;
  run(200);
  EXPECT_EQ(shown.owner, CommandSource::none);
  EXPECT_TRUE(lead(2));
  EXPECT_EQ(clients.owner(0), 2);
  EXPECT_NE(clients.changes(0), changes);
  EXPECT_FALSE(word(1, 15));
}

TEST_F(ClientsOfAnAxis, StopItThoughItIsADifferentOnesAndHoldItUntilTheyLiftIt) {
  for (const int stop : {0, 2, 6, 7}) {
    SCOPED_TRACE(stop);
    axis.coasts = false;
    ASSERT_TRUE(lead(1));
    move(1);
    EXPECT_TRUE(word(2, stop));
    EXPECT_FALSE(word(1, 15)) << "in its tick already";
    run(1500);
    EXPECT_FALSE(axis.drive.powered());
    EXPECT_EQ(clients.owner(0), 0);
    EXPECT_EQ(shown.held_by, CommandSource::modbus);
    EXPECT_FALSE(lead(1));
    EXPECT_FALSE(axis.remote.ask(controlword::shutdown, CommandSource::can)) << "nor may the other bus";
    EXPECT_TRUE(word(2, 15));
    run(100);
    EXPECT_FALSE(axis.drive.powered()) << "lifting moves nothing";
    EXPECT_EQ(shown.held_by, CommandSource::none);
    EXPECT_TRUE(lead(1));
    EXPECT_TRUE(word(1, 0));
    run(400);
  }
}

TEST_F(ClientsOfAnAxis, HoldItTogetherUntilTheLastLiftsIt) {
  ASSERT_TRUE(lead(1));
  EXPECT_TRUE(word(2, 6));
  EXPECT_TRUE(word(3, 2));
  run(1000);
  EXPECT_TRUE(word(3, 15));
  run(100);
  EXPECT_FALSE(lead(1));
  EXPECT_FALSE(lead(4));
  EXPECT_FALSE(word(4, 15)) << "it holds nothing";
  EXPECT_TRUE(word(2, 15));
  run(100);
  EXPECT_TRUE(lead(4));
}

// A master that connects again, as one that makes a connection for each request.
TEST_F(ClientsOfAnAxis, LeaveWhatTheyHadToTheNextOneWhenTheyAreGone) {
  std::uint16_t client = 1;
  for (const int value : {6, 7, 15}) {
    EXPECT_TRUE(word(client, value));
    clients.forget(client++);
    run(40);
  }
  EXPECT_TRUE(axis.drive.powered());
  EXPECT_EQ(clients.owner(0), 0xffff);
  move(client);
  EXPECT_EQ(clients.owner(0), client);
  EXPECT_FALSE(word(99, 15));
  // And a hold: any of them lifts it, however many are gone.
  for (std::uint16_t other = 100; other < 200; ++other) {
    EXPECT_TRUE(word(other, 6));
    clients.forget(other);
  }
  run(1500);
  EXPECT_FALSE(lead(client));
  EXPECT_TRUE(word(300, 15));
  run(100);
  EXPECT_TRUE(lead(301));
}

TEST_F(ClientsOfAnAxis, AreForgottenWithTheTimeOfTheirWatchOrWhereTheOtherBusStops) {
  ASSERT_TRUE(lead(1));
  EXPECT_TRUE(axis.remote.ask(controlword::quick_stop, CommandSource::can));
  run(1000);
  EXPECT_FALSE(axis.drive.powered());
  EXPECT_FALSE(lead(1)) << "CAN holds it";
  axis.remote.ask(controlword::enable_operation, CommandSource::can);
  run(100);
  EXPECT_TRUE(lead(2));
  EXPECT_EQ(clients.owner(0), 2);
}

// Words of several connections against the stop of one, in any order, at any rate and with what is shown late.
TEST_F(ClientsOfAnAxis, StopAndWinInAnyOrderAndAtAnyRate) {
  std::mt19937 draw(27);
  const auto any = [&](int most) { return static_cast<int>(draw() % static_cast<unsigned>(most)); };
  constexpr std::array<int, 4> stops{0, 2, 6, 7}, enabling{6, 7, 15, 31};
  int won = 0;
  for (int k = 0; k < 1000; ++k) {
    axis = ServedAxis{};
    axis.coasts = false;
    clients = {};
    shown = {};
    run(70 + any(40));
    ASSERT_TRUE(lead(1));
    if (any(2) == 0) move(1);
    const int pause = 1 + any(20);
    const auto send = [&](std::uint16_t client) {
      word(client, enabling[static_cast<std::size_t>(client == 1 ? any(4) : 2 + any(2))]);
    };
    if (any(2) == 0) send(1);
    EXPECT_TRUE(word(2, stops[static_cast<std::size_t>(any(4))]));
    bool enabled_again = false, was_off = false;
    for (int i = 0; i < 1200; ++i) {
      if (i % pause == 0) send(any(2) == 0 ? std::uint16_t{1} : std::uint16_t{3});
      tick();
      was_off |= !axis.drive.powered();
      enabled_again |= was_off && axis.drive.powered();
    }
    const bool stopped = was_off && !enabled_again && !axis.drive.powered();
    EXPECT_TRUE(stopped) << "case " << k;
    won += stopped ? 1 : 0;
  }
  figure("stop over one Modbus connection against enabling words over others",
         std::to_string(won) + " of 1000 won (bound all)");
  EXPECT_EQ(won, 1000);
}

}  // namespace
}  // namespace stiction::test
