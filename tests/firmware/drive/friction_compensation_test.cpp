// The stage between set-points and axis: what it holds back, what it lets pass, when its current comes.
#include "stiction/drive/friction_compensation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "firmware/machine/configuration/conversion.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction {
namespace {

using S = FixedSignals;
using machine::to_si;
template <class T>
T signal(double value) {
  return machine::to_signal<T>(value).value();
}

FrictionCompensationConfig<S> config(CompensationKind kind, std::uint32_t delay) {
  FrictionCompensationConfig<S> c;
  c.kind = kind;
  c.set_point_delay = delay;
  c.friction.limit = signal<S::Current>(10.0);
  // One stiff element: 1 A over 1 um.
  c.friction.elements[0] = {signal<S::Step>(0.5e-6), signal<S::ContactStiffness>(2e6)};
  return c;
}

SetPoint<S> set_point(double x, double v = 0.0) {
  SetPoint<S> set;
  set.position = signal<S::Position>(x);
  set.velocity = signal<S::Velocity>(v);
  return set;
}

TEST(FrictionCompensation, OffHoldsSetPointsBackByTheDelay) {
  FrictionCompensation<S> stage(config(CompensationKind::off, 7));
  stage.start(signal<S::Position>(0.125));
  FrictionCompensationSignals<S> terms;
  for (int k = 0; k < 40; ++k) {
    auto set = set_point(0.125 + 1e-3 * k, 0.01 * k);
    stage.step(set, terms);
    const double wanted = k < 7 ? 0.125 : 0.125 + 1e-3 * (k - 7);
    EXPECT_NEAR(to_si(set.position), wanted, 1e-11) << k;
    EXPECT_NEAR(to_si(set.velocity), k < 7 ? 0.0 : 0.01 * (k - 7), 1e-8) << k;
    EXPECT_EQ(to_si(set.injection), 0.0);
  }
}

TEST(FrictionCompensation, TestSignalAndInvalidMarkAreNotHeldBack) {
  FrictionCompensation<S> stage(config(CompensationKind::friction, 10));
  stage.start({});
  FrictionCompensationSignals<S> terms;
  auto set = set_point(0.0);
  set.injection = signal<S::Current>(1.5);
  set.valid = false;
  stage.step(set, terms);
  EXPECT_EQ(to_si(set.injection), 1.5);
  EXPECT_FALSE(set.valid);
}

// cst: the current is the one that is asked for.
TEST(FrictionCompensation, AddsNothingToACurrentThatIsGiven) {
  FrictionCompensation<S> stage(config(CompensationKind::friction, 10));
  stage.start({});
  FrictionCompensationSignals<S> terms;
  double added = 0.0;
  for (int k = 0; k < 40; ++k) {
    auto set = set_point(k < 5 ? 0.0 : 10e-6);
    set.injection = signal<S::Current>(1.5);
    set.by_current = true;
    stage.step(set, terms);
    EXPECT_EQ(to_si(set.injection), 1.5);
    added = std::max(added, to_si(terms.current));
  }
  EXPECT_GT(added, 0.9) << "what it would have added";
}

// The tick in which the current begins to come, counted from the set-point's arrival at the axis.
int lead(double lag) {
  auto c = config(CompensationKind::friction, 10);
  c.lag_ticks = static_cast<std::uint32_t>(lag);
  c.lag_fraction = signal<S::TickFraction>(lag - std::floor(lag));
  FrictionCompensation<S> stage(c);
  stage.start({});
  FrictionCompensationSignals<S> terms;
  int current_at = -1, motion_at = -1;
  for (int k = 0; k < 40; ++k) {
    auto set = set_point(k < 5 ? 0.0 : 10e-6);
    stage.step(set, terms);
    if (current_at < 0 && to_si(terms.current) >= 0.999) current_at = k;
    if (motion_at < 0 && to_si(set.position) > 5e-6) motion_at = k;
  }
  return motion_at - current_at;
}

TEST(FrictionCompensation, CurrentComesBeforeTheSetPointByTheLookAhead) {
  EXPECT_EQ(lead(10.0), 0);
  EXPECT_EQ(lead(6.0), 4);
  EXPECT_EQ(lead(0.0), 10);
}

TEST(FrictionCompensation, LookAheadHasFractionsOfATick) {
  auto c = config(CompensationKind::friction, 10);
  c.lag_ticks = 4;
  c.lag_fraction = signal<S::TickFraction>(0.25);
  FrictionCompensation<S> stage(c);
  stage.start({});
  FrictionCompensationSignals<S> terms;
  std::vector<double> current;
  for (int k = 0; k < 10; ++k) {
    auto set = set_point(k < 1 ? 0.0 : 10e-6);
    stage.step(set, terms);
    current.push_back(to_si(terms.current));
  }
  EXPECT_EQ(current[4], 0.0);
  EXPECT_NEAR(current[5], 0.75, 1e-5);
  EXPECT_NEAR(current[6], 1.0, 1e-5);
}

TEST(FrictionCompensation, PulseIsAddedToTheSetSpeed) {
  auto c = config(CompensationKind::pulse, 0);
  c.pulse.amplitude = signal<S::Velocity>(1e-3);
  c.pulse.final_amplitude = c.pulse.amplitude;
  c.pulse.rise = signal<S::PulseSlope>(1.0);
  c.pulse.duration_ticks = 5;
  FrictionCompensation<S> stage(c);
  stage.start({});
  FrictionCompensationSignals<S> terms;
  for (int k = 0; k < 20; ++k) {
    auto set = set_point(0.0, k < 10 ? -0.1 : 0.1);
    set.acceleration = signal<S::Acceleration>(1.0);
    stage.step(set, terms);
    const double pulse = k >= 10 && k < 15 ? 1e-3 : 0.0;
    EXPECT_NEAR(to_si(set.velocity), (k < 10 ? -0.1 : 0.1) + pulse, 1e-8) << k;
  }
}

TEST(FrictionCompensation, StartForgetsWhatWas) {
  FrictionCompensation<S> stage(config(CompensationKind::friction, 3));
  FrictionCompensationSignals<S> terms;
  stage.start({});
  for (int k = 0; k < 20; ++k) {
    auto set = set_point(1e-5 * k);
    stage.step(set, terms);
  }
  EXPECT_NEAR(to_si(terms.current), 1.0, 1e-5);
  stage.start(signal<S::Position>(0.2));
  auto set = set_point(0.2);
  stage.step(set, terms);
  EXPECT_EQ(to_si(terms.current), 0.0);
  EXPECT_NEAR(to_si(set.position), 0.2, 1e-11);
}

// What the axis' error teaches comes through the stage, and only to a stage that learns.
TEST(FrictionCompensation, ObservesTheErrorWhereItLearns) {
  for (const auto kind : {CompensationKind::friction, CompensationKind::learning}) {
    auto c = config(kind, 10);
    c.learning.error_gain = signal<S::ContactStiffness>(1e5);
    c.learning.error_limit = signal<S::Distance>(50e-6);
    c.learning.filter = signal<S::FilterCoefficient>(0.5);
    c.learning.filter_rest = signal<S::FilterCoefficient>(0.5);
    FrictionCompensation<S> stage(c);
    stage.start({});
    FrictionCompensationSignals<S> terms;
    AxisSignals<S> axis;
    axis.e = signal<S::Distance>(2e-6);
    for (int k = 0; k < 40; ++k) {
      auto set = set_point(0.0);
      stage.step(set, terms);
      stage.observe(axis, terms);
    }
    EXPECT_NEAR(to_si(terms.missing), kind == CompensationKind::learning ? 0.2 : 0.0, 1e-3);
    EXPECT_FALSE(stage.dropped());
  }
}

// The tables of the last start are played from the first tick, and are what is kept for the next one.
TEST(FrictionCompensation, GivesBackTheTablesItStartedWithUntilTheErrorTeaches) {
  auto c = config(CompensationKind::learning, 10);
  c.learning.tables[1].front() = signal<S::Current>(0.25);
  FrictionCompensation<S> stage(c);
  stage.start({});
  EXPECT_EQ(stage.learned()[1].front(), c.learning.tables[1].front());
  EXPECT_EQ(to_si(stage.learned()[0].front()), 0.0);
}

}  // namespace
}  // namespace stiction
