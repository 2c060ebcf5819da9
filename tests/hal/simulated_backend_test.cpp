#include "hal/simulated/simulated_backend.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "sim/experiment/circle_path.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/support/closed_loop.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

static_assert(hal::Backend<hal::SimulatedBackend<FixedSignals>>);
static_assert(hal::Backend<hal::SimulatedBackend<machine::DoubleSignals>>);

constexpr std::array<double, 2> start{0.09, 0.0};

auto standstill = [](double) {
  return std::array<sim::AxisSetPoint, 2>{sim::AxisSetPoint{0.09, 0.0, 0.0}, sim::AxisSetPoint{}};
};

TEST(SimulatedBackend, RepeatsARunToTheBit) {
  const auto machine = cross_table({"axis.*.encoder.noise=5 nm", "axis.*.encoder.velocity=estimated"});
  sim::CircleSettings settings;
  settings.feed = 0.4;
  const sim::CirclePath path(settings);
  const auto run = [&] {
    hal::SimulatedBackend<FixedSignals> backend(machine, start);
    return raw_words(record(
        backend, machine, 4000, [&](double t) { return path.at(t).axes; }, [](auto&, int) {}));
  };
  EXPECT_EQ(run(), run());
}

// The voltage commanded at a tick acts two ticks later (0.125 ms): the plant's current moves first in the third
// feedback after the command.
TEST(SimulatedBackend, LetsACommandActAfterTheInvertersDeadTime) {
  const auto machine = cross_table({"axis.*.motor.model=dc"});
  hal::SimulatedBackend<FixedSignals> backend(machine, start);
  std::array<Feedback<FixedSignals>, 2> feedback;
  std::array<Command<FixedSignals>, 2> command{};
  command[0].enable = command[1].enable = true;
  command[0].voltage[0] = FixedSignals::Voltage::from_raw(100 << FixedSignals::Voltage::fraction_bits);
  std::array<double, 4> current{};
  for (auto& i : current) {
    backend.wait_for_tick();
    backend.read(feedback);
    i = machine::to_si(feedback[0].current[0]);
    backend.write(command);
  }
  EXPECT_EQ(current[0], 0.0);
  EXPECT_EQ(current[1], 0.0);
  EXPECT_EQ(current[2], 0.0);
  // One tick of U (1 - e^(-R T / L)) / R = 0.346 A has acted by the fourth.
  EXPECT_NEAR(current[3], 100.0 / 1.8 * (1.0 - std::exp(-1.8 * 62.5e-6 / 0.018)), 1e-5);
}

TEST(ControlLoop, MovesTheMachineTheSameToTheBitWhereNobodyReadsItsSignals) {
  using S = FixedSignals;
  const auto machine = cross_table();
  const sim::CirclePath path({.feed = 0.4});
  const auto configs = configurations<S>(machine);
  const auto run = [&](auto tick) {
    hal::SimulatedBackend<S> backend(machine, start);
    hal::ControlLoop loop(backend, std::span<const AxisConfig<S>>(configs), ticker_of(machine));
    std::vector<double> way;
    for (int i = 0; i < 4000; ++i) {
      const auto point = path.at(static_cast<double>(loop.now_ns()) * 1e-9);
      const std::array set{sim::to_set_point<S>(point.axes[0]), sim::to_set_point<S>(point.axes[1])};
      tick(loop, set);
      for (std::size_t k = 0; k < 2; ++k) way.push_back(backend.plant(k).position());
    }
    return way;
  };
  EXPECT_EQ(run([](auto& loop, const auto& set) { loop.tick_untraced(set); }),
            run([](auto& loop, const auto& set) { loop.tick(set); }));
}

TEST(SimulatedBackend, ReportsAPlantThatIsNotANumberAsAFaultAndNeverAsANumber) {
  const auto machine = cross_table();
  hal::SimulatedBackend<FixedSignals> backend(machine, start);
  const auto trace = record(backend, machine, 200, standstill, [&](auto&, int i) {
    if (i == 100) backend.plant(0).set_external_force(std::nan(""));
  });
  EXPECT_EQ(trace.back().fault, Fault::none);                    // Y has none of its own
  EXPECT_EQ(trace[trace.size() - 2].fault, Fault::drive_input);  // X: its current is not a number either
  EXPECT_EQ(trace.size(), 2u * 102u);                            // in the first tick that could see it
}

TEST(SimulatedBackend, TellsTheControlASetPointThatIsNotANumber) {
  const auto machine = cross_table();
  hal::SimulatedBackend<FixedSignals> backend(machine, start);
  const auto trace = record(
      backend, machine, 100,
      [&](double t) {
        auto set = standstill(t);
        if (t > 0.003) set[1].position = std::nan("");
        return set;
      },
      [](auto&, int) {});
  EXPECT_EQ(trace.back().fault, Fault::set_point);
  EXPECT_EQ(trace.size(), 2u * 50u);  // the first tick after 3 ms is number 49
}

}  // namespace
}  // namespace stiction::test
