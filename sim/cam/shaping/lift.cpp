#include "sim/cam/shaping/lift.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/cam/characteristics.hpp"
#include "sim/cam/hermite.hpp"
#include "sim/cam/laws.hpp"

namespace stiction::sim::cam {
namespace {

// A joint nearer than this to the next one, in shares of the whole, is the same one.
constexpr double same_joint = 1e-9;

std::vector<double> without_doubles(std::vector<double> joints, double length) {
  std::sort(joints.begin(), joints.end());
  std::vector<double> kept;
  for (const double joint : joints)
    if (kept.empty() || joint - kept.back() > same_joint * length) kept.push_back(joint);
  return kept;
}

Segment points_of(const std::vector<Piece>& pieces) {
  const double begin = pieces.front().begin, start = pieces.front().derivative(begin, 0);
  Segment segment;
  segment.law = "points";
  PointTable& points = segment.points.emplace();
  const auto add = [&](const Piece& piece, double x) {
    points.master.push_back(x - begin);
    points.slave.push_back(piece.derivative(x, 0) - start);
    points.speed.push_back(piece.derivative(x, 1));
    points.acceleration.push_back(piece.derivative(x, 2));
  };
  for (const Piece& piece : pieces) add(piece, piece.begin);
  add(pieces.back(), pieces.back().end);
  segment.length = points.master.back();
  segment.stroke = points.slave.back();
  return segment;
}

// Tables of points for `lift`, one from each jump of its acceleration to the next.
std::vector<Segment> segments_of(const Curve& lift) {
  const double peak = extremes(lift, 2).magnitude();
  std::vector<Segment> segments;
  std::vector<Piece> smooth;
  for (const Piece& piece : lift.pieces()) {
    if (!smooth.empty() &&
        std::fabs(piece.derivative(piece.begin, 2) - smooth.back().derivative(piece.begin, 2)) > 1e-9 * peak) {
      segments.push_back(points_of(smooth));
      smooth.clear();
    }
    smooth.push_back(piece);
  }
  segments.push_back(points_of(smooth));
  return segments;
}

bool rests(const Segment& segment) { return segment.stroke == 0.0 && !segment.points; }

}  // namespace

void Lift::add(Curve curve, double gain, int order) { terms_.push_back({std::move(curve), gain, order}); }

double Lift::derivative(double x, int order, Side side) const {
  double sum = order == 0 ? constant_ : 0.0;
  for (const Term& term : terms_) {
    const Curve& curve = term.curve;
    const int of = order + term.order;
    const bool before = side == Side::left ? x <= curve.begin() : x < curve.begin();
    const bool behind = side == Side::left ? x > curve.end() : x >= curve.end();
    if (!before && !behind)
      sum += term.gain * curve.derivative(x, of, side);
    else if (of == 0)
      sum += term.gain * curve.derivative(before ? curve.begin() : curve.end(), 0, before ? Side::right : Side::left);
  }
  return sum;
}

Curve Lift::sampled(double begin, double end, int steps) const {
  const double length = end - begin;
  std::vector<double> joints{begin, end};
  for (const Term& term : terms_)
    for (const Piece& piece : term.curve.pieces())
      for (const double joint : {piece.begin, piece.end})
        if (joint > begin + same_joint * length && joint < end - same_joint * length) joints.push_back(joint);
  joints = without_doubles(std::move(joints), length);
  std::vector<Piece> pieces;
  const auto state = [&](double x, double step, Side side) {
    return EndState{derivative(x, 0, side), derivative(x, 1, side) * step, derivative(x, 2, side) * step * step, 0.0};
  };
  for (std::size_t k = 0; k + 1 < joints.size(); ++k) {
    const double part = joints[k + 1] - joints[k];
    // Few steps of a short part would not show how its speed leads from place to place.
    constexpr int fewest = 4;
    const auto count = std::max(fewest, static_cast<int>(std::ceil(part / length * steps - 1e-9)));
    const double step = part / count;
    for (int i = 0; i < count; ++i) {
      const double from = joints[k] + i * step, to = i + 1 == count ? joints[k + 1] : joints[k] + (i + 1) * step;
      Piece piece = polynomial_piece(from, to, quintic(state(from, step, Side::right), state(to, step, Side::left)));
      piece.rate = 1.0 / step;
      pieces.push_back(std::move(piece));
    }
  }
  return Curve(std::move(pieces));
}

Curve law_curve(std::string_view name, double begin, double length, double stroke) {
  Cam cam{.name = "law"};
  cam.periodic = false;
  cam.segments = {{.length = length, .stroke = stroke, .law = std::string(name)}};
  return compose(cam).curve.placed({.begin = begin});
}

Cam with_lift(const Cam& cam, const Curve& lift) {
  const double rounding = 1e-9 * cam.cycle();
  const double begin = lift.begin(), end = lift.end();
  Cam changed = cam;
  changed.segments.clear();
  bool placed = false;
  for (std::size_t k = 0; k < cam.segments.size(); ++k) {
    const Segment& segment = cam.segments[k];
    const double from = cam.begin_of(k), to = cam.begin_of(k + 1);
    const bool before = to <= begin + rounding, behind = from >= end - rounding;
    if (before || behind) {
      changed.segments.push_back(segment);
      continue;
    }
    if (!placed && std::fabs(from - begin) > rounding)
      throw CamError(
          fmt::format("found a lift that begins at {:.6g} within a segment; expected it where one begins", begin));
    if (!placed)
      for (Segment& part : segments_of(lift)) changed.segments.push_back(std::move(part));
    placed = true;
    if (to <= end + rounding) continue;
    if (!rests(segment))
      throw CamError(fmt::format("found a lift that ends at {:.6g} within a motion; expected it in a rest", end));
    Segment rest = segment;
    rest.length = to - end;
    changed.segments.push_back(rest);
  }
  if (!placed) throw CamError("found a lift outside of the cycle; expected it inside");
  double rise = 0.0, wanted = 0.0;
  for (const Segment& segment : changed.segments) rise += segment.rise();
  for (const Segment& segment : cam.segments) wanted += segment.rise();
  const double off = wanted - rise;
  if (std::fabs(off) > 1e-6 * std::fabs(lift(lift.begin()) - lift(lift.end())) + 1e-12)
    throw CamError(fmt::format("found a lift that ends {:.3g} off; expected it where the cam goes on", off));
  return changed;
}

}  // namespace stiction::sim::cam
