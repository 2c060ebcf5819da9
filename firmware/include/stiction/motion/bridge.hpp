// What carries a motion over to a different one without a jump: the deviation between both, as a polynomial of fifth
// degree that begins with its position, speed and acceleration and ends with none of them (quintic Hermite segment, L.
// Biagiotti, C. Melchiorri, "Trajectory Planning for Automatic Machines and Robots", 2008, 2.1.7). With s from 0 to 1
// and w = 1 - s,
//   p   = w^3 (d + (V + 3 d) s + (A/2 + 3 V + 6 d) s^2)
//   p'  = w^2 (V + (A + 2 V) s - 5 (A/2 + 3 V + 6 d) s^2)
//   p'' = w   (A - (8 A + 36 V + 60 d) s + (10 A + 60 V + 120 d) s^2)
// where V and A are speed and acceleration over the length of the bridge. Factors of w make the end exactly zero.
//
// A bridge runs over ticks, whatever the master does, or over a distance of the master, in which it goes back when the
// master does.
#pragma once

#include <bit>
#include <cstdint>
#include <initializer_list>

#include "stiction/motion/cam_peaks.hpp"
#include "stiction/motion/motion_point.hpp"
#include "stiction/number/product.hpp"

namespace stiction {

// A length and its reciprocal, so that a share of it takes no division.
struct Span {
  static constexpr int share_bits = 62;
  static constexpr std::int64_t longest = std::int64_t{1} << 61;

  std::int64_t length = 1;
  std::int64_t reciprocal = std::int64_t{1} << 62;  // 2^(62 + bits) / length, from 2^61
  std::int8_t bits = 0;                             // of the length, less one

  // The span of `length`, 1 to 2^61: ticks, or 2^-40 cycles of the master. A division of four digits (D. E. Knuth, "The
  // Art of Computer Programming", volume 2, 4.3.1), each by a division of words that is too small by up to 3.
  static constexpr Span of(std::int64_t length) {
    const auto whole = static_cast<std::uint64_t>(length < 1 ? 1 : length > longest ? longest : length);
    Span span;
    span.length = static_cast<std::int64_t>(whole);
    span.bits = static_cast<std::int8_t>(std::bit_width(whole) - 1);
    const std::uint64_t divisor = whole << (61 - span.bits);
    const auto leading = static_cast<std::uint32_t>(divisor >> 46) + 1;
    const bool one = divisor == std::uint64_t{1} << 61;
    std::uint64_t rest = one ? 0 : std::uint64_t{1} << 61, quotient = one ? 1 : 0;
    for (const int bits_of_digit : {16, 16, 15, 15}) {
      std::uint32_t digit = static_cast<std::uint32_t>(rest >> (46 - bits_of_digit)) / leading;
      rest = (rest << bits_of_digit) - divisor * digit;
      for (int k = 0; k < 3; ++k)
        if (rest >= divisor) rest -= divisor, ++digit;
      quotient = quotient << bits_of_digit | digit;
    }
    span.reciprocal = static_cast<std::int64_t>(quotient);
    return span;
  }

  // `part` / length in 2^-62; `part`: 0 to the length. Two products of 32 bits for a length of ticks.
  constexpr std::int64_t share(std::int64_t part) const {
    if (bits > 31) return product_shifted(part, reciprocal, bits);
    const auto word = static_cast<std::uint32_t>(part);
    const std::uint64_t low = static_cast<std::uint64_t>(static_cast<std::uint32_t>(reciprocal)) * word;
    const std::uint64_t high = (static_cast<std::uint64_t>(reciprocal) >> 32) * word + (low >> 32);
    return static_cast<std::int64_t>(high << (32 - bits) | static_cast<std::uint32_t>(low) >> bits);
  }

  // `x` * 2^up / length. `up`: up to 62.
  constexpr std::int64_t divide(std::int64_t x, int up) const {
    return product_shifted(x, reciprocal, share_bits + bits - up);
  }
};

class Bridge {
 public:
  // What a bridge runs over: ticks, or 2^-40 cycles, so that its slopes are those of a MotionPoint or 2^-40 of the
  // slave's unit for each cycle and for its square.
  enum class Over : std::uint8_t { ticks, distance };

  // A bridge from the deviation `from`, which is over after `span`, `over` what it says. Its polynomials are made in
  // the tick in which it first goes on, as that one has no decision to take.
  constexpr void start(const Span& span, const MotionPoint& from, Over over) {
    span_ = span;
    over_ = over;
    gone_ = 0;
    active_ = true;
    made_ = false;
    p_[0] = from.position;
    v_[0] = from.velocity;
    a_[0] = from.acceleration;
  }

