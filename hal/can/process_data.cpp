#include "hal/can/process_data.hpp"

namespace stiction::hal::can {
namespace {

constexpr std::uint32_t node_bits = 0x7f;

template <class Word>
void put(Frame& frame, Word value) {
  for (std::size_t i = 0; i < sizeof(Word); ++i)
    frame.data[frame.size++] = static_cast<std::uint8_t>(static_cast<std::make_unsigned_t<Word>>(value) >> (8 * i));
}

template <class Word>
Word get(const Frame& frame, std::size_t at) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < sizeof(Word); ++i) bits |= std::uint32_t{frame.data[at + i]} << (8 * i);
  return static_cast<Word>(bits);
}

Frame of(Pdo pdo, int node) {
  Frame frame;
  frame.id = description_of(pdo).id() + static_cast<std::uint32_t>(node);
  return frame;
}

}  // namespace

PdoAddress pdo_address_of(const Frame& frame) {
  const auto node = static_cast<int>(frame.id & node_bits);
  if (node == 0) return {};
  for (const auto& row : pdo_table)
    if (row.received && row.id() == (frame.id & ~node_bits))
      return {frame.size == row.size ? PdoVerdict::good : PdoVerdict::wrong_size, row.pdo, node};
  return {};
}

ControllerData decode_pdo(Pdo pdo, const Frame& frame) {
  ControllerData data;
  if (pdo == Pdo::offsets) {
    data.velocity_offset = get<std::int32_t>(frame, 0);
    data.torque_offset = get<std::int16_t>(frame, 4);
    return data;
  }
  data.controlword = get<std::uint16_t>(frame, 0);
  if (pdo == Pdo::mode) data.mode = get<std::int8_t>(frame, 2);
  if (pdo == Pdo::target) data.target = get<std::int32_t>(frame, 2);
  if (pdo == Pdo::speed) data.speed = get<std::int32_t>(frame, 2);
  if (pdo == Pdo::torque) data.torque = get<std::int16_t>(frame, 2);
  if (pdo == Pdo::torque) data.most_torque = get<std::uint16_t>(frame, 4);
  return data;
}

Frame encode_pdo(Pdo pdo, int node, const ControllerData& data) {
  Frame frame = of(pdo, node);
  if (pdo == Pdo::offsets) {
    put(frame, data.velocity_offset);
    put(frame, data.torque_offset);
    return frame;
  }
  put(frame, data.controlword);
  if (pdo == Pdo::mode) put(frame, data.mode);
  if (pdo == Pdo::target) put(frame, data.target);
  if (pdo == Pdo::speed) put(frame, data.speed);
  if (pdo == Pdo::torque) put(frame, data.torque);
  if (pdo == Pdo::torque) put(frame, data.most_torque);
  return frame;
}

Frame encode_position(int node, std::uint16_t statusword, std::int32_t position) {
  Frame frame = of(Pdo::position, node);
  put(frame, statusword);
  put(frame, position);
  return frame;
}

Frame encode_position(int node, std::uint16_t statusword, std::int32_t position, std::int16_t torque) {
  Frame frame = encode_position(node, statusword, position);
  put(frame, torque);
  return frame;
}

Frame encode_motion(int node, std::int32_t velocity, std::int32_t following_error) {
  Frame frame = of(Pdo::motion, node);
  put(frame, velocity);
  put(frame, following_error);
  return frame;
}

}  // namespace stiction::hal::can
