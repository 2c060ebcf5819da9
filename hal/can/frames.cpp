#include "hal/can/frames.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "stiction/number/crc.hpp"

namespace stiction::hal::can {
namespace {

// Little-endian, as DBC's @1 has it.
template <class Word>
void put(Frame& frame, std::size_t at, Word value, std::size_t bytes = sizeof(Word)) {
  const auto bits = static_cast<std::uint64_t>(static_cast<std::make_signed_t<Word>>(value));
  for (std::size_t i = 0; i < bytes; ++i) frame.data[at + i] = static_cast<std::uint8_t>(bits >> (8 * i));
}

template <class Word>
Word get(const Frame& frame, std::size_t at, std::size_t bytes = sizeof(Word)) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < bytes; ++i) bits |= std::uint64_t{frame.data[at + i]} << (8 * i);
  // The sign of a word that came in fewer bytes.
  const std::size_t unused = 64 - 8 * bytes;
  if constexpr (std::is_signed_v<Word>) return static_cast<Word>(static_cast<std::int64_t>(bits << unused) >> unused);
  return static_cast<Word>(bits);
}

// The k-th of 16 bits.
std::int32_t short_word(const Frame& frame, std::size_t k) { return get<std::int16_t>(frame, 2 * k); }

Crc16 checksum(const Frame& frame, std::size_t covered) {
  Crc16 crc;
  crc.add(static_cast<std::uint8_t>(frame.id)).add(static_cast<std::uint8_t>(frame.id >> 8));
  return crc.add(frame.data, covered);
}
std::uint8_t short_checksum(const Frame& frame, std::size_t covered) {
  Crc8 crc;
  crc.add(static_cast<std::uint8_t>(frame.id)).add(static_cast<std::uint8_t>(frame.id >> 8));
  return crc.add(frame.data, covered).value();
}

// The last bytes of a frame.
void seal(Frame& frame, Format format) {
  if (format == Format::fd)
    put<std::uint16_t>(frame, frame.size - 2u, checksum(frame, frame.size - 2u).value());
  else
    put<std::uint8_t>(frame, frame.size - 1u, short_checksum(frame, frame.size - 1u));
}
bool sealed(const Frame& frame, Format format) {
  return format == Format::fd ? get<std::uint16_t>(frame, frame.size - 2u) == checksum(frame, frame.size - 2u).value()
                              : get<std::uint8_t>(frame, frame.size - 1u) == short_checksum(frame, frame.size - 1u);
}

constexpr std::size_t sync_size = 8;

// FD feedback, bytes from 0: position 8, velocity 4, currents 3 x 4, sample's age 4, index position 8, flags 1,
// counter 1, protection 7 (DC link, temperatures of motor and stage), motor flags 1; checksum 2.
namespace fd {
constexpr std::size_t velocity = 8, current = 12, age = 24, index = 28, flags = 36, counter = 37;
constexpr std::size_t protection = 38, protection_bytes = 7, motor_flags = 45;
constexpr int dc_link_bits = 30;      // of the control's own voltage: +-2048 V
constexpr int temperature_bits = 13;  // tenths of a degree: 409 degrees, beyond what is a broken sensor
constexpr std::size_t command_flags = 12, command_counter = 13;
}  // namespace fd

enum Flag : std::uint8_t {
  valid = 1,
  fault = 2,
  limit_negative = 4,
  limit_positive = 8,
  home = 16,
  index_mark = 32,
  torque_off_a = 64,
  torque_off_b = 128
};

// Hall signals in bits 0 to 2, and what the node has.
enum MotorFlag : std::uint8_t {
  hall_signals = 7,
  has_hall = 8,
  has_dc_link = 16,
  has_motor_temperature = 32,
  has_stage_temperature = 64,
  has_torque_off = 128
};

constexpr unsigned set_if(bool condition, unsigned flag) { return condition ? flag : 0u; }

