// The generator of homing moves on a bench whose axis follows exactly.
#include "stiction/drive/homing.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/firmware/drive/axis_bench.hpp"

namespace stiction::test {
namespace {

using S = FixedSignals;
using Ramp = VelocityRamp<S>;
using Phase = Homing<S>::Phase;

constexpr double search = 0.05, creep = 0.002, deceleration = 10.0;

HomingConfig<S> config(HomingMethod method) {
  return {method, si<S::Velocity>(search), si<S::Velocity>(creep), si<S::Position>(0.3), si<S::Position>(0.1), 160000};
}

// An axis without mass, with switches and an index mark.
struct Axis {
  explicit Axis(HomingMethod method) : homing(config(method)) { homing.start({}); }

  Phase run(int ticks) {
    for (int i = 0; i < ticks && homing.phase() != Phase::done && homing.phase() != Phase::failed; ++i) {
      const double x = machine::to_si(set.position);
      DigitalInputs<S> in;
      in.limit_negative = x <= negative;
      in.limit_positive = x >= positive;
      in.home = x <= home_below || x >= home_above;
      in.index = (before < index) != (x < index);
      in.index_position = si<S::Position>(index);
      before = x;
      fastest = std::max(fastest, std::abs(machine::to_si(set.velocity)));
      const auto target = homing.step(set, set.position, in);
      Ramp::step(ramp, set, target, saturations);
    }
    return homing.phase();
  }

  Homing<S> homing;
  Ramp::Config ramp{si<S::Velocity>(deceleration * tick), S::seconds(tick_ns / 2), S::rate(tick_ns)};
  Ramp::State set{};
  SaturationCounter saturations;
  double home_below = -9.0, home_above = 9.0;
  double negative = -1.0, positive = 1.0, index = 2.0, before = 0.0, fastest = 0.0;
};

TEST(Homing, FindsWhereASwitchOpensAndStandsBesideIt) {
  for (const bool down : {true, false}) {
    Axis a(down ? HomingMethod::limit_negative : HomingMethod::limit_positive);
    (down ? a.negative : a.positive) = down ? -0.06 : 0.06;
    EXPECT_EQ(a.run(160000), Phase::done);
    const double mark = down ? -0.06 : 0.06;
    EXPECT_NEAR(machine::to_si(a.homing.origin()), mark - 0.3, creep * tick);
    EXPECT_EQ(a.set.velocity, S::Velocity{});
    EXPECT_LT(std::abs(machine::to_si(a.set.position) - mark), 1e-6);  // 0.2 um to stop, and a tick
    EXPECT_NEAR(a.fastest, search, 1e-6);
  }
}

// Methods 19 and 21, from outside of the switch and from on it.
TEST(Homing, FindsWhereAHomeSwitchOpens) {
  for (const bool down : {true, false})
    for (const bool on_it : {true, false}) {
      Axis a(down ? HomingMethod::home_negative : HomingMethod::home_positive);
      const double mark = (on_it ? 1.0 : -1.0) * (down ? 0.003 : -0.003);
      (down ? a.home_below : a.home_above) = mark;
      EXPECT_EQ(a.run(160000), Phase::done);
      EXPECT_NEAR(machine::to_si(a.homing.origin()), mark - 0.3, creep * tick);
      EXPECT_FALSE(a.homing.seeks_negative() || a.homing.seeks_positive());
    }
}

TEST(Homing, ThatIsInterruptedKeepsWhatHasEnded) {
  Axis a(HomingMethod::here);
  EXPECT_EQ(a.run(2), Phase::done);
  a.homing.interrupt();
  EXPECT_EQ(a.homing.phase(), Phase::done);
  Axis failed(HomingMethod::limit_negative);
  EXPECT_EQ(failed.run(400000), Phase::failed);
  failed.homing.interrupt();
  EXPECT_EQ(failed.homing.phase(), Phase::failed);
  Axis b(HomingMethod::limit_negative);
  b.run(10);
  b.homing.interrupt();
  EXPECT_EQ(b.homing.phase(), Phase::idle);
}

TEST(Homing, FindsAnIndexAtCreepSpeed) {
  for (const bool down : {true, false}) {
    Axis a(down ? HomingMethod::index_negative : HomingMethod::index_positive);
    a.index = down ? -0.0033 : 0.0033;
    EXPECT_EQ(a.run(160000), Phase::done);
    EXPECT_NEAR(machine::to_si(a.homing.origin()), a.index - 0.3, 2e-12);
    EXPECT_NEAR(a.fastest, creep, 1e-8);
  }
}

TEST(Homing, TakesThePlaceWhereItStands) {
  Axis a(HomingMethod::here);
  EXPECT_EQ(a.run(2), Phase::done);
  EXPECT_NEAR(machine::to_si(a.homing.origin()), -0.3, 1e-11);
}

TEST(Homing, OfAnAbsoluteEncoderHasItsZero) {
  Axis a(HomingMethod::none);
  EXPECT_EQ(a.homing.phase(), Phase::done);
  EXPECT_EQ(a.homing.origin(), S::Position{});
}

TEST(Homing, FailsBeyondItsWayAndStops) {
  for (const auto method : {HomingMethod::limit_negative, HomingMethod::limit_positive}) {
    Axis a(method);  // no switch within 0.1 m
    EXPECT_EQ(a.run(160000), Phase::failed);
    EXPECT_NEAR(std::abs(machine::to_si(a.set.position)), 0.1, search * tick * 2);
    EXPECT_EQ(a.homing.step(a.set, a.set.position, {}), S::Velocity{});
    EXPECT_EQ(a.homing.phase(), Phase::failed);
  }
}

TEST(Homing, FailsAfterItsTime) {
  Axis a(HomingMethod::index_positive);  // 0.02 m in 160000 ticks at creep speed
  EXPECT_EQ(a.run(160000), Phase::leave);
  EXPECT_EQ(a.run(1), Phase::failed);
}

TEST(Homing, MarksNothingAtASwitchThatBouncesWhileItIsReached) {
  Homing<S> homing(config(HomingMethod::limit_negative));
  homing.start({});
  Ramp::State set{{}, si<S::Velocity>(-search)};
  DigitalInputs<S> in;
  in.limit_negative = true;
  homing.step(set, {}, in);
  EXPECT_EQ(homing.phase(), Phase::leave);
  in.limit_negative = false;  // a bounce: it still runs onto the switch
  homing.step(set, {}, in);
  EXPECT_EQ(homing.phase(), Phase::leave);
  EXPECT_TRUE(homing.seeks_negative());
  EXPECT_FALSE(homing.seeks_positive());
}

TEST(Homing, IsIdleWhenStopped) {
  Axis a(HomingMethod::limit_positive);
  a.run(10);
  EXPECT_TRUE(a.homing.seeks_positive());
  a.homing.stop();
  EXPECT_EQ(a.homing.phase(), Phase::idle);
  EXPECT_FALSE(a.homing.seeks_positive());
  EXPECT_EQ(a.homing.step(a.set, a.set.position, {}), S::Velocity{});
}

}  // namespace
}  // namespace stiction::test
