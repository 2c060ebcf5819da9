// A raw SocketCAN socket (linux/can/raw.h): classical and FD frames, kernel filters, receive time stamps, error frames.
// Nothing here waits but receive(), which waits in ppoll() until a deadline.
#pragma once

#include <linux/can.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "hal/can/frames.hpp"

namespace stiction::hal::can {

// what() says what was found, what was expected and what to do.
class CanError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Filter {
  std::uint32_t id;
  std::uint32_t mask;
  bool inverted = false;  // the frames that do not match
};

struct Received {
  Frame frame;
  bool error = false;            // an error frame: `frame.id` holds the classes of linux/can/error.h
  std::int64_t received_ns = 0;  // by the kernel, on CLOCK_MONOTONIC
};

class CanSocket {
 public:
  // Opens the interface. All filters must be passed by a frame if they are inverted, one of them otherwise. Throws
  // CanError where the interface is not there, is down, or carries no frames of this format. `interface`: name, such as
  // can0; `format`: of the frames; `filters`: of the kernel; `errors`: error frames are received too.
  CanSocket(const std::string& interface, Format format, std::span<const Filter> filters, bool errors);
  CanSocket(const CanSocket&) = delete;
  CanSocket& operator=(const CanSocket&) = delete;
  ~CanSocket();

  // False when the kernel's queue is full or the interface went down; the frame is lost then. `format`: of the wire.
  bool send(const Frame& frame) { return send(frame, format_); }
  // The same in a format of its own. `frame`: of at most eight bytes where it is classical.
  bool send(const Frame& frame, Format format);

  // The next frame; waits for it until `deadline_ns` on CLOCK_MONOTONIC (0: does not wait). False when none came.
  bool receive(Received& received, std::int64_t deadline_ns);

  // True where the interface is that of the start, or one with its name has taken its place and is bound now: an
  // adapter that is unplugged takes its interface with it, and a socket of that hears nothing when the adapter is back.
  // For who has heard nothing for a while and whose axes are off: it costs a few system calls, and to bind waits for
  // others that change interfaces. Allocates nothing.
  bool find_again();

  std::uint64_t lost_in_kernel() const { return lost_in_kernel_; }  // frames that the socket's queue had no room for

 private:
  bool take(Received& received);

  bool bind(int index) const;

  int descriptor_ = -1;
  std::string index_file_;  // of the interface
  int index_ = 0;           // of the interface that is bound
  std::vector<can_filter> filters_;
  Format format_;
  std::uint64_t lost_in_kernel_ = 0;
};

// Whether the interface has no wire (vcan, vxcan): what it carries is not bounded by a bit rate.
bool is_virtual(const std::string& interface);

}  // namespace stiction::hal::can
