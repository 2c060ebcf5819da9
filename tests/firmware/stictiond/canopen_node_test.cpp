// A node of CANopen before the drive: states by network management, boot-up, heartbeats and emergency messages, with
// frames as CiA 301 has them, written out here.
#include <gtest/gtest.h>

#include <vector>

#include "tests/firmware/stictiond/served_table.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

using hal::can::Frame;

Frame frame_of(std::uint32_t id, std::vector<std::uint8_t> bytes) {
  Frame frame;
  frame.id = id;
  frame.size = static_cast<std::uint8_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), frame.data.begin());
  return frame;
}

// The table with what its first node sends.
class Nodes : public ::testing::Test {
 protected:
  explicit Nodes(const std::vector<std::string>& settings = {}) : table(settings) {}

  void order(std::uint8_t command, std::uint8_t node) { take(frame_of(0x000, {command, node})); }
  void take(const Frame& frame) { table.frames.take(table.loop.now_ns(), frame, table.programme.remote()); }
  // What the first node sends behind a cycle.
  std::vector<Frame> cycle(const std::function<void()>& sends = {}) {
    table.cycle(sends);
    std::vector<Frame> sent;
    table.frames.node(0).step(table.loop.now_ns(), table.loop.fault(0),
                              [&](const Frame& frame) { sent.push_back(frame); });
    return sent;
  }
  static void expect(const Frame& frame, std::uint32_t id, const std::vector<std::uint8_t>& bytes) {
    EXPECT_EQ(frame.id, id);
    ASSERT_EQ(frame.size, bytes.size());
    for (std::size_t i = 0; i < bytes.size(); ++i) EXPECT_EQ(frame.data[i], bytes[i]) << i;
  }

  ServedTable table;
};

TEST_F(Nodes, SayTheirBootUpOnceAndStartByThemselves) {
  const auto sent = cycle();
  ASSERT_EQ(sent.size(), 1u);
  expect(sent[0], 0x701, {0});
  EXPECT_TRUE(table.frames.node(0).exchanges());
  EXPECT_TRUE(cycle().empty());
}

TEST_F(Nodes, GoWhereTheMasterOfTheNetworkSendsThem) {
  cycle();
  struct Row {
    std::uint8_t command;
    int state;  // of a heartbeat
  };
  table.frames.links()->at(0).heartbeat_ms = 1;
  for (const auto& [command, state] : {Row{2, 4}, Row{128, 127}, Row{1, 5}, Row{128, 127}, Row{2, 4}, Row{1, 5}}) {
    order(command, 1);
    std::vector<Frame> sent;
    for (int i = 0; i < 3 && sent.empty(); ++i) sent = cycle();
    ASSERT_FALSE(sent.empty());
    expect(sent.back(), 0x701, {static_cast<std::uint8_t>(state)});
    EXPECT_EQ(table.frames.node(0).exchanges(), state == 5);
  }
  order(128, 2);
  EXPECT_TRUE(table.frames.node(0).exchanges()) << "an order for a different node";
  order(128, 0);
  EXPECT_FALSE(table.frames.node(0).exchanges()) << "an order for all";
  EXPECT_FALSE(table.frames.node(1).exchanges());
  // None of the standard's, and none at all.
  for (const auto& wrong : {frame_of(0, {3, 1}), frame_of(0, {1}), frame_of(0, {1, 1, 1}), frame_of(0, {1, 200})})
    take(wrong);
  EXPECT_FALSE(table.frames.node(0).exchanges());
  for (const int reset : {129, 130}) {
    table.frames.links()->at(0).heartbeat_ms = 5;
    order(static_cast<std::uint8_t>(reset), 1);
    const auto sent = cycle();
    ASSERT_EQ(sent.size(), 1u);
    expect(sent[0], 0x701, {0});
    EXPECT_EQ(table.frames.links()->at(0).heartbeat_ms, 0) << "what was written is taken back";
    EXPECT_TRUE(table.frames.node(0).exchanges());
  }
}

TEST_F(Nodes, TakeNoProcessDataUnlessOperational) {
  order(128, 1);
  const auto before = table.frames.counts().taken;
  EXPECT_FALSE(table.enable(0));
  EXPECT_EQ(table.frames.counts().taken, before);
  order(1, 1);
  EXPECT_TRUE(table.enable(0));
}

