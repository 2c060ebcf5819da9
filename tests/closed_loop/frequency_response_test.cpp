// Margins measured with a test signal while the axis moves, against the gains at which it goes unstable. Measured on
// the shipped machine as it is: firmware in fixed point, three-phase motor, LuGre friction, quantizer of 1 um. Found on
// the linear axis by raising one gain at a time (stability_limit.hpp). From one set of random phases to another, the
// quantizer's noise scatters the velocity gain's margin by 1.7 % (standard deviation of eleven), the others' by 0.3 %;
// friction, which the linear axis has not, adds 1.5 to 2.3 % to the position gain's.
#include "host/simulate/frequency_response.hpp"

#include <gtest/gtest.h>

#include <array>

#include "host/response/axis_response.hpp"
#include "host/simulate/circle.hpp"
#include "tests/support/figure.hpp"
#include "tests/support/stability_limit.hpp"

namespace stiction::test {
namespace {

using host::AxisResponse;
using host::LoopResponse;

constexpr double agreement = 0.05;

std::array<AxisResponse, 2> responses_of(const host::FrequencyResponsePlan& plan, const host::Log& log) {
  std::array<AxisResponse, 2> result;
  for (std::size_t k = 0; k < 2; ++k)
    result[k] = host::axis_response(log, log.axes[k], plan.machine.timing, plan.machine.axes[k]);
  return result;
}

host::FrequencyResponsePlan plan_for(const machine::Machine& machine) {
  host::FrequencyResponsePlan plan;
  plan.machine = machine;
  return plan;
}

std::array<AxisResponse, 2> measure(const host::FrequencyResponsePlan& plan) {
  return responses_of(plan, run_frequency_response(plan));
}

const std::array<AxisResponse, 2>& shipped() {
  static const auto responses = measure(plan_for(cross_table()));
  return responses;
}

// Holds both predictions of one loop's margins to what raising the gain finds; `study`: docs/prototype_figures.md, 2.
void expect_agreement(const char* what, const std::array<const LoopResponse*, 2>& loops, std::array<double, 2> study,
                      auto&& scale) {
  std::array<double, 2> unstable{}, decaying{};
  for (std::size_t k = 0; k < 2; ++k) {
    ASSERT_TRUE(loops[k]->limit && loops[k]->decays) << what;
    unstable[k] = limit_factor(k, decays_at_all, scale);
    decaying[k] = limit_factor(k, decays_well, scale);
    const char* axis = k == 0 ? " X" : " Y";
    EXPECT_NEAR(loops[k]->limit->factor / unstable[k], 1.0, agreement) << what << axis;
    EXPECT_NEAR(loops[k]->decays->factor / decaying[k], 1.0, agreement) << what << axis;
    EXPECT_NEAR(loops[k]->decays->factor / study[k], 1.0, agreement) << what << axis;
  }
  figure(
      fmt::format("frequency response, {}, margin, X | Y", what),
      fmt::format("x{:.2f} | x{:.2f}, unstable from x{:.2f} | x{:.2f} (within 5 %); decaying up to x{:.2f} | x{:.2f}, "
                  "found x{:.2f} | x{:.2f}, prototype x{:g} | x{:g} (within 5 %)",
                  loops[0]->limit->factor, loops[1]->limit->factor, unstable[0], unstable[1], loops[0]->decays->factor,
                  loops[1]->decays->factor, decaying[0], decaying[1], study[0], study[1]));
}

TEST(FrequencyResponse, PredictsTheCurrentGainAtWhichTheAxisGoesUnstable) {
  const auto& r = shipped();
  ASSERT_TRUE(r[0].current && r[1].current);
  expect_agreement("current gain", {&*r[0].current, &*r[1].current}, {4.47, 4.59},
                   [](auto& a, double f) { a.current_controller->gain *= f; });
}
TEST(FrequencyResponse, PredictsTheVelocityGainAtWhichTheAxisGoesUnstable) {
  const auto& r = shipped();
  expect_agreement("velocity gain", {&r[0].velocity, &r[1].velocity}, {11.5, 13.0},
                   [](auto& a, double f) { a.velocity_controller.gain *= f; });
}
TEST(FrequencyResponse, PredictsThePositionGainAtWhichTheAxisGoesUnstable) {
  const auto& r = shipped();
  expect_agreement("position gain", {&r[0].position, &r[1].position}, {5.40, 4.05},
                   [](auto& a, double f) { a.position_controller.gain *= f; });
}
TEST(FrequencyResponse, PredictsTheVelocityGainWithoutNotch) {
  auto machine = cross_table();
  for (auto& axis : machine.axes) axis.notch.reset();
  const auto r = measure(plan_for(machine));
  expect_agreement("velocity gain without notch", {&r[0].velocity, &r[1].velocity}, {15.7, 17.9},
                   [](auto& a, double f) {
                     a.notch.reset();
                     a.velocity_controller.gain *= f;
                   });
}

// The loop alone differs from the axis' return ratio by what the outer loops add at its phase crossover: 1.5 % of the
// current gain, 1.3 % of the velocity gain on the linear axis; 3 % leaves room for the quantizer's noise.
TEST(FrequencyResponse, TheMarginOfALoopAloneIsThatOfTheAxisWithinThreePercent) {
  for (const auto& r : shipped())
    for (const auto* loop : {&*r.current, &r.velocity, &r.position})
      EXPECT_NEAR(loop->gain->factor / loop->limit->factor, 1.0, 0.03) << r.axis;
}

TEST(FrequencyResponse, OneSineAfterTheOtherGivesTheMarginsOfTheMultisine) {
  auto plan = plan_for(cross_table());
  plan.signal = host::TestSignal::stepped_sine;
  const auto stepped = measure(plan);
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& many = shipped()[k];
    const auto& one = stepped[k];
    EXPECT_NEAR(one.current->limit->factor / many.current->limit->factor, 1.0, agreement);
    EXPECT_NEAR(one.velocity.limit->factor / many.velocity.limit->factor, 1.0, agreement);
    EXPECT_NEAR(one.position.limit->factor / many.position.limit->factor, 1.0, agreement);
    EXPECT_NEAR(one.velocity.phase->degrees, many.velocity.phase->degrees, 2.0);
  }
}

// What a customer's log may lack: then the machine file's controllers take the place of the set current, and the
// position that of the speed.
TEST(FrequencyResponse, ALogOfPositionAndCurrentAloneGivesTheSameMargins) {
  const auto plan = plan_for(cross_table());
  auto log = run_frequency_response(plan);
  for (auto& axis : log.axes) axis.x_set = axis.v_set = axis.v = axis.i_set = {};
  const auto bare = responses_of(plan, log);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_TRUE(bare[k].set_current_computed);
    EXPECT_FALSE(shipped()[k].set_current_computed);
    EXPECT_NEAR(bare[k].current->limit->factor / shipped()[k].current->limit->factor, 1.0, agreement);
    EXPECT_NEAR(bare[k].velocity.limit->factor / shipped()[k].velocity.limit->factor, 1.0, agreement);
    EXPECT_NEAR(bare[k].position.limit->factor / shipped()[k].position.limit->factor, 1.0, agreement);
  }
}

