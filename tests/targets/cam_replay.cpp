// Runs masters, a cam and its switches for some seconds of commands that a generator draws, and prints a hash of every
// signal: the same on every target. Needs nothing but the firmware's headers. Where the machine counts instructions
// (Cortex-M4 under QEMU), `count` prints for each law: name, least, largest, sum, ticks.
// usage: cam_replay [count]
#include <array>

#include "tests/targets/cam_laws.hpp"
#include "tests/targets/decimal.hpp"
#include "tests/targets/hash.hpp"

namespace {

using namespace stiction;
using namespace stiction::targets;

constexpr std::uint32_t ticks = 64000;
// In 2^-64 cycles a tick at 16 kHz.
constexpr std::int64_t cycle_a_second = 1152921504606847;

class Generator {
 public:
  std::uint32_t next(std::uint32_t below) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::uint32_t>(state_ >> 33) % below;
  }

 private:
  std::uint64_t state_ = 2006;
};

// What happens from time to time.
void command(CamContext& c, Generator& random) {
  const CamCurve* curves[] = {&c.cam, &c.scaled, &c.gear};
  CamRequest request{.curve = curves[random.next(3)]};
  request.trigger = static_cast<CamTrigger>(random.next(2) == 0 ? 0 : random.next(5));
  request.slave_relative = request.curve == &c.gear || random.next(3) == 0;
  request.master_relative = random.next(3) == 0;
  request.span = Span::of(800 + random.next(4000));
  request.tolerance = {std::int64_t{1} << 36, std::int64_t{1} << 40, std::int64_t{1} << 40};
  switch (random.next(8)) {
    case 0:
      c.master.run((std::int64_t{random.next(5)} - 2) * cycle_a_second);
      break;
    case 1:
      c.master.stop_at(std::uint64_t{random.next(1u << 30)} << 34);
      break;
    case 2:
      c.motion.phase((std::int64_t{random.next(9)} - 4) * (std::int64_t{1} << 36));
      break;
    case 3:
      c.motion.leave(random.next(2) == 0 ? 0 : std::int64_t{1} << 40);
      break;
    case 4:
      request.approach = CamApproach::ticks;
      [[fallthrough]];
    case 5:
      c.motion.engage(request);
      break;
    case 6:
      request.approach = CamApproach::distance;
      request.span = Span::of(std::int64_t{1} << 39);
      c.motion.engage(request);
      break;
    default:
      request.goal = CamGoal::position;
      request.position = (std::int64_t{random.next(9)} - 4) * (std::int64_t{1} << 37);
      c.motion.engage(request);
  }
}

constexpr const char* names[] = {"master_cycles",
                                 "master_phase",
                                 "master_velocity",
                                 "master_acceleration",
                                 "estimated_cycles",
                                 "estimated_phase",
                                 "estimated_velocity",
                                 "estimated_acceleration",
                                 "table_position",
                                 "table_speed",
                                 "table_acceleration",
                                 "position",
                                 "velocity",
                                 "acceleration",
                                 "status",
                                 "refusal",
                                 "switches",
                                 "edges",
                                 "tuning_sums",
                                 "tuning_fit"};
constexpr std::size_t count_of_names = sizeof(names) / sizeof(names[0]);

// What the tuner sees in this tick, and the fit of a record that is full.
void tune(CamContext& c) {
  const bool dwells = c.at.position.coarse() >= 0x80000000u;
  const std::int64_t place = dwells ? std::int64_t{1} << 38 : std::int64_t{c.at.position.coarse()} << 7;
  c.elastic.step(place);
  c.tuned = {.master = c.at.position, .velocity = c.at.velocity, .load = c.elastic.at, .set_point = place};
  if (c.tuning.stage != CamTuning::Stage::full) return;
  c.fit = CamTuning::evaluate(c.tuning_config, c.tuning);
  CamTuning::release(c.tuning);
}

void hash(const CamContext& c, std::array<Hash, count_of_names>& hashes) {
  const auto& s = c.motion.status();
  const std::int64_t status = (s.busy ? 1 : 0) | (s.active ? 2 : 0) | (s.in_sync ? 4 : 0) | (s.waiting ? 8 : 0) |
                              (s.end_of_profile ? 16 : 0) | (s.command_aborted ? 32 : 0);
  std::int64_t edges = c.outputs.changed;
  for (const std::uint16_t time : c.switches.edge_time) edges = edges * 31 % 1000000007 + time;
  const std::int64_t words[count_of_names] = {
      c.at.position.cycles,
      static_cast<std::int64_t>(c.at.position.phase),
      c.at.velocity,
      c.at.acceleration,
      c.estimated.position.cycles,
      static_cast<std::int64_t>(c.estimated.position.phase),
      c.estimated.velocity,
      c.estimated.acceleration,
      c.found.position,
      c.found.speed,
      c.found.acceleration,
      c.point.position,
      c.point.velocity,
      c.point.acceleration,
      status,
      static_cast<std::int64_t>(s.refusal) * 16 + static_cast<std::int64_t>(s.fault),
      c.outputs.on,
      edges,
      c.tuning.d + 3 * c.tuning.dc + 5 * c.tuning.ds + 7 * c.tuning.cs + c.tuning.re + c.tuning.im,
      static_cast<std::int64_t>(c.fit.refusal) + 3 * c.fit.re + 5 * c.fit.im + 7 * c.fit.offset + 9 * c.fit.quality +
          11 * c.fit.first + 13 * c.fit.second};
  for (std::size_t k = 0; k < count_of_names; ++k) hashes[k].add(words[k]);
}

void print_hash(const char* name, std::uint64_t value) {
  char text[18] = "0000000000000000\n";
  for (std::size_t k = 0; k < 16; ++k) text[k] = "0123456789abcdef"[value >> (60 - 4 * k) & 15];
  print("cam.");
  print(name);
  print(" ");
  print(text);
}

struct Tally {
  std::uint32_t least = UINT32_MAX, largest = 0, sum = 0;
};

CamContext context;
std::array<Hash, count_of_names> hashes;
std::array<Tally, cam_laws.size()> tallies;

}  // namespace

int main(int argc, char**) {
  Generator random;
  context.master.run(cycle_a_second);
  std::uint32_t next = 8000;
  for (std::uint32_t tick = 0; tick < ticks; ++tick) {
    if (tick == next) {
      command(context, random);
      next += 100 + random.next(1600);
    }
    tune(context);
    const std::uint32_t empty = count_instructions(cam_laws[0].step, &context);
    for (std::size_t k = 0; k < cam_laws.size(); ++k) {
      // A profiler from outside counts a function with its return; so does this.
      const std::uint32_t taken = count_instructions(cam_laws[k].step, &context) - empty + 1;
      Tally& tally = tallies[k];
      tally.least = taken < tally.least ? taken : tally.least;
      tally.largest = taken > tally.largest ? taken : tally.largest;
      tally.sum += taken;
    }
    hash(context, hashes);
  }
  if (argc > 1) {
    for (std::size_t k = 0; counts_instructions && k < cam_laws.size(); ++k) {
      print(cam_laws[k].name);
      for (const auto number : {tallies[k].least, tallies[k].largest, tallies[k].sum, ticks}) {
        print(" ");
        print_decimal(number);
      }
      print("\n");
    }
    return 0;
  }
  for (std::size_t k = 0; k < count_of_names; ++k) print_hash(names[k], hashes[k].value());
  return 0;
}
