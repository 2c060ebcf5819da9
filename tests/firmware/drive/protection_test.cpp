// The protections by themselves: what of the currents heats which body, and the ends of the thermal model.
#include "stiction/drive/protection.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "stiction/drive/commutation_search.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction {
namespace {

using S = FixedSignals;

// Of 10 A and one second, for steps of 1 ms.
constexpr ThermalModel::Config body{static_cast<std::int64_t>(0x1p36 / 100.0),
                                    static_cast<std::int64_t>(0.0009995001666 * 0x1p56)};

Feedback<S> currents(double a, double b, double c) {
  Feedback<S> feedback;
  const std::array<double, 3> amperes{a, b, c};
  for (std::size_t k = 0; k < 3; ++k)
    feedback.current[k] = S::Current::from_raw(static_cast<std::int32_t>(std::lround(amperes[k] * 0x1p20)));
  return feedback;
}

// Ticks of 62.5 us until a fault, at most ten seconds of them.
std::pair<Fault, int> until_fault(const ProtectionConfig<S>& config, const Feedback<S>& feedback) {
  Protection<S> protection(config);
  for (int k = 1; k <= 160000; ++k)
    if (const Fault fault = protection.step(feedback, {}, true); fault != Fault::none) return {fault, k};
  return {Fault::none, 0};
}

// u = 4 (1 - e^-t) passes 1.025 at t = ln(4 / 2.975) = 0.2961 s.
TEST(Protection, HeatsTheMotorByTheSquareOfTheCurrentsVector) {
  ProtectionConfig<S> config;
  config.three_phase = true;
  config.motor = body;
  const auto [fault, ticks] = until_fault(config, currents(20.0, -10.0, -10.0));
  EXPECT_EQ(fault, Fault::motor_overload);
  EXPECT_NEAR(ticks * 62.5e-6, 0.2961, 1e-3);
  EXPECT_EQ(until_fault(config, currents(10.0, -5.0, -5.0)).first, Fault::none);  // the continuous current
}

// The phase that carries all of it at standstill: twice the mean of a turning one.
TEST(Protection, HeatsAPhaseOfThePowerStageThatStandsTwiceAsMuch) {
  ProtectionConfig<S> config;
  config.three_phase = true;
  config.stage = body;
  EXPECT_EQ(until_fault(config, currents(10.0, -5.0, -5.0)).first, Fault::stage_overload);
  EXPECT_EQ(until_fault(config, currents(7.0, -3.5, -3.5)).first, Fault::none);
}

TEST(Protection, HeatsADcMotorByItsCurrent) {
  ProtectionConfig<S> config;
  config.motor = body;
  EXPECT_EQ(until_fault(config, currents(20.0, 0.0, 0.0)).first, Fault::motor_overload);
  EXPECT_EQ(until_fault(config, currents(9.9, 0.0, 0.0)).first, Fault::none);
}

// At standstill or not, the one leg carries its current.
TEST(Protection, HeatsTheStageOfADcMotorByItsCurrent) {
  ProtectionConfig<S> config;
  config.stage = body;
  EXPECT_EQ(until_fault(config, currents(20.0, 0.0, 0.0)).first, Fault::stage_overload);
  EXPECT_EQ(until_fault(config, currents(9.9, 0.0, 0.0)).first, Fault::none);
  EXPECT_EQ(until_fault(config, currents(0.0, 20.0, 20.0)).first, Fault::none) << "phases that it does not have";
}

// Ten time constants at half of the continuous current; the third phase is the hottest one.
TEST(Protection, TellsHowWarmMotorAndHottestPhaseAre) {
  ProtectionConfig<S> config;
  config.three_phase = true;
  config.motor = config.stage = body;
  Protection<S> protection(config);
  EXPECT_EQ(protection.motor_percent(), 0);
  EXPECT_EQ(protection.stage_state(), 0);
  for (int k = 0; k < 160000; ++k) protection.step(currents(-2.5, -2.5, 5.0), {}, true);
  EXPECT_NEAR(protection.motor_percent(), 25, 1);  // of an amplitude of 5 A
  EXPECT_NEAR(static_cast<double>(protection.stage_state()) * 0x1p-40, 0.5, 1e-3);
}

// With a time constant of 10000 s, a day at 101 % of the current's square ends at 101 %, no word overflows at 2000 A.
TEST(ThermalModel, KeepsItsDigitsWithLongTimeConstantsAndLargeCurrents) {
  const ThermalModel::Config slow{static_cast<std::int64_t>(0x1p36 / 100.0), static_cast<std::int64_t>(1e-4 * 0x1p56)};
  ThermalModel model;
  for (int k = 0; k < 200000; ++k) model.step(slow, static_cast<std::int64_t>(101.0 * 0x1p20));
  EXPECT_NEAR(static_cast<double>(model.state()) * 0x1p-40, 1.01, 1e-4);
  ThermalModel hot;
  for (int k = 0; k < 100000; ++k) hot.step(slow, static_cast<std::int64_t>(2000.0 * 2000.0 * 0x1p20));
  EXPECT_GT(hot.state(), ThermalModel::trip);
}

// From 0, 120 and 240 degrees on a signal is high for half a turn.
TEST(HallSignals, NameTheirSectorOrNone) {
  for (int sector = 0; sector < 6; ++sector) {
    const int middle = 60 * sector + 30;
    int code = 0;
    for (int k = 0; k < 3; ++k)
      if ((middle - 120 * k + 360) % 360 < 180) code |= 1 << k;
    EXPECT_EQ(hall_sector(static_cast<std::uint8_t>(code)), sector);
  }
  EXPECT_EQ(hall_sector(0), -1);
  EXPECT_EQ(hall_sector(7), -1);
}

}  // namespace
}  // namespace stiction
