// A drive over CAN as a process of its own, the simulated machine at its bus, a controller that keeps its axis in
// motion, and what both buses carried: so that a stop is seen from outside, with the kernel's time stamps. On a kernel
// with CAN and the interfaces vcan0 (the nodes') and vcan1 (the controller's).
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "hal/can/can_socket.hpp"
#include "hal/can/process_data.hpp"
#include "hal/tick_clock.hpp"
#include "stiction/drive/state_machine.hpp"

namespace stiction::test {

inline constexpr int axis_node = 1;
inline constexpr std::int64_t millisecond_ns = 1'000'000;
inline constexpr std::int64_t tick_ns = millisecond_ns;  // of the measured EMPS axis
inline constexpr std::uint16_t state_mask = 0x6F, enabled_state = 0x27;

inline std::int64_t now_ns() { return hal::MonotonicTime().now_ns(); }

// A process that is found in $PATH; its standard output and error go to a file, or to a descriptor.
class Process {
 public:
  // `arguments`: its name and options; `log`: the file; `error`: for standard error in its place, -1: none; `preload`:
  // a library.
  Process(const std::vector<std::string>& arguments, const std::string& log, int error = -1,
          const std::string& preload = "") {
    id_ = ::fork();
    if (id_ != 0) return;
    const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    ::dup2(file, STDOUT_FILENO);
    ::dup2(error >= 0 ? error : file, STDERR_FILENO);
    if (!preload.empty()) ::setenv("LD_PRELOAD", preload.c_str(), 1);
    std::vector<char*> words;
    for (const auto& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    ::execvp(words[0], words.data());
    ::_exit(127);
  }
  ~Process() {
    if (!ended_) end(SIGKILL);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  int id() const { return id_; }
  void send(int signal) const { ::kill(id_, signal); }

  // True when it has ended; its status is that of waitpid().
  bool ended() {
    if (!ended_) ended_ = ::waitpid(id_, &status_, WNOHANG) == id_;
    return ended_;
  }
  int status() const { return status_; }
  void end(int signal) {
    send(signal);
    send(SIGCONT);
    if (!ended_) ended_ = ::waitpid(id_, &status_, 0) == id_;
  }

 private:
  int id_ = -1, status_ = 0;
  bool ended_ = false;
};

inline std::string text_of(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline constexpr int modbus_port = 15021;

// The measured EMPS axis between two buses and Modbus.
inline std::vector<std::string> drive_command() {
  std::vector<std::string> command{"stictiond", "--machine", "emps", "--hal", "can", "--parameters", "/tmp/parameters"};
  for (const char* setting :
       {"drive.can.interface=vcan0", "drive.axis.X.node=1", "drive.can_server.interface=vcan1",
        "drive.axis.X.server_node=1", "drive.can_server.motion=allowed", "drive.axis.X.quick_stop_deceleration=1 m/s^2",
        "drive.modbus_server.address=127.0.0.1:15021", "drive.modbus_server.motion=allowed",
        "drive.modbus_server.commander_timeout=0 s"})
    command.insert(command.end(), {"--set", setting});
  return command;
}

// Its machine. The nodes are computers of their own, so it has the priority of the drive's loop: as an ordinary
// process it waits for its turn behind the drive's server and its clients, answers three ticks late, and the drive
// trips fault 32. Below the loop, the loop interrupts it where it hands over an answer.
inline const std::vector<std::string> plant_command{"chrt",      "-f",
                                                    "80",        "stiction-plant",
                                                    "--machine", "emps",
                                                    "--bus",     "can:vcan0",
                                                    "--set",     "drive.can.interface=vcan0",
                                                    "--set",     "drive.axis.X.node=1"};

// What the buses carried since a moment.
struct Seen {
  std::int64_t since_ns = 0;
  std::int64_t last_enabling_ns = 0;  // command to the node; 0: none since then
  std::int64_t disabling_ns = 0;      // the first one that takes the power
  // The first statusword of the axis that is not "operation enabled", or speed that is an increment of the ramp lower.
  std::int64_t stop_shown_ns = 0;
  std::vector<std::int64_t> ticks{};  // SYNCs to the nodes

  // That the loop began since the moment, up to the one that made the frame of this time.
  std::int64_t ticks_until(std::int64_t time_ns) const {
    return std::count_if(ticks.begin(), ticks.end(), [=](std::int64_t tick) { return tick <= time_ns; });
  }
};

class Buses {
 public:
  explicit Buses(hal::can::Format format)
      : format_(format),
        nodes_("vcan0", format, all(), false),
        controller_("vcan1", hal::can::Format::classical, all(), false) {}

  // Reads both until `done`, for so long at most; true when it came. Meanwhile the controller commands `speed`, if any.
  template <class Done>
  bool watch(std::int64_t for_ns, Done done) {
    const std::int64_t end = now_ns() + for_ns;
    while (true) {
      drain();
      if (done()) return true;
      const std::int64_t now = now_ns();
      if (now >= end) return false;
      if (beside_) beside_();
      if (speed_ != 0 && now >= say_again_ns_) command_speed();
      hal::can::Received received;
      if (nodes_.receive(received, std::min(end, now + (beside_ ? millisecond_ns / 10 : millisecond_ns))))
        take_node(received);
    }
  }
  void watch(std::int64_t for_ns) {
    watch(for_ns, [] { return false; });
  }

  // What comes from now on is counted from here.
  void mark() {
    drain();
    speed_at_mark_ = std::abs(shown_speed_);
    seen_ = {.since_ns = now_ns()};
  }
  const Seen& seen() const { return seen_; }
  std::uint16_t statusword() const { return statusword_; }
  std::int64_t shown_ns() const { return shown_ns_; }
  std::uint64_t syncs() const { return syncs_; }  // to the nodes, since begin()
  double speed() const { return shown_speed_; }   // m/s
  std::uint64_t lost() const { return nodes_.lost_in_kernel() + controller_.lost_in_kernel(); }

  // A new machine and a new drive.
  void begin() {
    speed_ = 0;
    drain();
    syncs_ = 0;
    statusword_ = 0;
    shown_ns_ = 0;
  }
  // Done again and again while the buses are watched, at least each millisecond.
  void set_beside(std::function<void()> beside) { beside_ = std::move(beside); }
  void find_again() { controller_.find_again(); }

  void send_word(std::uint16_t word, std::int8_t mode) {
    controller_.send(hal::can::encode_pdo(hal::can::Pdo::mode, axis_node, {.controlword = word, .mode = mode}));
  }

  // Leads the axis to operation enabled in the mode profile velocity, and to this speed (um/s), which is
  // reached in `settles_ns`.
  bool moves(std::int32_t speed, std::int64_t settles_ns = 200 * millisecond_ns) {
    constexpr std::int8_t profile_velocity = 3;
    constexpr std::array<std::array<std::uint16_t, 2>, 3> steps{{{0x06, 0x21}, {0x07, 0x23}, {0x0F, enabled_state}}};
    for (const auto& [word, state] : steps) {
      send_word(word, profile_velocity);
      if (!watch(1000 * millisecond_ns, [&, state = state] { return (statusword_ & state_mask) == state; }))
        return false;
    }
    if (speed == 0) return true;
    accelerate(speed);
    watch(settles_ns);
    return std::abs(shown_speed_ - speed * 1e-6) < ramp_step;
  }
  void accelerate(std::int32_t speed) {
    speed_ = speed;
    command_speed();
  }
  void be_silent() { speed_ = 0; }

 private:
  // m/s in half a tick at 1 m/s^2, ten increments of the measured speed.
  static constexpr double ramp_step = 0.5e-3;

  static std::vector<hal::can::Filter> all() { return {{0x7FF, 0x7FF, true}}; }  // but an identifier that nobody has

  // Four times in the time of the watch over the commander, 0.5 s; sooner a stop could be in its way.
  void command_speed() {
    say_again_ns_ = now_ns() + 125 * millisecond_ns;
    controller_.send(hal::can::encode_pdo(hal::can::Pdo::speed, axis_node, {.controlword = 0x0F, .speed = speed_}));
  }

  void drain() {
    hal::can::Received received;
    while (nodes_.receive(received, 0)) take_node(received);
    while (controller_.receive(received, 0)) take_controller(received);
  }

  void take_node(const hal::can::Received& received) {
    const auto address = hal::can::address_of(received.frame, format_);
    const bool counts = seen_.since_ns != 0 && received.received_ns >= seen_.since_ns;
    if (address.kind == hal::can::Kind::sync) {
      ++syncs_;
      if (counts) seen_.ticks.push_back(received.received_ns);
      return;
    }
    Command<FixedSignals> command;
    std::uint32_t counter = 0;
    if (!counts || address.kind != hal::can::Kind::command ||
        !hal::can::decode_command(format_, received.frame, counter, command))
      return;
    if (command.enable) {
      seen_.last_enabling_ns = received.received_ns;
    } else if (seen_.disabling_ns == 0) {
      seen_.disabling_ns = received.received_ns;
    }
  }

  void take_controller(const hal::can::Received& received) {
    const auto& data = received.frame.data;
    const auto is = [&](hal::can::Pdo pdo) {
      return received.frame.id == hal::can::description_of(pdo).id() + axis_node &&
             received.frame.size == hal::can::description_of(pdo).size;
    };
    if (is(hal::can::Pdo::motion)) {
      std::int32_t speed = 0;
      for (int byte = 3; byte >= 0; --byte)
        speed =
            static_cast<std::int32_t>(static_cast<std::uint32_t>(speed) << 8 | data[static_cast<std::size_t>(byte)]);
      shown_speed_ = speed * 1e-6;
      if (speed_at_mark_ - std::abs(shown_speed_) > ramp_step) show_stop(received.received_ns);
    }
    if (!is(hal::can::Pdo::position)) return;
    statusword_ = static_cast<std::uint16_t>(data[0] | data[1] << 8);
    shown_ns_ = received.received_ns;
    if ((statusword_ & state_mask) != enabled_state) show_stop(received.received_ns);
  }

  void show_stop(std::int64_t received_ns) {
    if (seen_.since_ns != 0 && received_ns >= seen_.since_ns && seen_.stop_shown_ns == 0)
      seen_.stop_shown_ns = received_ns;
  }

  hal::can::Format format_;
  hal::can::CanSocket nodes_, controller_;
  std::function<void()> beside_;
  Seen seen_;
  std::uint16_t statusword_ = 0;
  std::int64_t shown_ns_ = 0, say_again_ns_ = 0;
  std::int32_t speed_ = 0;  // um/s
  double shown_speed_ = 0.0, speed_at_mark_ = 0.0;
  std::uint64_t syncs_ = 0;
};

}  // namespace stiction::test
