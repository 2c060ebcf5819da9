// One thing after the other dies around a drive over CAN whose axis is in motion: what both buses carry from that
// moment on, against the time that it may take. On a kernel with CAN and the interfaces vcan0 and vcan1, as root.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "firmware/stictiond/configuration.hpp"
#include "tests/rt/drive_over_can.hpp"

namespace stiction::test {

inline constexpr std::int32_t speed_um_s = 20'000;
// From 20 mm/s at the 1 m/s^2 that the measured axis can, and the margin of a stop (machine::stop_margin) until the
// power goes; the tick under way and the one that takes the stop.
inline constexpr std::int64_t ramp_ns = (20 + 100 + 2) * millisecond_ns;
// A stop is taken by the tick after the one under way and shown in the one after that, which waits for three quarters
// of its time for the nodes at most. The speed of an axis that goes on by a ramp once its deceleration has come, in
// profile_jerk_time.
inline constexpr std::int64_t taken_ns = 2 * tick_ns + 3 * tick_ns / 4, ramp_shown_ns = taken_ns + 16 * millisecond_ns;
// 20 mm/s against the Coulomb friction of 20.4 N less the constant force of 3.2 N on 95.1 kg: v^2 / 2a, without the
// viscous part. After a controlled stop the axis is at rest.
inline constexpr double most_coasted_um = 1106.0, most_rest_um = 100.0;
inline constexpr std::int64_t watchdog_ns = 110 * millisecond_ns;  // docs/safety.md
inline constexpr std::int64_t commander_ns = 500 * millisecond_ns;

// How it must end, and by what its time is judged: a controlled stop by the first frame that shows it to the
// controller, power off by the first command that takes it, the end of all commands by the last one that enables.
enum class Reaction { controlled, off, silence };

struct Death {
  std::string name;
  Reaction reaction = Reaction::controlled;
  std::int64_t within_ns = ramp_shown_ns;
  std::string cause = {};              // words of the log, or of the next start's
  int status = 0;                      // as waitpid() gives it
  bool controlled_later = false;       // after a fault of which the bus shows no time
  double coasts_um = most_coasted_um;  // at most, without power
  std::function<void()> at_end = {};   // when drive and machine have ended
};

class KillList {
 public:
  KillList(hal::can::Format format) : buses_(format) { std::filesystem::create_directories("/tmp/parameters"); }

  // A machine and a drive that moves its axis; false, said so, where it does not come to that. `error`: its standard
  // error, -1: a file.
  // A `before`: what is done when it serves and its axis is off.
  bool starts(
      int error = -1, const std::string& preload = "", const std::function<void()>& before = [] {}) {
    return serves({}, {}, error, preload, before) && moves(speed_um_s);
  }

  // A machine and a drive that serves, with more arguments of each.
  bool serves(
      const std::vector<std::string>& of_plant, const std::vector<std::string>& of_drive, int error = -1,
      const std::string& preload = "", const std::function<void()>& before = [] {}) {
    std::vector<std::string> plant_words = plant_command, drive_words = drive_command();
    plant_words.insert(plant_words.end(), of_plant.begin(), of_plant.end());
    drive_words.insert(drive_words.end(), of_drive.begin(), of_drive.end());
    drive_.reset();
    plant_.reset();
    buses_.begin();
    buses_.watch(20 * millisecond_ns);
    plant_.emplace(plant_words, "/tmp/plant.log");
    buses_.watch(1000 * millisecond_ns, [] { return !text_of("/tmp/plant.log").empty(); });
    drive_.emplace(drive_words, "/tmp/drive.log", error, preload);
    const bool shown = buses_.watch(5000 * millisecond_ns, [&] { return buses_.statusword() != 0 || drive_->ended(); });
    if (shown && !drive_->ended()) before();
    if (shown && !drive_->ended()) return true;
    return not_moved();
  }
  // Its axis at this speed, um/s; false, said so, where it does not come to that.
  bool moves(std::int32_t speed) { return buses_.moves(speed) || not_moved(); }
  bool not_moved() {
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
    if (death.at_end) death.at_end();
    const double way_um = coasted();
    const double most_um = controlled || death.controlled_later ? most_rest_um : death.coasts_um;
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

// The format of the nodes' frames in drive_command().
inline hal::can::Format format_of_nodes() {
  drive::DriveOptions options;
  options.machine = "emps";
  options.set = {"drive.can.interface=vcan0", "drive.axis.X.node=1"};
  return drive::can_config(drive::read_configuration(options)).format;
}

}  // namespace stiction::test
