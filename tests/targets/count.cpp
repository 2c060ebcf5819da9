// Counts the instructions of a tick, by law and for the whole axis, over a recording of its inputs. Where the machine
// counts itself (Cortex-M4 under QEMU) it prints for each law: name, least, largest, sum, ticks, and where the extremes
// were (tick, axis). Elsewhere it only runs the laws, for a profiler that knows their names.
// usage: count RECORDING                 run and, where possible, count
//        count RECORDING TICK AXIS       say what the axis does in that tick
#include <array>

#include "stiction/drive/ticker.hpp"
#include "tests/targets/decimal.hpp"
#include "tests/targets/laws.hpp"
#include "tests/targets/platform/platform.hpp"
#include "tests/targets/recording.hpp"

namespace {

using namespace stiction;
using namespace stiction::targets;

struct Place {
  std::uint32_t tick = 0;
  std::uint32_t axis = 0;
};

class Tally {
 public:
  void add(std::uint32_t count, Place place) {
    if (count < least_) least_ = count, least_at_ = place;
    if (count > largest_) largest_ = count, largest_at_ = place;
    sum_ += count;
  }
  void report(const char* name, std::uint32_t ticks) const {
    print(name);
    for (const auto number :
         {least_, largest_, sum_, ticks, least_at_.tick, least_at_.axis, largest_at_.tick, largest_at_.axis}) {
      print(" ");
      print_decimal(number);
    }
    print("\n");
  }

 private:
  std::uint32_t least_ = UINT32_MAX;
  std::uint32_t largest_ = 0;
  std::uint32_t sum_ = 0;
  Place least_at_;
  Place largest_at_;
};

// What can make a tick take another path.
void describe(const LawContext& c) {
  print(c.slow ? "slow" : "fast");
  if (!c.feedback.position_valid) print(", no position");
  if (!c.set.valid) print(", set-point not valid");
  if (c.signals.limiting.velocity) print(", velocity limited");
  if (c.signals.limiting.current) print(", current limited");
  if (c.signals.limiting.voltage) print(", voltage limited");
  if (c.signals.fault != Fault::none) print(", fault: "), print(name_of(c.signals.fault));
  print("\n");
}

// Brings the context to the next tick.
void prepare(LawContext& c, const Sample& sample, const Ticker& ticker, bool first) {
  c.set = c.set_of_pulse = c.set_of_friction = c.set_of_learning = sample.set;
  c.feedback = sample.feedback;
  c.now_ns = ticker.now_ns();
  c.slow = ticker.slow();
  if (!first) return;
  for (auto* axis : {&c.axis, &c.cascade, &c.given}) axis->start(c.feedback);
  for (auto* compensation : {&c.pulse, &c.friction, &c.learning}) compensation->start(c.feedback.position);
}

template <class EachTick>
bool for_each_tick(const char* path, EachTick&& each_tick) {
  static Opening opening;
  Input input(path);
  if (!read_opening(input, opening)) return false;
  std::array<LawContext, axis_count> contexts{LawContext(opening.configs[0]), LawContext(opening.configs[1])};
  Ticker ticker(opening.header.period_ns, static_cast<std::uint32_t>(opening.header.slow_ratio));
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(opening.header.ticks); ++i, ticker.advance())
    for (std::uint32_t k = 0; k < axis_count; ++k) {
      Sample sample;
      if (!read_record(input, sample)) return false;
      prepare(contexts[k], sample, ticker, i == 0);
      each_tick(contexts[k], Place{i, k});
    }
  return true;
}

bool count(const char* path) {
  static std::array<Tally, laws.size()> tallies;
  std::uint32_t ticks = 0;
  const bool complete = for_each_tick(path, [&](LawContext& c, Place place) {
    const std::uint32_t empty = count_instructions(laws[0].step, &c);
    c.before = c.axis.state();
    c.part = c.axis;
    for (std::size_t l = 0; l < laws.size(); ++l) {
      c.state = c.before;
      if (laws[l].step == law_velocity_loop) c.part_signals = c.signals;
      // A profiler from outside counts a function with its return; so does this.
      tallies[l].add(count_instructions(laws[l].step, &c) - empty + 1, place);
      if (laws[l].step == law_axis)
        c.i_wanted = saturated_sum(c.signals.i_notch,
                                   saturated_sum(c.signals.i_feedforward, c.set.injection, c.state.saturations),
                                   c.state.saturations);
    }
    ++ticks;
  });
  if (counts_instructions)
    for (std::size_t l = 0; l < laws.size(); ++l) tallies[l].report(laws[l].name, ticks);
  return complete;
}

std::uint32_t number_of(const char* text) {
  std::uint32_t number = 0;
  for (; *text >= '0' && *text <= '9'; ++text) number = number * 10 + static_cast<std::uint32_t>(*text - '0');
  return number;
}

bool describe(const char* path, std::uint32_t tick, std::uint32_t axis) {
  return for_each_tick(path, [&](LawContext& c, Place place) {
    c.command = c.axis.tick(c.set, c.feedback, c.now_ns, c.slow, c.signals);
    if (place.tick == tick && place.axis == axis) describe(c);
  });
}

}  // namespace

int main(int argc, char** argv) {
  bool done = false;
  if (argc == 2) {
    done = count(argv[1]);
  } else if (argc == 4) {
    done = describe(argv[1], number_of(argv[2]), number_of(argv[3]));
  } else {
    print("usage: count RECORDING [TICK AXIS]\n");
    return 2;
  }
  if (!done) print("count: no complete recording of this version\n");
  return done ? 0 : 1;
}
