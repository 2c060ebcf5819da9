#include "sim/cam/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/cam/laws.hpp"

namespace stiction::sim::cam {
namespace {

// m or rad, of a length and a stroke: beyond what any machine has, and squares of it still are numbers.
constexpr double least_length = 1e-9, largest_extent = 1e9, largest_forced = 1e12;

constexpr std::string_view points_law = "points";

// A cycle closes, and points cover their segment, within this share of the motion's size: files give 15 digits.
constexpr double closing_tolerance = 1e-9;

std::string place_of(std::size_t k) { return fmt::format("segment {}: ", k + 1); }

std::string problem_of_points(const Segment& segment) {
  if (!segment.points) return "found no points; expected a table of them for the law points";
  if (auto problem = problem_of(*segment.points); !problem.empty()) return problem;
  const auto& master = segment.points->master;
  const auto& slave = segment.points->slave;
  if (std::fabs(master.front()) > closing_tolerance * segment.length ||
      std::fabs(master.back() - segment.length) > closing_tolerance * segment.length)
    return fmt::format("found points from {} to {} of the master; expected 0 to the segment's length {}",
                       master.front(), master.back(), segment.length);
  if (std::fabs(slave.back() - slave.front() - segment.stroke) > closing_tolerance * (1e-3 + std::fabs(segment.stroke)))
    return fmt::format("found points that move by {}; expected the segment's stroke {}", slave.back() - slave.front(),
                       segment.stroke);
  return {};
}

std::string problem_of_forced(const Boundary& boundary) {
  for (const auto& value : {boundary.speed, boundary.acceleration, boundary.jerk})
    if (value && !(std::fabs(*value) <= largest_forced))
      return fmt::format("found a forced value of {}; expected a number up to {}", *value, largest_forced);
  return {};
}

std::string problem_of_segment(const Segment& segment) {
  if (auto problem = problem_of_forced(segment.end); !problem.empty()) return problem;
  if (!std::isfinite(segment.length) || !(segment.length > 0.0))
    return fmt::format("found a length of {}; expected more than 0: its end behind its begin", segment.length);
  if (segment.length < least_length || segment.length > largest_extent)
    return fmt::format("found a length of {}; expected {} to {}", segment.length, least_length, largest_extent);
  if (!(std::fabs(segment.stroke) <= largest_extent))
    return fmt::format("found a stroke of {}; expected a number up to {}", segment.stroke, largest_extent);
  if (segment.law == points_law) return problem_of_points(segment);
  const Law* law = find_law(segment.law);
  if (law == nullptr) return fmt::format("found the law \"{}\"; expected one of `stiction cam laws`", segment.law);
  try {
    unit_curve(*law, segment.values);
  } catch (const machine::ValueError& error) {
    return fmt::format("law {}: found {}; expected {}", law->name, error.found, error.expected);
  } catch (const CamError& error) {
    return error.what();
  }
  return {};
}

bool is_hermite(const Segment& segment) {
  const Law* law = find_law(segment.law);
  return law != nullptr && (law->ends == EndValues::second || law->ends == EndValues::third);
}

EndState state_of(const Curve& curve, double x, Side side) {
  return {curve.derivative(x, 0, side), curve.derivative(x, 1, side), curve.derivative(x, 2, side),
          curve.derivative(x, 3, side)};
}

const std::optional<double>& member(const Boundary& boundary, int order) {
  return order == 1 ? boundary.speed : order == 2 ? boundary.acceleration : boundary.jerk;
}

double member(const EndState& state, int order) {
  return order == 1 ? state.speed : order == 2 ? state.acceleration : state.jerk;
}
double& member(EndState& state, int order) {
  return order == 1 ? state.speed : order == 2 ? state.acceleration : state.jerk;
}

// Boundary values scaled to the unit law and back: stroke / length^order.
double unit_scale(const Segment& segment, int order) {
  double scale = segment.stroke;
  for (int k = 0; k < order; ++k) scale /= segment.length;
  return scale;
}

// The curve of a segment whose law is none of the Hermite ones, from 0. `start` and `end`: what is forced there; a law
// that takes slopes takes the speeds.
Curve own_curve(const Segment& segment, const Boundary& start, const Boundary& end) {
  if (segment.law == points_law) return curve_of(*segment.points).placed({.offset = -segment.points->slave.front()});
  const Law& law = *find_law(segment.law);
  LawValues values = segment.values;
  if (law.ends == EndValues::slopes && segment.stroke != 0.0) {
    if (start.speed) values["start_slope"] = {*start.speed / unit_scale(segment, 1)};
    if (end.speed) values["end_slope"] = {*end.speed / unit_scale(segment, 1)};
  }
  try {
    return unit_curve(law, values).placed({.stretch = segment.length, .gain = segment.stroke});
  } catch (const machine::ValueError& error) {  // a forced speed makes a slope beyond what a law takes
    throw CamError(fmt::format("law {}: found {} of the unit law; expected {}", law.name, error.found, error.expected));
  }
}

// Forced values that the curve of a law does not have.
void require_forced(const Segment& segment, const Curve& curve, const Boundary& forced, bool at_start,
                    std::size_t number) {
  for (int order = 1; order <= 3; ++order) {
    const auto& wanted = member(forced, order);
    if (!wanted) continue;
    const double x = at_start ? curve.begin() : curve.end();
    const double found = curve.derivative(x, order, at_start ? Side::right : Side::left);
    const double size = std::fabs(unit_scale(segment, order)) + std::fabs(*wanted);
    if (std::fabs(found - *wanted) > closing_tolerance * size)
      throw CamError(fmt::format("{}found a forced {} of {} at its {}; expected {}, all that the law {} can have there",
                                 place_of(number),
                                 order == 1   ? "speed"
                                 : order == 2 ? "acceleration"
                                              : "jerk",
                                 *wanted, at_start ? "start" : "end", found, segment.law));
  }
}

// One end of a Hermite segment: what is forced, else its own parameter, else what its neighbour ends with, else rest.
EndState hermite_end(const Segment& segment, const Law& law, const Boundary& forced, const EndState* neighbour,
                     bool at_start) {
  EndState state;
  constexpr const char* names[] = {"slope", "acceleration", "jerk"};
  for (int order = 1; order <= (law.ends == EndValues::third ? 3 : 2); ++order) {
    const std::string key = fmt::format("{}_{}", at_start ? "start" : "end", names[order - 1]);
    const bool free = std::any_of(law.parameters.begin(), law.parameters.end(),
                                  [&](const auto& parameter) { return parameter.key == key; });
    if (!free) continue;
    if (member(forced, order))
      member(state, order) = *member(forced, order);
    else if (segment.values.contains(key))
      member(state, order) = value(segment.values, key) * unit_scale(segment, order);
    else if (neighbour != nullptr)
      member(state, order) = member(*neighbour, order);
  }
  return state;
}

// In units of the segment's length, so that the polynomial's variable is 0 to 1.
EndState over_length(EndState state, double length) {
  double factor = 1.0;
  for (int order = 1; order <= 3; ++order) {
    factor *= length;
    member(state, order) *= factor;
  }
  return state;
}

Curve hermite_curve(const Segment& segment, const Law& law, EndState start, EndState end) {
  end.position = segment.stroke;
  start = over_length(start, segment.length);
  end = over_length(end, segment.length);
  const auto through = law.ends == EndValues::third ? septic : quintic;
  Piece first{
      .begin = 0.0, .end = 0.5 * segment.length, .rate = 1.0 / segment.length, .polynomial = through(start, end)};
  Piece second{.begin = 0.5 * segment.length,
               .end = segment.length,
               .rate = 1.0 / segment.length,
               .from_end = true,
               .polynomial = through(end.reversed(), start.reversed())};
  return Curve({first, second});
}

}  // namespace

double Segment::rise() const {
  const Law* named = find_law(law);
  return named == nullptr || named->kind == LawKind::rise ? stroke : 0.0;
}

double Cam::cycle() const { return begin_of(segments.size()); }

double Cam::begin_of(std::size_t k) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < k; ++i) sum += segments[i].length;
  return sum;
}

