// Friction from set-points: presliding by distance, damping, sliding curve, in both signal policies.
#include "stiction/control/friction_feedforward.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "firmware/machine/configuration/conversion.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction {
namespace {

using machine::to_si;
template <class T>
T signal(double value) {
  return machine::to_signal<T>(value).value();
}

constexpr double coulomb = 1.0;  // A

// Eight elements of an eighth of the level each, which slip again 2, 4, .. 256 um after a reversal.
template <class S>
typename FrictionFeedforward<S>::Config elements(double damping = 0.0) {
  typename FrictionFeedforward<S>::Config c;
  for (int k = 0; k < 8; ++k) {
    const double reach = std::ldexp(1e-6, k);
    c.elements[static_cast<std::size_t>(k)] = {signal<typename S::Step>(reach),
                                               signal<typename S::ContactStiffness>(0.125 * coulomb / reach)};
  }
  c.damping = signal<typename S::ContactDamping>(damping);
  c.limit = signal<typename S::Current>(100.0);
  return c;
}

template <class S>
class Feedforward {
 public:
  explicit Feedforward(const typename FrictionFeedforward<S>::Config& config) : config_(config) {}
  typename FrictionFeedforward<S>::Terms step(double dx, double v = 0.0) {
    return FrictionFeedforward<S>::step(config_, state_, signal<typename S::Step>(dx), signal<typename S::Velocity>(v),
                                        saturations_);
  }
  // Moves by `way` in steps of at most 0.1 um; the contact's current at the end.
  double move(double way) {
    const int steps = static_cast<int>(std::ceil(std::abs(way) / 1e-7));
    double current = to_si(step(0.0).contact);
    for (int k = 0; k < steps; ++k) current = to_si(step(way / steps).contact);
    return current;
  }
  SaturationCounter saturations_;

