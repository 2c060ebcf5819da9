#include "sim/cam/spline.hpp"

#include <array>
#include <cstddef>
#include <utility>

namespace stiction::sim::cam {
namespace {

// Speed and acceleration of a node; of a cubic spline the second is carried along as zero.
using Pair = std::array<double, 2>;
using Block = std::array<std::array<double, 2>, 2>;

Pair operator-(const Pair& a, const Pair& b) { return {a[0] - b[0], a[1] - b[1]}; }
Pair operator*(const Block& m, const Pair& v) {
  return {m[0][0] * v[0] + m[0][1] * v[1], m[1][0] * v[0] + m[1][1] * v[1]};
}
Block operator*(const Block& a, const Block& b) {
  Block c{};
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j) c[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j];
  return c;
}
Block operator-(const Block& a, const Block& b) {
  Block c{};
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j) c[i][j] = a[i][j] - b[i][j];
  return c;
}
Block inverse(const Block& m) {
  const double d = m[0][0] * m[1][1] - m[0][1] * m[1][0];
  return {{{m[1][1] / d, -m[0][1] / d}, {-m[1][0] / d, m[0][0] / d}}};
}

// A row of the system: left * x[i-1] + own * x[i] + right * x[i+1] = given.
struct Row {
  Block left{}, own{}, right{};
  Pair given{};
};

// What an interval says of the two highest derivatives that must be continuous, at one of its ends: near * (state of
// that end) + far * (state of the other) + constant. Of a cubic spline that is the acceleration alone.
struct EndForm {
  Block near{}, far{};
  Pair constant{};
};

// From the coefficients of hermite.hpp: y''' = 6 c3 and y'''' = 24 c4 at the start of [0, 1]. The other end is the same
// read backwards: odd derivatives change their sign.
EndForm end_form(double length, double rise, SplineDegree degree, bool at_start) {
  const double h = length, sign = at_start ? 1.0 : -1.0, d = sign * rise;
  if (degree == SplineDegree::cubic) {  // y'' = 6 rise / h^2 - (4 v0 + 2 v1) / h
    return {{{{-4.0 * sign / h, 0.0}, {0.0, 1.0}}}, {{{-2.0 * sign / h, 0.0}, {0.0, 0.0}}}, {6.0 * d / (h * h), 0.0}};
  }
  const double h2 = h * h, h3 = h2 * h, h4 = h3 * h;
  // In the coordinate that runs inwards from this end: speed and third derivative have the sign.
  const Block near{{{-36.0 / h2, -9.0 * sign / h}, {192.0 * sign / h3, 36.0 / h2}}};
  const Block far{{{-24.0 / h2, 3.0 * sign / h}, {168.0 * sign / h3, -24.0 / h2}}};
  return {near, far, {60.0 * rise / h3, -360.0 * d / h4}};
}

Row end_row(const EndForm& form, SplineEnds ends, const EndState& state, bool first) {
  Row row;
  if (ends == SplineEnds::clamped) {
    row.own = {{{1.0, 0.0}, {0.0, 1.0}}};
    row.given = {state.speed, state.acceleration};
    return row;
  }
  row.own = form.near;
  (first ? row.right : row.left) = form.far;
  row.given = Pair{0.0, 0.0} - form.constant;
  return row;
}

// Forward elimination and back substitution by blocks (Thomas).
std::vector<Pair> solve(std::vector<Row> rows) {
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const Block factor = rows[i].left * inverse(rows[i - 1].own);
    rows[i].own = rows[i].own - factor * rows[i - 1].right;
    rows[i].given = rows[i].given - factor * rows[i - 1].given;
  }
  std::vector<Pair> x(rows.size());
  for (std::size_t i = rows.size(); i-- > 0;)
    x[i] = inverse(rows[i].own) * (i + 1 < rows.size() ? rows[i].given - rows[i].right * x[i + 1] : rows[i].given);
  return x;
}

struct Interval2 {
  double length, rise;
};

std::vector<Interval2> intervals_of(const std::vector<SplineNode>& nodes) {
  std::vector<Interval2> intervals;
  for (std::size_t i = 1; i < nodes.size(); ++i)
    intervals.push_back({nodes[i].master - nodes[i - 1].master, nodes[i].slave - nodes[i - 1].slave});
  return intervals;
}