  // A bridge of speed alone, over ticks: the way that it takes is what it makes it. Returns the deviation of the
  // position at its begin, with which the polynomial is one of fourth degree. `span`: in ticks; `v`, `a`: deviations of
  // speed and acceleration.
  constexpr std::int64_t start_speed(const Span& span, std::int64_t v, std::int64_t a) {
    const std::int64_t slope = product<MotionPoint::tick_bits>(a, span.length);
    // -V/2 - A/12
    const std::int64_t way = product<MotionPoint::tick_bits>(6 * v + slope, span.length);
    const std::int64_t d = -product<66>(way, 0x5555555555555555);
    start(span, {d, v, a}, Over::ticks);
    return d;
  }

  // Goes on by a tick. Over at its end.
  constexpr void tick() { go_to(gone_ + 1); }
  // Goes to `gone` of its length, in units of it, from 0 on.
  constexpr void go_to(std::int64_t gone) {
    gone_ = gone;
    if (gone_ >= span_.length) active_ = false;
    if (active_ && !made_) make();
  }
  constexpr void clear() { active_ = false; }

  constexpr bool active() const { return active_; }
  constexpr Over over() const { return over_; }
  constexpr std::int64_t gone() const { return gone_; }
  constexpr std::int64_t length() const { return span_.length; }

  // The deviation where it is.
  constexpr MotionPoint point() const {
    if (!active_) return {};
    if (!made_) return {p_[0], v_[0], a_[0]};
    const std::int64_t share = span_.share(span_.length - gone_), gone = (std::int64_t{1} << Span::share_bits) - share;
    const auto w = static_cast<std::uint32_t>(share >> 31), s = static_cast<std::uint32_t>(gone >> 31);
    // By the scheme of Horner for a polynomial of w that begins with its third power, and for its slope; what is below
    // 31 bits of w counts by the slope.
    const std::int64_t first = of(w, p_[2]), b4 = first + p_[1], b3 = of(w, b4) + p_[0], b2 = of(w, b3), b1 = of(w, b2);
    const std::int64_t d3 = of(w, first + b4) + b3, d2 = of(w, d3) + b2, d1 = of(w, d2) + b1;
    const auto rest = static_cast<std::int32_t>(share & INT32_MAX);
    MotionPoint out;
    const std::int64_t fine = of(w, b1) + (std::int64_t{static_cast<std::int32_t>(d1 >> 32)} * rest >> 30);
    out.position = finer_ ? (fine + half_of_finer) >> finer_bits : fine;
    out.velocity = of(w, of(w, v_[0] + of(s, v_[1] + of(s, v_[2]))));
    out.acceleration = of(w, a_[0] + of(s, a_[1] + of(s, a_[2])));
    return out;
  }

  // Whether a bridge of `ticks`, below 2^32, from the deviation `from` keeps within `room`. Its parts are bounded each
  // by itself: the largest |p'|, |p''|, |p'''| are 15/8, 5.7735, 60 of a position, 1, 3.9403, 36 of a speed, and
  // 0.0678, 1, 9 of an acceleration. By the scheme of Horner for the length: what the acceleration leaves of the
  // jerk's, what the speed leaves of that. All factors are rounded up, all that is left is rounded down.
  static constexpr bool fits(const MotionPoint& from, std::int64_t ticks, const MotionLimits& room) {
    const std::int64_t d = bounded(from.position), v = bounded(from.velocity), a = bounded(from.acceleration);
    if (d >= most_way || v >= most_deviation || a >= most_deviation || ticks > UINT32_MAX) return false;
    const auto times = [t = static_cast<std::uint32_t>(ticks)](std::int64_t x) { return a_tick(x, t); };
    const std::int64_t of_a = times(a);  // as a speed
    if (times(v) >= most_way || times(of_a) >= most_way) return false;
    const std::int64_t speed = room.velocity - v - ((of_a >> 4) + (of_a >> 8) + (of_a >> 9) + (a > 0 ? 4 : 0));
    const std::int64_t change = times(room.acceleration - a) - (4 * v - (v * 15 >> 8));
    const std::int64_t jerk = times(times(room.jerk) - 9 * a) - 36 * v;
    return times(speed) >= (15 * d + 7) >> 3 && times(change) >= 6 * d - (d * 231 >> 10) && times(jerk) >= 60 * d;
  }

