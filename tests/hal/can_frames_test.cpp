// What crosses a CAN bus: the same state on both sides, and nothing that was changed on the way.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <random>
#include <regex>
#include <sstream>
#include <string>

#include "firmware/machine/configuration/conversion.hpp"
#include "hal/can/dbc.hpp"
#include "hal/can/frames.hpp"
#include "hal/can/network.hpp"
#include "hal/can/process_data.hpp"
#include "stiction/number/crc.hpp"

namespace stiction::hal::can {
namespace {

using S = FixedSignals;

constexpr std::array formats{Format::classical, Format::fd};

NodeFeedback random_state(std::mt19937_64& random, double largest_current, double largest_position) {
  const auto within = [&](double largest) { return std::uniform_real_distribution(-largest, largest)(random); };
  NodeFeedback state;
  auto& f = state.feedback;
  EXPECT_TRUE(machine::convert(within(largest_position), f.position));
  EXPECT_TRUE(machine::convert(within(7.0), f.velocity));
  for (auto& current : f.current) EXPECT_TRUE(machine::convert(within(largest_current), current));
  EXPECT_TRUE(machine::convert(within(largest_position), state.inputs.index_position));
  f.position_time_ns = -std::uniform_int_distribution<std::int64_t>(0, 60000)(random);
  f.position_valid = (random() & 1) != 0;
  f.fault = (random() & 1) != 0;
  state.inputs.limit_negative = (random() & 1) != 0;
  state.inputs.limit_positive = (random() & 1) != 0;
  state.inputs.home = (random() & 1) != 0;
  state.inputs.index = (random() & 1) != 0;
  state.inputs.hall = static_cast<std::uint8_t>(random() & 7);
  auto& p = state.protection;
  EXPECT_TRUE(machine::convert(within(1500.0), p.dc_link));
  // A platinum sensor and its broken wire.
  p.motor_temperature = static_cast<std::int16_t>(within(4000.0));
  p.stage_temperature = static_cast<std::int16_t>(within(4000.0));
  p.torque_off_a = (random() & 1) != 0;
  p.torque_off_b = (random() & 1) != 0;
  state.motor_signals = {.hall = (random() & 1) != 0,
                         .dc_link = (random() & 1) != 0,
                         .motor_temperature = (random() & 1) != 0,
                         .stage_temperature = (random() & 1) != 0,
                         .torque_off = (random() & 1) != 0};
  return state;
}

// Every frame of a state, decoded into another one.
NodeFeedback through_the_bus(Format format, const NodeFeedback& state, std::uint32_t tick) {
  std::array<Frame, 2> frames;
  const auto count = encode_feedback(format, 5, tick, state, std::span<Frame, 2>(frames));
  EXPECT_EQ(count, properties(format).feedback_frames);
  NodeFeedback found;
  for (std::size_t i = 0; i < count; ++i) {
    const auto address = address_of(frames[i], format);
    EXPECT_EQ(address.node, 5);
    std::uint32_t counter = 0;
    EXPECT_TRUE(decode_feedback(format, address.kind, frames[i], counter, found));
    EXPECT_EQ(counter, tick & properties(format).counter_mask);
  }
  return found;
}

void expect_same_flags(const NodeFeedback& found, const NodeFeedback& sent) {
  EXPECT_EQ(found.feedback.position_valid, sent.feedback.position_valid);
  EXPECT_EQ(found.feedback.fault, sent.feedback.fault);
  EXPECT_EQ(found.inputs.limit_negative, sent.inputs.limit_negative);
  EXPECT_EQ(found.inputs.limit_positive, sent.inputs.limit_positive);
  EXPECT_EQ(found.inputs.home, sent.inputs.home);
  EXPECT_EQ(found.inputs.index, sent.inputs.index);
  EXPECT_EQ(found.protection.torque_off_a, sent.protection.torque_off_a);
  EXPECT_EQ(found.protection.torque_off_b, sent.protection.torque_off_b);
}

TEST(CanFrames, OfCanFdCarryTheControlsIntegers) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 1000; ++i) {
    const auto sent = random_state(random, 2000.0, 2e6);
    const auto found = through_the_bus(Format::fd, sent, static_cast<std::uint32_t>(random()));
    EXPECT_EQ(found.feedback.position, sent.feedback.position);
    EXPECT_EQ(found.feedback.velocity, sent.feedback.velocity);
    EXPECT_EQ(found.feedback.current, sent.feedback.current);
    EXPECT_EQ(found.feedback.position_time_ns, sent.feedback.position_time_ns);
    EXPECT_EQ(found.inputs.index_position, sent.inputs.index_position);
    EXPECT_EQ(found.inputs.hall, sent.inputs.hall);
    EXPECT_EQ(found.protection.dc_link, sent.protection.dc_link);
    EXPECT_EQ(found.protection.motor_temperature, sent.protection.motor_temperature);
    EXPECT_EQ(found.protection.stage_temperature, sent.protection.stage_temperature);
    EXPECT_EQ(found.motor_signals, sent.motor_signals);
    expect_same_flags(found, sent);
  }
}

