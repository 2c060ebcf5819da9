// The thread that serves the nodes' objects on a CAN bus. It may wait, and takes as many requests a second as a bus at
// rest brings; it must be started before the loop's thread takes a processor for itself.
#pragma once

#include <sched.h>

#include <atomic>
#include <memory>
#include <thread>
#include <utility>

#include "firmware/stictiond/object_server.hpp"
#include "hal/can/can_socket.hpp"
#include "hal/tick_clock.hpp"

namespace stiction::drive {

// `Socket`: CanSocket, or a test's, that sends, receives until a deadline and finds its interface again.
template <class Socket>
class ObjectThread {
 public:
  static constexpr std::int64_t round_ns = 20'000'000;
  static constexpr std::int64_t silence_ns = 1'000'000'000;  // after which an adapter is looked for

  // `server`: must outlive this; `socket`: for its requests alone.
  ObjectThread(ObjectServer& server, std::unique_ptr<Socket> socket)
      : server_(server), socket_(std::move(socket)), thread_([this] { run(); }) {}
  ~ObjectThread() {
    end_ = true;
    thread_.join();
  }
  ObjectThread(const ObjectThread&) = delete;
  ObjectThread& operator=(const ObjectThread&) = delete;

 private:
  void run() {
    const sched_param ordinary{};
    ::sched_setscheduler(0, SCHED_OTHER, &ordinary);
    const hal::MonotonicTime time;
    std::int64_t heard_ns = time.now_ns();
    while (!end_) {
      hal::can::Received received;
      const bool heard = socket_->receive(received, time.now_ns() + round_ns);
      const std::int64_t now_ns = time.now_ns();
      if (heard) {
        heard_ns = now_ns;
        if (const auto frame = server_.answer(received.frame, now_ns)) socket_->send(*frame);
      } else if (now_ns - heard_ns >= silence_ns) {
        heard_ns = now_ns;
        socket_->find_again();
      }
      server_.poll(now_ns, [this](const hal::can::Frame& frame) { socket_->send(frame); });
    }
  }

  ObjectServer& server_;
  std::unique_ptr<Socket> socket_;
  std::atomic<bool> end_ = false;
  std::thread thread_;
};

// For the requests to the nodes of `config`: classical frames, as CiA 301 has them. Throws hal::can::CanError.
inline std::unique_ptr<hal::can::CanSocket> object_socket(const CanServerConfig& config) {
  std::vector<hal::can::Filter> filters;
  for (const int node : config.nodes) filters.push_back({id_of(hal::can::CobId::sdo_request, node), CAN_SFF_MASK});
  return std::make_unique<hal::can::CanSocket>(config.interface, hal::can::Format::classical, filters, false);
}

}  // namespace stiction::drive