std::uint8_t flags_of(const NodeFeedback& state) {
  const auto& in = state.inputs;
  const auto& protection = state.protection;
  return static_cast<std::uint8_t>(set_if(state.feedback.position_valid, valid) | set_if(state.feedback.fault, fault) |
                                   set_if(in.limit_negative, limit_negative) |
                                   set_if(in.limit_positive, limit_positive) | set_if(in.home, home) |
                                   set_if(in.index, index_mark) | set_if(protection.torque_off_a, torque_off_a) |
                                   set_if(protection.torque_off_b, torque_off_b));
}
void take_low_flags(std::uint8_t flags, NodeFeedback& state) {
  state.feedback.position_valid = (flags & valid) != 0;
  state.feedback.fault = (flags & fault) != 0;
  state.inputs.limit_negative = (flags & limit_negative) != 0;
  state.inputs.limit_positive = (flags & limit_positive) != 0;
}
void take_high_flags(std::uint8_t flags, NodeFeedback& state) {
  state.inputs.home = (flags & home) != 0;
  state.inputs.index = (flags & index_mark) != 0;
  state.protection.torque_off_a = (flags & torque_off_a) != 0;
  state.protection.torque_off_b = (flags & torque_off_b) != 0;
}

// A number of `bits` bits at `first_bit`, held within them; and back, with its sign.
constexpr std::uint64_t in_bits(std::int64_t number, int first_bit, int bits) {
  const std::int64_t most = (std::int64_t{1} << (bits - 1)) - 1;
  const auto word = static_cast<std::uint64_t>(std::clamp(number, -most - 1, most));
  return (word & ((std::uint64_t{1} << bits) - 1)) << first_bit;
}
constexpr std::int64_t of_bits(std::uint64_t word, int first_bit, int bits) {
  return static_cast<std::int64_t>(word << (64 - first_bit - bits)) >> (64 - bits);
}

void put_motor(Frame& frame, const NodeFeedback& state) {
  const auto& p = state.protection;
  const auto& has = state.motor_signals;
  put<std::uint64_t>(frame, fd::protection,
                     in_bits(p.dc_link.raw(), 0, fd::dc_link_bits) |
                         in_bits(p.motor_temperature, fd::dc_link_bits, fd::temperature_bits) |
                         in_bits(p.stage_temperature, fd::dc_link_bits + fd::temperature_bits, fd::temperature_bits),
                     fd::protection_bytes);
  frame.data[fd::motor_flags] = static_cast<std::uint8_t>(
      (state.inputs.hall & hall_signals) | set_if(has.hall, has_hall) | set_if(has.dc_link, has_dc_link) |
      set_if(has.motor_temperature, has_motor_temperature) | set_if(has.stage_temperature, has_stage_temperature) |
      set_if(has.torque_off, has_torque_off));
}
void take_motor(const Frame& frame, NodeFeedback& state) {
  auto& p = state.protection;
  const auto word = get<std::uint64_t>(frame, fd::protection, fd::protection_bytes);
  const auto temperature = [&](int first_bit) {
    return static_cast<std::int16_t>(of_bits(word, first_bit, fd::temperature_bits));
  };
  p.dc_link = FixedSignals::Voltage::from_raw(static_cast<std::int32_t>(of_bits(word, 0, fd::dc_link_bits)));
  p.motor_temperature = temperature(fd::dc_link_bits);
  p.stage_temperature = temperature(fd::dc_link_bits + fd::temperature_bits);
  const std::uint8_t flags = frame.data[fd::motor_flags];
  state.inputs.hall = flags & hall_signals;
  state.motor_signals = {.hall = (flags & has_hall) != 0,
                         .dc_link = (flags & has_dc_link) != 0,
                         .motor_temperature = (flags & has_motor_temperature) != 0,
                         .stage_temperature = (flags & has_stage_temperature) != 0,
                         .torque_off = (flags & has_torque_off) != 0};
}

