// Bridges against the quintic through their ends in double precision, and their bounds against its samples.
#include "stiction/motion/bridge.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/firmware/cam/cam_bench.hpp"
#include "tests/firmware/number/exact.hpp"

namespace stiction {
namespace {

using test::Int128;

TEST(Product, IsExactAndRoundedToNearest) {
  std::mt19937_64 random(3);
  for (int k = 0; k < 200'000; ++k) {
    const auto a = static_cast<std::int64_t>(random()) >> (random() % 64);
    const auto b = static_cast<std::int64_t>(random()) >> (random() % 64);
    const int shift = static_cast<int>(random() % 127);
    const Int128 exact = Int128{a} * b, size = exact < 0 ? -exact : exact;
    const Int128 rounded = shift == 0 ? size : (size + (Int128{1} << (shift - 1))) >> shift;
    const Int128 held = rounded > INT64_MAX ? Int128{INT64_MAX} : rounded;
    ASSERT_EQ(product_shifted(a, b, shift), static_cast<std::int64_t>(exact < 0 ? -held : held));
    const std::int64_t x = a < 0 ? ~a : a, y = b < 0 ? ~b : b;
    const Int128 whole = Int128{x} * y;
    ASSERT_EQ(product_held(x, y), static_cast<std::int64_t>(whole > INT64_MAX ? Int128{INT64_MAX} : whole));
    const auto word = static_cast<std::int32_t>(b);
    const Int128 of_word = Int128{a >> 2} * word;
    ASSERT_EQ(product_by_word<36>(a >> 2, word), static_cast<std::int64_t>(of_word >> 36));
  }
  EXPECT_EQ(product_shifted(INT64_MIN, INT64_MIN, 0), INT64_MAX);
  EXPECT_EQ(product_shifted(INT64_MIN, 1, 0), -INT64_MAX);
  EXPECT_EQ(product_shifted(INT64_MIN, INT64_MIN, 127), 1);
  EXPECT_EQ(product_held(INT64_MAX, 1), INT64_MAX);
  EXPECT_EQ(product_held(INT64_MAX, 0), 0);
  EXPECT_EQ(product_held(INT64_MAX, INT64_MAX), INT64_MAX);
  EXPECT_EQ(product_held((std::int64_t{1} << 31) - 1, std::int64_t{1} << 32), INT64_MAX - UINT32_MAX);
}

// To the nearest, ties up, of numbers up to 2^62, by the product of 128 bits that the compiler brings along.
TEST(Product, WithinAWordIsTheNearestWholeNumber) {
  std::mt19937_64 random(11);
  for (int k = 0; k < 200'000; ++k) {
    const int shift = 32 + static_cast<int>(random() % 32);
    const std::int64_t a = static_cast<std::int64_t>(random()) >> (1 + random() % 60);
    const std::int64_t b = static_cast<std::int64_t>(random()) >> (1 + random() % 60);
    const Int128 exact = (Int128{a} * b + (Int128{1} << (shift - 1))) >> shift;
    if (exact > INT64_MAX || exact < INT64_MIN) continue;
    ASSERT_EQ(product_within(a, b, shift), static_cast<std::int64_t>(exact)) << a << ' ' << b << ' ' << shift;
  }
  constexpr std::int64_t most = std::int64_t{1} << 62;
  EXPECT_EQ(product_within(most, -most, 62), -most);
  EXPECT_EQ(product_within(1, most, 63), 1);
  EXPECT_EQ(product_within(-1, most, 63), 0);
}

// 2^(62 + bits) / length, rounded down, by the division of 128 bits that the compiler brings along.
TEST(Span, HasTheExactReciprocal) {
  const auto check = [](std::int64_t length) {
    const Span span = Span::of(length);
    __extension__ using Wide = unsigned __int128;
    const auto expected = static_cast<std::int64_t>((Wide{1} << (62 + span.bits)) / static_cast<std::uint64_t>(length));
    ASSERT_EQ(span.reciprocal, expected) << length;
    ASSERT_EQ(span.length, length);
  };
  for (std::int64_t length = 1; length <= 70'000; ++length) check(length);
  for (int bit = 2; bit <= 61; ++bit)
    for (const std::int64_t off : {-3, -2, -1, 0, 1, 2, 3})
      if (bit < 61 || off <= 0) check((std::int64_t{1} << bit) + off > 0 ? (std::int64_t{1} << bit) + off : 1);
  std::mt19937_64 random(5);
  for (int k = 0; k < 1'000'000; ++k) check(static_cast<std::int64_t>(random() >> (3 + random() % 50)) + 1);
  for (int k = 0; k < BridgeLengths::count; ++k) {
    const Span span = BridgeLengths::span(k), expected = Span::of(BridgeLengths::ticks(k));
    EXPECT_EQ(span.length, expected.length);
    EXPECT_EQ(span.reciprocal, expected.reciprocal);
    EXPECT_EQ(span.bits, expected.bits);
  }
}

// What lies beyond a word is its end, also where it does by the rounding alone: 2^64 - 1 over 2.
TEST(Product, BeyondAWordIsItsEnd) {
  EXPECT_EQ(product_shifted((std::int64_t{1} << 32) - 1, (std::int64_t{1} << 32) + 1, 1), INT64_MAX);
  EXPECT_EQ(product_shifted(1 - (std::int64_t{1} << 32), (std::int64_t{1} << 32) + 1, 1), -INT64_MAX);
  EXPECT_EQ(product_shifted((std::int64_t{1} << 32) - 1, (std::int64_t{1} << 31), 1), ((std::int64_t{1} << 32) - 1)
                                                                                          << 30);
}

// A deviation of the whole format within a thousandth of a tick: its peaks are held, and still far beyond any limit.
TEST(Bridge, PeaksOfWhatNoWordHoldsAreHeld) {
  MotionPoint all{};
  all.position = INT64_MAX;
  all.velocity = INT64_MAX;
  const auto peaks = Bridge::peaks(all, Span::of(1));
  for (const std::int64_t peak : {peaks.slope, peaks.bend, peaks.third}) EXPECT_GT(peak, std::int64_t{1} << 59);
}

TEST(Span, DividesByItsLength) {
  std::mt19937_64 random(5);
  for (int k = 0; k < 20'000; ++k) {
    const std::int64_t length = 1 + static_cast<std::int64_t>(random() >> (3 + random() % 60));
    const Span span = Span::of(length);
    EXPECT_EQ(span.length, length);
    const auto part = static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(length));
    EXPECT_NEAR(static_cast<double>(span.share(part)), static_cast<double>(part) / static_cast<double>(length) * 0x1p62,
                0x1p11);
    EXPECT_EQ(span.share(0), 0);
    const auto x = static_cast<std::int64_t>(random() >> 30);
    EXPECT_NEAR(static_cast<double>(span.divide(x, 12)), static_cast<double>(x) * 4096 / static_cast<double>(length),
                1.0);
  }
  EXPECT_EQ(Span::of(0).length, 1);
  EXPECT_EQ(Span::of(INT64_MAX).length, Span::longest);
}

// The quintic by its textbook equation, over time in s.
struct Quintic {
  Quintic(double d, double v, double a, double seconds) : t_(seconds), c_{d, v, a / 2} {
    const double v1 = v * seconds, a1 = a * seconds * seconds;
    c_[3] = (-20 * d - 12 * v1 - 3 * a1) / 2 / std::pow(seconds, 3);
    c_[4] = (30 * d + 16 * v1 + 3 * a1) / 2 / std::pow(seconds, 4);
    c_[5] = (-12 * d - 6 * v1 - a1) / 2 / std::pow(seconds, 5);
  }
  double at(double t, int order) const {
    double sum = 0.0;
    for (int n = 5; n >= order; --n) {
      double factor = c_[n];
      for (int k = 0; k < order; ++k) factor *= n - k;
      sum = sum * t + factor;
    }
    return sum;
  }
  double largest(int order) const {
    double most = 0.0;
    for (int k = 0; k <= 2000; ++k) most = std::max(most, std::abs(at(t_ * k / 2000, order)));
    return most;
  }

