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

// The states of a part's piece at its ends, over units of the master.
EndState state_at(const Part& part, std::uint64_t phase, double cycle) {
  const double x = place_of(phase, cycle);
  return {part.piece->derivative(x, 0), part.piece->derivative(x, 1), part.piece->derivative(x, 2), 0.0};
}

// The polynomial through both states over a way of `h` of the master.
Coefficients hermite_of(const EndState& begin, const EndState& end, double h) {
  const auto over = [h](const EndState& s) { return EndState{s.position, s.speed * h, s.acceleration * h * h, 0.0}; };
  const auto found = quintic(over(begin), over(end));
  Coefficients c{};
  std::copy(found.begin(), found.end(), c.begin());
  return c;
}

Coefficients hermite_of(const Part& part, double cycle) {
  return hermite_of(state_at(part, part.begin, cycle), state_at(part, part.end, cycle),
                    place_of(part.end, cycle) - place_of(part.begin, cycle));
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

// What t is at the end of a segment of `length` phases: 1, or below it by the rounding of the reciprocal.
double end_of_t(const CamTable::Segment& segment, std::uint64_t length) {
  return static_cast<double>(length * segment.reciprocal) * power_of_two(-32 - segment.down);
}

// The way of the master over which t goes from 0 to 1.
double way_of_t(const CamTable::Segment& segment, double cycle) {
  return power_of_two(segment.down) / segment.reciprocal * cycle;
}

// Of coefficients over u, which is 1 at the segment's end, those over t, which is `end` there.
Coefficients over_t(Coefficients c, double end) {
  double power = 1.0;
  for (double& each : c) each /= power, power *= end;
  return c;
}

// Below what a word holds by more than joining a segment to the next one changes a coefficient.
constexpr double largest_coefficient = 2147483000.0;

// The exponent that all coefficients share: position = coefficient * 2^extra_bits / 2^shift.
void set_shift(CamTable::Segment& segment, const Coefficients& c, int position_bits) {
  double largest = 0.0;
  for (std::size_t n = 1; n < 6; ++n) largest = std::max(largest, absolute(c[n] * power_of_two(position_bits)));
  // No finer than 2^-8 of a position's unit: the products of all segments are shifted to one scale.
  int shift = CamTable::extra_bits;
  while (shift < CamTable::extra_bits + 8 &&
         largest * power_of_two(shift + 1 - CamTable::extra_bits) < largest_coefficient)
    ++shift;
  while (shift > 0 && largest * power_of_two(shift - CamTable::extra_bits) >= largest_coefficient) --shift;
  segment.shift = static_cast<std::uint8_t>(shift);
}

// By how many bits the coefficient `c` of t^`n` can be finer than the exponent that all share.
int finer_bits_of(const CamTable::Segment& segment, int n, double c, int position_bits) {
  const double value = c * power_of_two(position_bits + segment.shift - CamTable::extra_bits);
  int finer = 0;
  while (n > 1 && finer < 15 && absolute(value) * power_of_two(finer + 1) < largest_coefficient) ++finer;
  return finer;
}

// Sets the coefficient of t^`n`, with all bits that its word has room for. What rounding left of `c`.
double set_coefficient(CamTable::Segment& segment, int n, double c, int position_bits) {
  const int finer = finer_bits_of(segment, n, c, position_bits);
  if (n > 1) segment.finer = static_cast<std::uint16_t>(segment.finer | finer << (4 * (n - 2)));
  const int bits = position_bits + segment.shift - CamTable::extra_bits + finer;
  segment.c[n - 1] = static_cast<std::int32_t>(to_nearest(c * power_of_two(bits)));
  return c - segment.c[n - 1] * power_of_two(-bits);
}

// Sets the last three coefficients. What rounding leaves of one is added to the next finer one, so that the end of the
// segment is off by what it leaves of the finest.
void set_last(CamTable::Segment& segment, const Coefficients& c, int position_bits) {
  std::array<int, 3> order{3, 4, 5};
  const auto bits = [&](int n) { return finer_bits_of(segment, n, c[static_cast<std::size_t>(n)], position_bits); };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return bits(a) < bits(b); });
  double left = 0.0;
  for (const int n : order) left = set_coefficient(segment, n, c[static_cast<std::size_t>(n)] + left, position_bits);
}

// The polynomial over t that the drive evaluates, without its roundings: exact doubles.
Coefficients exact_of(const CamTable::Segment& segment, int position_bits) {
  Coefficients c{static_cast<double>(segment.c0) * power_of_two(-position_bits)};
  for (int n = 1; n < 6; ++n)
    c[static_cast<std::size_t>(n)] =
        segment.c[n - 1] * power_of_two(CamTable::extra_bits - segment.shift - segment.finer_bits(n) - position_bits);
  return c;
}

// The segment of `part` but for the last three coefficients: what it begins with.
CamTable::Segment begun(const Part& part, double cycle, int position_bits) {
  CamTable::Segment segment;
  segment.start = static_cast<std::uint32_t>(part.begin);
  const std::uint64_t length = part.end - part.begin;
  set_reciprocal(segment, length);
  const Coefficients c = over_t(hermite_of(part, cycle), end_of_t(segment, length));
  set_shift(segment, c, position_bits);
  segment.c0 = to_nearest(c[0] * power_of_two(position_bits));
  for (int n = 1; n < 3; ++n) set_coefficient(segment, n, c[static_cast<std::size_t>(n)], position_bits);
  return segment;
}