 private:
  typename FrictionFeedforward<S>::Config config_;
  typename FrictionFeedforward<S>::State state_;
};

template <class S>
class FeedforwardOf : public ::testing::Test {};
using Policies = ::testing::Types<FixedSignals, machine::DoubleSignals>;
TYPED_TEST_SUITE(FeedforwardOf, Policies);

// A stiffness is rounded by up to 1/16 A/m, and the reaches are 255 um in all; a current is rounded by 5e-7 A.
constexpr double rounding = 255e-6 / 16 + 5e-7;

TYPED_TEST(FeedforwardOf, SlidesAtTheCoulombLevelInBothDirections) {
  Feedforward<TypeParam> f(elements<TypeParam>());
  EXPECT_NEAR(f.move(1e-3), coulomb, rounding);
  EXPECT_NEAR(f.move(-1e-3), -coulomb, rounding);
  EXPECT_EQ(f.saturations_.count, 0u);
}

TYPED_TEST(FeedforwardOf, ComesBackFromTheOneLevelToTheOtherOverTheDistances) {
  Feedforward<TypeParam> f(elements<TypeParam>());
  f.move(1e-3);
  for (const double way : {1e-6, 2e-6, 10e-6, 100e-6, 256e-6, 400e-6}) {
    Feedforward<TypeParam> g = f;
    double expected = 0.0;
    for (int k = 0; k < 8; ++k) expected += 0.125 * coulomb * std::max(-1.0, 1.0 - 2.0 * way / std::ldexp(2e-6, k));
    EXPECT_NEAR(g.move(-way), expected, rounding) << way;
  }
}

TYPED_TEST(FeedforwardOf, AReversalInsideOfAReversalLeavesNoTrace) {
  Feedforward<TypeParam> f(elements<TypeParam>());
  f.move(1e-3);
  f.move(-30e-6);
  Feedforward<TypeParam> straight = f;
  f.move(7e-6);
  f.move(-2e-6);
  f.move(2e-6);
  f.move(-7e-6);
  // The steps there and back add up to the same but for the format's last bit, 1 pm each.
  EXPECT_NEAR(f.move(-5e-6), straight.move(-5e-6), 1e-5);
}

TYPED_TEST(FeedforwardOf, StandsStillWithTheLastCurrent) {
  Feedforward<TypeParam> f(elements<TypeParam>());
  f.move(1e-3);
  const double before = f.move(-20e-6);
  for (int k = 0; k < 1000; ++k) EXPECT_EQ(to_si(f.step(0.0).contact), before);
}

TYPED_TEST(FeedforwardOf, DampingAddsTheChangeOfATick) {
  Feedforward<TypeParam> f(elements<TypeParam>(52.0));
  const double before = to_si(f.step(0.0).contact);
  const auto terms = f.step(0.3e-6);
  EXPECT_NEAR(to_si(terms.damping), 52.0 * (to_si(terms.contact) - before), 52.0 * rounding);
  EXPECT_NEAR(to_si(terms.sum), to_si(terms.contact) + to_si(terms.damping), rounding);
}

TYPED_TEST(FeedforwardOf, SlidingCurveIsReadByDirectionAndIsZeroAtRest) {
  auto c = elements<TypeParam>();
  for (std::size_t k = 1; k < c.forward.size(); ++k) {
    c.forward[k] = signal<typename TypeParam::Current>(0.1 * static_cast<double>(k));
    c.backward[k] = signal<typename TypeParam::Current>(0.2 * static_cast<double>(k));
  }
  const auto at = [&](double v) {
    return to_si(FrictionFeedforward<TypeParam>::sliding(c, signal<typename TypeParam::Velocity>(v)));
  };
  EXPECT_EQ(at(0.0), 0.0);
  // Node 1 is at 2^-12 m/s, node 3 at 2^-11; between them it is straight.
  EXPECT_NEAR(at(0x1p-12), 0.1, rounding);
  EXPECT_NEAR(at(-0x1p-12), -0.2, rounding);
  EXPECT_NEAR(at(0x1p-13), 0.05, rounding);
  EXPECT_NEAR(at(1.25 * 0x1p-12), 0.15, rounding);
  EXPECT_NEAR(at(1.0), 0.1 * 25, rounding);
  EXPECT_NEAR(at(-7.999999), -0.2 * 31, 1e-5);
}

TYPED_TEST(FeedforwardOf, TheWholeStaysWithinItsLimit) {
  auto c = elements<TypeParam>(1000.0);
  c.limit = signal<typename TypeParam::Current>(1.25);
  Feedforward<TypeParam> f(c);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> any(-50e-6, 50e-6);
  for (int k = 0; k < 10000; ++k) {
    const double sum = to_si(f.step(any(random)).sum);
    ASSERT_LE(std::abs(sum), 1.25);
  }
}

TEST(FrictionFeedforward, FixedPointFollowsDoubleOnARandomWay) {
  auto fixed = elements<FixedSignals>(20.0);
  auto real = elements<machine::DoubleSignals>(20.0);
  for (std::size_t k = 1; k < fixed.forward.size(); ++k) {
    const double current = std::sqrt(static_cast<double>(k));
    fixed.forward[k] = fixed.backward[k] = signal<FixedSignals::Current>(current);
    real.forward[k] = real.backward[k] = signal<machine::DoubleSignals::Current>(current);
  }
  Feedforward<FixedSignals> a(fixed);
  Feedforward<machine::DoubleSignals> b(real);
  std::mt19937_64 random(7);
  std::normal_distribution<double> push(0.0, 0.3e-6);
  double dx = 0.0, worst = 0.0;
  for (int k = 0; k < 100000; ++k) {
    dx = 0.99 * dx + push(random);
    const double exact = std::ldexp(std::round(std::ldexp(dx, 40)), -40);  // no difference from the way itself
    const double v = std::ldexp(std::round(std::ldexp(dx / 62.5e-6, 28)), -28);
    worst = std::max(worst, std::abs(to_si(a.step(exact, v).sum) - to_si(b.step(exact, v).sum)));
  }
  // Damping counts a rounding of the contact's current 20 times, twice: 2e-5 A.
  EXPECT_LT(worst, 5e-5);
}

// A step beyond the format saturates; the elements are then where they slip, and nothing overflows.
TEST(FrictionFeedforward, AJumpOfTheSetPointLeavesTheElementsSlipping) {
  Feedforward<FixedSignals> f(elements<FixedSignals>());
  EXPECT_NEAR(to_si(f.step(1.94e-3).contact), coulomb, rounding);
  EXPECT_NEAR(to_si(f.step(-1.94e-3).contact), -coulomb, rounding);
}

}  // namespace
}  // namespace stiction
