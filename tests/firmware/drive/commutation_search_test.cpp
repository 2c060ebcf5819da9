// The search for the magnets by itself, on an axis that yields like a spring: it is where the force puts it, at once.
#include "stiction/drive/commutation_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "stiction/number/fixed_signals.hpp"

namespace stiction {
namespace {

using S = FixedSignals;
using Search = CommutationSearch<S>;
using Phase = Search::Phase;

constexpr double pitch = 0.032, response = 8e-6, most_current = 10.0;  // m, m, A
constexpr double stiff = 4e-6;                                         // m/A: the response at 2 A
constexpr double true_offset = 200.0;                                  // degrees

Turn turn(double degrees) {
  return Turn{static_cast<std::uint32_t>(static_cast<std::int64_t>(std::llround(degrees / 360.0 * 0x1p32)))};
}
S::Position position(double x) { return S::Position::from_raw(std::llround(x * 0x1p40)); }
// Degrees, -180 to 180.
double apart(Turn a, Turn b) { return static_cast<std::int32_t>(a.raw - b.raw) * 360.0 * 0x1p-32; }

CommutationConfig<S> config_of(CommutationMethod method) {
  CommutationConfig<S> c;
  c.method = method;
  c.offset = turn(true_offset);
  c.tolerance = turn(10.0);
  c.inverse_pole_pair_pitch = S::PitchInverse::from_raw(static_cast<std::int32_t>(std::lround(0x1p20 / pitch)));
  c.most_current = S::Current::from_raw(static_cast<std::int32_t>(most_current * 0x1p20));
  c.response = position(response);
  c.longest_way = position(pitch / 50.0);
  return c;
}

// An axis and how far it yields in each part of the test.
class Yielding {
 public:
  explicit Yielding(CommutationConfig<S> config = config_of(CommutationMethod::test)) : search(config) {}

  double growing = stiff, forwards = stiff, backwards = stiff, pushed = stiff;  // m/A
  double drift = 0.0;                                                           // m a tick
  double shaken = 0.0, fading = 1.0;                                            // m behind the turns, of it in a tick
  double pole_pair = pitch;
  double shaken_from = 0.0;  // rad
  bool standing = true;
  Search search;
  double highest = 0.0;  // A
  int waited = 0;        // ticks

  // To the end of the test, at most a million ticks.
  void run() {
    search.begin(position(at_), {});
    for (int k = 0; k < 1'000'000 && search.searching(); ++k) tick();
    EXPECT_FALSE(search.searching());
  }

 private:
  void tick() {
    const Phase before = search.phase();
    waited += before == Phase::waiting ? 1 : 0;
    at_ += drift;
    const auto& order = search.order();
    const double current = order.current.raw() * 0x1p-20;
    highest = std::max(highest, current);
    const double phi = true_offset / 360.0 + x_ / pole_pair, theta = order.angle.raw * 0x1p-32;
    x_ = at_ + yields(before) * current * std::cos(2.0 * std::numbers::pi * (phi - theta));
    if (before == Phase::resting || before == Phase::pushing) {
      shaken *= fading;
      x_ += shaken * std::cos(2.0 * std::numbers::pi * ++shakes_ / 700.0 + shaken_from);
    }
    search.step(position(x_), standing);
    measured_ += before == Phase::turning && search.phase() != Phase::turning ? 1 : 0;
  }
  double yields(Phase phase) const {
    if (phase == Phase::growing) return growing;
    if (phase == Phase::pushing) return pushed;
    return measured_ == 0 ? forwards : backwards;
  }