// At 100 Hz friction's slope and the mass decide: v/i = K_F/(m s + mu_v), the mount is stiff. LuGre at 2 m/min follows
// the speed with a corner at 47 Hz (k_s v/F_C), which takes its part of the phase: 2 % and 2 deg.
TEST(FrequencyResponse, ThePlantAloneIsThatOfTheMass) {
  const auto& machine = cross_table();
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& plant = shipped()[k].plant;
    const auto place =
        std::lower_bound(plant.frequency.begin(), plant.frequency.end(), 100.0) - plant.frequency.begin();
    const double w = 2.0 * std::numbers::pi * plant.frequency[static_cast<std::size_t>(place)];
    const auto& axis = machine.axes[k];
    const double expected = axis.motor.force_constant / (axis.mass * w);
    EXPECT_NEAR(std::abs(plant.value[static_cast<std::size_t>(place)]) / expected, 1.0, 0.02);
    EXPECT_NEAR(std::arg(plant.value[static_cast<std::size_t>(place)]) * 180.0 / std::numbers::pi, -90.0, 2.0);
  }
}

void expect_refused(const host::FrequencyResponsePlan& plan, const std::string& message) {
  try {
    run_frequency_response(plan);
    FAIL() << "not refused; expected: " << message;
  } catch (const host::InfeasibleMotion& refusal) {
    EXPECT_NE(std::string(refusal.what()).find(message), std::string::npos) << refusal.what();
  }
}

TEST(FrequencyResponse, RefusesASpeedThatCrossesZeroWithTheSpeedItNeeds) {
  auto plan = plan_for(cross_table());
  plan.speed = 0.05 / 60.0;
  expect_refused(plan, "speed: found 0.05 m/min, but with a test signal of 7 A axis X falls to -");
  expect_refused(plan, "expected a speed that never crosses zero: at least 0.");
}

TEST(FrequencyResponse, RefusesAnAmplitudeThatALimitHoldsBack) {
  auto plan = plan_for(cross_table());
  for (const double amplitude : {20.0, 60.0}) {  // of the 600 V; and until the axis stops with a fault
    plan.amplitude = amplitude;
    expect_refused(plan, fmt::format("amplitude: found {} A, with which axis X is held back at a limit", amplitude));
  }
}

TEST(FrequencyResponse, RefusesAPassThatIsLongerThanTheTravel) {
  auto plan = plan_for(cross_table());
  plan.speed = 20.0 / 60.0;
  expect_refused(plan, "expected at most the travel of axis X, 500 mm");
}

}  // namespace
}  // namespace stiction::test
