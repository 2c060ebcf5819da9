// The supervision on a bench: feedback and set-points are prescribed, each row at its threshold.
#include "stiction/drive/supervision.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>

#include "tests/firmware/drive/axis_bench.hpp"

namespace stiction::test {
namespace {

template <class S>
SupervisionConfig<S> bench_supervision() {
  SupervisionConfig<S> c;
  c.period_ns = tick_ns;
  c.frozen_distance = si<typename S::Distance>(100e-6);
  c.encoder_jump = si<typename S::Distance>(5e-6);
  c.phases_sum = true;
  c.current_measured = true;
  c.current_sum = si<typename S::Current>(3.5);
  c.runaway_current = si<typename S::Current>(14.0);
  c.runaway_rise = si<typename S::Velocity>(2.7e-3);
  c.least_speed = si<typename S::Velocity>(1e-3);
  c.negative_switch = c.positive_switch = true;
  c.negative_from = si<typename S::Position>(-0.245);
  c.negative_by = si<typename S::Position>(-0.255);
  c.positive_from = si<typename S::Position>(0.245);
  c.positive_by = si<typename S::Position>(0.255);
  return c;
}

// Feeds one axis that moves as told.
template <class S>
class Watched {
 public:
  explicit Watched(const SupervisionConfig<S>& config = bench_supervision<S>()) : supervision(config) {
    seen.powered = true;
    seen.referenced = true;
    for (int i = 0; i < 4; ++i) EXPECT_EQ(at(0.0), Fault::none);
  }

  // A tick with the carriage at `x`; the set-point is there too, unless told otherwise.
  Fault at(double x) {
    set(x);
    return shows(x);
  }
  Fault shows(double x, bool valid = true) {
    now_ns += tick_ns;
    seen.now_ns = now_ns;
    seen.feedback.position_valid = valid;
    if (valid) {
      seen.feedback.position = si<typename S::Position>(x);
      seen.feedback.position_time_ns = now_ns;
      seen.position = seen.feedback.position;
    }
    return supervision.step(seen);
  }
  void set(double x, double v = 0.0) {
    seen.set_position = si<typename S::Position>(x);
    seen.set_velocity = si<typename S::Velocity>(v);
  }
  void current(double i) { seen.current = si<typename S::Current>(i); }
  void phases(double a, double b, double c) {
    seen.feedback.current = {si<typename S::Current>(a), si<typename S::Current>(b), si<typename S::Current>(c)};
  }

