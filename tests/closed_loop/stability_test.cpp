// How far each gain is from instability, on the linear machine: no friction, no quantizer, no limits. After a 150 N
// step on one axis the swing must decay. Expected values: an independent prototype's (plant study, section 10), one
// gain at a time. Its words "no longer decays" leave open how fast; a swing that takes longer than a third of a second
// for a factor of ten is what agrees with all ten of its figures. The margin at which the swing grows for ever is
// measured beside it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "hal/simulated/simulated_backend.hpp"
#include "tests/support/closed_loop.hpp"
#include "tests/support/figure.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

sim::Machine linear_axis(std::size_t axis) {
  auto machine = cross_table({"axis.*.encoder.velocity=ideal"});
  machine.axes = {machine.axes[axis]};
  auto& a = machine.axes[0];
  // The DC equivalent with the inductance that the star point leaves of the winding's: linear at every position.
  a.motor.model = sim::MotorModel::dc;
  a.motor.phase_inductance -= a.motor.mutual_inductance;
  a.encoder.increment = 0.0;
  a.position_controller.increment = 0.0;
  a.friction.models["coulomb_viscous"] = sim::CoulombViscous::Parameters{0.0, 0.0};
  a.friction.use = "coulomb_viscous";
  a.inverter.voltage_limit = a.inverter.current_limit = 1e12;
  a.supervision = {1.0, 1e6, 1e3};  // what comes here is running away
  a.max_velocity = 1e12;
  return machine;
}

// What is left of the swing a third of a second later, as a share.
double remainder_of_swing(const sim::Machine& machine) {
  const std::array<double, 1> start{0.0};
  hal::SimulatedBackend<sim::DoubleSignals> backend(machine, start);
  backend.plant(0).set_external_force(150.0);
  constexpr int per_second = 16000;
  constexpr int ticks = per_second * 6 / 10;
  const auto trace = record(
      backend, machine, ticks, [](double) { return std::array<sim::AxisSetPoint, 1>{}; }, [](auto&, int) {});
  if (trace.size() < ticks) return HUGE_VAL;  // stopped by a fault
  const auto largest = [&](double from, double to) {
    double result = 0.0;
    for (auto i = static_cast<std::size_t>(from * per_second); i < static_cast<std::size_t>(to * per_second); ++i)
      result = std::max(result, std::abs(trace[i].e.value));
    return result;
  };
  const double early = largest(0.1, 0.2);
  // A well damped loop is down to rounding by then; there, growth means nothing.
  if (early < 1e-13 * largest(0.0, 0.1)) return 0.0;
  return largest(0.1 + 1.0 / 3.0, 0.2 + 1.0 / 3.0) / early;
}

constexpr double decays_well = 0.1;  // by a factor of ten in a third of a second
constexpr double decays_at_all = 1.0;

// The factor at which `scale(axis, factor)` leaves more than `share` of the swing, to 0.3 %.
template <class Scale>
double limit_factor(std::size_t axis, double share, Scale&& scale) {
  double stable = 1.0, unstable = 40.0;
  while (unstable / stable > 1.003) {
    const double factor = std::sqrt(stable * unstable);
    auto machine = linear_axis(axis);
    scale(machine.axes[0], factor);
    (remainder_of_swing(machine) < share ? stable : unstable) = factor;
  }
  return std::sqrt(stable * unstable);
}

void expect_limit(const char* what, std::array<double, 2> expected, auto&& scale) {
  std::array<double, 2> well{}, at_all{};
  for (std::size_t k = 0; k < 2; ++k) {
    well[k] = limit_factor(k, decays_well, scale);
    at_all[k] = limit_factor(k, decays_at_all, scale);
    EXPECT_NEAR(well[k] / expected[k], 1.0, 0.10) << what << (k == 0 ? " X" : " Y");
  }
  figure(fmt::format("stability limit, {}, X | Y", what),
         fmt::format("x{:.2f} | x{:.2f} (prototype x{:g} | x{:g}, within 10 %); grows from x{:.2f} | x{:.2f}", well[0],
                     well[1], expected[0], expected[1], at_all[0], at_all[1]));
}

TEST(StabilityLimit, OfTheVelocityGain) {
  expect_limit("velocity gain", {11.5, 13.0}, [](auto& a, double f) { a.velocity_controller.gain *= f; });
}
TEST(StabilityLimit, OfTheVelocityGainWithoutNotch) {
  expect_limit("velocity gain without notch", {15.7, 17.9}, [](auto& a, double f) {
    a.notch.reset();
    a.velocity_controller.gain *= f;
  });
}
TEST(StabilityLimit, OfTheCurrentGain) {
  expect_limit("current gain", {4.47, 4.59}, [](auto& a, double f) { a.current_controller->gain *= f; });
}
TEST(StabilityLimit, OfThePositionGain) {
  expect_limit("position gain", {5.40, 4.05}, [](auto& a, double f) { a.position_controller.gain *= f; });
}

// The prototype's dead times are whole ticks: the most that still decays. In the plant's finer steps the limit lies
// between that one and the next.
TEST(StabilityLimit, OfTheDeadTime) {
  const std::array<double, 2> expected{375e-6, 437.5e-6};
  constexpr double tick = 62.5e-6;
  constexpr double step = tick / sim::plant_steps_per_tick;
  std::array<double, 2> whole{}, fine{};
  for (std::size_t k = 0; k < 2; ++k) {
    auto machine = linear_axis(k);
    const double usual = machine.axes[0].inverter.dead_time;
    const auto longest = [&](double unit) {
      int count = 0;
      do machine.axes[0].inverter.dead_time = usual + ++count * unit;
      while (count < 100 && remainder_of_swing(machine) < decays_well);
      return (count - 1) * unit;
    };
    whole[k] = longest(tick);
    fine[k] = longest(step);
    EXPECT_NEAR(whole[k] / expected[k], 1.0, 0.10) << (k == 0 ? "X" : "Y");
  }
  figure("stability limit, extra dead time in whole ticks, X | Y",
         fmt::format("{:.1f} us | {:.1f} us (prototype 375 us | 437 us, within 10 %); in steps of 15.6 us {:.0f} us | "
                     "{:.0f} us",
                     whole[0] * 1e6, whole[1] * 1e6, fine[0] * 1e6, fine[1] * 1e6));
}

}  // namespace
}  // namespace stiction::test
