// The objects of the drive's nodes, read and written by a client from the standard's text, while the drive runs in
// logical time; what they are to be is of CiA 301, CiA 402 and of the machine file.
#include "firmware/stictiond/object_server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "firmware/stictiond/modbus_motion.hpp"
#include "firmware/stictiond/object_thread.hpp"
#include "firmware/stictiond/run.hpp"
#include "tests/firmware/stictiond/served_table.hpp"
#include "tests/hal/modbus_support.hpp"
#include "tests/hal/sdo_client.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

using drive::ParameterSet;

// Written out from IEC 61800-7-201 and CiA 301: index, and how many bytes a value has.
const std::map<unsigned, std::size_t> sizes{
    {0x1000, 4}, {0x1001, 1}, {0x1014, 4}, {0x1017, 2}, {0x603f, 2}, {0x6040, 2}, {0x6041, 2}, {0x605a, 2},
    {0x605b, 2}, {0x605c, 2}, {0x605d, 2}, {0x605e, 2}, {0x6060, 1}, {0x6061, 1}, {0x6062, 4}, {0x6063, 4},
    {0x6064, 4}, {0x6065, 4}, {0x6066, 2}, {0x6067, 4}, {0x6068, 2}, {0x606c, 4}, {0x6071, 2}, {0x6072, 2},
    {0x6077, 2}, {0x607a, 4}, {0x607c, 4}, {0x6081, 4}, {0x6083, 4}, {0x6084, 4}, {0x6085, 4}, {0x6098, 1},
    {0x609a, 4}, {0x60f4, 4}, {0x60ff, 4}, {0x6502, 4}};

class Objects : public ::testing::Test {
 protected:
  explicit Objects(const std::vector<std::string>& settings = {}, bool allowed = true)
      : folder(std::filesystem::temp_directory_path() / ("stiction-objects-" + std::to_string(::getpid()))),
        table(settings, allowed) {
    std::filesystem::create_directories(folder);
    make({.file = folder / "parameters"});
  }
  ~Objects() override { std::filesystem::remove_all(folder); }