// CiA 402, 6007h: to leave operational is to lose the connection. The watch of the commander is off here.
TEST_F(Nodes, StopAnAxisWhoseNodeIsTakenOutOfOperation) {
  int stopped = 0, tried = 0;
  for (const int command : {2, 128, 129, 130}) {
    ServedTable each;
    ASSERT_TRUE(each.enable(0));
    const double begin = each.position(0);
    for (int k = 0; k < 250; ++k) each.cycle([&] { each.target(0, begin + smooth(20e-3, (k + 1) / 500.0)); });
    ASSERT_GT(std::abs(each.set_velocity(0)), 0.01);
    each.frames.take(each.loop.now_ns(), frame_of(0, {static_cast<std::uint8_t>(command), 1}), each.programme.remote());
    const double v = std::abs(each.set_velocity(0));
    // The ramp of 10 m/s^2 and two cycles.
    int cycles = 0;
    for (; cycles < 1000 && each.set_velocity(0) != 0.0; ++cycles) each.cycle();
    EXPECT_LE(cycles, std::ceil(v / 10.0 * 1e3) + 2);
    for (int i = 0; i < 200; ++i) each.cycle();
    ++tried;
    stopped += each.loop.fault(0) == Fault::commander_lost && !each.powered(0) ? 1 : 0;
  }
  EXPECT_EQ(stopped, tried);
  figure("axis whose CANopen node is stopped, reset or set pre-operational in motion: controlled stop, fault 53",
         fmt::format("{} of {} (bound all)", stopped, tried));
}

// CiA 301, 7.2.8.2.2: from the first heartbeat on.
TEST_F(Nodes, WatchTheHeartbeatThatTheyAreTold) {
  table.frames.links()->at(0).watched = 0x007d0064;  // node 125, 100 ms
  ASSERT_TRUE(table.enable(0));
  const double at = table.position(0);
  const auto hold = [&](int cycles, int heartbeat_each, std::uint32_t node = 125) {
    for (int k = 0; k < cycles; ++k)
      table.cycle([&] {
        table.target(0, at);
        if (heartbeat_each != 0 && k % heartbeat_each == 0) take(frame_of(0x700 + node, {5}));
      });
  };
  hold(300, 0);
  EXPECT_EQ(table.loop.fault(0), Fault::none) << "none was heard yet";
  hold(500, 50);
  EXPECT_EQ(table.loop.fault(0), Fault::none);
  hold(45, 0);
  EXPECT_EQ(table.loop.fault(0), Fault::none);
  hold(60, 10, 124);  // of a different node, with targets that go on
  EXPECT_EQ(table.loop.fault(0), Fault::commander_lost);
}

TEST_F(Nodes, SendTheirHeartbeatInTime) {
  cycle();
  table.frames.links()->at(0).heartbeat_ms = 20;
  int sent = 0;
  for (int k = 0; k < 1000; ++k)
    for (const auto& frame : cycle()) {
      expect(frame, 0x701, {5});
      ++sent;
    }
  EXPECT_NEAR(sent, 50, 1);
}

// CiA 301, 7.2.7.1: code, 1001h, five bytes of the maker's; 0 when it is over.
TEST_F(Nodes, SendAnEmergencyForEachFaultAndForItsEnd) {
  struct Row {
    Fault fault;
    std::uint16_t code;
    std::uint8_t error_register;
  };
  constexpr Row rows[]{{Fault::over_current, 0x2310, 0x03},
                       {Fault::following_error, 0x8611, 0x21},
                       {Fault::encoder_frozen, 0x7305, 0x01},
                       {Fault::commander_lost, 0x8130, 0x11},
                       {Fault::limit_switch, 0xff14, 0x81}};
  drive::NodeLink link;
  drive::CanopenNode node(9, link);
  std::vector<Frame> sent;
  std::int64_t now_ns = 0;
  const auto step = [&](Fault fault) {
    sent.clear();
    node.step(now_ns += 1'000'000, fault, [&](const Frame& frame) { sent.push_back(frame); });
  };
  step(Fault::none);
  ASSERT_EQ(sent.size(), 1u) << "boot-up alone";
  for (const auto& row : rows) {
    step(row.fault);
    ASSERT_EQ(sent.size(), 1u);
    expect(sent[0], 0x089,
           {static_cast<std::uint8_t>(row.code), static_cast<std::uint8_t>(row.code >> 8), row.error_register,
            static_cast<std::uint8_t>(row.fault), 0, 0, 0, 0});
    step(row.fault);
    EXPECT_TRUE(sent.empty()) << "once";
  }
  step(Fault::none);
  ASSERT_EQ(sent.size(), 1u);
  expect(sent[0], 0x089, {0, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(link.error_count, std::size(rows));
  // In the state stopped nothing is sent; what still holds is said behind it.
  RemoteAxis axis{RemoteAxisConfig{}};
  node.take({hal::can::NetworkCommand::stop, 9}, axis);
  step(Fault::over_speed);
  EXPECT_TRUE(sent.empty());
  node.take({hal::can::NetworkCommand::start, 9}, axis);
  step(Fault::over_speed);
  ASSERT_EQ(sent.size(), 1u);
  EXPECT_EQ(sent[0].id, 0x089u);
}

}  // namespace
}  // namespace stiction::test