 private:
  double t_, c_[6];
};

class Drawn {
 public:
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }

 private:
  std::mt19937_64 random_{7};
};

TEST(Bridge, IsTheQuinticThroughItsEnds) {
  Drawn drawn;
  for (int k = 0; k < 400; ++k) {
    const auto ticks = static_cast<std::int64_t>(std::exp(drawn.between(6.0, 11.0)));
    const double seconds = static_cast<double>(ticks) / test::rate;
    const double d = drawn.between(-2, 2), v = drawn.between(-3, 3) / seconds,
                 a = drawn.between(-9, 9) / seconds / seconds;
    const Quintic truth(d, v, a, seconds);
    Bridge bridge;
    bridge.start(Span::of(ticks), {test::raw_position(d), test::raw_velocity(v), test::raw_acceleration(a)},
                 Bridge::Over::ticks);
    for (std::int64_t tick = 0; tick <= ticks; tick += 1 + ticks / 57) {
      bridge.go_to(tick);
      const double t = static_cast<double>(tick) / test::rate;
      EXPECT_NEAR(test::position_of(bridge.point().position), truth.at(t, 0), 2e-11);
      EXPECT_NEAR(test::velocity_of(bridge.point().velocity), truth.at(t, 1), 4e-8 / seconds);  // shares of 31 bits
      EXPECT_NEAR(test::acceleration_of(bridge.point().acceleration), truth.at(t, 2), 1e-7 / seconds / seconds);
    }
    bridge.go_to(ticks);
    EXPECT_FALSE(bridge.active());
    EXPECT_EQ(bridge.point(), MotionPoint{});
  }
}

// Ways of 3000 units have 2^-40 of them, and no bits more.
TEST(Bridge, OfALongWayIsTheQuinticToo) {
  constexpr std::int64_t ticks = 160'000;
  constexpr double seconds = ticks / test::rate;
  const Quintic truth(3000.0, 40.0, -3.0, seconds);
  Bridge bridge;
  bridge.start(Span::of(ticks), {test::raw_position(3000.0), test::raw_velocity(40.0), test::raw_acceleration(-3.0)},
               Bridge::Over::ticks);
  EXPECT_EQ(bridge.point().position, test::raw_position(3000.0));
  for (std::int64_t tick = 1; tick < ticks; tick += 777) {
    bridge.go_to(tick);
    EXPECT_NEAR(test::position_of(bridge.point().position), truth.at(static_cast<double>(tick) / test::rate, 0), 3e-9);
  }
}

// What fits is within the limits, and what does not fit would not be by far.
TEST(Bridge, FitsWhereItsLargestDerivativesDo) {
  Drawn drawn;
  int fitting = 0, close = 0;
  for (int k = 0; k < 3000; ++k) {
    const auto ticks = static_cast<std::int64_t>(std::exp(drawn.between(3.0, 10.0)));
    const double seconds = static_cast<double>(ticks) / test::rate;
    const double d = drawn.between(-1, 1), v = drawn.between(-1, 1) / seconds,
                 a = drawn.between(-1, 1) / seconds / seconds;
    const Quintic truth(d, v, a, seconds);
    const double factor = std::exp(drawn.between(-1.0, 2.0));
    const double most[3] = {truth.largest(1) * factor, truth.largest(2) * factor, truth.largest(3) * factor};
    const bool fits = Bridge::fits({test::raw_position(d), test::raw_velocity(v), test::raw_acceleration(a)}, ticks,
                                   test::limits(most[0], most[1], most[2]));
    if (fits) {
      EXPECT_GE(factor, 0.9999);
    }
    fitting += fits;
    close += fits && factor < 1.8;
  }
  EXPECT_GT(fitting, 500);
  EXPECT_GT(close, 100);
  const MotionLimits wide = test::limits(10.0, 100.0, 1000.0);
  EXPECT_FALSE(Bridge::fits({INT64_MIN, 0, 0}, 1000, wide));
  EXPECT_FALSE(Bridge::fits({0, INT64_MIN, 0}, 1000, wide));
  EXPECT_FALSE(Bridge::fits({0, 0, INT64_MIN}, 1000, wide));
  EXPECT_TRUE(Bridge::fits({}, 4, {}));
  EXPECT_TRUE(Bridge::fits_speed(test::raw_velocity(1.0), 0, 16000, test::limits(1.01, 1.51, 6.1)));
  EXPECT_FALSE(Bridge::fits_speed(test::raw_velocity(1.0), 0, 16000, test::limits(0.99, 1.51, 6.1)));
  EXPECT_FALSE(Bridge::fits_speed(test::raw_velocity(1.0), 0, 16000, test::limits(1.01, 1.49, 6.1)));
  EXPECT_FALSE(Bridge::fits_speed(test::raw_velocity(1.0), 0, 16000, test::limits(1.01, 1.51, 5.9)));
  EXPECT_FALSE(Bridge::fits_speed(0, test::raw_acceleration(2.0), 16000, test::limits(1.01, 1.51, 60.0)));
  EXPECT_FALSE(Bridge::fits_speed(INT64_MIN, 0, 16000, wide));
  EXPECT_FALSE(Bridge::fits_speed(0, INT64_MIN, 16000, wide));
  // Three days at most; what a word does not hold of such lengths is held.
  const MotionLimits most{std::int64_t{1} << 56, std::int64_t{1} << 56, std::int64_t{1} << 56};
  EXPECT_TRUE(Bridge::fits({std::int64_t{1} << 53, 1, 1}, std::int64_t{1} << 31, most));
  EXPECT_FALSE(Bridge::fits({1, 1, 1}, std::int64_t{UINT32_MAX} + 1, most));
  EXPECT_TRUE(Bridge::fits_speed(1, 1, std::int64_t{1} << 31, most));
  EXPECT_FALSE(Bridge::fits_speed(1, 1, std::int64_t{UINT32_MAX} + 1, most));
  // A speed or an acceleration that takes more than 2^14 units on the way.
  EXPECT_FALSE(Bridge::fits({0, std::int64_t{1} << 50, 0}, 1 << 20, most));
  EXPECT_FALSE(Bridge::fits({0, 0, std::int64_t{1} << 40}, 1 << 25, most));
  EXPECT_FALSE(Bridge::fits_speed(std::int64_t{1} << 50, 0, 1 << 20, most));
  EXPECT_FALSE(Bridge::fits_speed(0, std::int64_t{1} << 40, 1 << 25, most));
}

TEST(Bridge, OfSpeedEndsWithItAndKeepsItsRule) {
  Drawn drawn;
  for (int k = 0; k < 300; ++k) {
    const MotionLimits limits = test::limits(drawn.between(0.5, 20), drawn.between(1, 300), drawn.between(20, 20000));
    const SpeedRampRule rule = SpeedRampRule::of(limits);
    // From any acceleration within the limit.
    const std::int64_t v = static_cast<std::int64_t>(drawn.between(-1, 1) * static_cast<double>(limits.velocity));
    const std::int64_t a = static_cast<std::int64_t>(drawn.between(-1, 1) * static_cast<double>(limits.acceleration));
    Bridge bridge;
    const std::int64_t ticks = rule.ticks(v), d = bridge.start_speed(Span::of(ticks), v, a);
    test::Watch watch(limits);
    for (std::int64_t tick = 1; tick <= ticks; ++tick) {
      bridge.tick();
      // Its own speed may be beyond the limit, as it is a deviation.
      MotionPoint point = bridge.point();
      watch.see(point);
    }
    EXPECT_FALSE(bridge.active());
    EXPECT_LE(watch.over_acceleration, 1e-6);
    EXPECT_LE(watch.over_jerk, 1e-3);
    EXPECT_LE(watch.position_jump, test::position_unit / 4);
    const double way = test::velocity_of(v) * static_cast<double>(ticks) / test::rate / 2;
    EXPECT_NEAR(test::position_of(d),
                -way - test::acceleration_of(a) * std::pow(static_cast<double>(ticks) / test::rate, 2) / 12, 1e-9);
  }
  EXPECT_EQ(SpeedRampRule::of({1, 1, INT64_MAX}).shortest, 16);
  EXPECT_EQ(SpeedRampRule::of({1, std::int64_t{1} << 60, 1}).shortest, ((std::int64_t{1} << 40) + 1) * 7);
}

}  // namespace
}  // namespace stiction