TEST(CanFrames, ClassicalOnesRoundToTheirResolution) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 1000; ++i) {
    const auto sent = random_state(random, 127.0, 1000.0);
    const auto found = through_the_bus(Format::classical, sent, static_cast<std::uint32_t>(random()));
    EXPECT_NEAR(machine::to_si(found.feedback.position), machine::to_si(sent.feedback.position), std::ldexp(0.5, -32));
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(machine::to_si(found.feedback.current[k]), machine::to_si(sent.feedback.current[k]),
                  std::ldexp(0.5, -8));
    EXPECT_EQ(found.motor_signals, (MotorSignalSet{.torque_off = true}));
    expect_same_flags(found, sent);
  }
}

TEST(CanFrames, HoldADcLinkAndATemperatureBeyondTheirRangeAtItsEnd) {
  NodeFeedback sent;
  ASSERT_TRUE(machine::convert(4000.0, sent.protection.dc_link));
  sent.protection.motor_temperature = 30'000;
  sent.protection.stage_temperature = -30'000;
  const auto found = through_the_bus(Format::fd, sent, 0);
  EXPECT_NEAR(machine::to_si(found.protection.dc_link), 2048.0, 0.01);
  EXPECT_EQ(found.protection.motor_temperature, 4095);
  EXPECT_EQ(found.protection.stage_temperature, -4096);
}

TEST(CanFrames, ClassicalOnesHoldWhatIsBeyondTheirRangeAtItsEnd) {
  NodeFeedback sent;
  ASSERT_TRUE(machine::convert(1000.0, sent.feedback.current[0]));
  ASSERT_TRUE(machine::convert(-1000.0, sent.feedback.current[1]));
  const auto found = through_the_bus(Format::classical, sent, 0);
  EXPECT_NEAR(machine::to_si(found.feedback.current[0]), 128.0, 0.01);
  EXPECT_NEAR(machine::to_si(found.feedback.current[1]), -128.0, 0.01);
}

TEST(CanFrames, CommandsAndSyncComeThrough) {
  for (const auto format : formats) {
    Command<S> sent;
    sent.enable = true;
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_TRUE(machine::convert(100.0 * static_cast<double>(k) - 90.0, sent.voltage[k]));
    const Frame frame = encode_command(format, 9, 1234567, sent);
    const auto address = address_of(frame, format);
    EXPECT_EQ(address.kind, Kind::command);
    EXPECT_EQ(address.node, 9);
    Command<S> found;
    std::uint32_t counter = 0;
    ASSERT_TRUE(decode_command(format, frame, counter, found));
    EXPECT_EQ(counter, 1234567 & properties(format).counter_mask);
    EXPECT_TRUE(found.enable);
    EXPECT_EQ(found.voltage, sent.voltage) << "these fit the classical resolution too";
    std::uint32_t tick = 0;
    EXPECT_EQ(address_of(encode_sync(77), format).kind, Kind::sync);
    ASSERT_TRUE(decode_sync(encode_sync(0xFEDCBA98), tick));
    EXPECT_EQ(tick, 0xFEDCBA98);
  }
}

TEST(CanFrames, AnyOneOrTwoFlippedBitsAreSeen) {
  std::mt19937_64 random(3);
  std::uint64_t tried = 0;
  for (const auto format : formats) {
    std::array<Frame, 2> frames;
    const auto count = encode_feedback(format, 1, 99, random_state(random, 100.0, 1.0), std::span<Frame, 2>(frames));
    for (std::size_t i = 0; i < count; ++i) {
      const auto kind = address_of(frames[i], format).kind;
      const int bits = 8 * frames[i].size;
      for (int a = 0; a < bits; ++a)
        for (int b = a; b < bits; ++b) {
          Frame damaged = frames[i];
          damaged.data[static_cast<std::size_t>(a / 8)] ^= static_cast<std::uint8_t>(1 << (a % 8));
          if (b != a) damaged.data[static_cast<std::size_t>(b / 8)] ^= static_cast<std::uint8_t>(1 << (b % 8));
          std::uint32_t counter = 0;
          NodeFeedback state;
          ASSERT_FALSE(decode_feedback(format, kind, damaged, counter, state)) << "bits " << a << " and " << b;
          ++tried;
        }
    }
  }
  EXPECT_GT(tried, 70000u);
}

