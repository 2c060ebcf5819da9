// A drive's configuration from SI units alone, against the machine file of the same axis, and what validate() says.
#include "stiction/design/axis_design.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "tests/firmware/design/configuration_words.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

// The Y axis of the cross table as mcfv5050ln.toml has it: two synchronous motors on one servo module.
constexpr AxisDesign y_axis{
    .timing = {.fast_period = 62.5e-6, .slow_period = 1e-3},
    .mass = 520.0,
    .max_velocity = 80.0 / 60.0,
    .motor = {.loop = CurrentLoop::three_phase, .force_constant = 94.0, .pole_pair_pitch = 0.072, .count = 2},
    .inverter = {.voltage_limit = 600.0, .current_limit = 70.0},
    .encoder = {.velocity = VelocityFeedback::given},
    .position_controller = {.gain = 83.3333, .increment = 1e-6},
    .velocity_controller = {.gain = 1200.0, .integral_time = 4.4e-3},
    .notch = {.frequency = 2000.0, .numerator_damping = 0.05, .denominator_damping = 0.7},
    .current_controller = {.gain = 17.0, .integral_time = 2e-3},
    .feedforward = {.velocity = 1.0, .current = 1.0},
};

// The axis of emps.toml: a force source under a proportional controller.
constexpr AxisDesign emps{
    .timing = {.fast_period = 1e-3, .slow_period = 1e-3},
    .mass = 95.1089,
    .max_velocity = 0.2,
    .motor = {.loop = CurrentLoop::none, .force_constant = 35.15065188248547},
    .inverter = {.voltage_limit = 10.0},
    .encoder = {.velocity = VelocityFeedback::mean_difference},
    .position_controller = {.gain = 160.18},
    .velocity_controller = {.gain = 243.45},
};

std::vector<std::string> sentences(const AxisDesign& design) {
  std::vector<std::string> all;
  for (const auto& problem : design.validate()) all.emplace_back(problem.sentence().c_str());
  return all;
}

