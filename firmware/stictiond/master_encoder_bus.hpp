// The socket of the encoder that is the drive's master (--master can:NODE), in the loop's thread: takes what came since
// the tick before, with its age. Nothing here waits, allocates or locks; the work of a tick is bounded.
#pragma once

#include <linux/can.h>

#include <array>
#include <cstdint>
#include <string>

#include "hal/can/can_socket.hpp"
#include "hal/can/encoder.hpp"
#include "hal/tick_clock.hpp"

namespace stiction::drive {

class MasterEncoderBus {
 public:
  static constexpr int most_taken = 16;  // frames in a tick
  static constexpr std::int64_t silence_ns = 1'000'000'000;

  // Throws hal::can::CanError where the bus is not as it must be. `interface`: of the network; `node`: of the encoder.
  MasterEncoderBus(const std::string& interface, int node)
      : socket_(interface, hal::can::Format::classical,
                std::array{hal::can::Filter{id_of(hal::can::CobId::node_position, node), CAN_SFF_MASK},
                           hal::can::Filter{id_of(hal::can::CobId::emergency, node), CAN_SFF_MASK}},
                false) {}

  // Before each tick: `take` is called with each frame and its age, ns. `now_ns`: time of the tick.
  template <class Take>
  void receive(std::int64_t now_ns, Take take) {
    hal::can::Received received;
    for (int k = 0; k < most_taken && socket_.receive(received, 0); ++k) {
      take(received.frame, hal::MonotonicTime().now_ns() - received.received_ns);
      heard_ns_ = now_ns;
    }
    // An adapter that was unplugged. An axis that follows has been stopped long before.
    if (now_ns - heard_ns_ < silence_ns) return;
    heard_ns_ = now_ns;
    socket_.find_again();
  }

 private:
  hal::can::CanSocket socket_;
  std::int64_t heard_ns_ = 0;
};

}  // namespace stiction::drive
