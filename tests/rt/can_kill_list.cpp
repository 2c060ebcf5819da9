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
#include <regex>
#include <tuple>

#include "firmware/stictiond/configuration.hpp"
#include "hal/signals.hpp"
#include "tests/rt/drive_over_can.hpp"
#include "tests/rt/modbus_load.hpp"

namespace stiction::test {
namespace {

constexpr std::int32_t speed_um_s = 20'000;
// From 20 mm/s at the 1 m/s^2 that the measured axis can, and the margin of a stop (machine::stop_margin) until the
// power goes; the tick under way and the one that takes the stop.
constexpr std::int64_t ramp_ns = (20 + 100 + 2) * millisecond_ns;
// A stop is taken by the tick after the one under way and shown in the one after that, which waits for three quarters
// of its time for the nodes at most. The speed of an axis that goes on by a ramp once its deceleration has come, in
// profile_jerk_time.
constexpr std::int64_t taken_ns = 2 * tick_ns + 3 * tick_ns / 4, ramp_shown_ns = taken_ns + 16 * millisecond_ns;
// 20 mm/s against the Coulomb friction of 20.4 N less the constant force of 3.2 N on 95.1 kg: v^2 / 2a, without the
// viscous part. After a controlled stop the axis is at rest.
constexpr double most_coasted_um = 1106.0, most_rest_um = 100.0;
constexpr std::int64_t watchdog_ns = 110 * millisecond_ns;  // docs/safety.md
constexpr std::int64_t commander_ns = 500 * millisecond_ns;
const std::string held_file = "/tmp/held";
constexpr std::uint16_t velocity_gain = 1004;

// How it must end, and by what its time is judged: a controlled stop by the first frame that shows it to the
// controller, power off by the first command that takes it, the end of all commands by the last one that enables.
enum class Reaction { controlled, off, silence };

struct Death {
  std::string name;
  Reaction reaction = Reaction::controlled;
  std::int64_t within_ns = ramp_shown_ns;
  std::string cause = {};         // words of the log, or of the next start's
  int status = 0;                 // as waitpid() gives it
  bool controlled_later = false;  // after a fault of which the bus shows no time
};

class KillList {
 public:
  KillList(hal::can::Format format) : buses_(format) { std::filesystem::create_directories("/tmp/parameters"); }

  // A machine and a drive that moves its axis; false, said so, where it does not come to that. `error`: its standard
  // error, -1: a file.
  // A `before`: what is done when it serves and its axis is off.
  bool starts(
      int error = -1, const std::string& preload = "", const std::function<void()>& before = [] {}) {
    drive_.reset();
    plant_.reset();
    buses_.begin();
    buses_.watch(20 * millisecond_ns);
    plant_.emplace(plant_command, "/tmp/plant.log");
    buses_.watch(1000 * millisecond_ns, [] { return !text_of("/tmp/plant.log").empty(); });
    drive_.emplace(drive_command(), "/tmp/drive.log", error, preload);
    const bool shown = buses_.watch(5000 * millisecond_ns, [&] { return buses_.statusword() != 0 || drive_->ended(); });
    if (shown && !drive_->ended()) before();
    if (shown && !drive_->ended() && buses_.moves(speed_um_s)) return true;
    std::printf("the drive did not move its axis; statusword 0x%04x, log:\n%s\n", buses_.statusword(),
                text_of("/tmp/drive.log").c_str());
    return false;
  }

  Buses& buses() { return buses_; }
  Process& drive() { return *drive_; }