  double at_ = 0.1, x_ = 0.1;
  int measured_ = 0, shakes_ = 0;
};

// A push is told from a vibration that the turns have left: by waiting, or not at all.
TEST(CommutationSearch, WaitsForAVibrationBeforeItBelievesAPush) {
  for (int k = 0; k < 24; ++k) {
    Yielding fades, stays;
    for (auto* axis : {&fades, &stays}) {
      axis->shaken = 50e-6;
      axis->shaken_from = k * std::numbers::pi / 12.0;
    }
    fades.fading = 1.0 - 1.0 / 2000.0;
    fades.run();
    EXPECT_TRUE(fades.search.known()) << k;
    EXPECT_NEAR(apart(fades.search.offset(), turn(true_offset)), 0.0, 2.0) << k;
    stays.run();
    EXPECT_EQ(stays.search.fault(), Fault::commutation_not_found) << k;
  }
}

TEST(CommutationSearch, FindsTheOffsetWithAllOfTheCurrentFromAQuarterOfTheResponseOn) {
  Yielding soft;
  soft.run();
  EXPECT_TRUE(soft.search.known());
  EXPECT_NEAR(apart(soft.search.offset(), turn(true_offset)), 0.0, 2.0);
  EXPECT_LT(soft.highest, most_current);
  Yielding half;
  half.growing = half.forwards = half.backwards = half.pushed = 0.5 * response / most_current;
  half.run();
  EXPECT_TRUE(half.search.known());
  EXPECT_NEAR(apart(half.search.offset(), turn(true_offset)), 0.0, 2.0);
  EXPECT_EQ(half.highest, most_current);
  Yielding fifth;
  fifth.growing = fifth.forwards = fifth.backwards = fifth.pushed = 0.2 * response / most_current;
  fifth.run();
  EXPECT_EQ(fifth.search.fault(), Fault::commutation_not_found);
}

// A way of a centimetre is more in a tick than the sums take; a vibration that is cut has the same phase.
TEST(CommutationSearch, FindsTheOffsetOfAVibrationThatIsCut) {
  auto config = config_of(CommutationMethod::test);
  config.inverse_pole_pair_pitch = S::PitchInverse::from_raw(1 << 20);  // of a metre
  config.longest_way = position(0.05);
  Yielding wide(config);
  wide.pole_pair = 1.0;
  wide.growing = wide.forwards = wide.backwards = wide.pushed = 0.01 / (most_current / 32.0);
  wide.run();
  EXPECT_TRUE(wide.search.known());
  EXPECT_NEAR(apart(wide.search.offset(), turn(true_offset)), 0.0, 2.0);
  EXPECT_EQ(wide.highest, most_current / 32.0);
}

TEST(CommutationSearch, GrowsTheCurrentAgainBehindAVibrationThatHasGoneAndFailsWithAllOfIt) {
  Yielding gone;
  gone.forwards = gone.backwards = 0.0;
  gone.growing = 10.0 * stiff;  // enough from the first turn on
  gone.run();
  EXPECT_EQ(gone.search.fault(), Fault::commutation_not_found);
  EXPECT_EQ(gone.highest, most_current);
  EXPECT_EQ(gone.search.order().current, S::Current{});
}

// Both parts have to be the same motion.
TEST(CommutationSearch, FailsWhereTheVibrationDoesNotLast) {
  Yielding gone;
  gone.backwards = 0.0;
  gone.run();
  EXPECT_EQ(gone.search.fault(), Fault::commutation_not_found);
  EXPECT_LT(gone.highest, most_current);
  Yielding stronger;
  stronger.backwards = 5.0 * stiff;
  stronger.run();
  EXPECT_EQ(stronger.search.fault(), Fault::commutation_not_found);
  Yielding weaker;
  weaker.forwards = 5.0 * stiff;
  weaker.run();
  EXPECT_EQ(weaker.search.fault(), Fault::commutation_not_found);
}

TEST(CommutationSearch, FailsWhereThePushesDoNotMoveTheAxis) {
  Yielding stuck;
  stuck.pushed = 0.0;
  stuck.run();
  EXPECT_EQ(stuck.search.fault(), Fault::commutation_not_found);
  EXPECT_FALSE(stuck.search.known());
}

TEST(CommutationSearch, FailsWhereTheAxisGoesFurtherThanItMayAndThenGivesNoCurrent) {
  for (const double drift : {1e-7, -1e-7}) {
    Yielding carried;
    carried.drift = drift;
    carried.run();
    EXPECT_EQ(carried.search.fault(), Fault::commutation_not_found);
    EXPECT_NEAR(static_cast<double>(carried.search.way()) * 0x1p-40, pitch / 50.0, 3.0 * response);
    carried.search.step(position(0.1), true);
    EXPECT_EQ(carried.search.phase(), Phase::failed);
    EXPECT_EQ(carried.search.order().current, S::Current{});
  }
}

// An encoder's noise may look like motion for ever.
TEST(CommutationSearch, WaitsForRestNoLongerThanHalfASecond) {
  Yielding noisy;
  noisy.standing = false;
  noisy.run();
  EXPECT_EQ(noisy.waited, Search::longest_rest_ticks);
  EXPECT_TRUE(noisy.search.known());
}

TEST(CommutationSearch, LosesWhatItFoundButNoOffsetThatIsTrusted) {
  auto stored = config_of(CommutationMethod::stored);
  Search trusted(stored);
  trusted.lose();
  EXPECT_TRUE(trusted.known());
  EXPECT_EQ(trusted.offset().raw, stored.offset.raw);
  stored.checked = true;
  Yielding checked(stored);
  checked.run();
  EXPECT_TRUE(checked.search.known());
  checked.search.lose();
  EXPECT_EQ(checked.search.phase(), Phase::unknown);
  Search zero(config_of(CommutationMethod::encoder_zero));
  zero.lose();
  EXPECT_TRUE(zero.known());
}

// Hall signals and an encoder; angles in degrees, which the encoder's position is too.
class Hall {
 public:
  Search search{config_of(CommutationMethod::hall)};