TEST(AxisDesign, GivesTheConfigurationOfTheSameMachineFileToTheBit) {
  const auto machine = cross_table();
  EXPECT_EQ(words(y_axis.configuration()),
            words(machine::configure_axis<FixedSignals>(machine.timing, machine.axes.at(1))));
  EXPECT_EQ(y_axis.slow_ticks(), 16u);
  const auto ball_screw =
      sim::read_machine(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/emps.toml", {});
  EXPECT_EQ(words(emps.configuration()),
            words(machine::configure_axis<FixedSignals>(ball_screw.timing, ball_screw.axes.at(0))));
  EXPECT_EQ(emps.slow_ticks(), 1u);
}

[[maybe_unused]] constexpr AxisDesign with_notch(double frequency) {
  auto design = y_axis;
  design.notch.frequency = frequency;
  return design;
}

// Clang has no tangent while compiling; of designs without a notch it makes constants as well.
TEST(AxisDesign, IsTheSameWhileCompilingAndWhileRunning) {
  static_assert(emps.validate().empty());
  static constinit const auto constant = emps.configuration();
  EXPECT_EQ(words(constant), words(emps.configuration()));
#ifndef __clang__
  constexpr double frequencies[] = {100.0, 900.0, 2000.0, 7900.0};
  static constinit const auto constants = [](const auto& all) {
    std::array<AxisConfig<FixedSignals>, 4> configs;
    for (std::size_t k = 0; k < configs.size(); ++k) configs[k] = with_notch(all[k]).configuration();
    return configs;
  }(frequencies);
  for (std::size_t k = 0; k < constants.size(); ++k) {
    const volatile double frequency = frequencies[k];  // the compiler knows nothing of it
    EXPECT_EQ(words(constants[k]), words(with_notch(frequency).configuration())) << frequencies[k] << " Hz";
  }
#endif
}

struct Wrong {
  const char* sentence;
  std::function<void(AxisDesign&)> change;
};

// Sentences are read by people, so that they are here as a whole. Bounds: powers of two of the formats (FixedSignals).
const std::vector<Wrong> wrong{
    {"timing.fast_period: found 0 s; expected more than 0 s", [](AxisDesign& d) { d.timing.fast_period = 0.0; }},
    {"timing.fast_period: found 2 s; expected at most 0.1 s", [](AxisDesign& d) { d.timing.fast_period = 2.0; }},
    {"timing.fast_period: found 25 us; expected at least 32.768 us, the range of the drive's number format",
     [](AxisDesign& d) { d.timing.fast_period = 25e-6; }},
    {"timing.slow_period: found 0.00103 s; expected a whole multiple of 6.25e-05 s, the fast_period",
     [](AxisDesign& d) { d.timing.slow_period = 1.03e-3; }},
    {"mass: found -1 kg; expected more than 0 kg", [](AxisDesign& d) { d.mass = -1.0; }},
    {"mass: found nan kg; expected more than 0 kg", [](AxisDesign& d) { d.mass = std::nan(""); }},
    {"motor.force_constant: found 0 N/A; expected more than 0 N/A",
     [](AxisDesign& d) { d.motor.force_constant = 0.0; }},
    {"motor.pole_pair_pitch: found 0 m; expected more than 0 m", [](AxisDesign& d) { d.motor.pole_pair_pitch = 0.0; }},
    {"inverter.current_limit: found 4000 A; expected at most 2048 A in magnitude, the range of the drive's number "
     "format",
     [](AxisDesign& d) { d.inverter.current_limit = 2000.0; }},
    {"position_controller.gain: found 1e-05 1/s; expected a value that the drive's number format resolves to 1 %, but "
     "it "
     "would become 9.53674e-06 1/s",
     [](AxisDesign& d) { d.position_controller.gain = 1e-5; }},
    {"velocity_controller.integral_time: found gain * period / time = 75000 A s/m; expected at most 16384 A s/m in "
     "magnitude, the range of the drive's number format",
     [](AxisDesign& d) { d.velocity_controller.integral_time = 1e-6; }},
    {"velocity_controller.integral_time: found -0.001 s; expected at least 0 s",
     [](AxisDesign& d) { d.velocity_controller.integral_time = -1e-3; }},
    {"current_controller.gain: found 0 V/A; expected more than 0 V/A",
     [](AxisDesign& d) { d.current_controller.gain = 0.0; }},
    {"notch.frequency: found 9000 Hz; expected more than 0 Hz and less than 8000 Hz, half of the fast loop's rate",
     [](AxisDesign& d) { d.notch.frequency = 9000.0; }},
    {"feedforward.velocity: found 11; expected at most 10", [](AxisDesign& d) { d.feedforward.velocity = 11.0; }},
    {"supervision.following_error: found 0.6 m; expected at most 0.5 m in magnitude, the range of the drive's number "
     "format",
     [](AxisDesign& d) { d.supervision.following_error = 0.6; }},
};

TEST(AxisDesign, SaysInASentenceWhatIsWrong) {
  ASSERT_TRUE(y_axis.validate().empty());
  for (const auto& row : wrong) {
    auto design = y_axis;
    row.change(design);
    const auto found = sentences(design);
    EXPECT_NE(std::find(found.begin(), found.end(), row.sentence), found.end())
        << row.sentence << "; first said: " << (found.empty() ? "nothing" : found[0]);
  }
}

TEST(AxisDesign, NamesTheUnitsOfAForceSourceInVolts) {
  auto design = emps;
  design.velocity_controller.gain = 0.0;
  design.current_controller.gain = 3.0;
  const std::vector<std::string> expected{
      "velocity_controller.gain: found 0 V s/m; expected more than 0 V s/m",
      "current_controller.gain: found 3 V/A; expected none, 0 V/A, with a force source"};
  EXPECT_EQ(sentences(design), expected);
}

TEST(AxisDesign, ListsEveryProblemAtOnceAndCountsThoseWithoutRoom) {
  const AxisDesign empty;  // a motor, an inverter, both gains, mass and speed are missing
  EXPECT_EQ(sentences(empty).size(), 8u);
  design::Problems many;
  for (int k = 0; k < 40; ++k) many.add({});
  EXPECT_EQ(many.size(), design::Problems::capacity);
  EXPECT_EQ(many.found(), 40u);
}

TEST(AxisDesign, ThatDoesNotValidateGivesAnAxisWithoutForce) {
  auto design = y_axis;
  design.mass = 0.0;
  Axis<FixedSignals> axis(design.configuration());
  AxisSignals<FixedSignals> signals;
  Feedback<FixedSignals> feedback;
  feedback.position_valid = true;
  axis.start(feedback);
  SetPoint<FixedSignals> set;
  set.position = design::to_signal<FixedSignals::Position>(1e-3);
  for (int tick = 1; tick < 100; ++tick) {
    feedback.position_time_ns = tick * 62500;
    const auto command = axis.tick(set, feedback, tick * 62500, true, signals);
    for (const auto u : command.voltage) ASSERT_EQ(u.raw(), 0) << tick;
  }
  EXPECT_EQ(axis.fault(), Fault::following_error) << "a limit of zero is exceeded by any error";
}

void expect_as_printf(double value) {
  char expected[32];
  std::snprintf(expected, sizeof expected, "%g", value);
  design::Text<32> text;
  text << value;
  EXPECT_STREQ(text.c_str(), expected);
}

TEST(DesignText, WritesNumbersAsPrintfDoes) {
  for (double x = 1e-300; x < 1e300; x *= 7.3) {
    expect_as_printf(x);
    expect_as_printf(-x);
  }
  for (const double x : {0.0, 1.0, 10.0, 999999.5, 100000.0, 0.0001, 5e-324, 1.7976931348623157e308})
    expect_as_printf(x);
  expect_as_printf(std::numeric_limits<double>::infinity());
  expect_as_printf(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace
}  // namespace stiction::test