double Cam::position_of(std::size_t k) const {
  double sum = start;
  for (std::size_t i = 0; i < k; ++i) sum += segments[i].rise();
  return sum;
}

std::string problem_of(const Cam& cam) {
  if (cam.segments.empty()) return "found no segment; expected one or more";
  if (!(std::fabs(cam.start) <= largest_extent))
    return fmt::format("found a start at {}; expected a number up to {}", cam.start, largest_extent);
  if (auto problem = problem_of_forced(cam.begin); !problem.empty()) return problem;
  double size = 0.0;
  for (std::size_t k = 0; k < cam.segments.size(); ++k) {
    if (auto problem = problem_of_segment(cam.segments[k]); !problem.empty()) return place_of(k) + problem;
    size = std::max(size, std::fabs(cam.segments[k].stroke));
  }
  if (!cam.periodic) return {};
  const double rise = cam.position_of(cam.segments.size()) - cam.start;
  double open = rise;
  if (cam.modulo) open -= *cam.modulo * std::nearbyint(rise / *cam.modulo);
  if (std::fabs(open) > closing_tolerance * size)
    return fmt::format("found a cycle that ends {} away from where it begins; expected a periodic cam to close{}", open,
                       cam.modulo ? " or to advance by whole multiples of modulo" : "");
  return {};
}