TEST(CanFrames, OfAnotherNodeAreNotTakenForThisOnes) {
  for (const auto format : formats) {
    Frame frame = encode_command(format, 1, 5, {});
    frame.id += 1;
    Command<S> command;
    std::uint32_t counter = 0;
    EXPECT_FALSE(decode_command(format, frame, counter, command)) << "the checksum covers the identifier";
  }
}

TEST(CanFrames, OfAnotherSizeOrFormatHaveNoAddress) {
  for (const auto format : formats) {
    Frame frame = encode_command(format, 1, 5, {});
    frame.size -= 1;
    EXPECT_EQ(address_of(frame, format).kind, Kind::unknown);
    frame.size += 1;
    frame.id |= 0x80000000u;  // a 29-bit identifier
    EXPECT_EQ(address_of(frame, format).kind, Kind::unknown);
  }
}

TEST(Crc, HasTheCheckValuesOfItsCatalogue) {
  const std::string digits = "123456789";
  EXPECT_EQ(Crc16().add(digits, digits.size()).value(), 0x29B1);
  EXPECT_EQ(Crc8().add(digits, digits.size()).value() ^ 0xFF, 0x4B) << "SAE J1850 inverts at the end";
}

// A reader of DBC that knows nothing of frames.cpp: signals by message, each with its bits and scale.
struct DbcSignal {
  int first = 0, bits = 0;
  bool is_signed = false;
  double scale = 0.0;
  double read(const Frame& frame) const {
    std::uint64_t raw = 0;
    for (int i = 0; i < bits; ++i) {
      const int bit = first + i;
      raw |= std::uint64_t{(frame.data[static_cast<std::size_t>(bit / 8)] >> (bit % 8)) & 1u} << i;
    }
    const int unused = 64 - bits;
    const auto value =
        is_signed ? static_cast<double>(static_cast<std::int64_t>(raw << unused) >> unused) : static_cast<double>(raw);
    return value * scale;
  }
};
std::map<std::uint32_t, std::map<std::string, DbcSignal>> parse_dbc(const std::string& text) {
  const std::regex message(R"(BO_ (\d+) (\w+): (\d+) (\w+))");
  const std::regex signal(R"( SG_ (\w+) : (\d+)\|(\d+)@1([+-]) \(([^,]+),0\) .*)");
  std::map<std::uint32_t, std::map<std::string, DbcSignal>> found;
  std::uint32_t id = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_match(line, match, message)) id = static_cast<std::uint32_t>(std::stoul(match[1]));
    if (std::regex_match(line, match, signal))
      found[id][match[1]] = {std::stoi(match[2]), std::stoi(match[3]), match[4] == "-", std::stod(match[5])};
  }
  return found;
}

