// The drive's configuration from a machine's SI values, and what it refuses.
#include "firmware/machine/configuration/axis_configuration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "firmware/machine/configuration/conversion.hpp"
#include "firmware/machine/configuration/double_signals.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::machine {
namespace {

using Fix = FixedSignals;

constexpr Timing timing{62.5e-6, 1e-3};

// The Y axis of the cross table (Mendricky 2006, Tab 3.1 to 3.3): two motors on one servo module.
AxisModel y_axis() {
  AxisModel axis;
  axis.name = "y";
  axis.mass = 520.0;
  axis.max_velocity = 80.0 / 60.0;
  axis.motor = {MotorModel::synchronous, false, 1.8, 18e-3, 1.8e-3, 62.8, 62.8, 94.0, 0.072, 2};
  axis.inverter = {0.125e-3, 300.0, 40.0};
  axis.encoder.velocity = VelocitySource::estimated;
  axis.position_controller = {83.3, 1e-6};
  axis.velocity_controller = {1200.0, 4.4e-3};
  axis.current_controller = CurrentControllerParameters{17.0, 2e-3};
  axis.notch = NotchParameters{2000.0, 0.05, 0.7};
  axis.feedforward = {1.0, 1.0};
  return axis;
}

// Half a bit of T, SI.
template <class T>
double half_bit() {
  if constexpr (std::is_same_v<T, Real>)
    return 1e-15;
  else
    return std::ldexp(0.5, -T::fraction_bits);
}

template <class T>
void expect_value(T signal, double expected, const char* what) {
  EXPECT_NEAR(to_si(signal), expected, 1.0001 * half_bit<T>() + 1e-15 * std::abs(expected)) << what;
}

template <class S>
void check_y_axis() {
  const auto c = configure_axis<S>(timing, y_axis());
  EXPECT_EQ(c.period_ns, 62500);
  expect_value(c.inverse_period, 1.0 / 62500.0, "1/ns");
  EXPECT_TRUE(c.quantizer.enabled);
  expect_value(c.quantizer.per_metre, 1e6, "increments");
  expect_value(c.quantizer.increment, 1e-6, "increment");
  expect_value(c.position_gain, 83.3, "K_v");
  expect_value(c.velocity_feedforward, 1.0, "K_wv");
  EXPECT_EQ(c.velocity_feedback, VelocityFeedback::difference);
  expect_value(c.velocity.proportional, 1200.0, "k_pv");
  expect_value(c.velocity.integral, 1200.0 * 62.5e-6 / 4.4e-3, "k_pv T / T_Nv");
  expect_value(c.velocity.tracking, 62.5e-6 / 4.4e-3, "T / T_Nv");
  EXPECT_TRUE(c.notch.enabled);
  expect_value(c.current_feedforward, 520.0 / 94.0, "m / K_F3");
  EXPECT_EQ(c.current_loop, CurrentLoop::three_phase);
  expect_value(c.current.proportional, 17.0, "k_pi");
  expect_value(c.current.integral, 17.0 * 62.5e-6 / 2e-3, "k_pi T / T_Ni");
  expect_value(c.current.tracking, 62.5e-6 / 2e-3, "T / T_Ni");
  expect_value(c.inverse_pole_pair_pitch, 1.0 / 0.072, "1 / pitch");
  expect_value(c.velocity_limit, 80.0 / 60.0, "v_max");
  expect_value(c.current_limit, 80.0, "both motors together");
  expect_value(c.voltage_limit, 300.0, "DC link");
  // Defaults of the supervision.
  expect_value(c.following_error_fault, 2e-3, "following error");
  expect_value(c.over_current_fault, 96.0, "1.2 of the current limit");
  expect_value(c.over_speed_fault, 1.2 * 80.0 / 60.0, "1.2 of the largest velocity");
  EXPECT_EQ(c.limit_cycle_window_ticks, 2000u) << "125 ms";
}

TEST(AxisConfiguration, CarriesEveryParameterIntoTheFixedFormats) { check_y_axis<Fix>(); }
TEST(AxisConfiguration, CarriesEveryParameterIntoDouble) { check_y_axis<DoubleSignals>(); }

TEST(AxisConfiguration, TakesTheSupervisionWhereItIsGiven) {
  auto axis = y_axis();
  axis.supervision = {5e-4, 50.0, 1.1};
  const auto c = configure_axis<Fix>(timing, axis);
  expect_value(c.following_error_fault, 5e-4, "following error");
  expect_value(c.over_current_fault, 50.0, "current");
  expect_value(c.over_speed_fault, 1.1, "speed");
}

TEST(AxisConfiguration, WhatIsLeftOutIsOff) {
  auto axis = y_axis();
  axis.position_controller.increment = 0.0;
  axis.velocity_controller.integral_time.reset();
  axis.current_controller->integral_time.reset();
  axis.notch.reset();
  axis.feedforward = {};
  const auto c = configure_axis<Fix>(timing, axis);
  EXPECT_FALSE(c.quantizer.enabled);
  EXPECT_FALSE(c.notch.enabled);
  EXPECT_EQ(c.velocity.integral.raw(), 0);
  EXPECT_EQ(c.velocity.tracking.raw(), 0);
  EXPECT_EQ(c.current.integral.raw(), 0);
  EXPECT_EQ(c.velocity_feedforward.raw(), 0);
  EXPECT_EQ(c.current_feedforward.raw(), 0);
}

TEST(AxisConfiguration, AForceMotorIsLimitedByItsVoltageAndHasNoCurrentLoop) {
  auto axis = y_axis();
  axis.motor = {};
  axis.motor.model = MotorModel::force;
  axis.motor.force_constant = 35.0;
  axis.inverter = {0.0, 10.0, INFINITY};
  axis.current_controller.reset();
  axis.encoder.velocity = VelocitySource::mean_difference;
  const auto c = configure_axis<Fix>(timing, axis);
  EXPECT_EQ(c.current_loop, CurrentLoop::none);
  EXPECT_EQ(c.velocity_feedback, VelocityFeedback::mean_difference);
  expect_value(c.current_limit, 10.0, "1 A stands for 1 V");
  expect_value(c.current_feedforward, 520.0 / 35.0, "V s^2/m");
}

TEST(AxisConfiguration, MapsMotorsAndVelocitySources) {
  auto axis = y_axis();
  axis.motor.model = MotorModel::dc;
  axis.encoder.velocity = VelocitySource::ideal;
  const auto c = configure_axis<Fix>(timing, axis);
  EXPECT_EQ(c.current_loop, CurrentLoop::direct);
  EXPECT_EQ(c.velocity_feedback, VelocityFeedback::given);
}

TEST(AxisConfiguration, CountsTicks) {
  EXPECT_EQ(slow_ratio(timing), 16);
  EXPECT_EQ(slow_ratio({1e-3, 1e-3}), 1);
  EXPECT_EQ(fast_period_ns(timing), 62500);
  EXPECT_EQ(fast_period_ns({1e-3 / 3.0, 1e-3}), 333333);
}

struct Refused {
  const char* key;
  const char* value;  // as the message shows it
  std::function<void(AxisModel&)> change;
};

const std::vector<Refused> refused{
    {"axis.y.position_controller.gain", "2000", [](AxisModel& a) { a.position_controller.gain = 2000.0; }},
    {"axis.y.position_controller.gain", "1e-05", [](AxisModel& a) { a.position_controller.gain = 1e-5; }},
    {"axis.y.position_controller.increment", "0.0001", [](AxisModel& a) { a.position_controller.increment = 1e-4; }},
    {"axis.y.position_controller.increment", "1e+10", [](AxisModel& a) { a.position_controller.increment = 1e-10; }},
    {"axis.y.feedforward.velocity", "100", [](AxisModel& a) { a.feedforward.velocity = 100.0; }},
    {"axis.y.feedforward.current", "553191", [](AxisModel& a) { a.mass = 5.2e7; }},
    {"axis.y.velocity_controller.gain", "1e+07", [](AxisModel& a) { a.velocity_controller.gain = 1e7; }},
    {"axis.y.velocity_controller.integral_time", "gain * period / time",
     [](AxisModel& a) { a.velocity_controller.integral_time = 1e-9; }},
    {"axis.y.velocity_controller.integral_time", "gain * period / time",
     [](AxisModel& a) { a.velocity_controller.integral_time = 1e7; }},
    {"axis.y.current_controller.gain", "100000", [](AxisModel& a) { a.current_controller->gain = 1e5; }},
    {"axis.y.current_controller.integral_time", "gain * period / time",
     [](AxisModel& a) { a.current_controller->integral_time = 1e-9; }},
    {"axis.y.motor.pole_pair_pitch", "2000", [](AxisModel& a) { a.motor.pole_pair_pitch = 5e-4; }},
    {"axis.y.max_velocity", "9", [](AxisModel& a) { a.max_velocity = 9.0; }},
    {"axis.y.inverter.current_limit", "3000", [](AxisModel& a) { a.inverter.current_limit = 1500.0; }},
    {"axis.y.inverter.current_limit", "inf", [](AxisModel& a) { a.inverter.current_limit = INFINITY; }},
    {"axis.y.inverter.voltage_limit", "10000", [](AxisModel& a) { a.inverter.voltage_limit = 10000.0; }},
    {"axis.y.supervision.following_error", "0.6", [](AxisModel& a) { a.supervision.following_error = 0.6; }},
    {"axis.y.supervision.over_current", "5000", [](AxisModel& a) { a.supervision.over_current = 5000.0; }},
    {"axis.y.supervision.over_speed", "20", [](AxisModel& a) { a.supervision.over_speed = 20.0; }},
    {"axis.y.position_controller.gain", "nan", [](AxisModel& a) { a.position_controller.gain = std::nan(""); }},
};

TEST(AxisConfiguration, RefusesWhatAFormatCannotHoldAndNamesKeyAndValue) {
  for (const auto& row : refused) {
    auto axis = y_axis();
    row.change(axis);
    try {
      configure_axis<Fix>(timing, axis);
      ADD_FAILURE() << row.key << " was taken";
    } catch (const ConfigurationError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.find(row.key), 0u) << what;
      EXPECT_NE(what.find(row.value), std::string::npos) << what;
      EXPECT_NE(what.find("expected"), std::string::npos) << what;
    }
  }
}