// Classical frames: three words of 16 bits, or a position of 48; then flags and counter, four bits each; checksum.
namespace classical {
constexpr std::size_t flags_and_counter = 6;
constexpr int position_shift = 8;  // 2^-32 m = 0.23 nm, +-32 km
constexpr int current_shift = 12;  // 2^-8 A = 3.9 mA, +-128 A
constexpr int voltage_shift = 13;  // 2^-5 V = 31 mV, +-1024 V
}  // namespace classical

// Rounded to nearest and held within 16 bits.
template <class T>
std::int16_t rounded(T value, int shift) {
  const std::int64_t half = std::int64_t{1} << (shift - 1);
  const std::int64_t word = (std::int64_t{value.raw()} + half) >> shift;
  return static_cast<std::int16_t>(std::clamp<std::int64_t>(word, INT16_MIN, INT16_MAX));
}

void put_flags_and_counter(Frame& frame, std::uint8_t flags, std::uint32_t tick) {
  frame.data[classical::flags_and_counter] = static_cast<std::uint8_t>((flags & 0x0F) | (tick & 0x0F) << 4);
}

}  // namespace

Address address_of(const Frame& frame, Format format) {
  const auto& sizes = properties(format).sizes;
  if (frame.id == sync_id) return {frame.size == sizes[0] ? Kind::sync : Kind::unknown, 0};
  const int node = static_cast<int>(frame.id & 0x7F);
  if (node == 0 || (frame.id & ~0x7FFu) != 0) return {};
  Address address;
  if ((frame.id & 0x780) == command_id && frame.size == sizes[1]) address = {Kind::command, node};
  if ((frame.id & 0x780) == position_id && frame.size == sizes[2]) address = {Kind::position, node};
  if ((frame.id & 0x780) == current_id && sizes[3] != 0 && frame.size == sizes[3]) address = {Kind::current, node};
  return address;
}

// The same in both formats, so that a node sees at its first frame which one the drive speaks.
Frame encode_sync(std::uint32_t tick) {
  Frame frame{sync_id, sync_size, {}};
  put<std::uint32_t>(frame, 0, tick);
  seal(frame, Format::fd);
  return frame;
}

bool decode_sync(const Frame& frame, std::uint32_t& tick) {
  if (frame.size != sync_size || !sealed(frame, Format::fd)) return false;
  tick = get<std::uint32_t>(frame, 0);
  return true;
}

Frame encode_command(Format format, int node, std::uint32_t tick, const Command<FixedSignals>& command) {
  Frame frame{command_id + static_cast<std::uint32_t>(node), properties(format).sizes[1], {}};
  if (format == Format::fd) {
    for (std::size_t k = 0; k < 3; ++k) put<std::int32_t>(frame, 4 * k, command.voltage[k].raw());
    frame.data[fd::command_flags] = command.enable ? 1 : 0;
    frame.data[fd::command_counter] = static_cast<std::uint8_t>(tick);
  } else {
    for (std::size_t k = 0; k < 3; ++k)
      put<std::int16_t>(frame, 2 * k, rounded(command.voltage[k], classical::voltage_shift));
    put_flags_and_counter(frame, command.enable ? 1 : 0, tick);
  }
  seal(frame, format);
  return frame;
}

bool decode_command(Format format, const Frame& frame, std::uint32_t& counter, Command<FixedSignals>& command) {
  if (!sealed(frame, format)) return false;
  using Voltage = FixedSignals::Voltage;
  if (format == Format::fd) {
    for (std::size_t k = 0; k < 3; ++k) command.voltage[k] = Voltage::from_raw(get<std::int32_t>(frame, 4 * k));
    command.enable = (frame.data[fd::command_flags] & 1) != 0;
    counter = frame.data[fd::command_counter];
  } else {
    for (std::size_t k = 0; k < 3; ++k)
      command.voltage[k] = Voltage::from_raw(short_word(frame, k) * (1 << classical::voltage_shift));
    command.enable = (frame.data[classical::flags_and_counter] & 1) != 0;
    counter = frame.data[classical::flags_and_counter] >> 4;
  }
  return true;
}

