// The speed pulse at reversals: its characteristic over acceleration, when it comes and how long it stays.
#include "stiction/control/reversal_pulse.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "firmware/machine/configuration/conversion.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction {
namespace {

using machine::to_si;
template <class T>
T signal(double value) {
  return machine::to_signal<T>(value).value();
}

// 1 mm/s from 0.5 to 2 m/s^2, 0.4 mm/s from 5 m/s^2 on; after 3 ticks for 10.
template <class S>
typename ReversalPulse<S>::Config config() {
  typename ReversalPulse<S>::Config c;
  c.amplitude = signal<typename S::Velocity>(1e-3);
  c.final_amplitude = signal<typename S::Velocity>(0.4e-3);
  c.rise = signal<typename S::PulseSlope>(1e-3 / 0.5);
  c.fall = signal<typename S::PulseSlope>(0.6e-3 / 3.0);
  c.flat_until = signal<typename S::Acceleration>(2.0);
  c.delay_ticks = 3;
  c.duration_ticks = 10;
  return c;
}

template <class S>
class PulseOf : public ::testing::Test {};
using Policies = ::testing::Types<FixedSignals, machine::DoubleSignals>;
TYPED_TEST_SUITE(PulseOf, Policies);

TYPED_TEST(PulseOf, AmplitudeRisesStaysAndFallsOverTheAcceleration) {
  const auto c = config<TypeParam>();
  SaturationCounter none;
  const auto at = [&](double a) {
    return to_si(ReversalPulse<TypeParam>::amplitude(c, signal<typename TypeParam::Acceleration>(a), none));
  };
  // A slope is rounded to 6e-8 s.
  constexpr double rounding = 5e-7;
  EXPECT_EQ(at(0.0), 0.0);
  EXPECT_NEAR(at(0.25), 0.5e-3, rounding);
  EXPECT_NEAR(at(0.5), 1e-3, rounding);
  EXPECT_NEAR(at(2.0), 1e-3, rounding);
  EXPECT_NEAR(at(3.5), 0.7e-3, rounding);
  EXPECT_NEAR(at(5.0), 0.4e-3, rounding);
  EXPECT_NEAR(at(20.0), 0.4e-3, rounding);
}

TYPED_TEST(PulseOf, ComesIntoTheNewDirectionAfterItsDelayForItsDuration) {
  using S = TypeParam;
  const auto c = config<S>();
  SaturationCounter none;
  auto state = ReversalPulse<S>::start(c);
  const auto step = [&](double v, double a) {
    return to_si(
        ReversalPulse<S>::step(c, state, signal<typename S::Velocity>(v), signal<typename S::Acceleration>(a), none));
  };
  for (int k = 0; k < 50; ++k) EXPECT_EQ(step(0.1, -1.0), 0.0) << "no pulse before a reversal";
  int ticks = 0;
  for (int k = 0; k < 50; ++k) {
    const double pulse = step(-0.1, -1.0);
    EXPECT_TRUE(k >= 3 || pulse == 0.0);
    if (pulse == 0.0) continue;
    EXPECT_NEAR(pulse, -1e-3, 5e-7);
    ++ticks;
  }
  EXPECT_EQ(ticks, 10);
}

TYPED_TEST(PulseOf, AStopIsNoReversal) {
  using S = TypeParam;
  const auto c = config<S>();
  SaturationCounter none;
  auto state = ReversalPulse<S>::start(c);
  for (const double v : {0.1, 0.0, 0.0, 0.1, 0.0, 0.1})
    for (int k = 0; k < 30; ++k)
      EXPECT_EQ(to_si(ReversalPulse<S>::step(c, state, signal<typename S::Velocity>(v),
                                             signal<typename S::Acceleration>(1.0), none)),
                0.0);
}

TYPED_TEST(PulseOf, AReversalAfterAStopIsOne) {
  using S = TypeParam;
  const auto c = config<S>();
  SaturationCounter none;
  auto state = ReversalPulse<S>::start(c);
  int ticks = 0;
  for (const double v : {-0.1, 0.0, 0.1})
    for (int k = 0; k < 30; ++k)
      ticks += to_si(ReversalPulse<S>::step(c, state, signal<typename S::Velocity>(v),
                                            signal<typename S::Acceleration>(1.0), none)) > 0.0;
  EXPECT_EQ(ticks, 10);
}

}  // namespace
}  // namespace stiction
