// Every fault that a machine over CAN can make, injected in motion by `stiction-plant --fault` or by a limit below what
// the motion needs, on a kernel whose computing costs time: the number that the drive names, the ticks until then, what
// both buses carry, how far the axis goes on. Prints a row each and how many ended as docs/faults.md says.
// As root: interfaces vcan0 and vcan1, `stictiond` and `stiction-plant` in $PATH.
// usage: can_faults [KIND]
#include <fmt/ranges.h>

#include <cstdlib>
#include <set>

#include "tests/rt/kill_list.hpp"

namespace stiction::test {
namespace {

constexpr int onset = 1000;  // tick of the machine

struct Injected {
  std::string kind;
  int lasts_ticks;
  std::set<int> numbers;  // that may be named for it
  int within_ticks;
  bool at_once;  // whether the power goes in the same tick; else after a controlled stop
  double coasts_um = most_coasted_um;
};

// What comes behind the answer of its tick, an error frame or those of a babbler, is read in the next one.
constexpr int lasting = 1'000'000;
// At 20 mm/s a set-point goes on by the 100 um of frozen_distance in 5 ticks; meanwhile the position controller adds
// 16 mm/s. A motor of the wrong sign is seen by its following error at the latest, 2 mm, which it has with 0.3 m/s^2
// after 120 ticks at most: at 0.06 m/s, from which friction lets it go on by 10 mm. A force source has no phase
// currents.
const std::vector<Injected> injected{
    {"frame-lost", 5, {32}, 3, true},
    {"frame-late", 20, {32}, 3, true},
    {"frame-stale", 20, {32}, 3, true},
    {"frame-damaged", 5, {32}, 3, true},
    {"frame-duplicate", 20, {33}, 11, false},
    {"frame-out-of-order", 20, {33}, 11, false},
    {"bus-off", 1, {34}, 2, true},
    {"babble", 5, {35}, 2, false},
    {"encoder-open", lasting, {4}, 3, true},
    {"encoder-frozen", lasting, {16, 17}, 16, true, 3'600.0},
    {"encoder-jump", lasting, {17}, 1, true},
    {"encoder-bit", lasting, {17}, 1, true},
    {"motor-reversed", lasting, {19, 1, 2, 3, 7}, 150, true, 10'000.0},
    {"power-stage", lasting, {5}, 1, true},
    {"limit-negative", lasting, {20, 21}, 1, false},
    {"limit-positive", lasting, {20, 21}, 1, false},
    {"torque-off", lasting, {89}, 1, true},
    {"torque-off-channel", lasting, {89}, 1, true},
};

// Of what power stages tell of themselves, these frames of eight bytes carry safe torque off alone.
const std::vector<std::string> watched{"--set", "drive.axis.X.protection.torque_off=two-channels"};

// A limit that the motion exceeds from its beginning on.
struct Limited {
  std::string setting;
  int number;
  bool at_once;
};
const std::vector<Limited> limited{
    {"axis.X.supervision.following_error=1 um", 1, false},
    {"axis.X.supervision.over_current=0.2 A", 2, true},
    {"axis.X.supervision.over_speed=10 mm/s", 3, true},
};

// The first fault in the drive's log, and the beginning of the tick in which it was named; 0: none.
struct Named {
  int number = 0;
  std::int64_t tick_ns = 0;
};
Named named() {
  const std::string log = text_of("/tmp/drive.log");
  std::smatch fault;
  if (!std::regex_search(log, fault, std::regex(R"(([\d.]+) s: axis \d+: fault (\d+) )"))) return {};
  return {std::stoi(fault[2]), std::llround(std::stod(fault[1]) * 1e9)};
}

// The machine's tick from which on its stage is off, as its log says; 0: it is not.
int off_since() {
  const std::string log = text_of("/tmp/plant.log");
  std::smatch found;
  return std::regex_search(log, found, std::regex(R"(stage off since tick (\d+))")) ? std::stoi(found[1]) : 0;
}

void inject(KillList& list, const Injected& row) {
  const std::string name = fmt::format("{} ({})", row.kind, fmt::join(row.numbers, " "));
  const std::string fault =
      fmt::format("{},axis=X,at={} s,ticks={}", row.kind, onset * 1e-9 * tick_ns, row.lasts_ticks);
  if (!list.serves({"--fault", fault}, watched) || !list.moves(speed_um_s)) return list.failed(name);
  list.buses().mark();
  Death death{.name = name, .status = 0x100, .coasts_um = row.coasts_um};
  death.reaction = row.at_once ? Reaction::off : Reaction::controlled;
  // The machine's ticks run on while it hears nothing, before the loop: its fault comes after 1000 of the loop's at
  // most.
  death.within_ns = 1000 * tick_ns;
  death.at_end = [&] {
    const Seen seen = list.buses().seen();
    const auto [number, fault_ns] = named();
    list.expect(row.numbers.count(number) == 1,
                fmt::format("fault {}, found {}", fmt::join(row.numbers, " or "), number));
    // The stage is off from the tick on whose command takes the power; with a fault of its own from there on.
    const int tick = off_since() - static_cast<int>((seen.disabling_ns - fault_ns) / tick_ns);
    const int taken = tick - onset + 1;
    list.expect(1 <= taken && taken <= row.within_ticks, fmt::format("it within {} ticks", row.within_ticks));
    if (row.at_once) list.expect(seen.disabling_ns - fault_ns < tick_ns, "power off in the same tick");
    std::printf("fault %2d after %3d of %3d ticks: ", number, taken, row.within_ticks);
  };
  list.judge(death);
}

void limit(KillList& list, const Limited& row) {
  const std::string name = fmt::format("{} ({})", row.setting, row.number);
  if (!list.serves({}, {"--set", row.setting}) || !list.moves(0)) return list.failed(name);
  list.buses().mark();
  list.buses().accelerate(speed_um_s);
  Death death{.name = name, .status = 0x100};
  death.reaction = row.at_once ? Reaction::off : Reaction::controlled;
  death.within_ns = 60 * millisecond_ns;  // 20 mm/s with the jerk's time at both ends
  list.judge(death, [&] {
    const int number = named().number;
    list.expect(number == row.number, fmt::format("fault {}, found {}", row.number, number));
    std::printf("fault %d: ", number);
  });
}

int run(const std::string& only) {
  KillList list(format_of_nodes());
  for (const auto& row : injected)
    if (only.empty() || only == row.kind) inject(list, row);
  for (const auto& row : limited)
    if (only.empty() || only == "limits") limit(list, row);
  return list.end();
}

}  // namespace
}  // namespace stiction::test

int main(int argc, char** argv) { return stiction::test::run(argc > 1 ? argv[1] : ""); }
