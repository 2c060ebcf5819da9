// Learning over laps, on a loop that is a plain lag: what it learns, what it must not.
#include "stiction/control/quadrant_learning.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "firmware/machine/configuration/conversion.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction {
namespace {

using S = FixedSignals;
using Learning = QuadrantLearning<S>;
using machine::to_si;
template <class T>
T signal(double value) {
  return machine::to_signal<T>(value).value();
}

constexpr double tick = 62.5e-6, per_metre = 1e5;  // s, A/m

Learning::Config config() {
  Learning::Config c;
  c.error_gain = signal<S::ContactStiffness>(per_metre);
  c.error_limit = signal<S::Distance>(50e-6);
  c.filter = signal<S::FilterCoefficient>(0.05);
  c.filter_rest = signal<S::FilterCoefficient>(0.95);
  c.gain = signal<S::FilterCoefficient>(0.6);
  c.keep = signal<S::FilterCoefficient>(0.96);
  c.smoothing = signal<S::FilterCoefficient>(0.01);
  c.limit = signal<S::Current>(0.5);
  c.credit_ticks = 20;
  c.tolerance = signal<S::Distance>(1e-6);
  c.machine = c.tables_machine = 1;
  return c;
}

// Swings of 20 mm. The error is what the force lacks, less what was learned: 0.2 A over the first 0.1 mm after each
// reversal, `lack` times.
class Swings {
 public:
  explicit Swings(const Learning::Config& config) : config_(config), state_(Learning::start(config)) {}

  // The largest error (m) of a swing there and back.
  double swing(double lack = 1.0, double half = 10e-3) {
    constexpr double frequency = 2.0;
    double worst = 0.0;
    x_ = -half;  // where the swing begins
    for (int k = 0; k < 8000; ++k, ++ticks_) {
      const double w = 2.0 * std::numbers::pi * frequency, phase = w * k * tick;
      const double x = -half * std::cos(phase), v = half * w * std::sin(phase), a = half * w * w * std::cos(phase);
      const double since = half - std::abs(x);  // on either side of the reversal
      const auto played = Learning::play(config_, state_, signal<S::Step>(x - x_), signal<S::Velocity>(v),
                                         signal<S::Acceleration>(a), saturations_);
      x_ = x;
      largest_step_ = std::max(largest_step_, std::abs(to_si(played) - current_));
      current_ = to_si(played);
      largest_ = std::max(largest_, std::abs(current_));
      const bool after = v * x < 0.0 && since < 0.1e-3;
      const double wanted = after ? lack * std::copysign(0.2, v) : 0.0;
      const double e = (wanted - current_) / per_metre;
      if (after) worst = std::max(worst, std::abs(e));
      Learning::learn(config_, state_, signal<S::Distance>(e), saturations_);
    }
    return worst;
  }
  Learning::State& state() { return state_; }
  double largest() const { return largest_; }            // A played
  double largest_step() const { return largest_step_; }  // A from tick to tick
  void forget_largest_step() { largest_step_ = 0.0; }
  double current() const { return current_; }

