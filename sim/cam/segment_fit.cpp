#include "sim/cam/segment_fit.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "sim/cam/hermite.hpp"

namespace stiction::sim::cam {
namespace {

using Coefficients = std::array<double, 6>;  // of t in 0 to 1 over the segment

constexpr std::size_t taylor_order = 14;
constexpr int subintervals = 8;

std::int64_t to_nearest(double value) { return static_cast<std::int64_t>(value + (value < 0.0 ? -0.5 : 0.5)); }

// The master's place of a phase.
double place_of(std::uint64_t phase, double cycle) { return static_cast<double>(phase) * 0x1p-32 * cycle; }

Coefficients hermite_of(const Part& part, double cycle) {
  const double begin = place_of(part.begin, cycle), end = place_of(part.end, cycle), h = end - begin;
  const auto state = [&](double x) {
    return EndState{part.piece->derivative(x, 0), part.piece->derivative(x, 1) * h,
                    part.piece->derivative(x, 2) * h * h, 0.0};
  };
  const auto found = quintic(state(begin), state(end));
  Coefficients c{};
  std::copy(found.begin(), found.end(), c.begin());
  return c;
}

// 2^(32 + down) / length with 32 bits.
void set_reciprocal(CamTable::Segment& segment, std::uint64_t length) {
  int down = 0;
  while (down < 31 && (std::uint64_t{1} << (down + 1)) < length) ++down;
  // Rounded down: t stays below 1 up to the last phase.
  const std::uint64_t exact = down == 31 && length == std::uint64_t{1} << 32
                                  ? std::uint64_t{1} << 31
                                  : (std::uint64_t{1} << (32 + down)) / length;
  segment.down = static_cast<std::uint8_t>(down);
  segment.reciprocal = static_cast<std::uint32_t>(std::min<std::uint64_t>(exact, UINT32_MAX));
}

void set_coefficients(CamTable::Segment& segment, const Coefficients& c, int position_bits) {
  const double scale = power_of_two(position_bits);
  segment.c0 = to_nearest(c[0] * scale);
  double largest = 0.0;
  for (std::size_t n = 1; n < 6; ++n) largest = std::max(largest, absolute(c[n] * scale));
  // position = coefficient * 2^extra_bits / 2^shift.
  // No finer than 2^-8 of a position's unit: the products of all segments are shifted to one scale.
  int shift = CamTable::extra_bits;
  while (shift < CamTable::extra_bits + 8 && largest * power_of_two(shift + 1 - CamTable::extra_bits) < 2147483647.0)
    ++shift;
  while (shift > 0 && largest * power_of_two(shift - CamTable::extra_bits) >= 2147483647.0) --shift;
  segment.shift = static_cast<std::uint8_t>(shift);
  for (std::size_t n = 1; n < 6; ++n)
    segment.c[n - 1] = static_cast<std::int32_t>(to_nearest(c[n] * scale * power_of_two(shift - CamTable::extra_bits)));
}

// The polynomial that the drive evaluates, without its roundings: exact doubles.
Coefficients exact_of(const CamTable::Segment& segment, int position_bits) {
  Coefficients c{static_cast<double>(segment.c0) * power_of_two(-position_bits)};
  for (std::size_t n = 1; n < 6; ++n)
    c[n] = segment.c[n - 1] * power_of_two(CamTable::extra_bits - segment.shift - position_bits);
  return c;
}

// A polynomial in t from 0 to 1 as one in s from -1 to 1: t = (1 + s) / 2, by Horner's scheme around 1/2, then halves.
std::vector<Interval> around_middle(const Coefficients& c) {
  std::vector<Interval> shifted(c.begin(), c.end());
  for (std::size_t n = 0; n < 5; ++n)
    for (std::size_t k = 5; k-- > n;) shifted[k] = shifted[k] + Interval(0.5) * shifted[k + 1];
  double half = 1.0;
  for (Interval& each : shifted) each = each * Interval(half), half *= 0.5;
  return shifted;
}

// Motion minus table over the segment as a polynomial in s, whose coefficients are enclosed.
std::vector<Interval> difference(const TaylorModel& model, const Coefficients& table) {
  std::vector<Interval> d = model.coefficients;
  Interval power = 1.0;
  for (Interval& c : d) c = c * power, power = power * Interval(model.radius);
  const auto shifted = around_middle(table);
  for (std::size_t n = 0; n < 6; ++n) d[n] = d[n] - shifted[n];
  return d;
}

std::vector<Interval> derivative_of(const std::vector<Interval>& c) {
  std::vector<Interval> d;
  for (std::size_t n = 1; n < c.size(); ++n) d.push_back(c[n] * Interval(static_cast<double>(n)));
  return d;
}

Interval value_of(const std::vector<Interval>& c, const Interval& s) {
  Interval sum = 0.0;
  for (std::size_t n = c.size(); n-- > 0;) sum = sum * s + c[n];
  return sum;
}

// A bound of the magnitude over [-1, 1]: on each subinterval the value at its middle and the largest slope.
double largest_of(const std::vector<Interval>& c) {
  const auto slope = derivative_of(c);
  double largest = 0.0;
  for (int k = 0; k < subintervals; ++k) {
    const double low = -1.0 + 2.0 * k / subintervals, high = -1.0 + 2.0 * (k + 1) / subintervals;
    const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
    largest = std::max(largest, value_of(c, middle).magnitude() + half * value_of(slope, {low, high}).magnitude());
  }
  return largest;
}

// What the drive's integers add, in the slave's unit and for it over cycles.
TableBound rounding_of(const CamTable::Segment& segment, const Coefficients& table, std::uint64_t length,
                       int position_bits) {
  // Largest derivatives over t, which is s / 2.
  const auto first = derivative_of(around_middle(table)), second = derivative_of(first);
  const double slope = 2.0 * largest_of(first), bend = 4.0 * largest_of(second);
  const double twist = 8.0 * largest_of(derivative_of(second));
  // t is rounded down, but for a length that is a power of two, and by the reciprocal's rounding.
  const double ideal = 0x1p32 * power_of_two(segment.down) / static_cast<double>(length);
  const double relative = absolute(segment.reciprocal - ideal) / ideal * (1.0 + 1e-12);
  const double late = (std::has_single_bit(length) ? 0.0 : 0x1p-32) + relative;
  // One unit of the extended coefficients for each step of a scheme.
  const double unit = power_of_two(-segment.shift - position_bits);
  const double over = 0x1p32 / static_cast<double>(length);  // t for each cycle
  TableBound bound;
  bound.position = late * slope + 6.0 * unit + 0.5 * power_of_two(-position_bits);
  bound.speed = over * (late * bend + relative * slope + 8.0 * unit);
  // The second product is rounded down in units that the first one has made smaller by up to two.
  bound.acceleration = over * over * (late * twist + 2.1 * relative * bend + 16.0 * unit);
  return bound;
}

}  // namespace

double power_of_two(int exponent) { return std::bit_cast<double>(static_cast<std::int64_t>(1023 + exponent) << 52); }

FittedSegment fit_segment(const Part& part, double cycle, int position_bits, double tolerance) {
  FittedSegment fitted;
  const std::uint64_t length = part.end - part.begin;
  fitted.segment.start = static_cast<std::uint32_t>(part.begin);
  set_reciprocal(fitted.segment, length);
  set_coefficients(fitted.segment, hermite_of(part, cycle), position_bits);

  const auto table = exact_of(fitted.segment, position_bits);
  const auto model = taylor_model(*part.piece, place_of(part.begin, cycle), place_of(part.end, cycle), taylor_order);
  const auto d = difference(model, table);
  const TableBound rounding = rounding_of(fitted.segment, table, length, position_bits);
  // From s to cycles.
  const double rate = cycle / model.radius;
  double size = 0.0, fast = 0.0, bent = 0.0;
  for (std::size_t n = 0; n < 6; ++n) size += absolute(table[n]);
  for (std::size_t n = 1; n < 6; ++n) fast += absolute(table[n]) * static_cast<double>(n);
  for (std::size_t n = 2; n < 6; ++n) bent += absolute(table[n]) * static_cast<double>(n * (n - 1));
  // The law in double precision is itself rounded: 64 units of the last place, and the place that it is evaluated at.
  constexpr double ulps = 64.0 * 0x1p-53;
  const double place = 2.0 * ulps * static_cast<double>(part.end) / static_cast<double>(length);
  fitted.bound.position = largest_of(d) + model.remainder[0] + rounding.position + ulps * size + place * fast;
  if (fitted.bound.position > tolerance) return fitted;
  const auto first = derivative_of(d), second = derivative_of(first);
  fitted.bound.speed = largest_of(first) * rate + model.remainder[1] * cycle + rounding.speed +
                       0.5 * rate * (ulps * fast + place * bent);
  fitted.bound.acceleration = largest_of(second) * rate * rate + model.remainder[2] * cycle * cycle +
                              rounding.acceleration + 0.25 * rate * rate * (ulps * bent + 4.0 * place * bent);
  return fitted;
}

TableBound smooth_error(const Part& part, double cycle) {
  const auto model = taylor_model(*part.piece, place_of(part.begin, cycle), place_of(part.end, cycle), taylor_order);
  const auto ideal = difference(model, hermite_of(part, cycle));
  const double rate = cycle / model.radius;
  return {largest_of(ideal), 0.0, largest_of(derivative_of(derivative_of(ideal))) * rate * rate};
}

}  // namespace stiction::sim::cam