  // `death`: what was done since mark(); `then`: is called after what the buses showed. Prints its row.
  template <class Then>
  void judge(const Death& death, Then then) {
    const bool controlled = death.reaction == Reaction::controlled;
    buses_.watch(death.within_ns + 300 * millisecond_ns);
    const Seen seen = buses_.seen();
    const auto after = [&](std::int64_t time_ns) { return time_ns == 0 ? 0 : time_ns - seen.since_ns; };
    const std::int64_t first = controlled ? seen.stop_shown_ns : seen.disabling_ns;
    if (death.reaction != Reaction::silence)
      expect(first != 0 && after(first) <= death.within_ns, fmt::format("it within {} ms", in_ms(death.within_ns)));
    const std::int64_t off_within = controlled ? death.within_ns + ramp_ns : death.within_ns;
    expect(after(seen.last_enabling_ns) <= off_within, fmt::format("no power after {} ms", in_ms(off_within)));
    then();
    end_drive();
    expect(drive_->ended() && drive_->status() == death.status,
           fmt::format("status {:#x}, found {:#x}", death.status, drive_->ended() ? drive_->status() : -1));
    buses_.watch(20 * millisecond_ns);  // a silent machine moves on by 80 ticks in 5 ms
    plant_->end(SIGTERM);
    const double way_um = coasted();
    const double most_um = controlled || death.controlled_later ? most_rest_um : most_coasted_um;
    expect(way_um <= most_um, fmt::format("the stage off and at most {} um to rest", most_um));
    expect(buses_.lost() == lost_, "no frame lost by this test");
    lost_ = buses_.lost();
    expect(death.cause.empty() || told(death.cause), "the words '" + death.cause + "' in a log");
    ++count_;
    if (wrong_.empty()) ++good_;
    const char* const shown[] = {"stop shown after", "disabled after", "silent"};
    std::printf("%-56s %-16s %8s ms, last enabling command %8s ms, coasted %6.1f um%s\n", death.name.c_str(),
                shown[static_cast<int>(death.reaction)],
                death.reaction == Reaction::silence ? "-" : in_ms(after(first)).c_str(),
                in_ms(after(seen.last_enabling_ns)).c_str(), way_um, wrong_.c_str());
    if (!wrong_.empty()) std::printf("%s", text_of("/tmp/drive.log").c_str());
    wrong_.clear();
    std::fflush(stdout);
  }
  void judge(const Death& death) {
    judge(death, [] {});
  }

  // Of the death that is judged.
  void expect(bool held, const std::string& what) {
    if (!held) wrong_ += "; expected " + what;
  }

  void failed(const std::string& name) {
    ++count_;
    std::printf("%s: not tried\n", name.c_str());
  }

  int end() const {
    std::printf("%d of %d ended in their reaction\n", good_, count_);
    return good_ == count_ ? 0 : 1;
  }

 private:
  static std::string in_ms(std::int64_t time_ns) { return fmt::format("{:.2f}", static_cast<double>(time_ns) * 1e-6); }

  void end_drive() {
    buses_.be_silent();
    if (drive_->ended()) return;
    drive_->send(SIGTERM);
    buses_.watch(3000 * millisecond_ns, [&] { return drive_->ended(); });
  }

  // um, that the axis moved without power until it was at rest; -1: the power is on.
  static double coasted() {
    const std::string machine = text_of("/tmp/plant.log");
    std::smatch found;
    const std::regex line(R"(axis X: stage off since tick \d+, coasted by (\S+) um)");
    return std::regex_search(machine, found, line) ? std::abs(std::stod(found[1])) : HUGE_VAL;
  }

  // In the log of the drive, or of the next start.
  bool told(const std::string& cause) {
    if (text_of("/tmp/drive.log").find(cause) != std::string::npos) return true;
    drive_.reset();
    Process next({"stictiond", "--machine", "emps", "--hal", "simulated", "--unpaced", "--hold", "0.01", "--parameters",
                  "/tmp/parameters"},
                 "/tmp/next.log");
    buses_.watch(5000 * millisecond_ns, [&] { return next.ended(); });
    return text_of("/tmp/next.log").find(cause) != std::string::npos;
  }

  Buses buses_;
  std::optional<Process> plant_, drive_;
  std::string wrong_;
  int count_ = 0, good_ = 0;
  std::uint64_t lost_ = 0;
};

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
  test::KillList list(drive::can_config(drive::read_configuration([] {
                        drive::DriveOptions options;
                        options.machine = "emps";
                        options.set = {"drive.can.interface=vcan0", "drive.axis.X.node=1"};
                        return options;
                      }()))
                          .format);
  const std::string only = argc > 1 ? argv[1] : "";
  if (only.empty() || only == "signals") test::signals(list);
  if (only.empty() || only == "threads") test::threads(list);
  if (only.empty() || only == "surroundings") test::surroundings(list);
  if (only.empty() || only == "controller") test::controller(list);
  return list.end();
}