EndState begin_of(const CamTable::Segment& segment, double cycle, int position_bits) {
  const Coefficients c = exact_of(segment, position_bits);
  const double h = way_of_t(segment, cycle);
  return {c[0], c[1] / h, 2.0 * c[2] / (h * h), 0.0};
}

// The same coefficients over u from 0 to 1 over all of the segment, enclosed.
std::vector<Interval> enclosed(const CamTable::Segment& segment, std::uint64_t length, int position_bits) {
  const double middle = end_of_t(segment, length);
  const Interval end =
      std::has_single_bit(length) ? Interval(middle) : Interval(next_below(middle), next_above(middle));
  std::vector<Interval> c;
  Interval power = 1.0;
  for (const double each : exact_of(segment, position_bits)) c.push_back(Interval(each) * power), power = power * end;
  return c;
}

// A polynomial in u from 0 to 1 as one in s from -1 to 1: u = (1 + s) / 2, by Horner's scheme around 1/2, then halves.
std::vector<Interval> around_middle(std::vector<Interval> shifted) {
  for (std::size_t n = 0; n < 5; ++n)
    for (std::size_t k = 5; k-- > n;) shifted[k] = shifted[k] + Interval(0.5) * shifted[k + 1];
  double half = 1.0;
  for (Interval& each : shifted) each = each * Interval(half), half *= 0.5;
  return shifted;
}

// Motion minus table over the segment as a polynomial in s, whose coefficients are enclosed.
std::vector<Interval> difference(const TaylorModel& model, const std::vector<Interval>& table) {
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
TableBound rounding_of(const CamTable::Segment& segment, const std::vector<Interval>& table, std::uint64_t length,
                       int position_bits) {
  // Largest derivatives over u, which is s / 2.
  const auto first = derivative_of(around_middle(table)), second = derivative_of(first);
  const double slope = 2.0 * largest_of(first), bend = 4.0 * largest_of(second);
  const double twist = 8.0 * largest_of(derivative_of(second));
  // t is rounded down, but for a length that is a power of two.
  const double late = std::has_single_bit(length) ? 0.0 : 0x1.00001p-32;
  // Each product is rounded down by up to a unit of the extended coefficients, which the sums behind it take up: 5 for
  // the value, 14 for its derivative, twice 19 for the second one; the products with the reciprocal round too.
  const double unit = power_of_two(-segment.shift - position_bits);
  const double over = 0x1p32 / static_cast<double>(length);  // u for each cycle
  TableBound bound;
  bound.position = late * slope + 6.0 * unit + 0.5 * power_of_two(-position_bits);
  bound.speed = over * (late * bend + 17.0 * unit);
  bound.acceleration = over * over * (late * twist + 45.0 * unit);
  return bound;
}

}  // namespace

double power_of_two(int exponent) { return std::bit_cast<double>(static_cast<std::int64_t>(1023 + exponent) << 52); }

EndState segment_begin(const Part& part, double cycle, int position_bits) {
  return begin_of(begun(part, cycle, position_bits), cycle, position_bits);
}

EndState part_begin(const Part& part, double cycle) { return state_at(part, part.begin, cycle); }
EndState part_end(const Part& part, double cycle) { return state_at(part, part.end, cycle); }

FittedSegment fit_segment(const Part& part, double cycle, int position_bits, const EndState& end, double tolerance) {
  FittedSegment fitted;
  const std::uint64_t length = part.end - part.begin;
  fitted.segment = begun(part, cycle, position_bits);
  const double t = end_of_t(fitted.segment, length);
  // Through the begin as it was rounded, so that its rounding is gone at the end.
  const EndState begin = begin_of(fitted.segment, cycle, position_bits);
  const Coefficients joined = over_t(hermite_of(begin, end, way_of_t(fitted.segment, cycle) * t), t);
  set_last(fitted.segment, joined, position_bits);

  const Coefficients exact = exact_of(fitted.segment, position_bits);
  const auto table = enclosed(fitted.segment, length, position_bits);
  const auto model = taylor_model(*part.piece, place_of(part.begin, cycle), place_of(part.end, cycle), taylor_order);
  const auto d = difference(model, table);
  const TableBound rounding = rounding_of(fitted.segment, table, length, position_bits);
  // From s to cycles.
  const double rate = cycle / model.radius;
  double size = 0.0, fast = 0.0, bent = 0.0;
  for (std::size_t n = 0; n < 6; ++n) size += absolute(exact[n]);
  for (std::size_t n = 1; n < 6; ++n) fast += absolute(exact[n]) * static_cast<double>(n);
  for (std::size_t n = 2; n < 6; ++n) bent += absolute(exact[n]) * static_cast<double>(n * (n - 1));
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
  const Coefficients c = hermite_of(part, cycle);
  const auto ideal = difference(model, {c.begin(), c.end()});
  const double rate = cycle / model.radius;
  return {largest_of(ideal), 0.0, largest_of(derivative_of(derivative_of(ideal))) * rate * rate};
}

}  // namespace stiction::sim::cam
