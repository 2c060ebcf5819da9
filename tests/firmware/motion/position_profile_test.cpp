// A move to a target: within its limits, exactly there, as fast as they allow, and new targets on the way.
#include "stiction/motion/position_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "firmware/machine/configuration/conversion.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

using S = FixedSignals;
using Profile = PositionProfile;

// With what is measured of it from tick to tick.
class Mover {
 public:
  Mover(std::int64_t period_ns, int smoothing_bits)
      : period_(static_cast<double>(period_ns) * 1e-9),
        profile_(
            std::make_unique<Profile>(Profile::Config{S::seconds(period_ns), S::rate(period_ns), smoothing_bits})) {
    profile_->start(position(start));
  }

  void go(double target, double velocity, double acceleration, double deceleration) {
    profile_->go({position(target), speed(velocity), speed(acceleration * period_), speed(deceleration * period_)});
  }
  // Ticks until it is there.
  int run(int most, bool halted = false) {
    int i = 0;
    for (; i < most && !(halted ? profile_->at_rest() : profile_->arrived()); ++i) tick(halted);
    return i;
  }
  void tick(bool halted = false) {
    const auto point = profile_->step(halted);
    const double x_before = x, v_before = v, a_before = a;
    x = machine::to_si(point.position), v = machine::to_si(point.velocity), a = machine::to_si(point.acceleration);
    inconsistent = std::max(inconsistent, std::abs((x - x_before) / period_ - v));
    inconsistent_acceleration = std::max(inconsistent_acceleration, std::abs((v - v_before) / period_ - a));
    jerk = std::max(jerk, std::abs(a - a_before) / period_);
    highest = std::max(highest, x), lowest = std::min(lowest, x);
    fastest = std::max(fastest, std::abs(v));
    const double along = v > 0.0 ? a : -a;
    if (v != 0.0) accelerated = std::max(accelerated, along), braked = std::max(braked, -along);
  }

  static constexpr double start = 0.03125;  // m
  double x = start, v = 0.0, a = 0.0;
  double highest = start, lowest = start, fastest = 0.0, accelerated = 0.0, braked = 0.0, jerk = 0.0;
  double inconsistent = 0.0, inconsistent_acceleration = 0.0;

 private:
  static S::Position position(double x) { return *machine::to_signal<S::Position>(x); }
  static S::Velocity speed(double v) { return *machine::to_signal<S::Velocity>(v); }

  double period_;
  std::unique_ptr<Profile> profile_;
};

// Of the trapezoid, s.
double ideal_time(double way, double v, double a, double d) {
  const double ramps = v * v / 2.0 / a + v * v / 2.0 / d;
  if (way > ramps) return v / a + v / d + (way - ramps) / v;
  const double top = std::sqrt(2.0 * way / (1.0 / a + 1.0 / d));
  return top / a + top / d;
}

