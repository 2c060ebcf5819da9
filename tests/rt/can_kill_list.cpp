// Everything that can die or halt around a drive over CAN whose axis is in motion, one after the other: what both buses
// carry from that moment on, against the times of docs/safety.md. Prints a row a death and how many ended as they must.
// On a kernel with CAN, as root: interfaces vcan0 and vcan1, `stictiond` and `stiction-plant` in $PATH;
// $HELD_FSYNC_LIBRARY: a library to preload, under which fsync() waits as long as the file $HELD_FSYNC is there.
#include <fmt/format.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/syscall.h>

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <optional>
#include <tuple>

#include "hal/signals.hpp"
#include "tests/rt/kill_list.hpp"
#include "tests/rt/modbus_load.hpp"

namespace stiction::test {
namespace {

const std::string held_file = "/tmp/held";
constexpr std::uint16_t velocity_gain = 1004;

std::vector<int> threads_of(int process) {
  std::vector<int> threads;
  for (const auto& entry : std::filesystem::directory_iterator(fmt::format("/proc/{}/task", process)))
    threads.push_back(std::stoi(entry.path().filename()));
  std::sort(threads.begin(), threads.end());
  return threads;
}

std::string name_of_thread(int process, int thread) {
  std::string name = text_of(fmt::format("/proc/{}/task/{}/comm", process, thread));
  if (!name.empty()) name.pop_back();
  return name;
}

void freeze(int thread) {
  ::ptrace(PTRACE_SEIZE, thread, nullptr, nullptr);
  ::ptrace(PTRACE_INTERRUPT, thread, nullptr, nullptr);
  int status = 0;
  ::waitpid(thread, &status, __WALL);
}
void thaw(int thread) { ::ptrace(PTRACE_DETACH, thread, nullptr, nullptr); }

void signals(KillList& list) {
  for (const int number : {SIGTERM, SIGINT, SIGQUIT, SIGHUP, SIGPWR, SIGXCPU}) {
    const std::string name = hal::name_of_signal(number);
    if (!list.starts()) return list.failed(name);
    list.buses().mark();
    list.drive().send(number);
    list.judge({.name = name});
  }
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS, SIGTRAP}) {
    const std::string name = hal::name_of_signal(number);
    if (!list.starts()) return list.failed(name);
    list.buses().mark();
    list.drive().send(number);
    list.judge({name, Reaction::off, tick_ns, "the power is off: the programme ends by " + name, number});
  }
  if (!list.starts()) return list.failed("SIGKILL");
  list.buses().mark();
  list.drive().send(SIGKILL);
  list.judge({"SIGKILL, as when memory is out", Reaction::silence, tick_ns,
              "the last run did not end in order, but while running", SIGKILL});
  // Without SYNC the node is off after 5 ms; what comes behind SIGCONT is the loop's: late ticks, a clock that jumped.
  for (const auto& [halted_ms, cause, controlled] :
       {std::tuple{10, "fault 48", true}, std::tuple{200, "fault 49", false}}) {
    const std::string name = fmt::format("SIGSTOP, {} ms later SIGCONT", halted_ms);
    if (!list.starts()) return list.failed(name);
    list.buses().mark();
    list.drive().send(SIGSTOP);
    list.buses().watch(halted_ms * millisecond_ns);
    list.drive().send(SIGCONT);
    list.judge({name, Reaction::silence, halted_ms * millisecond_ns + (controlled ? ramp_ns : tick_ns), cause, 0x100,
                controlled});
  }
}

void threads(KillList& list) {
  std::size_t count = 1;
  for (std::size_t number = 0; number < count; ++number) {
    if (!list.starts()) return list.failed("a thread that crashes");
    const auto threads = threads_of(list.drive().id());
    count = threads.size();
    const std::string name =
        fmt::format("thread {} ({}) crashes", number + 1, name_of_thread(list.drive().id(), threads[number]));
    list.buses().mark();
    ::syscall(SYS_tgkill, list.drive().id(), threads[number], SIGSEGV);
    list.judge({name, Reaction::off, tick_ns, "the power is off: the programme ends by SIGSEGV", SIGSEGV});
  }
  if (!list.starts()) return list.failed("a loop that does not go on");
  list.buses().mark();
  freeze(list.drive().id());
  list.judge({"the loop does not go on", Reaction::off, watchdog_ns, "fault 51", 0x100},
             [&] { thaw(list.drive().id()); });
  for (std::size_t number = 1; number < count; ++number) {
    if (!list.starts()) return list.failed("a thread that does not go on");
    const auto threads = threads_of(list.drive().id());
    const std::string name = fmt::format("thread {} ({}) does not go on, SIGTERM", number + 1,
                                         name_of_thread(list.drive().id(), threads[number]));
    freeze(threads[number]);
    list.buses().watch(300 * millisecond_ns);
    list.buses().mark();
    list.drive().send(SIGTERM);
    list.judge({.name = name}, [&] { thaw(threads[number]); });
  }
}