TEST(ProcessData, IsReadAsItWasWrittenAndAsTheDbcDescribesIt) {
  constexpr double increment = 10e-9;
  const auto dbc = parse_dbc(dbc_text({}, {Format::classical, {{"X", 5}}}, increment));
  std::mt19937 random(7);
  for (int i = 0; i < 200; ++i) {
    ControllerData sent;
    sent.controlword = static_cast<std::uint16_t>(random());
    sent.mode = static_cast<std::int8_t>(random());
    sent.target = static_cast<std::int32_t>(random());
    sent.speed = static_cast<std::int32_t>(random());
    sent.velocity_offset = static_cast<std::int32_t>(random());
    sent.torque_offset = static_cast<std::int16_t>(random());
    sent.torque = static_cast<std::int16_t>(random());
    sent.most_torque = static_cast<std::uint16_t>(random());
    for (const auto& row : pdo_table) {
      if (!row.received) continue;
      const Frame frame = encode_pdo(row.pdo, 5, sent);
      const auto address = pdo_address_of(frame);
      EXPECT_EQ(address.verdict, PdoVerdict::good);
      EXPECT_EQ(address.pdo, row.pdo);
      EXPECT_EQ(address.node, 5);
      const auto found = decode_pdo(row.pdo, frame);
      const auto& signals = dbc.at(frame.id);
      if (row.pdo == Pdo::offsets) {
        EXPECT_EQ(found.velocity_offset, sent.velocity_offset);
        EXPECT_EQ(found.torque_offset, sent.torque_offset);
        EXPECT_NEAR(signals.at("torque_offset").read(frame), sent.torque_offset * 0.1, 1e-9);
        continue;
      }
      EXPECT_EQ(found.controlword, sent.controlword);
      EXPECT_EQ(signals.at("controlword").read(frame), sent.controlword);
      EXPECT_EQ(found.mode, row.pdo == Pdo::mode ? sent.mode : 0);
      EXPECT_EQ(found.speed, row.pdo == Pdo::speed ? sent.speed : 0);
      EXPECT_NEAR(row.pdo == Pdo::speed ? signals.at("target_velocity").read(frame) : 0.0,
                  found.speed * 1e3 * increment, 1e-9);
      EXPECT_EQ(found.torque, row.pdo == Pdo::torque ? sent.torque : 0);
      EXPECT_EQ(found.most_torque, row.pdo == Pdo::torque ? sent.most_torque : 0);
      EXPECT_NEAR(row.pdo == Pdo::torque ? signals.at("target_torque").read(frame) : 0.0, found.torque * 0.1, 1e-9);
      EXPECT_NEAR(row.pdo == Pdo::torque ? signals.at("max_torque").read(frame) : 0.0, found.most_torque * 0.1, 1e-9);
      if (row.pdo != Pdo::target) continue;
      EXPECT_EQ(found.target, sent.target);
      EXPECT_NEAR(signals.at("target_position").read(frame), sent.target * increment, 1e-12);
    }
    const Frame state = encode_position(5, sent.controlword, sent.target);
    EXPECT_NEAR(dbc.at(state.id).at("actual_position").read(state), sent.target * increment, 1e-12);
    EXPECT_EQ(state.size, 6);
    const Frame torque = encode_position(5, sent.controlword, sent.target, sent.torque_offset);
    EXPECT_EQ(torque.id, state.id);
    EXPECT_EQ(torque.size, 8);
    EXPECT_NEAR(dbc.at(torque.id).at("actual_position").read(torque), sent.target * increment, 1e-12);
    EXPECT_NEAR(dbc.at(torque.id).at("actual_torque").read(torque), sent.torque_offset * 0.1, 1e-9);
    EXPECT_EQ(pdo_address_of(torque).verdict, PdoVerdict::unknown) << "the drive's own";
    const Frame motion = encode_motion(5, sent.velocity_offset, sent.target);
    EXPECT_NEAR(dbc.at(motion.id).at("actual_velocity").read(motion), sent.velocity_offset * 1e3 * increment, 1e-9);
    EXPECT_EQ(pdo_address_of(motion).verdict, PdoVerdict::unknown) << "the drive's own";
  }
  for (std::uint8_t size = 0; size <= 8; ++size)
    for (const auto& row : pdo_table) {
      Frame frame{row.id() + 5, size, {}};
      const auto verdict = !row.received      ? PdoVerdict::unknown
                           : size == row.size ? PdoVerdict::good
                                              : PdoVerdict::wrong_size;
      EXPECT_EQ(pdo_address_of(frame).verdict, verdict);
      frame.id = row.id();
      EXPECT_EQ(pdo_address_of(frame).verdict, PdoVerdict::unknown) << "node 0";
    }
}

// CiA 301, 7.3.5: what a master's tools take for granted, whatever else a node sends.
TEST(Identifiers, AreThoseOfThePredefinedSetWhereItHasThem) {
  EXPECT_EQ(base_of(CobId::network), 0x000u);
  EXPECT_EQ(base_of(CobId::sync), 0x080u);
  EXPECT_EQ(id_of(CobId::emergency, 1), 0x081u);
  EXPECT_EQ(id_of(CobId::sdo_answer, 1), 0x581u);
  EXPECT_EQ(id_of(CobId::sdo_request, 127), 0x67fu);
  EXPECT_EQ(id_of(CobId::heartbeat, 127), 0x77fu);
}

TEST(Identifiers, HaveOneMeaningEach) {
  std::map<std::uint32_t, const char*> seen;
  for (const auto& row : identifier_table)
    for (int node = row.of_node ? 1 : 0; node <= (row.of_node ? highest_node : 0); ++node) {
      const auto id = id_of(row.use, node);
      EXPECT_LE(id, 0x7ffu);
      const auto [at, is_new] = seen.emplace(id, row.text);
      EXPECT_TRUE(is_new) << std::hex << id << ": " << row.text << " and " << at->second;
    }
  for (const auto& row : pdo_table) EXPECT_NE(row.id(), base_of(CobId::sdo_answer));
}

