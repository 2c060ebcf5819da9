// The drive's Modbus server as a whole: the state of a loop on a client's screen, a client's parameters on the disk.
#include "firmware/stictiond/modbus_publisher.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "firmware/machine/file/drive_file.hpp"
#include "firmware/stictiond/configuration.hpp"
#include "firmware/stictiond/modbus_setup.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/hal/modbus_support.hpp"
#include "tests/support/figure.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

const std::string machine_file = std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml";

machine::DriveSetup setup_with(bool motion_allowed) {
  auto setup = machine::read_drive_setup(machine_file, cross_table());
  setup.modbus_server.emplace();
  setup.modbus_server->address = "127.0.0.1:0";
  setup.modbus_server->motion_allowed = motion_allowed;
  return setup;
}

class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / ("stiction-publisher-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

std::vector<std::string> lines_of(drive::ModbusPublisher& publisher) {
  std::vector<std::string> lines;
  comes_true([&] {
    lines = publisher.serve();
    return !lines.empty();
  });
  return lines;
}

std::vector<drive::MotionWrite> motions_of(drive::ModbusPublisher& publisher) {
  std::vector<drive::MotionWrite> motions;
  publisher.take_motion([&](const drive::MotionWrite& write) { motions.push_back(write); });
  return motions;
}

TEST(ModbusPublisher, ShowsTheLoopsStateToAClient) {
  drive::ModbusPublisher publisher(cross_table(), setup_with(false), {},
                                   [](drive::PublishedState& state) { state.missed_deadlines = 3; });
  std::array<AxisSignals<FixedSignals>, 2> signals{};
  const auto status = [](std::size_t axis, drive::PublishedAxis& shown) {
    shown.statusword = axis == 0 ? 0x1237 : 0x0218;
    shown.position = axis == 0 ? 0.0 : 0.25;
  };
  signals[1].i = FixedSignals::Current::from_raw(-(3 << 20));  // -3 A
  publisher.publish<FixedSignals>(signals, 5'000'000'000, Fault::none, status);
  signals[1].i = FixedSignals::Current::from_raw(1 << 20);
  publisher.publish<FixedSignals>(signals, 7'500'000'000, Fault::bus_off, status);

  const RawClient client(publisher.server().port());
  const auto read = [&](std::uint8_t address, int words) {
    client.send(request({4, 0, address, 0, static_cast<std::uint8_t>(words)}));
    const auto answer = client.receive();
    std::vector<std::uint16_t> found;
    for (std::size_t at = 9; at + 1 < answer.size(); at += 2)
      found.push_back(static_cast<std::uint16_t>(answer[at] << 8 | answer[at + 1]));
    return found;
  };
  EXPECT_EQ(read(0, 8), (std::vector<std::uint16_t>{0x5344, 5, 2, 34, 0, 2, 0, 3}));
  EXPECT_EQ(read(100, 1), (std::vector<std::uint16_t>{0x1237}));
  const auto second = read(200, 20);
  ASSERT_EQ(second.size(), 20U);
  EXPECT_EQ(second[0], 0x0218);
  const auto number = [&](hal::RegisterType type, std::size_t at) {
    return hal::number_in(type, std::span(second).subspan(at));
  };
  EXPECT_EQ(number(hal::RegisterType::int32, 4), 25e6);    // 10 nm each
  EXPECT_EQ(number(hal::RegisterType::float32, 10), 1.0);  // current
  EXPECT_EQ(number(hal::RegisterType::float32, 16), 3.0);  // its peak
  EXPECT_NEAR(number(hal::RegisterType::float32, 18), std::sqrt(5.0), 1e-6);
}

TEST(ModbusPublisher, KeepsAParameterThatAClientWritesAndStores) {
  const Folder folder;
  drive::ModbusPublisher publisher(cross_table(), setup_with(false), {folder / "parameters", {}, {}});
  publisher.open_commissioning();
  EXPECT_EQ(lines_of(publisher), (std::vector<std::string>{"clients may write parameters for 900 s"}));
  const RawClient client(publisher.server().port());
  // 550 at 1004 (0x3ec), the velocity gain of the first axis; then "store".
  client.send(request({16, 3, 0xec, 0, 2, 4, 0x44, 0x09, 0x80, 0}));
  EXPECT_EQ(client.receive().size(), 12U);
  EXPECT_EQ(
      lines_of(publisher),
      (std::vector<std::string>{
          "Modbus: axis.X.velocity_controller.gain = 550, which takes effect at the next start if it is stored"}));
  client.send(request({6, 0, 0, 0x53, 0x54}));
  EXPECT_EQ(client.receive().size(), 12U);
  EXPECT_EQ(lines_of(publisher),
            (std::vector<std::string>{"Modbus: parameters stored in " + (folder / "parameters").string()}));
  const auto stored = drive::read_parameters(folder / "parameters");
  ASSERT_TRUE(stored);
  EXPECT_EQ(stored->values, (std::map<std::string, double>{{"axis.X.velocity_controller.gain", 550.0}}));
}

// What a client may do to parameters: nothing, until an operator opens the window; never to loosen a limit.
class WrittenParameters : public ::testing::Test {
 protected:
  static constexpr std::uint16_t gain = 1004;

  static std::vector<std::uint8_t> float_request(std::uint16_t address, float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    std::vector<std::uint8_t> pdu{16, static_cast<std::uint8_t>(address >> 8), static_cast<std::uint8_t>(address), 0, 2,
                                  4};
    for (int shift = 24; shift >= 0; shift -= 8) pdu.push_back(static_cast<std::uint8_t>(bits >> shift));
    return request(pdu);
  }
  static std::uint16_t address_of(const drive::ModbusPublisher& publisher, const std::string& name) {
    for (const auto& r : publisher.server().map().registers())
      if (r.name == name) return r.address;
    ADD_FAILURE() << name;
    return 0;
  }
  // The exception's code; 0: done.
  static int ask(const RawClient& client, const std::vector<std::uint8_t>& bytes) {
    client.send(bytes);
    const auto answer = client.receive();
    return answer.size() == 9 ? int{answer[8]} : 0;
  }
  static int read(const RawClient& client, std::uint8_t address) {
    client.send(request({4, 0, address, 0, 1}));
    const auto answer = client.receive();
    return answer.size() == 11 ? answer[9] << 8 | answer[10] : -1;
  }
  static std::vector<std::uint8_t> store() { return request({6, 0, 0, 0x53, 0x54}); }
  static machine::DriveSetup short_window(double seconds) {
    auto setup = setup_with(false);
    setup.modbus_server->commissioning_time = seconds;
    return setup;
  }
};

TEST_F(WrittenParameters, AreRefusedWhileTheWindowIsClosedAndNothingIsStored) {
  const Folder folder;
  drive::ModbusPublisher publisher(cross_table(), short_window(0.3), {folder / "parameters", {}, {}});
  const RawClient client(publisher.server().port());
  int refused = 0, tried = 0;
  const auto expect_refused = [&](int answer, const std::string& name) {
    EXPECT_EQ(answer, 1) << name;
    ++tried;
    refused += answer == 1 ? 1 : 0;
  };
  for (const auto& r : publisher.server().map().registers()) {
    if (r.access != hal::RegisterAccess::write || r.address == 0) continue;
    expect_refused(ask(client, float_request(r.address, 0.005F)), r.name);
  }
  expect_refused(ask(client, store()), "store");
  figure("writes of parameters over Modbus without the window: refused",
         fmt::format("{} of {} (bound all)", refused, tried));
  const auto lines = lines_of(publisher);
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines[0].find("the commissioning window is closed"), std::string::npos) << lines[0];
  // Opened, it closes by itself; or at once.
  publisher.open_commissioning();
  EXPECT_EQ(read(client, 17), 1) << "seconds left, rounded up";
  EXPECT_EQ(ask(client, float_request(gain, 550.0F)), 0);
  EXPECT_TRUE(comes_true([&] { return read(client, 17) == 0; }));
  EXPECT_EQ(ask(client, float_request(gain, 551.0F)), 1);
  publisher.open_commissioning();
  publisher.close_commissioning();
  EXPECT_EQ(ask(client, float_request(gain, 551.0F)), 1);
  EXPECT_EQ(ask(client, store()), 1);
  EXPECT_FALSE(std::filesystem::exists(folder / "parameters"));
}

// Each limit of the table by the least that a float shows, and to what is far off.
TEST_F(WrittenParameters, LoosenNoLimitOfTheTable) {
  drive::ModbusPublisher publisher(cross_table(), setup_with(false), {});
  publisher.open_commissioning();
  const RawClient client(publisher.server().port());
  int refused = 0, tried = 0;
  for (const auto& parameter : drive::drive_parameters(cross_table(), setup_with(false))) {
    const auto limit =
        std::find_if(drive::limit_parameters.begin(), drive::limit_parameters.end(),
                     [&](const auto& row) { return parameter.key.ends_with("." + std::string(row.key)); });
    if (limit == drive::limit_parameters.end()) continue;
    const double sign = limit->tightens == drive::Tightens::down ? 1.0 : -1.0;
    const double value = parameter.value.value_or(1.0);
    for (const double by : {std::max(1e-6 * std::abs(value), 1e-6), 0.5 * std::abs(value) + 1e-3}) {
      const int answer =
          ask(client, float_request(address_of(publisher, parameter.key), static_cast<float>(value + sign * by)));
      EXPECT_EQ(answer, 3) << parameter.key << " " << value + sign * by;
      ++tried;
      refused += answer == 3 ? 1 : 0;
    }
  }
  EXPECT_GE(tried, 60);
  figure("limits loosened over Modbus in the window: refused", fmt::format("{} of {} (bound all)", refused, tried));
}

TEST_F(WrittenParameters, LoosenNoLimit) {
  drive::ModbusPublisher publisher(cross_table(), setup_with(false), {});
  publisher.open_commissioning();
  const RawClient client(publisher.server().port());
  const auto deceleration = address_of(publisher, "drive.axis.X.quick_stop_deceleration");
  EXPECT_EQ(ask(client, float_request(deceleration, 9.9F)), 3);
  EXPECT_EQ(ask(client, float_request(deceleration, 12.0F)), 0);
  EXPECT_EQ(ask(client, float_request(address_of(publisher, "axis.X.supervision.following_error"), 0.001F)), 3);
  std::string said;
  for (const auto& line : lines_of(publisher)) said += line + "\n";
  EXPECT_NE(said.find("expected at least 10 m/s^2, the limit in force"), std::string::npos) << said;
}

// A value that would refuse a start is told so, harms no later set, and leaves what was stored.
TEST_F(WrittenParameters, ThatWouldRefuseAStartAreNotStoredAndHarmNothingElse) {
  const Folder folder;
  drive::DriveOptions options;
  options.machine = machine_file;
  drive::ModbusPublisher publisher(
      cross_table(), setup_with(false),
      {folder / "parameters", [options](const drive::ParameterSet& set) { drive::check_whole(options, set); }, {}});
  publisher.open_commissioning();
  const RawClient client(publisher.server().port());
  // Above half of the fast loop's rate; slower than the number format resolves; the ends the wrong way round.
  const std::array<std::pair<const char*, float>, 3> bad{{{"axis.X.notch.frequency", 9000.0F},
                                                          {"drive.axis.X.homing.creep_speed", 1e-9F},
                                                          {"drive.axis.X.negative_end", 0.4F}}};
  EXPECT_EQ(read(client, 18), 0);
  std::size_t stored = 0;
  for (const auto& [key, value] : bad) {
    SCOPED_TRACE(key);
    EXPECT_EQ(ask(client, float_request(address_of(publisher, key), value)), 0);
    EXPECT_EQ(ask(client, store()), 4);
    EXPECT_EQ(read(client, 18), 3);
    const auto kept = drive::read_parameters(folder / "parameters");
    stored += kept && kept->values.contains(key) ? 1u : 0u;
    EXPECT_EQ(ask(client, float_request(gain, 550.0F)), 0);
    EXPECT_EQ(ask(client, store()), 0) << "a later set";
    EXPECT_EQ(read(client, 18), 1);
    EXPECT_EQ(drive::read_parameters(folder / "parameters")->values,
              (std::map<std::string, double>{{"axis.X.velocity_controller.gain", 550.0}}));
  }
  figure("sets that a start would refuse: stored", fmt::format("{} of {} (bound 0)", stored, bad.size()));
  // A disk that does not take it is told so, and the values are kept for the next time.
  std::filesystem::create_directory(folder / "parameters.new");
  EXPECT_EQ(ask(client, float_request(gain, 560.0F)), 0);
  EXPECT_EQ(ask(client, store()), 4);
  EXPECT_EQ(read(client, 18), 4);
  std::filesystem::remove(folder / "parameters.new");
  EXPECT_EQ(ask(client, store()), 0);
  EXPECT_EQ(drive::read_parameters(folder / "parameters")->values.at("axis.X.velocity_controller.gain"), 560.0);
}

TEST(ModbusPublisher, HandsMotionToTheLoopOnlyWhereItIsAllowed) {
  for (const bool allowed : {false, true}) {
    drive::ModbusPublisher publisher(cross_table(), setup_with(allowed), {});
    const RawClient client(publisher.server().port());
    client.send(request({6, 0, 200, 0, 15}));  // controlword of the second axis
    EXPECT_EQ(client.receive().size(), allowed ? 12U : 9U);
    if (!allowed) {
      EXPECT_TRUE(publisher.serve().empty());
      EXPECT_TRUE(motions_of(publisher).empty());
      continue;
    }
    EXPECT_EQ(lines_of(publisher), (std::vector<std::string>{"Modbus: axis Y: controlword 15"}));
    const auto motions = motions_of(publisher);
    ASSERT_EQ(motions.size(), 1U);
    EXPECT_EQ(motions[0].axis, 1U);
    EXPECT_EQ(motions[0].value, 15.0);
    client.send(request({6, 0, 201, 0, 7}));  // a mode that the drive does not have
    const auto answer = client.receive();
    ASSERT_EQ(answer.size(), 9U);
    EXPECT_EQ(answer[8], 3);
  }
}

// The loop takes a stop in its next tick, after 10 000 requests of parameters as before the first.
TEST(ModbusPublisher, HandsAStopOverWhateverElseIsWritten) {
  drive::ModbusPublisher publisher(cross_table(), setup_with(true), {});
  publisher.open_commissioning();
  const RawClient flooding(publisher.server().port()), stopping(publisher.server().port());
  int busy = 0;
  for (int i = 0; i < 10'000; ++i) {
    flooding.send(request({16, 3, 0xec, 0, 2, 4, 0x44, 0x09, 0x80, 0}));
    busy += flooding.receive().size() == 9 ? 1 : 0;
    if (i % 10 != 0) continue;
    stopping.send(request({6, 0, 100, 0, static_cast<std::uint8_t>(i % 20 == 0 ? 15 : 6)}));
    ASSERT_EQ(stopping.receive().size(), 12U);
    const auto motions = motions_of(publisher);
    ASSERT_EQ(motions.size(), 1U);
    EXPECT_EQ(motions[0].value, i % 20 == 0 ? 15.0 : 6.0);
  }
  EXPECT_GT(busy, 0);  // parameters were limited
  EXPECT_LT(busy, 10'000 - 256 + 1);
}

// An axis that CAN commands takes a stop over Modbus and nothing else.
TEST(ModbusPublisher, RefusesWhatAnOwnerOnADifferentBusHasToSay) {
  drive::ModbusPublisher publisher(cross_table(), setup_with(true), {});
  std::array<AxisSignals<FixedSignals>, 2> signals{};
  publisher.publish<FixedSignals>(signals, 0, Fault::none, [](std::size_t axis, drive::PublishedAxis& shown) {
    shown.owner = axis == 0 ? CommandSource::can : CommandSource::modbus;
    shown.owner_token = 7;
  });
  const RawClient client(publisher.server().port());
  const auto code_of = [&](std::uint8_t address, std::uint8_t value) {
    client.send(request({6, 0, address, 0, value}));
    const auto answer = client.receive();
    return answer.size() == 9 ? int{answer[8]} : 0;
  };
  for (const int stop : {0, 2, 6, 7}) EXPECT_EQ(code_of(100, static_cast<std::uint8_t>(stop)), 0);
  EXPECT_EQ(code_of(100, 15), 6);
  EXPECT_EQ(code_of(101, 1), 6);
  EXPECT_EQ(code_of(200, 15), 0);
  client.send(request({4, 0, 121, 0, 2}));
  const auto answer = client.receive();
  ASSERT_EQ(answer.size(), 13U);
  EXPECT_EQ(answer[10], 1);  // CAN
  EXPECT_EQ(answer[12], 7);
}

// A state that is no longer true is a fault, and no command is answered "done" that the loop does not take.
TEST(ModbusPublisher, ShowsALoopThatMakesNoProgressAsFault51) {
  std::atomic<bool> stale{false};
  drive::ModbusPublisher publisher(cross_table(), setup_with(true), {}, {}, [&] { return stale.load(); });
  std::array<AxisSignals<FixedSignals>, 2> signals{};
  publisher.publish<FixedSignals>(signals, 0, Fault::none,
                                  [](std::size_t, drive::PublishedAxis& shown) { shown.statusword = 0x1237; });
  const RawClient client(publisher.server().port());
  const auto word = [&](std::uint8_t address) {
    client.send(request({4, 0, address, 0, 1}));
    const auto answer = client.receive();
    return answer.size() == 11 ? answer[9] << 8 | answer[10] : -1;
  };
  EXPECT_EQ(word(100), 0x1237);
  stale = true;
  EXPECT_EQ(word(3), 51);
  EXPECT_EQ(word(100), 0x1208);
  EXPECT_EQ(word(202), 51);
  client.send(request({6, 0, 100, 0, 0}));
  const auto answer = client.receive();
  ASSERT_EQ(answer.size(), 9U);
  EXPECT_EQ(answer[8], 4);
}

TEST(ModbusSetup, TakesTheUnitsOfTheAxesFromTheirNodes) {
  const auto machine = cross_table();
  auto setup = setup_with(false);
  setup.modbus_client.emplace();
  setup.modbus_client->device = "10.0.0.2:502";
  for (auto& [name, axis] : setup.axes) axis.node = 0;
  EXPECT_THROW(drive::modbus_client_config(machine, setup), hal::ModbusError);  // no unit
  setup.axes.at("X").node = 3;
  setup.axes.at("Y").node = 3;
  EXPECT_THROW(drive::modbus_client_config(machine, setup), hal::ModbusError);  // the same twice
  setup.axes.at("Y").node = 4;
  const auto config = drive::modbus_client_config(machine, setup);
  EXPECT_EQ(config.units, (std::vector<int>{3, 4}));
  // Two units each 10 ms are 200 exchanges a second.
  EXPECT_THROW(hal::check(drive::modbus_client_budget(config)), hal::BusBudgetError);
}

}  // namespace
}  // namespace stiction::test