  void make(drive::KeptParameters kept) {
    desk =
        std::make_shared<drive::ParameterDesk>(table.configuration.machine, table.configuration.setup, std::move(kept));
    server = std::make_unique<drive::ObjectServer>(table.configuration, drive::can_server_config(table.configuration),
                                                   desk, table.frames.links(), [this] { return is_stale; });
  }
  // As the drive's loop does.
  void cycles(int count) {
    for (int i = 0; i < count; ++i) {
      server->loop().take_motion([&](const drive::MotionWrite& write) {
        drive::ask(write, period(), table.programme.remote()[write.axis], CommandSource::can);
      });
      table.cycle();
      table.frames.node(0).step(table.loop.now_ns(), table.loop.fault(0), [](const hal::can::Frame&) {});
      drive::show_to_clients(table.loop, table.programme, period(), *server);
    }
  }
  double period() const { return table.configuration.machine.timing.fast_period; }
  std::string said() {
    std::string lines;
    for (const auto& line : desk->said().take(now_ns += 2'000'000'000)) lines += line + "\n";
    return lines;
  }
  // In csp an axis wants a target each cycle, which SDO does not give.
  bool enable() {
    EXPECT_EQ(client.set(0x6060, 0, 1, 1), 0u);
    for (const int word : {6, 7, 15}) {
      EXPECT_EQ(client.set(0x6040, 0, word, 2), 0u);
      cycles(20);
    }
    return (client.number(0x6041) & 0x6f) == 0x27;
  }

  std::filesystem::path folder;
  bool is_stale = false;
  std::int64_t now_ns = 0;
  ServedTable table;
  std::shared_ptr<drive::ParameterDesk> desk;
  std::unique_ptr<drive::ObjectServer> server;
  SdoClient client{1, [this](const hal::can::Frame& frame) { return server->answer(frame, now_ns); }};
};

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
  // pp, pv, homing, csp, csv, cst: bits 0, 2, 5, 7, 8, 9.
  EXPECT_EQ(client.number(0x6502), 0x3a5u);
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

class ObjectsOfLimits : public Objects {
 protected:
  ObjectsOfLimits() : Objects({"axis.*.supervision.following_error=2 mm"}) {}
};
TEST_F(ObjectsOfLimits, AreRefusedWithoutTheWindowAndNeverLoosened) {
  cycles(1);
  struct Row {
    unsigned index, sub;
    std::size_t size;
    std::int64_t looser, tighter;
  };
  const std::vector<Row> limits{{0x6065, 0, 4, 2'000'001, 1'999'999},
                                {0x607d, 1, 4, -250'000'001, -249'999'999},
                                {0x607d, 2, 4, 250'000'001, 249'999'999},
                                {0x6085, 0, 4, 9'999'999, 10'000'001},
                                {0x6066, 0, 2, 1, 0}};
  const std::vector<Row> others{
      {0x6067, 0, 4, 20'000, 0}, {0x607c, 0, 4, 5'000, 0}, {0x6099, 1, 4, 30'000, 0}, {0x6099, 2, 4, 3'000, 0}};
  int refused = 0, tried = 0;
  const auto expect = [&](std::uint32_t found, std::uint32_t wanted) {
    EXPECT_EQ(found, wanted);
    ++tried;
    refused += found != 0 ? 1 : 0;
  };
  for (const auto& row : limits) {
    expect(client.set(row.index, row.sub, row.looser, row.size), 0x08000021u);
    expect(client.set(row.index, row.sub, row.tighter, row.size), 0x08000021u);
  }
  for (const auto& row : others) expect(client.set(row.index, row.sub, row.looser, row.size), 0x08000021u);
  expect(client.set(0x1010, 1, 0x65766173, 4), 0x08000021u);
  EXPECT_TRUE(desk->registers().written().values.empty());
  EXPECT_THAT(said(), ::testing::HasSubstr("CAN: axis.X.supervision.following_error is refused: the commissioning "
                                           "window is closed"));
  desk->open_commissioning();
  for (const auto& row : limits) expect(client.set(row.index, row.sub, row.looser, row.size), 0x06090030u);
  EXPECT_TRUE(desk->registers().written().values.empty());
  EXPECT_THAT(said(), ::testing::HasSubstr("over a bus limits are only made tighter"));
  EXPECT_EQ(refused, tried);
  figure("writes over SDO without the window, and limits loosened in it: refused",
         fmt::format("{} of {} (bound all)", refused, tried));
  // What is read may be written back: it is no looser.
  for (const auto& row : limits) {
    EXPECT_EQ(client.set(row.index, row.sub, client.number(row.index, row.sub), row.size), 0u) << std::hex << row.index;
    EXPECT_EQ(client.set(row.index, row.sub, row.tighter, row.size), 0u) << std::hex << row.index;
  }
  for (const auto& row : others) {
    EXPECT_EQ(client.set(row.index, row.sub, row.looser, row.size), 0u);
    EXPECT_EQ(client.number(row.index, row.sub), row.looser);
  }
  EXPECT_EQ(desk->registers().written().values.at("axis.X.supervision.following_error"), 1'999'999e-9);
  desk->close_commissioning();
  EXPECT_EQ(client.set(0x6067, 0, 10'000, 4), 0x08000021u);
}

// The limit in force is shown where the machine file leaves it out, but cannot be judged.
TEST_F(Objects, OfALimitThatTheFileLeavesOutAreReadAndNotWritten) {
  cycles(1);
  desk->open_commissioning();
  EXPECT_EQ(client.number(0x6065), 2'000'000u);
  EXPECT_EQ(client.set(0x6065, 0, 1'000'000, 4), 0x06090030u);
  EXPECT_THAT(said(), ::testing::HasSubstr("expected a value in the machine file first"));
}

TEST_F(Objects, AreStoredByTheirSignatureAlone) {
  cycles(1);
  EXPECT_EQ(client.number(0x1010, 1), 1u);
  desk->open_commissioning();
  EXPECT_EQ(client.set(0x6067, 0, 20'000, 4), 0u);
  EXPECT_EQ(client.set(0x1010, 1, 0x64616f6c, 4), 0x08000020u) << "\"load\"";
  EXPECT_EQ(client.set(0x1010, 1, 0x65766173, 4), SdoClient::no_answer) << "when the disk has it";
  std::optional<hal::can::Frame> answer;
  ASSERT_TRUE(comes_true([&] {
    server->poll(now_ns, [&](const hal::can::Frame& frame) { answer = frame; });
    return answer.has_value();
  }));
  EXPECT_EQ(answer->data[0], 0x60);
  const auto stored = drive::read_parameters(folder / "parameters");
  ASSERT_TRUE(stored);
  EXPECT_EQ(stored->values, (std::map<std::string, double>{{"drive.axis.X.target_window", 20e-6}}));
}

TEST_F(Objects, AreNotStoredWhereAStartWouldRefuseThemOrWithoutAFolder) {
  make({.file = folder / "parameters", .check = [](const ParameterSet&) { throw std::runtime_error("refused"); }});
  desk->open_commissioning();
  cycles(1);
  EXPECT_EQ(client.set(0x6067, 0, 20'000, 4), 0u);
  EXPECT_EQ(client.set(0x1010, 1, 0x65766173, 4), SdoClient::no_answer);
  std::optional<hal::can::Frame> answer;
  ASSERT_TRUE(comes_true([&] {
    server->poll(now_ns, [&](const hal::can::Frame& frame) { answer = frame; });
    return answer.has_value();
  }));
  EXPECT_EQ(answer->data[0], 0x80);
  EXPECT_EQ(answer->data[7] << 24 | answer->data[4], 0x08000020);
  EXPECT_EQ(client.number(0x6067), 10'000u) << "taken back";
  EXPECT_FALSE(std::filesystem::exists(folder / "parameters"));
  make({});
  desk->open_commissioning();
  EXPECT_EQ(client.set(0x1010, 1, 0x65766173, 4), 0x08000020u);
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

// One table: the page and the data sheet are printed from it.
std::string text_of(const std::string& file) {
  std::ifstream stream(std::string(STICTION_SOURCE_DIR) + "/" + file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(ObjectPage, IsCurrent) {
  EXPECT_TRUE(text_of("docs/canopen_objects.md") == drive::object_page())
      << "docs/canopen_objects.md is a different one; print it with: stictiond --canopen-objects";
}

// Read as an INI file (CiA 306): every section and what it says of type and access against the server.
TEST_F(Objects, AreThoseOfTheDataSheet) {
  cycles(1);
  std::map<std::string, std::map<std::string, std::string>> sheet;
  std::istringstream lines(drive::eds_text());
  std::string section;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) continue;
    if (line.front() == '[') {
      section = line.substr(1, line.size() - 2);
      EXPECT_FALSE(sheet.contains(section)) << section;
      sheet[section];
      continue;
    }
    const auto equals = line.find('=');
    ASSERT_NE(equals, std::string::npos) << line;
    sheet[section][line.substr(0, equals)] = line.substr(equals + 1);
  }
  for (const char* needed : {"FileInfo", "DeviceInfo", "MandatoryObjects", "OptionalObjects", "ManufacturerObjects"})
    EXPECT_TRUE(sheet.contains(needed)) << needed;
  std::set<std::string> listed;
  for (const char* list : {"MandatoryObjects", "OptionalObjects"}) {
    const auto& rows = sheet[list];
    for (int i = 1; i <= std::stoi(rows.at("SupportedObjects")); ++i)
      listed.insert(rows.at(std::to_string(i)).substr(2));
  }
  EXPECT_EQ(sheet["MandatoryObjects"]["SupportedObjects"], "3") << "1000h, 1001h, 1018h";
  const std::map<std::string, std::size_t> bytes{{"0x0002", 1}, {"0x0003", 2}, {"0x0004", 4},
                                                 {"0x0005", 1}, {"0x0006", 2}, {"0x0007", 4}};
  int compared = 0;
  for (const auto& index : listed) {
    ASSERT_TRUE(sheet.contains(index)) << index;
    const auto number = static_cast<unsigned>(std::stoul(index, nullptr, 16));
    const bool record = sheet[index].contains("SubNumber");
    for (unsigned sub = 0; sub < (record ? std::stoul(sheet[index]["SubNumber"]) : 1); ++sub) {
      const auto& row = record ? sheet.at(index + fmt::format("sub{:X}", sub)) : sheet.at(index);
      const auto found = client.upload(number, sub);
      const auto* value = std::get_if<SdoClient::Bytes>(&found);
      if (value == nullptr) {
        EXPECT_EQ(std::get<std::uint32_t>(found), 0x08000024u) << index;
        continue;
      }
      if (const auto size = bytes.find(row.at("DataType")); size != bytes.end()) {
        EXPECT_EQ(value->size(), size->second) << index;
      }
      const bool writable = client.set(number, sub, 0, 4) != 0x06010002u;
      EXPECT_EQ(writable, row.at("AccessType") == "rw") << index;
      ++compared;
    }
  }
  EXPECT_EQ(compared, 68 - 8) << "all but the empty history";
}

}  // namespace
}  // namespace stiction::test
