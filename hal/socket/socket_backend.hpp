// The machine at the other end of a socket, in lock step: one packet of feedback and one of commands a tick. The plant
// may live in another process; only the integers of the control's border cross.
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "hal/backend.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::hal {

// The peer went away or sent something that is not a packet of this protocol.
class SocketError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class SocketBackend {
 public:
  using Signals = FixedSignals;

  // `descriptor`: a connected SOCK_SEQPACKET socket, not owned.
  SocketBackend(int descriptor, std::size_t axis_count);

  std::size_t axis_count() const { return feedback_.size(); }
  std::int64_t wait_for_tick();  // throws SocketError
  void read(std::span<Feedback<Signals>> feedback) const;
  void write(std::span<const Command<Signals>> command);  // throws SocketError

 private:
  int descriptor_;
  std::vector<Feedback<Signals>> feedback_;
};

namespace socket_detail {
void send_feedback(int descriptor, std::int64_t now_ns, std::span<const Feedback<FixedSignals>> feedback);
// False when the peer has closed the socket.
bool receive_command(int descriptor, std::span<Command<FixedSignals>> command);
}  // namespace socket_detail

// Plays the machine for a SocketBackend at the other end with any backend of this process, until the peer closes.
template <Backend B>
void serve(B& machine, int descriptor) {
  std::vector<Feedback<FixedSignals>> feedback(machine.axis_count());
  std::vector<Command<FixedSignals>> command(machine.axis_count());
  for (;;) {
    const std::int64_t now_ns = machine.wait_for_tick();
    machine.read(feedback);
    socket_detail::send_feedback(descriptor, now_ns, feedback);
    if (!socket_detail::receive_command(descriptor, command)) return;
    machine.write(command);
  }
}

}  // namespace stiction::hal