// Continuity at a node between the interval before and the one behind it.
Row inner_row(const Interval2& before, const Interval2& behind, SplineDegree degree) {
  const EndForm a = end_form(before.length, before.rise, degree, false);
  const EndForm b = end_form(behind.length, behind.rise, degree, true);
  const Block zero{};
  Row row{zero - a.far, b.near - a.near, b.far, a.constant - b.constant};
  if (degree == SplineDegree::cubic) row.own[1][1] = 1.0;
  return row;
}

// A periodic spline: nodes 0 to n - 1 in a ring. With the state of node 0 given, the others follow from a tridiagonal
// system; it is solved for three states, and the row of node 0 then is two equations for the right one.
std::vector<Pair> solve_ring(const std::vector<Interval2>& intervals, SplineDegree degree) {
  const std::size_t n = intervals.size();
  const auto rest = [&](const Pair& first) {
    std::vector<Row> rows;
    for (std::size_t i = 1; i < n; ++i) rows.push_back(inner_row(intervals[i - 1], intervals[i], degree));
    if (rows.empty()) return std::vector<Pair>{};
    rows.front().given = rows.front().given - rows.front().left * first;
    rows.back().given = rows.back().given - rows.back().right * first;
    return solve(std::move(rows));
  };
  const Row closing = inner_row(intervals.back(), intervals.front(), degree);
  const auto residual = [&](const Pair& first) {
    const auto others = rest(first);
    const Pair before = others.empty() ? first : others.back(), behind = others.empty() ? first : others.front();
    const Pair sum = closing.own * first, left = closing.left * before, right = closing.right * behind;
    return Pair{sum[0] + left[0] + right[0] - closing.given[0], sum[1] + left[1] + right[1] - closing.given[1]};
  };
  const Pair base = residual({0.0, 0.0}), one = residual({1.0, 0.0}) - base, two = residual({0.0, 1.0}) - base;
  const Pair first = inverse({{{one[0], two[0]}, {one[1], two[1]}}}) * (Pair{0.0, 0.0} - base);
  std::vector<Pair> states{first};
  const auto others = rest(first);
  states.insert(states.end(), others.begin(), others.end());
  states.push_back(first);
  return states;
}

}  // namespace

Curve through_states(const std::vector<SplineNode>& nodes, const std::vector<EndState>& states, SplineDegree degree) {
  std::vector<Piece> pieces;
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const double h = nodes[i].master - nodes[i - 1].master;
    const auto unit = [&](const EndState& s, double y) {
      return EndState{y, s.speed * h, s.acceleration * h * h, 0.0};
    };
    const EndState start = unit(states[i - 1], nodes[i - 1].slave), end = unit(states[i], nodes[i].slave);
    Piece piece{.begin = nodes[i - 1].master, .end = nodes[i].master, .rate = 1.0 / h};
    if (degree == SplineDegree::quintic) {
      piece.polynomial = quintic(start, end);
    } else {
      const double rise = end.position - start.position;
      piece.polynomial = {start.position, start.speed, 3.0 * rise - 2.0 * start.speed - end.speed,
                          start.speed + end.speed - 2.0 * rise};
    }
    pieces.push_back(std::move(piece));
  }
  return Curve(std::move(pieces));
}

Curve spline(const std::vector<SplineNode>& nodes, SplineDegree degree, SplineEnds ends, const EndState& first,
             const EndState& last) {
  const auto intervals = intervals_of(nodes);
  std::vector<Pair> solved;
  if (ends == SplineEnds::periodic) {
    solved = solve_ring(intervals, degree);
  } else {
    std::vector<Row> rows;
    rows.push_back(
        end_row(end_form(intervals.front().length, intervals.front().rise, degree, true), ends, first, true));
    for (std::size_t i = 1; i < intervals.size(); ++i)
      rows.push_back(inner_row(intervals[i - 1], intervals[i], degree));
    rows.push_back(end_row(end_form(intervals.back().length, intervals.back().rise, degree, false), ends, last, false));
    solved = solve(std::move(rows));
  }
  std::vector<EndState> states;
  for (const Pair& s : solved) states.push_back({0.0, s[0], s[1], 0.0});
  return through_states(nodes, states, degree);
}

}  // namespace stiction::sim::cam