TEST(PositionProfile, KeepsItsLimitsAndArrivesExactlyInTheTimeThatTheyAllow) {
  double slowest = 0.0;
  for (const std::int64_t period_ns : {62'500, 1'000'000, 10'000'000})
    for (const int bits : {0, 3, 8})
      for (const double way : {1e-9, -3e-6, 1e-4, -0.02, 0.3})
        for (const double d : {0.05, 2.0, 10.0}) {
          SCOPED_TRACE(fmt::format("period {} ns, smoothing {}, way {}, deceleration {}", period_ns, bits, way, d));
          constexpr double v = 0.4, a = 5.0;
          const double period = static_cast<double>(period_ns) * 1e-9, window = period * (1 << bits);
          Mover mover(period_ns, bits);
          const double target = Mover::start + way;
          mover.go(target, v, a, d);
          const int ticks = mover.run(1'000'000);
          const double expected = ideal_time(std::abs(way), v, a, d);
          EXPECT_NEAR(mover.x, target, 1e-12);
          EXPECT_LE(mover.highest, std::max(target, Mover::start) + 1e-12);
          EXPECT_GE(mover.lowest, std::min(target, Mover::start) - 1e-12);
          EXPECT_LE(mover.fastest, v + 4e-9);
          EXPECT_LE(mover.accelerated, a * 1.01 + 1e-6);
          // The last tick of a braking may take an eighth more; the mean over the window has less of it.
          EXPECT_LE(mover.braked, d * (1.0 + 0.13 / (1 << bits)) + 1e-6);
          EXPECT_LE(mover.jerk, (a + 1.13 * d) / window * 1.02);
          EXPECT_LE(ticks * period, expected * 1.012 + window + 3.0 * period);
          slowest = std::max(slowest, (ticks - 3) * period / (expected + window));
          // Way and mean of two ticks are rounded to 0.9 pm, velocity to 3.7 nm/s, and the period to 0.07 ppm.
          EXPECT_LT(mover.inconsistent, 3e-12 / period + 4e-9 + 1e-7 * v);
          EXPECT_LT(mover.inconsistent_acceleration, 8e-9 / period + 1e-6);
        }
  figure("profile moves: time over that of the trapezoid and its smoothing, largest",
         fmt::format("{:.4f} beside three ticks (bound 1.012)", slowest));
}

TEST(PositionProfile, TakesANewTargetOnItsWayAndTurnsBack) {
  Mover mover(62'500, 6);
  mover.go(0.2, 0.4, 5.0, 10.0);
  for (int i = 0; i < 1600; ++i) mover.tick();
  EXPECT_NEAR(mover.v, 0.4, 1e-6);
  mover.go(0.0, 0.2, 5.0, 10.0);
  mover.run(100'000);
  EXPECT_NEAR(mover.x, 0.0, 1e-12);
  EXPECT_LE(mover.braked, 10.1);
  EXPECT_LE(mover.accelerated, 10.1);  // the mean over the turn has both in it
  EXPECT_GE(mover.lowest, -1e-12);
}

TEST(PositionProfile, HaltsWithItsDecelerationAndGoesOn) {
  Mover mover(62'500, 4);
  mover.go(0.4, 0.4, 5.0, 8.0);
  for (int i = 0; i < 2000; ++i) mover.tick();
  const int ticks = mover.run(10'000, true);
  EXPECT_NEAR(ticks * 62.5e-6, 0.4 / 8.0 + 1e-3, 1e-3);
  EXPECT_LT(mover.x, 0.2);
  EXPECT_EQ(mover.v, 0.0);
  EXPECT_LE(mover.braked, 8.1);
  mover.run(100'000);
  EXPECT_NEAR(mover.x, 0.4, 1e-12);
}

TEST(PositionProfile, HaltsAMotionBackwardsAsOneForwards) {
  Mover mover(62'500, 4);
  mover.go(-0.4, 0.4, 5.0, 8.0);
  for (int i = 0; i < 2000; ++i) mover.tick();
  EXPECT_NEAR(mover.v, -0.4, 1e-6);
  const int ticks = mover.run(10'000, true);
  EXPECT_NEAR(ticks * 62.5e-6, 0.4 / 8.0 + 1e-3, 1e-3);
  EXPECT_EQ(mover.v, 0.0);
  EXPECT_LE(mover.braked, 8.1);
  mover.run(100'000);
  EXPECT_NEAR(mover.x, -0.4, 1e-12);
}

TEST(PositionProfile, PassesATargetThatIsTooCloseToBrakeAndComesBack) {
  for (const double side : {1.0, -1.0}) {
    Mover mover(62'500, 0);
    mover.go(Mover::start + side, 0.4, 5.0, 8.0);
    for (int i = 0; i < 3000; ++i) mover.tick();
    const double target = mover.x + side * 10e-9;
    mover.go(target, 0.4, 5.0, 8.0);
    mover.run(100'000);
    EXPECT_NEAR(mover.x, target, 1e-12);
    // v^2 / (2 d) of braking, and a tick at most.
    const double beyond = side > 0.0 ? mover.highest - target : target - mover.lowest;
    EXPECT_NEAR(beyond, 0.4 * 0.4 / (2.0 * 8.0), 0.4 * 62.5e-6);
    EXPECT_LE(mover.braked, 8.0 * 1.13 + 1e-6);
  }
}

TEST(PositionProfile, AcceleratesSlowlyTowardsATargetThatIsNearerThanATicksBraking) {
  Mover mover(62'500, 0);
  constexpr double way = 10e-9, a = 0.05;
  mover.go(Mover::start + way, 0.4, a, 10.0);
  const int ticks = mover.run(10'000);
  EXPECT_NEAR(mover.x, Mover::start + way, 1e-12);
  EXPECT_LE(mover.accelerated, a * 1.01 + 1e-6);
  EXPECT_NEAR(ticks * 62.5e-6, std::sqrt(2.0 * way / a), 3.0 * 62.5e-6);
}

TEST(PositionProfile, ArrivesWithTheLeastDecelerationThatTheFormatHas) {
  constexpr double least = 1.0 / (1 << 28) / 62.5e-6;  // one unit of velocity a tick: 60 um/s^2
  Mover mover(62'500, 0);
  constexpr double way = 1e-6;
  mover.go(Mover::start + way, 0.4, 10.0 * least, least);
  const int ticks = mover.run(100'000);
  EXPECT_NEAR(mover.x, Mover::start + way, 1e-12);
  // Below one unit there is no reserve to plan with; what rounding leaves is not seen by a 1 nm encoder.
  EXPECT_LE(mover.highest - (Mover::start + way), 1e-9);
  EXPECT_NEAR(ticks * 62.5e-6, ideal_time(way, 0.4, 10.0 * least, least), 0.05 * ticks * 62.5e-6);
}

TEST(PositionProfile, TellsTheMoveThatItMakes) {
  PositionProfile profile({S::seconds(62'500), S::rate(62'500), 0});
  const auto place = *machine::to_signal<S::Position>(0.5), target = *machine::to_signal<S::Position>(0.25);
  const auto speed = *machine::to_signal<S::Velocity>(0.125);
  profile.start(place);
  EXPECT_EQ(profile.move().target, place);
  profile.go({target, speed, speed, speed});
  EXPECT_EQ(profile.move().target, target);
  EXPECT_EQ(profile.move().velocity, speed);
}

TEST(PositionProfile, StandsUntilItIsGivenAMove) {
  Mover mover(62'500, 8);
  for (int i = 0; i < 1000; ++i) mover.tick();
  EXPECT_EQ(mover.x, Mover::start);
  EXPECT_EQ(mover.fastest, 0.0);
}

}  // namespace
}  // namespace stiction::test
