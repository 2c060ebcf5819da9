// The border is real: with the plant in another process, behind a socket, the control's trace is the same to the bit.
#include "hal/socket/socket_backend.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>

#include "hal/simulated/simulated_backend.hpp"
#include "sim/experiment/circle_path.hpp"
#include "tests/support/closed_loop.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

constexpr std::array<double, 2> start{0.09, 0.0};
constexpr int ticks = 16000;  // one second of both axes: start, reversals, every controller at work

auto no_extra = [](auto&, int) {};

auto circle_set_points() {
  sim::CircleSettings settings;
  settings.feed = 24.0 / 60.0;
  return [path = sim::CirclePath(settings)](double t) { return path.at(t).axes; };
}

// A process that plays the machine at the other end of `descriptor` until the peer closes.
class PlantProcess {
 public:
  explicit PlantProcess(const machine::Machine& machine) {
    std::array<int, 2> ends;
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends.data()) != 0) throw std::runtime_error("socketpair");
    child_ = ::fork();
    if (child_ == 0) {
      ::close(ends[0]);
      int code = 0;
      try {
        hal::SimulatedBackend<FixedSignals> plant(machine, start);
        hal::serve(plant, ends[1]);
      } catch (...) {
        code = 1;
      }
      ::_exit(code);
    }
    ::close(ends[1]);
    descriptor_ = ends[0];
  }
  int descriptor() const { return descriptor_; }
  // Closes the socket and returns the process' exit code.
  int stop() {
    ::close(descriptor_);
    int status = -1;
    ::waitpid(child_, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t child_;
  int descriptor_;
};

TEST(SocketBackend, GivesTheSameTraceToTheBitWithThePlantInAnotherProcess) {
  const auto machine = cross_table({"axis.*.encoder.velocity=estimated", "axis.*.encoder.noise=2 nm"});
  hal::SimulatedBackend<FixedSignals> here(machine, start);
  const auto expected = raw_words(record(here, machine, ticks, circle_set_points(), no_extra));

  PlantProcess plant(machine);
  hal::SocketBackend there(plant.descriptor(), 2);
  const auto found = raw_words(record(there, machine, ticks, circle_set_points(), no_extra));

  ASSERT_EQ(found.size(), expected.size());
  EXPECT_EQ(found, expected);
  EXPECT_EQ(plant.stop(), 0);
}

TEST(SocketBackend, SaysThatTheMachineWentAway) {
  std::array<int, 2> ends;
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends.data()), 0);
  ::close(ends[1]);
  hal::SocketBackend backend(ends[0], 2);
  EXPECT_THROW(backend.wait_for_tick(), hal::SocketError);
  const std::array<Command<FixedSignals>, 2> command{};
  EXPECT_THROW(backend.write(command), hal::SocketError);
  ::close(ends[0]);
}

TEST(SocketBackend, RefusesAPacketOfAnotherSize) {
  std::array<int, 2> ends;
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends.data()), 0);
  ASSERT_EQ(::send(ends[1], "short", 5, 0), 5);
  hal::SocketBackend backend(ends[0], 2);
  try {
    backend.wait_for_tick();
    FAIL() << "took a packet of 5 bytes";
  } catch (const hal::SocketError& error) {
    EXPECT_STREQ(error.what(), "socket: found a packet of 5 bytes; expected 88");
  }
  ::close(ends[0]);
  ::close(ends[1]);
}

}  // namespace
}  // namespace stiction::test