 private:
  Learning::Config config_;
  Learning::State state_;
  SaturationCounter saturations_;
  double x_ = 0.0, current_ = 0.0, largest_ = 0.0, largest_step_ = 0.0;
  long ticks_ = 0;
};

double largest_of(const Learning::Tables& tables) {
  double largest = 0.0;
  for (const auto& table : tables)
    for (const auto& current : table) largest = std::max(largest, std::abs(to_si(current)));
  return largest;
}

TEST(QuadrantLearning, NothingIsPlayedBeforeAReferenceIsTaken) {
  Swings s(config());
  s.swing();
  EXPECT_EQ(s.largest(), 0.0);
}

TEST(QuadrantLearning, LearnsWhatIsMissingAfterAReversal) {
  Swings s(config());
  for (int k = 0; k < 8; ++k) s.swing();
  // Table nodes at 2 to 90 um hold most of the 0.2 A; both directions with their sign.
  EXPECT_GT(largest_of(s.state().tables), 0.1);
  EXPECT_GT(to_si(s.state().tables[1][8]), 0.08);
  EXPECT_LT(to_si(s.state().tables[0][8]), -0.08);
  EXPECT_FALSE(s.state().dropped);
}

TEST(QuadrantLearning, IsBounded) {
  auto c = config();
  c.limit = signal<S::Current>(0.05);
  Swings s(c);
  for (int k = 0; k < 12; ++k) s.swing(3.0);
  EXPECT_NEAR(largest_of(s.state().tables), 0.05, 1e-5);
  EXPECT_LE(s.largest(), 0.05 + 1e-5);
}

TEST(QuadrantLearning, ForgetsWhatIsNoLongerMissing) {
  Swings s(config());
  for (int k = 0; k < 6; ++k) s.swing();
  const double before = largest_of(s.state().tables);
  auto& state = s.state();
  // A lap without any error: every taught node keeps 98 % and takes from its neighbours.
  for (auto& r : state.reference)
    for (auto& peak : r) peak = signal<S::Distance>(1e-3);
  for (int k = 0; k < 40; ++k) s.swing(0.0);
  EXPECT_LT(largest_of(state.tables), 0.5 * before);
}

TEST(QuadrantLearning, CurrentHasNoJumpOnceItHasLearned) {
  Swings s(config());
  for (int k = 0; k < 12; ++k) s.swing();
  // Before, what is taught to a node near the set-point is a step of its own.
  s.forget_largest_step();
  s.swing();
  // From -0.2 to 0.2 A over 30 um and more, at up to 0.7 um a tick, and what the last lap still teaches.
  EXPECT_LT(s.largest_step(), 0.02);
}

TEST(QuadrantLearning, AShortReversalHoldsTheCurrentAndTeachesNothing) {
  Swings s(config());
  for (int k = 0; k < 6; ++k) s.swing();
  const auto tables = s.state().tables;
  s.swing(1.0, 0.5e-3);  // the first of these reversals still has a long way before it
  const auto taught = s.state().tables;
  const double held = s.current();
  for (int k = 0; k < 3; ++k) {
    s.swing(1.0, 0.5e-3);
    EXPECT_NEAR(s.current(), held, 1e-5);
  }
  EXPECT_EQ(s.state().tables, taught);
  EXPECT_NE(largest_of(tables), 0.0);
}

TEST(QuadrantLearning, ATableThatMakesTheErrorGrowIsDroppedAndStaysSo) {
  auto c = config();
  for (std::size_t k = 0; k < Learning::nodes; ++k) {
    c.tables[1][k] = signal<S::Current>(-0.4);  // against what is missing
    c.tables[0][k] = signal<S::Current>(0.4);
  }
  c.adapt = false;
  Swings s(c);
  s.swing();  // silent, takes the reference
  s.swing();
  EXPECT_FALSE(s.state().dropped && s.largest() == 0.0);
  s.swing();
  EXPECT_TRUE(s.state().dropped);
  for (int k = 0; k < 3; ++k) s.swing();
  EXPECT_NEAR(s.current(), 0.0, 1e-5) << "the baseline alone";
  EXPECT_TRUE(s.state().dropped);
}

TEST(QuadrantLearning, ATableOfAnotherMachineIsNotTaken) {
  auto c = config();
  c.tables[1].fill(signal<S::Current>(0.3));
  c.tables_machine = 2;
  EXPECT_FALSE(Learning::takes(c));
  EXPECT_EQ(largest_of(Learning::start(c).tables), 0.0);
  c.tables_machine = c.machine;
  EXPECT_NEAR(largest_of(Learning::start(c).tables), 0.3, 1e-6);
}

TEST(QuadrantLearning, CanBeStoppedAtAnyTime) {
  auto c = config();
  Swings learned(c);
  for (int k = 0; k < 5; ++k) learned.swing();
  c.tables = learned.state().tables;
  c.adapt = false;
  Swings frozen(c);
  for (int k = 0; k < 5; ++k) frozen.swing();
  EXPECT_EQ(frozen.state().tables, c.tables);
  EXPECT_GT(frozen.largest(), 0.0);
}

TEST(QuadrantLearning, LearnsNothingMoreOnceItIsDropped) {
  Swings swings(config());
  for (int lap = 0; lap < 3; ++lap) swings.swing();
  swings.state().dropped = true;
  const auto before = swings.state().tables;
  for (int lap = 0; lap < 2; ++lap) swings.swing(3.0);
  EXPECT_TRUE(swings.state().tables == before);
}

TEST(QuadrantLearning, OctavesOfAccelerationEndAtBothEnds) {
  constexpr int highest = 5;
  const std::array<std::pair<double, int>, 5> wanted{{{0.0, 0}, {0.01, 0}, {0.04, 1}, {-0.04, 1}, {40.0, highest}}};
  for (const auto& [acceleration, place] : wanted)  // m/s^2; the first octave begins at 1/32
    EXPECT_EQ(S::acceleration_octave(signal<S::Acceleration>(acceleration), highest), place) << acceleration;
}

}  // namespace
}  // namespace stiction
