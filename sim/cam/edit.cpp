#include "sim/cam/edit.hpp"

#include <fmt/format.h>

#include "sim/cam/laws.hpp"

namespace stiction::sim::cam {
namespace {

Cam consistent(Cam cam) {
  if (const auto problem = problem_of(cam); !problem.empty()) throw CamError(problem);
  return cam;
}

void require_segment(const Cam& cam, std::size_t at, std::size_t count) {
  if (at >= count)
    throw CamError(fmt::format("found segment {} of {}; expected one of them", at + 1, cam.segments.size()));
}

// Rise-return laws and points have their own stroke; the others take any.
void require_elastic(const Segment& segment) {
  const Law* law = find_law(segment.law);
  if (law == nullptr || law->kind != LawKind::rise)
    throw CamError(fmt::format("found a segment of the law {} at the boundary; expected one that rises by any stroke",
                               segment.law));
}

// Whether the law of `segment` takes a forced derivative of `order`.
bool takes(const Segment& segment, int order) {
  const Law* law = find_law(segment.law);
  if (law == nullptr) return false;
  if (law->ends == EndValues::slopes) return order == 1 && segment.stroke != 0.0;
  return law->ends == EndValues::third || (law->ends == EndValues::second && order <= 2);
}

// What is forced at the start of the segment `behind` is dropped where a law on one of its sides cannot have it.
void drop_impossible(Cam& cam, std::size_t behind) {
  const std::size_t n = cam.segments.size();
  if (behind == 0 && !cam.periodic) return;
  Boundary& boundary = cam.segments[(behind + n - 1) % n].end;
  const auto both = [&](int order) {
    return takes(cam.segments[(behind + n - 1) % n], order) && takes(cam.segments[behind % n], order);
  };
  if (!both(1)) boundary.speed.reset();
  if (!both(2)) boundary.acceleration.reset();
  if (!both(3)) boundary.jerk.reset();
}

// The part of `curve` between two places of the master as a Hermite segment. Speed and acceleration of one of its ends,
// the start or the end, become parameters of the unit law; the other end is forced by who calls.
Segment hermite_part(const Curve& curve, double from, double to, bool start) {
  Segment segment{
      .length = to - from, .stroke = curve.derivative(to, 0, Side::left) - curve.derivative(from, 0), .law = "hermite"};
  const double place = start ? from : to;
  const double speed = curve.derivative(place, 1, start ? Side::right : Side::left);
  const double acceleration = curve.derivative(place, 2, start ? Side::right : Side::left);
  if (segment.stroke == 0.0) {
    if (curve.derivative(0.5 * (from + to), 1) != 0.0)
      throw CamError(fmt::format(
          "found a split into a part that ends as high as it begins, {}; expected a different place", curve(from)));
    segment.law = "linear";
    return segment;
  }
  const double unit = segment.length / segment.stroke;
  segment.values[start ? "start_slope" : "end_slope"] = {speed * unit};
  segment.values[start ? "start_acceleration" : "end_acceleration"] = {acceleration * unit * segment.length};
  return segment;
}

}  // namespace

Cam append(const Cam& cam, const Segment& segment) {
  Cam result = cam;
  result.segments.push_back(segment);
  return consistent(std::move(result));
}

Cam insert(const Cam& cam, std::size_t at, const Segment& segment) {
  require_segment(cam, at, cam.segments.size());
  Cam result = cam;
  Segment& behind = result.segments[at];
  if (segment.rise() != 0.0 || behind.points) require_elastic(behind);
  if (!(segment.length < behind.length))
    throw CamError(
        fmt::format("found a length of {} to insert in one of {}; expected less", segment.length, behind.length));
  behind.length -= segment.length;
  if (behind.rise() != 0.0 || segment.rise() != 0.0) behind.stroke -= segment.rise();
  result.segments.insert(result.segments.begin() + static_cast<std::ptrdiff_t>(at), segment);
  drop_impossible(result, at);
  drop_impossible(result, (at + 2) % result.segments.size());
  return consistent(std::move(result));
}

Cam remove(const Cam& cam, std::size_t at) {
  require_segment(cam, at, cam.segments.size());
  if (cam.segments.size() == 1) throw CamError("found the only segment; expected one of several to remove");
  Cam result = cam;
  const Segment removed = cam.segments[at];
  result.segments.erase(result.segments.begin() + static_cast<std::ptrdiff_t>(at));
  Segment& heir = result.segments[at == 0 ? 0 : at - 1];
  if (removed.rise() != 0.0 || heir.points) require_elastic(heir);
  heir.length += removed.length;
  if (removed.rise() != 0.0) heir.stroke += removed.rise();
  if (at != 0) heir.end = removed.end;
  drop_impossible(result, at == 0 ? 0 : at - 1);
  drop_impossible(result, (at == 0 ? 1 : at) % result.segments.size());
  return consistent(std::move(result));
}

Cam split(const Cam& cam, double x) {
  const Motion motion = compose(cam);
  if (!(x > 0.0 && x < cam.cycle()))
    throw CamError(fmt::format("found a split at {}; expected a place inside the cycle {}", x, cam.cycle()));
  const std::size_t at = motion.segment_of(motion.curve.piece_at(x));
  const double begin = cam.begin_of(at), end = begin + cam.segments[at].length;
  if (!(x > begin))
    throw CamError(fmt::format("found a split at the boundary {}; expected a place inside a segment", x));
  const Curve& curve = motion.curve;
  Cam result = cam;
  Segment first = hermite_part(curve, begin, x, true), second = hermite_part(curve, x, end, false);
  first.end = {curve.derivative(x, 1), curve.derivative(x, 2), {}};
  second.end = cam.segments[at].end;
  result.segments[at] = second;
  result.segments.insert(result.segments.begin() + static_cast<std::ptrdiff_t>(at), first);
  return consistent(std::move(result));
}

Cam drag_boundary(const Cam& cam, std::size_t at, double x, double position) {
  if (at + 1 >= cam.segments.size())
    throw CamError(
        fmt::format("found boundary {} of {}; expected one between two segments", at + 1, cam.segments.size() - 1));
  Cam result = cam;
  Segment &before = result.segments[at], &behind = result.segments[at + 1];
  const double begin = cam.begin_of(at), end = cam.begin_of(at + 2);
  if (!(x > begin && x < end))
    throw CamError(fmt::format("found a boundary at {}; expected it between its neighbours {} and {}", x, begin, end));
  const double from = cam.position_of(at), to = cam.position_of(at + 2);
  for (const auto& [segment, rise] : {std::pair{&before, position - from}, std::pair{&behind, to - position}})
    if (segment->points || rise != segment->rise()) require_elastic(*segment);
  before.length = x - begin;
  behind.length = end - x;
  if (before.rise() != position - from) before.stroke = position - from;
  if (behind.rise() != to - position) behind.stroke = to - position;
  // A segment that no longer moves takes no slope.
  for (std::size_t k = at; k <= at + 2; ++k) drop_impossible(result, k % result.segments.size());
  return consistent(std::move(result));
}

}  // namespace stiction::sim::cam