std::size_t Motion::segment_of(std::size_t piece) const {
  std::size_t k = 0;
  while (k + 1 < segments.size() && piece >= segments[k].end_piece) ++k;
  return k;
}

Motion compose(const Cam& cam) {
  if (const auto problem = problem_of(cam); !problem.empty()) throw CamError(problem);
  const std::size_t n = cam.segments.size();
  const auto start_of = [&](std::size_t k) -> const Boundary& {
    return k > 0 ? cam.segments[k - 1].end : cam.periodic ? cam.segments.back().end : cam.begin;
  };
  std::vector<std::optional<Curve>> curves(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Segment& segment = cam.segments[k];
    if (is_hermite(segment)) continue;
    curves[k] = own_curve(segment, start_of(k), segment.end);
  }
  const auto neighbour = [&](std::size_t k, bool before) -> std::optional<EndState> {
    if ((before ? k == 0 : k + 1 == n) && !cam.periodic) return std::nullopt;
    const std::size_t other = before ? (k + n - 1) % n : (k + 1) % n;
    if (is_hermite(cam.segments[other])) return std::nullopt;
    const Curve& curve = *curves[other];
    return before ? state_of(curve, curve.end(), Side::left) : state_of(curve, curve.begin(), Side::right);
  };
  Motion motion{cam, {}, {}};
  std::vector<Piece> pieces;
  for (std::size_t k = 0; k < n; ++k) {
    const Segment& segment = cam.segments[k];
    if (is_hermite(segment)) {
      const Law& law = *find_law(segment.law);
      const auto before = neighbour(k, true), behind = neighbour(k, false);
      curves[k] = hermite_curve(segment, law, hermite_end(segment, law, start_of(k), before ? &*before : nullptr, true),
                                hermite_end(segment, law, segment.end, behind ? &*behind : nullptr, false));
    }
    require_forced(segment, *curves[k], start_of(k), true, k);
    require_forced(segment, *curves[k], segment.end, false, k);
    const Curve placed = curves[k]->placed({.begin = cam.begin_of(k), .offset = cam.position_of(k)});
    motion.segments.push_back({pieces.size(), pieces.size() + placed.pieces().size()});
    pieces.insert(pieces.end(), placed.pieces().begin(), placed.pieces().end());
  }
  motion.curve = Curve(std::move(pieces));
  return motion;
}

bool is_on(const Track& track, double x, double cycle, double speed, bool was_on) {
  const auto wrapped = [&](double place) { return place - cycle * std::floor(place / cycle); };
  const double wider = was_on ? track.hysteresis : 0.0;
  const double place = wrapped(x);
  return std::any_of(track.windows.begin(), track.windows.end(), [&](const Track::Window& window) {
    if (wrapped(window.first) == wrapped(window.last)) return true;
    const double first = wrapped(window.first + speed * track.on_compensation - wider);
    const double last = wrapped(window.last + speed * track.off_compensation + wider);
    return first <= last ? place >= first && place < last : place >= first || place < last;
  });
}

}  // namespace stiction::sim::cam
