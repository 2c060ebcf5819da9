// The objects of the drive's nodes, read and written by a client from the standard's text, while the drive runs in
// logical time; what they are to be is of CiA 301, CiA 402 and of the machine file.
#include "firmware/stictiond/object_server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <mutex>
#include <thread>

#include "firmware/stictiond/object_thread.hpp"
#include "tests/firmware/stictiond/served_objects.hpp"
#include "tests/hal/modbus_support.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

// Written out from IEC 61800-7-201 and CiA 301: index, and how many bytes a value has.
const std::map<unsigned, std::size_t> sizes{
    {0x1000, 4}, {0x1001, 1}, {0x1014, 4}, {0x1017, 2}, {0x603f, 2}, {0x6040, 2}, {0x6041, 2}, {0x605a, 2},
    {0x605b, 2}, {0x605c, 2}, {0x605d, 2}, {0x605e, 2}, {0x6060, 1}, {0x6061, 1}, {0x6062, 4}, {0x6063, 4},
    {0x6064, 4}, {0x6065, 4}, {0x6066, 2}, {0x6067, 4}, {0x6068, 2}, {0x606c, 4}, {0x6071, 2}, {0x6072, 2},
    {0x6077, 2}, {0x607a, 4}, {0x607c, 4}, {0x6081, 4}, {0x6083, 4}, {0x6084, 4}, {0x6085, 4}, {0x6098, 1},
    {0x609a, 4}, {0x60f4, 4}, {0x60ff, 4}, {0x6502, 4}};

TEST_F(Objects, AreThereWithTheStandardsSizes) {
  cycles(100);
  for (const auto& [index, size] : sizes) {
    const auto found = client.upload(index, 0);
    ASSERT_TRUE(std::holds_alternative<SdoClient::Bytes>(found)) << std::hex << index;
    EXPECT_EQ(std::get<SdoClient::Bytes>(found).size(), size) << std::hex << index;
  }
  for (const auto& [index, subs] :
       std::map<unsigned, unsigned>{{0x1010, 1}, {0x1016, 1}, {0x1018, 4}, {0x607d, 2}, {0x6099, 2}}) {
    EXPECT_EQ(client.number(index, 0), subs) << std::hex << index;
    for (unsigned sub = 1; sub <= subs; ++sub) EXPECT_EQ(client.abort_of(index, sub), 0u);
    EXPECT_EQ(client.abort_of(index, subs + 1), 0x06090011u);
  }
  EXPECT_EQ(client.abort_of(0x2000), 0x06020000u);
}

TEST_F(Objects, SayWhatTheDriveIs) {
  EXPECT_EQ(client.number(0x1000), 0x00020192u) << "CiA 402, servo drive";
  EXPECT_EQ(client.number(0x1014), 0x081u);
  EXPECT_EQ(client.number(0x1200, 1), 0x601u);
  EXPECT_EQ(client.number(0x1200, 2), 0x581u);
  const auto text = [&](unsigned index) {
    const auto bytes = std::get<SdoClient::Bytes>(client.upload(index, 0));
    return std::string(bytes.begin(), bytes.end());
  };
  EXPECT_EQ(text(0x1008), "stiction");
  EXPECT_EQ(text(0x1009), table.configuration.machine.id);
  EXPECT_THAT(text(0x100a), ::testing::HasSubstr("commit"));
  // pp, pv, homing, csp, csv, cst: bits 0, 2, 5, 7, 8, 9; cam and gear: 16, 17.
  EXPECT_EQ(client.number(0x6502), 0x303a5u);
}

TEST_F(Objects, AreOfTheirNodeAlone) {
  cycles(3);
  const SdoClient second(2, [this](const hal::can::Frame& frame) { return server->answer(frame, 0); });
  EXPECT_EQ(second.number(0x1014), 0x082u);
  EXPECT_EQ(client.number(0x6064), 90'000'000u);
  EXPECT_EQ(second.number(0x6064), 0u);
  const SdoClient third(3, [this](const hal::can::Frame& frame) { return server->answer(frame, 0); });
  EXPECT_EQ(std::get<std::uint32_t>(third.upload(0x1000, 0)), SdoClient::no_answer);
}