TEST(Dbc, HasTheTorqueOfTheStateWhereItIsExchanged) {
  const auto has_torque = [](int level) {
    return parse_dbc(dbc_text({}, {Format::classical, {{"X", 5}}, level})).at(0x385).contains("actual_torque");
  };
  EXPECT_FALSE(has_torque(0));
  EXPECT_FALSE(has_torque(1));
  EXPECT_TRUE(has_torque(2));
}

// On a bus with CAN FD too they are classical frames.
TEST(Dbc, DescribesWhatCanopenHasBesideProcessData) {
  const auto text = dbc_text({}, {Format::fd, {{"X", 5}}});
  const auto dbc = parse_dbc(text);
  const Frame emergency = encode_emergency(5, 0x8611, 1);
  EXPECT_EQ(emergency.id, 0x085u);
  EXPECT_EQ(dbc.at(0x085).at("error_code").read(emergency), 0x8611);
  EXPECT_EQ(dbc.at(0x085).at("error_register").read(emergency), 0x21);
  EXPECT_EQ(dbc.at(0x085).at("fault").read(emergency), 1);
  EXPECT_EQ(dbc.at(0x705).at("state").read(encode_heartbeat(5, NodeState::pre_operational)), 127);
  const Frame request{0x605, 8, {0x40, 0x65, 0x60, 2}};
  EXPECT_EQ(dbc.at(0x605).at("index").read(request), 0x6065);
  EXPECT_EQ(dbc.at(0x585).at("sub_index").read(request), 2);
  const Frame order{0x000, 2, {128, 5}};
  EXPECT_EQ(dbc.at(0x000).at("command").read(order), 128);
  EXPECT_EQ(network_order_of(order)->node, 5);
  EXPECT_EQ(text.find("BO_ 133 14;"), std::string::npos);
  EXPECT_NE(text.find("BO_ 1029 14;"), std::string::npos) << "a target";
}

TEST(Dbc, DescribesTheFramesAsTheyAre) {
  std::mt19937_64 random(4);
  for (const auto format : formats) {
    const auto dbc = parse_dbc(dbc_text({format, {{"X", 5}, {"Y", 6}}}));
    for (int i = 0; i < 20; ++i) {
      const auto state = random_state(random, 100.0, 1.0);
      std::array<Frame, 2> frames;
      const auto count = encode_feedback(format, 5, 7, state, std::span<Frame, 2>(frames));
      std::map<std::string, double> read;
      for (std::size_t k = 0; k < count; ++k)
        for (const auto& [name, signal] : dbc.at(frames[k].id)) read[name] = signal.read(frames[k]);
      const auto found = through_the_bus(format, state, 7);
      EXPECT_EQ(read.at("position"), machine::to_si(found.feedback.position));
      EXPECT_EQ(read.at("current_B"), machine::to_si(found.feedback.current[1]));
      EXPECT_EQ(read.at("valid"), found.feedback.position_valid);
      EXPECT_EQ(read.at("limit_positive"), found.inputs.limit_positive);
      EXPECT_EQ(read.at("home"), found.inputs.home);
      EXPECT_EQ(read.at("index_passed"), found.inputs.index);
      EXPECT_EQ(read.at("counter"), 7);
      if (format == Format::fd) {
        EXPECT_EQ(read.at("sample_age"), static_cast<double>(-state.feedback.position_time_ns));
        EXPECT_EQ(read.at("index_position"), machine::to_si(state.inputs.index_position));
        EXPECT_EQ(read.at("velocity"), machine::to_si(state.feedback.velocity));
      }
    }
    Command<S> command;
    command.enable = true;
    ASSERT_TRUE(machine::convert(-17.25, command.voltage[2]));
    const Frame frame = encode_command(format, 6, 3, command);
    EXPECT_EQ(dbc.at(frame.id).at("voltage_C").read(frame), -17.25);
    EXPECT_EQ(dbc.at(frame.id).at("enable").read(frame), 1.0);
    EXPECT_EQ(dbc.at(sync_id).at("tick").read(encode_sync(4000000000u)), 4e9);
  }
}

}  // namespace
}  // namespace stiction::hal::can
