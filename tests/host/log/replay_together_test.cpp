#include "host/simulate/replay_together.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <string>

#include "firmware/machine/configuration/double_signals.hpp"
#include "host/simulate/replay.hpp"
#include "sim/machine_file.hpp"

namespace stiction::host {
namespace {

// A wave of a machine's first axis alone, of `seconds`, pushed from outside by `force` N where that is not 0.
Log wave(const machine::AxisModel& axis, double seconds, double force) {
  Log log;
  log.source = "wave";
  log.period = 1e-3;
  auto& channels = log.axes.emplace_back();
  const double w = 25.0, amplitude = std::min(2e-3, 0.2 * axis.max_velocity / w);
  for (double t = 0.0; t < seconds; t += log.period) {
    log.t.push_back(t);
    channels.x_set.push_back(amplitude * (1.0 - std::cos(w * t)));
    channels.x.push_back(channels.x_set.back());
    if (force != 0.0) channels.external_force.push_back(force * std::sin(40.0 * t));
  }
  return log;
}

machine::Machine alone(const std::string& name) {
  auto machine = sim::read_machine(STICTION_SOURCE_DIR "/firmware/machine/shipped/" + name + ".toml");
  machine.axes.resize(1);
  return machine;
}

std::string difference(const Log& one, const Log& other) {
  const auto &a = one.axes.front(), &b = other.axes.front();
  if (one.t != other.t || one.source != other.source) return "times";
  for (const auto& channel : log_channels)
    if (a.*channel.values != b.*channel.values) return channel.name;
  return "";
}

}  // namespace

// Axes of many kinds, with effects that act lane by lane and those for which each plant goes on by itself, of several
// lengths, some of which trip: what each is alone.
TEST(ReplayTogether, GivesEachLogTheBitsThatItHasAlone) {
  std::deque<machine::Machine> machines;
  std::deque<Log> logs;
  std::vector<ReplayOf> which;
  const auto add = [&](const machine::Machine& machine, double seconds, double push) {
    machines.push_back(machine);
    const auto& axis = machines.back().axes.front();
    logs.push_back(wave(axis, seconds, push * axis.mass));
    which.push_back({&machines.back(), &logs.back()});
  };
  const std::vector<machine::Effect> none,
      ripple{{"force_ripple", {{"pitch", {0.024}}, {"cosine", {3.0}}, {"sine", {1.0}}}}},
      late{{"time_skew", {{"delay", {2e-4}}}}}, play{{"backlash", {{"width", {5e-6}}}}};
  for (const auto* name :
       {"mcfv5050ln", "emps", "vertical-axis", "screw-linear-scale", "screw-motor-encoder", "belt-axis"})
    for (const auto* effects : {&none, &ripple, &late, &play}) {
      auto machine = alone(name);
      machine.axes.front().effects.insert(machine.axes.front().effects.end(), effects->begin(), effects->end());
      add(machine, 0.2, 0.0);
      add(machine, 0.2, 1.0);
      add(machine, 0.3, 0.5);
    }
  auto trips = alone("mcfv5050ln");
  trips.axes.front().supervision.following_error = 1e-7;
  add(trips, 0.2, 1.0);

  const auto together = replay_together(which);
  ASSERT_EQ(together.size(), which.size());
  std::size_t faults = 0;
  for (std::size_t k = 0; k < which.size(); ++k) {
    const auto& machine = *which[k].machine;
    try {
      const auto own = machine.axes.front().cascaded() && !machine.axes.front().second_encoder
                           ? replay_linear<machine::DoubleSignals>(machine, *which[k].log)
                           : replay_linear_as_held(machine, *which[k].log);
      ASSERT_TRUE(std::holds_alternative<Log>(together[k])) << k << ' ' << machine.id;
      EXPECT_EQ(difference(std::get<Log>(together[k]), own), "") << k << ' ' << machine.id;
    } catch (const FaultTripped& fault) {
      ++faults;
      ASSERT_TRUE(std::holds_alternative<FaultTripped>(together[k])) << k << ' ' << machine.id;
      EXPECT_STREQ(std::get<FaultTripped>(together[k]).what(), fault.what());
    }
  }
  EXPECT_GE(faults, 1U);
  EXPECT_LT(faults, which.size() / 4);
}

TEST(ReplayTogether, RefusesALogThatIsFasterThanTheAxis) {
  const auto machine = alone("mcfv5050ln");
  auto fast = wave(machine.axes.front(), 0.2, 0.0);
  for (double& x : fast.axes.front().x_set) x *= 1e4;
  const ReplayOf one{&machine, &fast};
  EXPECT_THROW(replay_together({&one, 1}), LogError);
}

}  // namespace stiction::host