  // The same of a bridge of speed of `ticks` within `room`, from the speed `v` and the acceleration `a`: the largest
  // deviations of speed, acceleration and jerk are 1, 3/2, 6 of a speed, and 4/27, 1, 4 of an acceleration.
  static constexpr bool fits_speed(std::int64_t v, std::int64_t a, std::int64_t ticks, const MotionLimits& room) {
    const std::int64_t speed = bounded(v), change = bounded(a);
    if (speed >= most_deviation || change >= most_deviation || ticks > UINT32_MAX) return false;
    const auto times = [t = static_cast<std::uint32_t>(ticks)](std::int64_t x) { return a_tick(x, t); };
    const std::int64_t of_a = times(change);
    if (times(speed) >= most_way || times(of_a) >= most_way) return false;
    return speed + (of_a >> 3) + (of_a >> 6) + (of_a >> 7) + (change > 0 ? 4 : 0) <= room.velocity &&
           times(room.acceleration - change) >= (3 * speed + 1) >> 1 &&
           times(times(room.jerk) - 4 * change) >= 6 * speed;
  }

  // Bounds of the derivatives of a bridge from the deviation `from` over the distance of `span`, by the same parts.
  static constexpr CamPeaks peaks(const MotionPoint& from, const Span& span) {
    constexpr int up = MotionPoint::position_bits;
    const std::int64_t d = bounded(from.position), v = bounded(from.velocity), a = bounded(from.acceleration);
    // Rounded up; what no word holds stays the largest.
    const auto part = [&](std::int64_t of) {
      const std::int64_t quotient = span.divide(of, up);
      return quotient < INT64_MAX ? quotient + 1 : quotient;
    };
    const std::int64_t d1 = part(d), d2 = part(d1), d3 = part(d2), v1 = part(v), v2 = part(v1), a1 = part(a);
    const std::int64_t of_a = product<up>(a, span.length);
    // Factors as in fits(), of numbers that are held so that the products are within a word.
    const auto held = [](std::int64_t x) { return x < std::int64_t{1} << 60 ? x : std::int64_t{1} << 60; };
    const std::int64_t bend = held(d2), of_v = held(v1);
    return {sum(2 * held(d1) - (held(d1) >> 3), v, (of_a >> 4) + (of_a >> 8) + (of_a >> 9)),
            sum(6 * bend - (bend >> 3) - (bend >> 4) - (bend >> 5), 4 * of_v - (of_v >> 5) - (of_v >> 6), a),
            sum(product_held(d3, 60), product_held(v2, 36), product_held(a1, 9))};
  }

 private:
  constexpr void make() {
    made_ = true;
    if (over_ == Over::ticks)
      make_over<MotionPoint::tick_bits>();
    else
      make_over<MotionPoint::position_bits>();
  }

  // Of the position in the units of the span, `Up` bits from one derivative to the next. The position's coefficients
  // are those of w^3, w^4, w^5, in which the factor of s is written out.
  template <int Up>
  constexpr void make_over() {
    const std::int64_t d = p_[0], v = v_[0], a = a_[0];
    const std::int64_t length = span_.length;
    const std::int64_t slope = product<Up>(a, length);                // A, as a speed
    const std::int64_t of_speed = product<Up>(v, length);             // V, as a way
    const std::int64_t of_acceleration = product<Up>(slope, length);  // A, as a way
    const std::int64_t d_speed = span_.divide(d, Up), d_acceleration = span_.divide(d_speed, Up);
    const std::int64_t v_acceleration = span_.divide(v, Up);
    const std::int64_t linear = of_speed + 3 * d, square = of_acceleration / 2 + 3 * linear - 3 * d;
    p_[0] = d + linear + square;
    p_[1] = -(linear + 2 * square);
    p_[2] = square;
    // So that the position is rounded to the nearest of its format, and a motion does not begin with a step back.
    const auto holds = [](std::int64_t x) { return magnitude(x) < std::uint64_t{1} << (59 - finer_bits); };
    finer_ = holds(p_[0]) && holds(p_[1]) && holds(p_[2]);
    if (finer_)
      for (std::int64_t& p : p_) p *= std::int64_t{1} << finer_bits;
    v_[1] = slope + 2 * v;
    v_[2] = -5 * (slope / 2 + 3 * v + 6 * d_speed);
    a_[1] = -(8 * a + 36 * v_acceleration + 60 * d_acceleration);
    a_[2] = 10 * a + 60 * v_acceleration + 120 * d_acceleration;
  }