std::size_t encode_feedback(Format format, int node, std::uint32_t tick, const NodeFeedback& state,
                            std::span<Frame, 2> frames) {
  const auto& [position, time_ns, is_valid, velocity, current, is_fault] = state.feedback;
  const auto& sizes = properties(format).sizes;
  Frame& first = frames[0] = {position_id + static_cast<std::uint32_t>(node), sizes[2], {}};
  const std::uint8_t flags = flags_of(state);
  if (format == Format::fd) {
    put<std::int64_t>(first, 0, position.raw());
    put<std::int32_t>(first, fd::velocity, velocity.raw());
    for (std::size_t k = 0; k < 3; ++k) put<std::int32_t>(first, fd::current + 4 * k, current[k].raw());
    put<std::uint32_t>(first, fd::age, static_cast<std::uint32_t>(std::clamp<std::int64_t>(-time_ns, 0, UINT32_MAX)));
    put<std::int64_t>(first, fd::index, state.inputs.index_position.raw());
    first.data[fd::flags] = flags;
    first.data[fd::counter] = static_cast<std::uint8_t>(tick);
    put_motor(first, state);
    seal(first, format);
    return 1;
  }
  const std::int64_t half = std::int64_t{1} << (classical::position_shift - 1);
  put<std::int64_t>(first, 0, (position.raw() + half) >> classical::position_shift, 6);
  put_flags_and_counter(first, flags, tick);
  seal(first, format);
  Frame& second = frames[1] = {current_id + static_cast<std::uint32_t>(node), sizes[3], {}};
  for (std::size_t k = 0; k < 3; ++k) put<std::int16_t>(second, 2 * k, rounded(current[k], classical::current_shift));
  put_flags_and_counter(second, static_cast<std::uint8_t>(flags >> 4), tick);
  seal(second, format);
  return 2;
}

bool decode_feedback(Format format, Kind kind, const Frame& frame, std::uint32_t& counter, NodeFeedback& state) {
  if (!sealed(frame, format)) return false;
  using S = FixedSignals;
  auto& f = state.feedback;
  if (format == Format::fd) {
    f.position = S::Position::from_raw(get<std::int64_t>(frame, 0));
    f.velocity = S::Velocity::from_raw(get<std::int32_t>(frame, fd::velocity));
    for (std::size_t k = 0; k < 3; ++k)
      f.current[k] = S::Current::from_raw(get<std::int32_t>(frame, fd::current + 4 * k));
    f.position_time_ns = -std::int64_t{get<std::uint32_t>(frame, fd::age)};
    state.inputs.index_position = S::Position::from_raw(get<std::int64_t>(frame, fd::index));
    take_low_flags(frame.data[fd::flags], state);
    take_high_flags(frame.data[fd::flags], state);
    take_motor(frame, state);
    counter = frame.data[fd::counter];
    return true;
  }
  const std::uint8_t flags_and_counter = frame.data[classical::flags_and_counter];
  counter = flags_and_counter >> 4;
  if (kind == Kind::position) {
    f.position = S::Position::from_raw(get<std::int64_t>(frame, 0, 6) * (1 << classical::position_shift));
    f.position_time_ns = 0;
    take_low_flags(flags_and_counter, state);
  } else {
    for (std::size_t k = 0; k < 3; ++k)
      f.current[k] = S::Current::from_raw(short_word(frame, k) * (1 << classical::current_shift));
    take_high_flags(static_cast<std::uint8_t>(flags_and_counter << 4), state);
    state.motor_signals = {.torque_off = true};
    state.inputs.index_position = f.position;  // the mark's own place has no room
  }
  return true;
}

}  // namespace stiction::hal::can