TEST_F(Objects, HaveTheMachineFilesValues) {
  // The cross table: 600 in the file is no object; 2 mm, 20 m/s^2, 80 m/min, 250 mm to both sides, 10 m/s^2.
  cycles(1);
  EXPECT_EQ(client.number(0x6065), 2'000'000u);
  EXPECT_EQ(client.number(0x6066), 0u);
  EXPECT_EQ(client.number(0x6067), 10'000u);
  EXPECT_EQ(static_cast<std::int32_t>(client.number(0x607d, 1)), -250'000'000);
  EXPECT_EQ(client.number(0x607d, 2), 250'000'000u);
  EXPECT_EQ(client.number(0x6081), 1'333'333u);
  EXPECT_NEAR(client.number(0x6083), 20'000'000.0, 20.0);
  EXPECT_EQ(client.number(0x6085), 10'000'000u);
  EXPECT_EQ(client.number(0x6099, 1), 20'000u);
  EXPECT_EQ(client.number(0x6072), 1000u);
  EXPECT_EQ(client.number(0x605a), 2u);
  EXPECT_EQ(client.number(0x6007), 1u);
}

TEST_F(Objects, MoveAnAxisByItsProfileFromEnableToTarget) {
  ASSERT_TRUE(enable());
  EXPECT_EQ(table.programme.remote()[0].owner().owner(), CommandSource::can);
  EXPECT_EQ(client.set(0x6060, 0, 1, 1), 0u);
  cycles(3);
  EXPECT_EQ(client.number(0x6061), 1u);
  EXPECT_EQ(client.set(0x607a, 0, 60'000'000, 4), 0u);
  EXPECT_EQ(client.set(0x6081, 0, 200'000, 4), 0u);
  EXPECT_EQ(client.set(0x6083, 0, 4'000'000, 4), 0u);
  EXPECT_EQ(client.set(0x6084, 0, 4'000'000, 4), 0u);
  EXPECT_EQ(client.set(0x6040, 0, 0x1f, 2), 0u);
  cycles(100);
  EXPECT_NEAR(static_cast<std::int32_t>(client.number(0x606c)), -200'000, 2'000);
  cycles(300);
  EXPECT_EQ(client.number(0x6041) & 0x0400, 0x0400u) << "reached";
  EXPECT_NEAR(static_cast<std::int32_t>(client.number(0x6064)), 60'000'000, 5'000);
  EXPECT_EQ(client.number(0x6062), 60'000'000u);
  EXPECT_NEAR(static_cast<std::int32_t>(client.number(0x60f4)), 0, 5'000);
  EXPECT_EQ(client.number(0x6040), 0x1fu);
}

// One coordinate system on all that shows a position: that of the zero that homing found.
class ObjectsOfAHomedAxis : public Objects {
 protected:
  ObjectsOfAHomedAxis() : Objects({"drive.axis.X.homing.method=here", "drive.axis.X.homing.offset=50 mm"}) {}
};
TEST_F(ObjectsOfAHomedAxis, ShowTheMachinesCoordinates) {
  cycles(1);
  EXPECT_EQ(client.number(0x6098), 35u);
  EXPECT_EQ(client.number(0x607c), 50'000'000u);
  ASSERT_TRUE(enable());
  EXPECT_EQ(client.number(0x6041) & 0x4000, 0x4000u) << "the zero is not known";
  EXPECT_EQ(client.set(0x6060, 0, 6, 1), 0u);
  cycles(3);
  EXPECT_EQ(client.set(0x6040, 0, 0x1f, 2), 0u);
  cycles(10);
  EXPECT_EQ(client.number(0x6041) & 0x5000, 0x1000u) << "attained";
  EXPECT_EQ(client.number(0x6064), static_cast<std::uint32_t>(ServedTable::units(table.position(0))));
  EXPECT_NEAR(client.number(0x6064), 50'000'000, 1'000);
}

// Stops are taken from everybody, and have their mailbox: an enabling word behind them in the same tick does not win.
TEST_F(Objects, HandAStopOverWhateverFollowsIt) {
  int won = 0;
  constexpr int tries = 50;
  for (int i = 0; i < tries; ++i) {
    if (!enable()) break;
    client.set(0x6040, 0, 2, 2);
    client.set(0x6040, 0, 15, 2);
    cycles(100);
    won += table.powered(0) ? 0 : 1;
    client.set(0x6040, 0, 0, 2);
    cycles(5);
  }
  EXPECT_EQ(won, tries);
  figure("stops over SDO with an enabling word behind them in the same tick",
         fmt::format("{} of {} won (bound all)", won, tries));
}

TEST_F(Objects, RefuseCommandsWhileModbusCommandsTheAxisButAStop) {
  for (const int word : {6, 7, 15}) {
    drive::ask({0, drive::MotionWrite::What::controlword, static_cast<double>(word)}, period(),
               table.programme.remote()[0]);
    cycles(20);
  }
  ASSERT_TRUE(table.powered(0));
  EXPECT_EQ(client.set(0x6060, 0, 3, 1), 0x08000021u);
  EXPECT_EQ(client.set(0x60ff, 0, 1000, 4), 0x08000021u);
  EXPECT_EQ(client.set(0x6040, 0, 15, 2), 0x08000021u);
  EXPECT_EQ(client.set(0x1016, 1, 0x007d0064, 4), 0x08000021u);
  EXPECT_EQ(client.set(0x6040, 0, 6, 2), 0u);
  cycles(200);
  EXPECT_FALSE(table.powered(0));
}

TEST_F(Objects, AreHeldToTheRangesOfTheirRegisters) {
  cycles(1);
  EXPECT_EQ(client.set(0x6081, 0, 1'400'000, 4), 0x06090031u) << "max_velocity";
  EXPECT_EQ(client.set(0x6081, 0, 0, 4), 0x06090032u);
  EXPECT_EQ(client.set(0x60ff, 0, -1'400'000, 4), 0x06090032u);
  EXPECT_EQ(client.set(0x6071, 0, 1001, 2), 0x06090031u);
  EXPECT_EQ(client.set(0x6060, 0, 2, 1), 0x06090030u) << "a mode that the drive does not have";
  EXPECT_EQ(client.set(0x607a, 0, std::numeric_limits<std::int32_t>::min(), 4), 0x06090032u);
  EXPECT_EQ(client.set(0x6040, 0, 6, 1), 0x06070013u);
  EXPECT_EQ(client.set(0x6040, 0, 6, 4), 0x06070012u);
  for (const unsigned index : {0x1000u, 0x1001u, 0x6041u, 0x605au, 0x6064u, 0x6098u, 0x609au})
    EXPECT_EQ(client.set(index, 0, 1, 4), 0x06010002u) << std::hex << index;
  EXPECT_EQ(client.set(0x1003, 0, 1, 1), 0x06090030u);
  EXPECT_EQ(client.set(0x1016, 1, 0x00800064, 4), 0x06090030u) << "node 128";
}

TEST_F(Objects, KeepTheErrorsOfTheNode) {
  cycles(3);
  EXPECT_EQ(client.number(0x1001), 0u);
  EXPECT_EQ(client.number(0x1003, 0), 0u);
  EXPECT_EQ(client.abort_of(0x1003, 1), 0x08000024u) << "no data";
  table.loop.trip(0, Fault::clock_jump);
  cycles(2);
  EXPECT_EQ(client.number(0x603f), 0xff31u);
  EXPECT_EQ(client.number(0x1001), 0x81u);
  EXPECT_EQ(client.number(0x1003, 0), 1u);
  EXPECT_EQ(client.number(0x1003, 1), 0x0031ff31u) << "fault 49 above its code";
  EXPECT_EQ(client.set(0x1003, 0, 0, 1), 0u);
  EXPECT_EQ(client.number(0x1003, 0), 0u);
  EXPECT_EQ(client.number(0x1001), 0x81u) << "the history alone is cleared";
}

TEST_F(Objects, KeepTheNewestEightErrors) {
  auto& link = table.frames.links()->at(0);
  drive::CanopenNode node(1, link);
  cycles(1);
  for (int i = 0; i < 11; ++i) {
    node.step(0, i % 2 == 0 ? Fault::over_current : Fault::over_speed, [](const hal::can::Frame&) {});
    node.step(0, Fault::none, [](const hal::can::Frame&) {});
  }
  EXPECT_EQ(client.number(0x1003, 0), 8u);
  EXPECT_EQ(client.number(0x1003, 1) & 0xffff, 0x2310u);
  EXPECT_EQ(client.number(0x1003, 8) & 0xffff, 0x8400u);
}

TEST_F(Objects, SetTheHeartbeatsOfTheNode) {
  cycles(1);
  EXPECT_EQ(client.set(0x1017, 0, 250, 2), 0u);
  EXPECT_EQ(client.number(0x1017), 250u);
  EXPECT_EQ(client.set(0x1016, 1, 0x007d0064, 4), 0u);
  EXPECT_EQ(client.number(0x1016, 1), 0x007d0064u);
  EXPECT_EQ(table.frames.links()->at(0).heartbeat_ms, 250);
}

TEST_F(Objects, AreNotServedInTheStateStopped) {
  cycles(1);
  auto& state = table.frames.links()->at(0).state;
  state = hal::can::NodeState::stopped;
  EXPECT_EQ(std::get<std::uint32_t>(client.upload(0x1000, 0)), SdoClient::no_answer);
  state = hal::can::NodeState::pre_operational;
  EXPECT_EQ(client.number(0x1000), 0x00020192u);
}

TEST_F(Objects, OfALoopThatMakesNoProgressAreAFaultAndTakeNoCommand) {
  cycles(3);
  is_stale = true;
  EXPECT_EQ(client.number(0x6041) & 0x4f, 0x08u) << "fault";
  EXPECT_EQ(client.number(0x603f), 0x6010u);
  EXPECT_EQ(client.set(0x6040, 0, 6, 2), 0x08000022u);
}

class ObjectsWithoutPermission : public Objects {
 protected:
  ObjectsWithoutPermission() : Objects({}, false) {}
};
TEST_F(ObjectsWithoutPermission, MoveNothing) {
  cycles(1);
  for (const int word : {6, 0}) EXPECT_EQ(client.set(0x6040, 0, word, 2), 0x08000021u);
  EXPECT_EQ(client.set(0x607a, 0, 1000, 4), 0x08000021u);
  EXPECT_EQ(client.set(0x1016, 1, 0x007d0064, 4), 0x08000021u);
  EXPECT_EQ(client.number(0x6064), 90'000'000u) << "everything can be read";
}

// A socket without a bus, for the thread.
class Wire {
 public:
  bool receive(hal::can::Received& received, std::int64_t) {
    const std::lock_guard lock(mutex);
    if (requests.empty()) {
      std::this_thread::yield();
      return false;
    }
    received.frame = requests.front();
    requests.erase(requests.begin());
    return true;
  }
  bool send(const hal::can::Frame& frame) {
    const std::lock_guard lock(mutex);
    answers.push_back(frame);
    return true;
  }
  bool find_again() { return true; }

  std::mutex mutex;
  std::vector<hal::can::Frame> requests, answers;
};

TEST_F(Objects, AreServedByAThreadBesideTheLoop) {
  cycles(1);
  auto owned = std::make_unique<Wire>();
  Wire& wire = *owned;
  const drive::ObjectThread<Wire> thread(*server, std::move(owned));
  const SdoClient over_the_wire(1, [&](const hal::can::Frame& frame) -> std::optional<hal::can::Frame> {
    {
      const std::lock_guard lock(wire.mutex);
      wire.answers.clear();
      wire.requests.push_back(frame);
    }
    std::optional<hal::can::Frame> answer;
    comes_true([&] {
      const std::lock_guard lock(wire.mutex);
      if (!wire.answers.empty()) answer = wire.answers.front();
      return answer.has_value();
    });
    return answer;
  });
  EXPECT_EQ(over_the_wire.number(0x1000), 0x00020192u);
  EXPECT_EQ(over_the_wire.number(0x6064), 90'000'000u);
}

}  // namespace
}  // namespace stiction::test