  static constexpr std::int64_t sum(std::int64_t a, std::int64_t b, std::int64_t c) {
    constexpr std::int64_t most = std::int64_t{1} << 60;
    const auto held = [](std::int64_t x) { return x < most ? x : most; };
    return held(a) + held(b) + held(c) + 6;
  }
  // x * share / 2^31, rounded down; share: up to 2^31.
  static constexpr std::int64_t of(std::uint32_t share, std::int64_t x) {
    const std::int64_t upper = (x >> 32) * std::int64_t{share};
    const std::uint64_t lower = std::uint64_t{static_cast<std::uint32_t>(x)} * share;
    return upper * 2 + static_cast<std::int64_t>(lower >> 31);
  }
  static constexpr std::int64_t bounded(std::int64_t x) { return x < 0 ? (x == INT64_MIN ? INT64_MAX : -x) : x; }
  // x * ticks / 2^12, rounded down, of a derivative that a length turns into the next lower one; held to 2^61, and to
  // -1 where nothing is left.
  [[gnu::always_inline]] static constexpr std::int64_t a_tick(std::int64_t x, std::uint32_t ticks) {
    if (x < 0) return -1;
    const std::uint64_t low = std::uint64_t{static_cast<std::uint32_t>(x)} * ticks;
    const std::uint64_t high = (static_cast<std::uint64_t>(x) >> 32) * ticks + (low >> 32);
    if (high >> 41 != 0) return std::int64_t{1} << 61;
    return static_cast<std::int64_t>(high << 20 | static_cast<std::uint32_t>(low) >> 12);
  }

  // With these the coefficients are within a word: ways of 2^14 units.
  static constexpr std::int64_t most_deviation = std::int64_t{1} << 57, most_way = std::int64_t{1} << 54;
  static constexpr int finer_bits = 8;  // of the position's coefficients, up to 2^11 units
  static constexpr std::int64_t half_of_finer = std::int64_t{1} << (finer_bits - 1);

  std::int64_t p_[3] = {}, v_[3] = {}, a_[3] = {};  // where it is not made, the first of each are the deviation
  std::int64_t gone_ = 0;
  Span span_{};
  bool active_ = false, made_ = false, finer_ = false;
  Over over_ = Over::ticks;
};

// How long a change of speed takes that keeps an acceleration A and a jerk J from any motion within them. The bridge of
// speed has the acceleration w ((1 - 3 s) a - 6 s v / T), which is at most A for |a| <= A and |v| / T <= 4 A / 9, and
// a jerk of up to (4 |a| + 6 |v| / T) / T, at most J then for T >= 20 A / (3 J).
struct SpeedRampRule {
  Span acceleration{};         // whose reciprocal is taken
  std::int64_t shortest = 16;  // ticks

  // Of `limits`; 64 steps of a division. The longest is 2^40 ticks.
  static constexpr SpeedRampRule of(const MotionLimits& limits) {
    SpeedRampRule rule;
    rule.acceleration = Span::of(limits.acceleration);
    const auto ticks = Span::of(limits.jerk).divide(limits.acceleration, MotionPoint::tick_bits);
    const std::int64_t bounded_ticks = ticks < (std::int64_t{1} << 40) ? ticks : std::int64_t{1} << 40;
    const std::int64_t needed = (bounded_ticks + 1) * 7;  // from 20 / 3 on
    rule.shortest = needed > 16 ? needed : 16;
    return rule;
  }

  // Ticks for a change of speed by `v`.
  constexpr std::int64_t ticks(std::int64_t v) const {
    const std::int64_t change = v < 0 ? -v : v;
    const std::int64_t needed = acceleration.divide(change / 4 + 1, MotionPoint::tick_bits) * 9 + 9;
    return needed > shortest ? needed : shortest;
  }
};

// The lengths that are tried one after the other, one each tick: 4, 5, 6, 7 ticks, and these doubled up to 18 times.
struct BridgeLengths {
  static constexpr int count = 76;
  // `k`: 0 to count - 1.
  static constexpr std::int64_t ticks(int k) { return std::int64_t{4 + k % 4} << (k / 4); }
  // The same as a span, without a division.
  static constexpr Span span(int k) {
    constexpr std::int64_t reciprocals[4] = {Span::of(4).reciprocal, Span::of(5).reciprocal, Span::of(6).reciprocal,
                                             Span::of(7).reciprocal};
    return {ticks(k), reciprocals[k % 4], static_cast<std::int8_t>(k / 4 + 2)};
  }
};

}  // namespace stiction