void stop_over_can(
    KillList& list, const std::string& name, const std::function<void()>& then = [] {}) {
  list.buses().mark();
  list.buses().be_silent();
  list.buses().send_word(0x02, 3);  // quick stop
  list.judge({.name = name, .within_ns = taken_ns}, then);
}

void surroundings(KillList& list) {
  const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
  if (!list.starts(full)) return list.failed("standard error full");
  stop_over_can(list, "standard error full, quick stop over CAN");
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0 || !list.starts(pipe[1])) return list.failed("reader of the pipe gone");
  ::close(pipe[0]);
  ::close(pipe[1]);
  stop_over_can(list, "reader of standard error gone, quick stop over CAN");
  // Its pipe is filled to the last byte.
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) return list.failed("standard error that is not read");
  const int flags = ::fcntl(pipe[1], F_GETFL);
  ::fcntl(pipe[1], F_SETFL, flags | O_NONBLOCK);
  while (::write(pipe[1], "xxxxxxxxxxxxxxxx", 1) > 0) {
  }
  ::fcntl(pipe[1], F_SETFL, flags);
  if (!list.starts(pipe[1])) return list.failed("standard error that is not read");
  // A drive that waits for it at its end leaves the machine alone, whose time runs faster then, and whose friction
  // creeps.
  stop_over_can(list, "standard error that is not read, quick stop over CAN", [&] { ::close(pipe[0]); });
  ::close(pipe[1]);

  std::optional<ModbusConnection> client;
  const auto connects = [&] {
    list.drive().send(SIGUSR1);
    list.buses().watch(100 * millisecond_ns);
    client.emplace(modbus_port);
    client->write(velocity_gain, 250.0F);
    list.buses().watch(100 * millisecond_ns);
    list.expect(client->idle(), "an answer to a written parameter");
  };
  if (!list.starts(-1, "", connects)) return list.failed("no memory to be had");
  rlimit none{.rlim_cur = 4096, .rlim_max = 4096};
  ::prlimit(list.drive().id(), RLIMIT_AS, &none, nullptr);
  for (int i = 0; i < 50; ++i) {
    client->write(velocity_gain, 250.0F + static_cast<float>(i));
    list.buses().watch(2 * millisecond_ns);
  }
  stop_over_can(list, "no memory to be had, quick stop over CAN");

  const char* library = std::getenv("HELD_FSYNC_LIBRARY");
  std::ofstream(held_file).put('1');
  ::setenv("HELD_FSYNC", held_file.c_str(), 1);
  const auto stores = [&] {
    connects();
    client->write_register(0, 0x5354);
    list.buses().watch(100 * millisecond_ns);
    list.expect(!client->idle(), "no answer of the disk");
  };
  if (!list.starts(-1, library == nullptr ? "" : library, stores)) return list.failed("a disk that does not answer");
  stop_over_can(list, "a disk that does not answer, quick stop over CAN", [&] {
    list.expect(!client->idle(), "no answer of the disk");
    std::filesystem::remove(held_file);
  });
  std::filesystem::remove(held_file);
}

// The controller and its bus.
void controller(KillList& list) {
  if (!list.starts()) return list.failed("the controller is silent");
  list.buses().mark();
  list.buses().be_silent();
  // Its last command came up to an eighth of a second before.
  list.judge(
      {.name = "the controller is silent", .within_ns = commander_ns + taken_ns, .cause = "fault 53", .status = 0x100});
  const std::string name = "the controller's adapter is unplugged and plugged in";
  if (!list.starts()) return list.failed(name);
  list.buses().mark();
  if (std::system("ip link del vcan1") != 0) return list.failed(name);
  list.judge({name, Reaction::silence, commander_ns + ramp_ns, "fault 53", 0, true}, [&] {
    list.expect(std::system("ip link add vcan1 type vcan && ip link set vcan1 up") == 0, "an interface again");
    list.buses().find_again();
    list.buses().be_silent();
    const std::int64_t back_ns = now_ns();
    // The drive looks once a second.
    list.expect(list.buses().watch(1100 * millisecond_ns, [&] { return list.buses().shown_ns() > back_ns; }),
                "the axis shown to the controller within 1.1 s");
    list.buses().send_word(0x80, 3);  // reset of the fault
    list.buses().watch(50 * millisecond_ns);
    list.expect(list.buses().moves(speed_um_s), "the axis moved by the controller");
    list.buses().be_silent();
    list.buses().send_word(0x02, 3);
    list.buses().watch(ramp_ns);
  });
}

}  // namespace
}  // namespace stiction::test

int main(int argc, char** argv) {
  using namespace stiction;
  test::KillList list(test::format_of_nodes());
  const std::string only = argc > 1 ? argv[1] : "";
  if (only.empty() || only == "signals") test::signals(list);
  if (only.empty() || only == "threads") test::threads(list);
  if (only.empty() || only == "surroundings") test::surroundings(list);
  if (only.empty() || only == "controller") test::controller(list);
  return list.end();
}
