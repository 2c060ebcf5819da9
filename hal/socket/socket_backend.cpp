#include "hal/socket/socket_backend.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <string>

namespace stiction::hal {
namespace {

// Both ends run on one machine, so words travel in its byte order. No padding: every byte is defined.
struct WireFeedback {
  std::int64_t position;
  std::int64_t position_time_ns;
  std::int32_t velocity;
  std::array<std::int32_t, 3> current;
  std::int32_t position_valid;
  std::int32_t fault;
};
static_assert(sizeof(WireFeedback) == 40);

struct WireCommand {
  std::array<std::int32_t, 3> voltage;
  std::int32_t enable;
};
static_assert(sizeof(WireCommand) == 16);

constexpr std::size_t most_axes = 16;

struct FeedbackPacket {
  std::int64_t now_ns;
  std::array<WireFeedback, most_axes> axes;
};
struct CommandPacket {
  std::array<WireCommand, most_axes> axes;
};

std::size_t feedback_size(std::size_t axes) { return offsetof(FeedbackPacket, axes) + axes * sizeof(WireFeedback); }
std::size_t command_size(std::size_t axes) { return axes * sizeof(WireCommand); }

void send_packet(int descriptor, const void* data, std::size_t size) {
  ssize_t sent = 0;
  do sent = ::send(descriptor, data, size, MSG_NOSIGNAL);
  while (sent < 0 && errno == EINTR);
  if (sent != static_cast<ssize_t>(size))
    throw SocketError(std::string("socket: send failed: ") + std::strerror(errno));
}

// False at the end of the stream.
bool receive_packet(int descriptor, void* data, std::size_t capacity, std::size_t expected) {
  ssize_t received = 0;
  do received = ::recv(descriptor, data, capacity, 0);
  while (received < 0 && errno == EINTR);
  if (received == 0) return false;
  if (received < 0) throw SocketError(std::string("socket: receive failed: ") + std::strerror(errno));
  if (static_cast<std::size_t>(received) != expected)
    throw SocketError("socket: found a packet of " + std::to_string(received) + " bytes; expected " +
                      std::to_string(expected));
  return true;
}

}  // namespace

SocketBackend::SocketBackend(int descriptor, std::size_t axis_count) : descriptor_(descriptor), feedback_(axis_count) {
  if (axis_count == 0 || axis_count > most_axes)
    throw SocketError("socket: found " + std::to_string(axis_count) + " axes; expected 1 to " +
                      std::to_string(most_axes));
}

std::int64_t SocketBackend::wait_for_tick() {
  FeedbackPacket packet;
  if (!receive_packet(descriptor_, &packet, sizeof packet, feedback_size(feedback_.size())))
    throw SocketError("socket: the machine's end was closed");
  for (std::size_t i = 0; i < feedback_.size(); ++i) {
    const auto& wire = packet.axes[i];
    auto& f = feedback_[i];
    f.position = Signals::Position::from_raw(wire.position);
    f.position_time_ns = wire.position_time_ns;
    f.position_valid = wire.position_valid != 0;
    f.velocity = Signals::Velocity::from_raw(wire.velocity);
    for (std::size_t k = 0; k < 3; ++k) f.current[k] = Signals::Current::from_raw(wire.current[k]);
    f.fault = wire.fault != 0;
  }
  return packet.now_ns;
}

void SocketBackend::read(std::span<Feedback<Signals>> feedback) const {
  std::copy(feedback_.begin(), feedback_.end(), feedback.begin());
}

void SocketBackend::write(std::span<const Command<Signals>> command) {
  CommandPacket packet;
  for (std::size_t i = 0; i < command.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) packet.axes[i].voltage[k] = command[i].voltage[k].raw();
    packet.axes[i].enable = command[i].enable;
  }
  send_packet(descriptor_, &packet, command_size(command.size()));
}

namespace socket_detail {

void send_feedback(int descriptor, std::int64_t now_ns, std::span<const Feedback<FixedSignals>> feedback) {
  FeedbackPacket packet;
  packet.now_ns = now_ns;
  for (std::size_t i = 0; i < feedback.size(); ++i) {
    const auto& f = feedback[i];
    packet.axes[i] = {f.position.raw(), f.position_time_ns,
                      f.velocity.raw(), {f.current[0].raw(), f.current[1].raw(), f.current[2].raw()},
                      f.position_valid, f.fault};
  }
  send_packet(descriptor, &packet, feedback_size(feedback.size()));
}

bool receive_command(int descriptor, std::span<Command<FixedSignals>> command) {
  CommandPacket packet;
  if (!receive_packet(descriptor, &packet, sizeof packet, command_size(command.size()))) return false;
  for (std::size_t i = 0; i < command.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      command[i].voltage[k] = FixedSignals::Voltage::from_raw(packet.axes[i].voltage[k]);
    command[i].enable = packet.axes[i].enable != 0;
  }
  return true;
}

}  // namespace socket_detail

}  // namespace stiction::hal