TEST(AxisConfiguration, NamesATimingByItsOwnKeyAndInItsOwnUnit) {
  // The format of the inverse period holds periods from 32.8 us on.
  try {
    configure_axis<Fix>({25e-6, 1e-3}, y_axis());
    ADD_FAILURE() << "a period of 25 us was taken";
  } catch (const ConfigurationError& error) {
    const std::string what = error.what();
    EXPECT_EQ(what.find("timing.fast_period"), 0u) << "no axis has this key: " << what;
    EXPECT_NE(what.find("25"), std::string::npos) << "the period itself is what stands in the file: " << what;
  }
}

TEST(AxisConfiguration, RefusesAVelocityThatTheMotionBetweenTwoSamplesCannotHold) {
  // The motion between two samples ends at 1.95 mm. Over the two ticks of a mean difference at 1 ms this is 0.98 m/s:
  // a faster axis would read a velocity that is too low, silently, and its over-speed limit of 1.6 m/s could never act.
  auto axis = y_axis();
  axis.encoder.velocity = VelocitySource::mean_difference;
  try {
    configure_axis<Fix>({1e-3, 1e-3}, axis);
    ADD_FAILURE() << "1.33 m/s at a tick of 1 ms was taken";
  } catch (const ConfigurationError& error) {
    EXPECT_NE(std::string(error.what()).find("max_velocity"), std::string::npos) << error.what();
  }
}

TEST(AxisConfiguration, InDoubleOnlyRefusesWhatIsNotFinite) {
  auto axis = y_axis();
  axis.position_controller.gain = 1e6;
  axis.velocity_controller.gain = 1e9;
  EXPECT_NO_THROW(configure_axis<DoubleSignals>(timing, axis));
  axis.position_controller.gain = INFINITY;
  EXPECT_THROW(configure_axis<DoubleSignals>(timing, axis), ConfigurationError);
}

TEST(AxisConfiguration, ResolvesEveryGainOfTheFormatsToOnePercentOrRefusesIt) {
  for (double gain = 1e-7; gain < 900.0; gain *= 1.7) {
    auto axis = y_axis();
    axis.position_controller.gain = gain;
    try {
      const auto c = configure_axis<Fix>(timing, axis);
      EXPECT_NEAR(to_si(c.position_gain), gain, 0.01 * gain);
    } catch (const ConfigurationError&) {
      EXPECT_LT(gain, 1e-4) << "50 bits of the gain's last one, 2^-20";
    }
  }
}

}  // namespace
}  // namespace stiction::machine