  Supervision<S> supervision;
  typename Supervision<S>::Seen seen{};
  std::int64_t now_ns = 0;
};

template <class S>
class SupervisionOf : public ::testing::Test {};
using Policies = ::testing::Types<FixedSignals, machine::DoubleSignals>;
TYPED_TEST_SUITE(SupervisionOf, Policies);

TYPED_TEST(SupervisionOf, SeesAJumpAboveItsThresholdAndNoneBelow) {
  for (const double v : {0.0, 0.4, -1.3}) {
    for (const double jump : {4.9e-6, -4.9e-6, 5.1e-6, -5.1e-6, 1e-3, -0.4, 0.6}) {
      Watched<TypeParam> w;
      double x = 0.0;
      // From rest: 20 m/s^2 until the speed is reached leaves 78 nm of a jump.
      double speed = 0.0;
      while (std::abs(speed) < std::abs(v)) {
        speed += std::copysign(20.0 * tick, v);
        x += speed * tick;
        ASSERT_EQ(w.at(x), Fault::none);
      }
      x += speed * tick + jump;
      EXPECT_EQ(w.at(x), std::abs(jump) > 5e-6 ? Fault::encoder_jump : Fault::none) << v << ' ' << jump;
    }
  }
}

TYPED_TEST(SupervisionOf, ForetellsOverTwoTicksWithoutAPosition) {
  Watched<TypeParam> w;
  double x = 0.0;
  for (int i = 0; i < 400; ++i) {
    x += 0.4 * tick * std::min(1.0, i / 320.0);
    const bool valid = i % 5 < 3;
    EXPECT_EQ(w.shows(x, valid), Fault::none) << i;
    w.set(x);
    EXPECT_EQ(w.supervision.fresh(), valid);
  }
}

TYPED_TEST(SupervisionOf, SaysNothingOfAJumpBehindALongerGap) {
  Watched<TypeParam> w;
  for (int i = 0; i < 5; ++i) w.shows(0.0, false);
  w.set(1e-3);
  EXPECT_EQ(w.shows(1e-3), Fault::none);    // what happened in between is not known,
  EXPECT_EQ(w.shows(1.1e-3), Fault::none);  // nor the speed behind it
  EXPECT_EQ(w.shows(2.2e-3), Fault::encoder_jump);
}

TYPED_TEST(SupervisionOf, TakesAnOldSampleAndOneFromTheFutureAsNone) {
  Watched<TypeParam> w;
  w.seen.now_ns = w.now_ns += tick_ns;
  w.seen.feedback.position = si<typename TypeParam::Position>(1.0);
  EXPECT_EQ(w.supervision.step(w.seen), Fault::none);  // with the time stamp of the tick before
  EXPECT_FALSE(w.supervision.fresh());
  w.seen.feedback.position_time_ns = w.now_ns + 2 * tick_ns;
  EXPECT_EQ(w.supervision.step(w.seen), Fault::none);
  EXPECT_FALSE(w.supervision.fresh());
}

TYPED_TEST(SupervisionOf, SeesAFrozenEncoderByTheWayOfTheSetPoint) {
  Watched<TypeParam> w;
  double set = 0.0;
  Fault fault = Fault::none;
  while (fault == Fault::none && set < 1.0) {
    set += 0.1 * tick;
    w.set(set);
    fault = w.shows(0.0);
  }
  EXPECT_EQ(fault, Fault::encoder_frozen);
  EXPECT_GT(set, 100e-6 - 1e-9);
  EXPECT_LT(set, 100e-6 + 2 * 0.1 * tick);
}

TYPED_TEST(SupervisionOf, TakesNoEncoderForFrozenThatShowsAnotherPositionNowAndThen) {
  Watched<TypeParam> w;
  double set = 0.0;
  for (int i = 0; i < 20000; ++i) {
    set += 0.1 * tick;
    w.set(set);
    EXPECT_EQ(w.shows(i % 12 < 6 ? 0.0 : 1e-9), Fault::none);  // 6 ticks are 37 um
  }
}

TYPED_TEST(SupervisionOf, TakesNoEncoderForFrozenWithoutPowerOrWithoutPositions) {
  Watched<TypeParam> w;
  w.seen.powered = false;
  w.set(0.1);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(w.shows(0.0), Fault::none);
  w.seen.powered = true;
  EXPECT_EQ(w.shows(0.0), Fault::none);
  w.set(0.2);
  EXPECT_EQ(w.shows(0.0, false), Fault::none);
  EXPECT_EQ(w.shows(0.0), Fault::encoder_frozen);
}

TYPED_TEST(SupervisionOf, SeesAnOffsetOfTheSumInSixteenTicksInARow) {
  Watched<TypeParam> w;
  w.phases(10.0, -6.0, -0.4);  // sum 3.6 A
  for (int i = 1; i < 16; ++i) EXPECT_EQ(w.at(0.0), Fault::none) << i;
  EXPECT_EQ(w.at(0.0), Fault::current_offset);
  w.phases(10.0, -6.0, -0.6);  // 3.4 A
  EXPECT_EQ(w.at(0.0), Fault::none);
  w.phases(-10.0, 6.0, 0.4);
  for (int i = 1; i < 16; ++i) EXPECT_EQ(w.at(0.0), Fault::none) << "it counts anew";
  EXPECT_EQ(w.at(0.0), Fault::current_offset);
}

TYPED_TEST(SupervisionOf, SeesAnOffsetOfEachPhaseOnceTheCurrentsHaveEnded) {
  for (std::size_t phase = 0; phase < 3; ++phase) {
    Watched<TypeParam> w;
    std::array<double, 3> i{};
    i[phase] = 3.6;
    i[(phase + 1) % 3] = -3.4;  // the sum is 0.2 A
    w.phases(i[0], i[1], i[2]);
    for (int k = 0; k < 100; ++k) EXPECT_EQ(w.at(0.0), Fault::none);
    w.seen.powered = false;
    for (int k = 1; k < 32 + 16; ++k) EXPECT_EQ(w.at(0.0), Fault::none) << k;
    EXPECT_EQ(w.at(0.0), Fault::current_offset);
  }
}

// Without a position there is nothing that could be unchanged: the set-point's way counts from the first one on.
TYPED_TEST(SupervisionOf, WatchesForAFrozenEncoderFromTheFirstPositionUnderPowerOn) {
  for (const bool powered : {true, false}) {
    Watched<TypeParam> w;
    w.supervision.restart();
    w.seen.powered = powered;
    for (int k = 0; k < 10; ++k) {
      w.set(k * 100e-6);
      EXPECT_EQ(w.shows(0.0, false), Fault::none);
    }
    w.seen.powered = true;
    for (const double way : {0.0, 50e-6, 99e-6}) {
      w.set(1e-3 + way);
      EXPECT_EQ(w.shows(0.0), Fault::none) << way;
    }
    w.set(1e-3 + 101e-6);
    EXPECT_EQ(w.shows(0.0), Fault::encoder_frozen);
  }
}

TYPED_TEST(SupervisionOf, AsksNoSensorsThatAreNotThere) {
  auto config = bench_supervision<TypeParam>();
  config.phases_sum = config.current_measured = false;
  Watched<TypeParam> w(config);
  w.phases(9.0, 9.0, 9.0);
  w.seen.powered = false;
  for (int k = 0; k < 100; ++k) EXPECT_EQ(w.at(0.0), Fault::none);
}

// Moves with a constant acceleration from `v`; returns the tick in which a fault is seen, 0 for none.
template <class S>
int accelerated(Watched<S>& w, double v, double a, double current, int ticks = 200) {
  double x = 0.0;
  for (int i = 0; i < 4; ++i) w.at(x += v * tick);
  w.supervision.restart();
  for (int i = 0; i < 40; ++i) w.at(x += v * tick);
  w.current(current);
  for (int i = 1; i <= ticks; ++i) {
    v += a * tick;
    x += v * tick;
    const Fault fault = w.at(x);
    if (fault == Fault::none) continue;
    EXPECT_EQ(fault, Fault::runaway) << name_of(fault);
    return i;
  }
  return 0;
}

TYPED_TEST(SupervisionOf, SeesASpeedThatRisesAgainstTheForceInSixteenTicks) {
  for (const double sign : {1.0, -1.0}) {
    Watched<TypeParam> w;
    EXPECT_EQ(accelerated(w, -0.1 * sign, -5.85 * sign, 14.1 * sign), 16);
  }
}

// Whichever way the axis moves: a motor of the wrong sign brakes at first.
TYPED_TEST(SupervisionOf, TellsAForceThatTheAxisAcceleratesAgainst) {
  struct Case {
    double v, a, i;
    bool resisted;
  };
  for (const auto& c : {Case{0.5, -5.85, 14.1, true}, Case{-0.5, 5.85, -14.1, true},   // a wrong sign, braking
                        Case{0.5, 5.85, 14.1, false}, Case{0.5, -5.85, -14.1, false},  // as the force says
                        Case{0.5, -5.85, 13.9, false},                                 // too weak to tell
                        Case{0.5, 0.0, 50.0, false},                                   // against friction
                        Case{0.5, -2.5, 30.0, false}}) {                               // and a little more
    Watched<TypeParam> w;
    accelerated(w, c.v, c.a, c.i, 31);
    EXPECT_FALSE(w.supervision.resisted()) << "31 ticks behind the eighth, in which half of the change is reached";
    Watched<TypeParam> longer;
    accelerated(longer, c.v, c.a, c.i, 40);
    EXPECT_EQ(longer.supervision.resisted(), c.resisted) << c.v << ' ' << c.a << ' ' << c.i;
  }
}

// 100 kN s/m before a force of 2 kN, on the masses of the cross table: the control gets the axis in hand again.
TYPED_TEST(SupervisionOf, TellsNoResistanceThatAbatesAsTheAxisSlowsDown) {
  for (const double mass : {225.0, 520.0})
    for (const double sign : {1.0, -1.0}) {
      Watched<TypeParam> w;
      double x = 0.0, v = 0.4 * sign;
      accelerated(w, v, 0.0, 0.0, 1);
      w.supervision.restart();
      for (int i = 0; i < 40; ++i) w.at(x += v * tick);
      w.current(30.0 * sign);
      for (int i = 0; i < 400; ++i) {
        v += (2e3 * sign - 1e5 * v) / mass * tick;
        w.at(x += v * tick);
        EXPECT_FALSE(w.supervision.resisted()) << i;
      }
    }
}

TYPED_TEST(SupervisionOf, BeginsTheRowOfAForceAgainWhereItsSignChangesOrThePowerGoes) {
  for (const bool off : {false, true}) {
    Watched<TypeParam> w;
    double x = 0.0, v = 0.5;
    w.supervision.restart();
    const auto slower = [&](double current, bool powered) {
      w.seen.powered = powered;
      w.current(current);
      v -= 5.85 * tick;
      w.at(x += v * tick);
    };
    for (int i = 0; i < 40; ++i) slower(0.0, true);
    for (int i = 0; i < 30; ++i) slower(14.1, true);
    slower(off ? 14.1 : -14.1, !off);
    for (int i = 1; i <= 31; ++i) {
      EXPECT_FALSE(w.supervision.resisted()) << i;
      slower(14.1, true);
    }
    EXPECT_TRUE(w.supervision.resisted());
  }
}

TYPED_TEST(SupervisionOf, TakesNoBrakingCruisingOrWeakForceForARunaway) {
  struct Case {
    double v, a, i;
  };
  for (const auto& c : {Case{0.5, -5.85, -14.1}, Case{-0.5, 5.85, 14.1},  // brakes
                        Case{0.1, 5.85, 14.1}, Case{-0.1, -5.85, -14.1},  // accelerates
                        Case{-0.1, -5.85, 13.9},                          // a force below the threshold
                        Case{-0.1, 0.0, 50.0}, Case{0.1, 0.0, -50.0},     // holds a load back at constant speed
                        Case{-0.1, -2.5, 30.0}}) {                        // that pulls it along slowly
    Watched<TypeParam> w;
    EXPECT_EQ(accelerated(w, c.v, c.a, c.i, 60), 0) << c.v << ' ' << c.a << ' ' << c.i;
  }
}

TYPED_TEST(SupervisionOf, SeesALimitSwitchOnlyTowardsIt) {
  Watched<TypeParam> w;
  auto& in = w.seen.inputs;
  double x = -0.25;
  w.supervision.restart();
  const auto still = [&] {
    w.set(x);
    return w.shows(x);
  };
  for (int i = 0; i < 4; ++i) still();
  in.limit_negative = true;
  EXPECT_EQ(still(), Fault::none);  // it stands there
  w.set(x, 0.1);
  EXPECT_EQ(w.shows(x), Fault::none);  // it leaves
  w.set(x, -0.1);
  EXPECT_EQ(w.shows(x), Fault::limit_switch);
  w.seen.seeks_negative = true;
  EXPECT_EQ(w.shows(x), Fault::none);
  w.seen.seeks_negative = false;
  w.seen.powered = false;
  EXPECT_EQ(w.shows(x), Fault::none);
  w.seen.powered = true;
  // Pushed towards it while the set-point rests: 2 mm/s.
  still();
  x -= 2e-3 * tick;
  EXPECT_EQ(still(), Fault::limit_switch);
}

TYPED_TEST(SupervisionOf, SeesThePositiveSwitchAsTheNegativeOne) {
  Watched<TypeParam> w;
  double x = 0.25;
  w.supervision.restart();
  w.seen.inputs.limit_positive = true;
  const auto still = [&](double v = 0.0) {
    w.set(x, v);
    return w.shows(x);
  };
  for (int i = 0; i < 4; ++i) EXPECT_EQ(still(), Fault::none);
  EXPECT_EQ(still(-0.1), Fault::none);
  EXPECT_EQ(still(0.1), Fault::limit_switch);
  w.seen.seeks_positive = true;
  EXPECT_EQ(still(0.1), Fault::none);
  w.seen.seeks_positive = false;
  x += 2e-3 * tick;
  EXPECT_EQ(still(), Fault::limit_switch);
}

TYPED_TEST(SupervisionOf, SeesASwitchThatCannotBeReachedOrHasNotBeen) {
  struct Case {
    double x;
    bool negative, positive;
    Fault fault;
  };
  for (const auto& c :
       {Case{0.0, true, true, Fault::limit_switch_stuck}, Case{0.0, true, false, Fault::limit_switch_stuck},
        Case{0.0, false, true, Fault::limit_switch_stuck}, Case{0.0, false, false, Fault::none},
        Case{-0.246, true, false, Fault::none}, Case{-0.244, true, false, Fault::limit_switch_stuck},
        Case{0.246, false, true, Fault::none}, Case{0.244, false, true, Fault::limit_switch_stuck},
        Case{-0.254, false, false, Fault::none}, Case{-0.256, false, false, Fault::limit_switch_stuck},
        Case{0.254, false, false, Fault::none}, Case{0.256, false, false, Fault::limit_switch_stuck}}) {
    Watched<TypeParam> w;
    w.supervision.restart();
    w.seen.inputs.limit_negative = c.negative;
    w.seen.inputs.limit_positive = c.positive;
    EXPECT_EQ(w.at(c.x), c.fault) << c.x;
    // Without a zero no position tells where a switch may be, but both at once may never be.
    w.seen.referenced = false;
    EXPECT_EQ(w.at(c.x), c.negative && c.positive ? Fault::limit_switch_stuck : Fault::none) << c.x;
  }
}

TYPED_TEST(SupervisionOf, MissesNoSwitchThatIsNotWired) {
  auto config = bench_supervision<TypeParam>();
  config.negative_switch = config.positive_switch = false;
  Watched<TypeParam> w(config);
  w.supervision.restart();
  EXPECT_EQ(w.at(0.3), Fault::none);
  w.supervision.restart();
  EXPECT_EQ(w.at(-0.3), Fault::none);
}

}  // namespace
}  // namespace stiction::test