  void begin(double degrees) { search.begin(place(degrees), signals(degrees)); }
  void see(double degrees) { watch(degrees, degrees); }
  void watch(double encoder, double magnets) { search.watch(place(encoder), signals(magnets)); }
  double error() const { return apart(search.offset(), turn(true_offset)); }

 private:
  static S::Position place(double degrees) { return position(degrees / 360.0 * pitch); }
  // Each is high for half a turn, from 0, 120 and 240 degrees on.
  static DigitalInputs<S> signals(double degrees) {
    DigitalInputs<S> inputs;
    for (int k = 0; k < 3; ++k)
      if (std::fmod(degrees - 120.0 * k + 720.0, 360.0) < 180.0) inputs.hall |= static_cast<std::uint8_t>(1 << k);
    return inputs;
  }
};

TEST(CommutationSearch, TakesTheEdgesOfHallSignalsInBothDirections) {
  Hall hall;
  hall.begin(50.0);
  EXPECT_NEAR(hall.error(), -20.0, 0.01) << "of the sector's middle";
  for (double at = 50.0; at > -130.0; at -= 0.5) hall.see(at);
  EXPECT_TRUE(hall.search.known());
  EXPECT_NEAR(hall.error(), 0.0, 0.5);
  for (double at = -130.0; at < 130.0; at += 0.5) hall.see(at);
  EXPECT_TRUE(hall.search.known());
  EXPECT_NEAR(hall.error(), 0.0, 0.5);
}

TEST(CommutationSearch, FailsWithAHallSectorThatIsLeftOut) {
  for (const double jump : {120.0, 180.0, 240.0}) {
    Hall hall;
    hall.begin(30.0);
    hall.watch(30.0, 30.0 + jump);
    EXPECT_EQ(hall.search.fault(), Fault::commutation_offset) << jump;
  }
}

TEST(CommutationSearch, FailsWithAnEncoderThatCountsAgainstTheHallSignals) {
  Hall hall;
  hall.begin(30.0);
  for (double at = 0.0; at < 29.0; at += 0.5) hall.watch(30.0 - at, 30.0 + at);
  EXPECT_EQ(hall.search.fault(), Fault::none);
  for (double at = 29.0; at < 32.0; at += 0.5) hall.watch(30.0 - at, 30.0 + at);
  EXPECT_EQ(hall.search.fault(), Fault::commutation_offset);
}

}  // namespace
}  // namespace stiction
