// How far each gain is from instability, on the linear machine: no friction, no quantizer, no limits. After a 150 N
// step on one axis the swing must decay. Expected values: an independent prototype's (docs/prototype_figures.md, 2),
// one gain at a time. Its words "no longer decays" leave open how fast; a swing that takes longer than a third of a
// second for a factor of ten is what agrees with all ten of its figures. The margin at which the swing grows for ever
// is measured beside it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/figure.hpp"
#include "tests/support/stability_limit.hpp"

namespace stiction::test {
namespace {

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
