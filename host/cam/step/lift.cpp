#include "host/cam/step/lift.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "sim/cam/check.hpp"

namespace stiction::host::step {
namespace {

using sim::cam::CamError;
constexpr std::size_t least_rows = 360;
// A column is the derivative of the one before it where it differs by no more than this share of its peak: what three
// digits hold.
constexpr double derivative_tolerance = 1e-3;

// The slope at the first of `nodes` of the polynomial through up to six of them, by Neville's scheme for derivatives.
double slope_at_first(const std::vector<sim::cam::SplineNode>& nodes) {
  const std::size_t n = std::min<std::size_t>(6, nodes.size());
  std::vector<double> value, slope(n, 0.0);
  for (std::size_t k = 0; k < n; ++k) value.push_back(nodes[k].slave);
  const double x = nodes.front().master;
  for (std::size_t level = 1; level < n; ++level)
    for (std::size_t k = 0; k + level < n; ++k) {
      const double left = nodes[k].master, right = nodes[k + level].master;
      slope[k] = ((x - left) * slope[k + 1] - (x - right) * slope[k] + value[k + 1] - value[k]) / (right - left);
      value[k] = ((x - left) * value[k + 1] - (x - right) * value[k]) / (right - left);
    }
  return slope.front();
}

// A spline from split to split, its slopes at both ends those of a polynomial through the rows beside them.
sim::cam::Curve between_splits(std::vector<sim::cam::SplineNode> nodes) {
  auto backwards = nodes;
  std::reverse(backwards.begin(), backwards.end());
  return spline(nodes, sim::cam::SplineDegree::cubic, sim::cam::SplineEnds::clamped, {0.0, slope_at_first(nodes)},
                {0.0, slope_at_first(backwards)});
}

sim::cam::Curve split_spline(const MeasuredLift& table) {
  std::optional<sim::cam::Curve> whole;
  std::vector<sim::cam::SplineNode> nodes;
  for (std::size_t k = 0; k < table.psi.size(); ++k) {
    nodes.push_back({table.psi[k], table.way[k]});
    const bool split = std::find(table.splits.begin(), table.splits.end(), table.psi[k]) != table.splits.end();
    if (k + 1 < table.psi.size() && !(split && nodes.size() > 1)) continue;
    const auto part = between_splits(nodes);
    whole = whole ? joined(*whole, part) : part;
    nodes.erase(nodes.begin(), nodes.end() - 1);
  }
  return *whole;
}

void compare_column(const StepLift& lift, const MeasuredLift& table, const std::vector<double>& column, int order,
                    std::vector<std::string>& notes) {
  if (column.empty()) return;
  double peak = 0.0, worst = 0.0, place = 0.0;
  for (std::size_t k = 0; k < column.size(); ++k) {
    const double psi = table.psi[k];
    // At a jump the column may have the value of either side.
    const double left = lift.curve().derivative(psi, order, sim::cam::Side::left);
    const double right = lift.curve().derivative(psi, order, sim::cam::Side::right);
    const double off = std::min(std::fabs(column[k] - left), std::fabs(column[k] - right));
    peak = std::max({peak, std::fabs(left), std::fabs(right)});
    if (off > worst) worst = off, place = psi;
  }
  if (worst > derivative_tolerance * peak)
    notes.push_back(
        fmt::format("The column of the {} is not the derivative of the one before it: it differs by {:.3g} {} at "
                    "{:.6g}°, {:.3g} % of its peak. It is not used; the spline through the ways has its own.",
                    order == 1 ? "speed" : "acceleration", worst, order == 1 ? "rad/rad" : "rad/rad²", place / degree,
                    100.0 * worst / peak));
}

}  // namespace

StepLift::StepLift(sim::cam::Curve curve) : curve_(std::move(curve)) {
  if (std::fabs(curve_.begin()) > 1e-12 || std::fabs(curve_.end() - turn) > 1e-9)
    throw CamError(fmt::format("found a lift over {:.6g}° to {:.6g}°; expected one turn of the cam, 0° to 360°",
                               curve_.begin() / degree, curve_.end() / degree));
  start_ = curve_(0.0);
  stroke_ = curve_.derivative(curve_.end(), 0, sim::cam::Side::left) - start_;
}

LiftState StepLift::at(double psi) const {
  const auto& piece = curve_.pieces()[curve_.piece_at(psi)];
  return {piece.derivative(psi, 0) - start_, piece.derivative(psi, 1), piece.derivative(psi, 2)};
}

StepLift lift_of(const sim::cam::Cam& cam) {
  if (cam.master != sim::cam::Coordinate::rotary || cam.slave != sim::cam::Coordinate::rotary)
    throw CamError(fmt::format("found the cam {} with a linear {}; expected a rotary master and a rotary slave",
                               cam.name, cam.master == sim::cam::Coordinate::rotary ? "slave" : "master"));
  const auto motion = sim::cam::compose(cam);
  for (const auto& found : jumps_of(motion))
    if (found.jump.order < 2)
      throw CamError(fmt::format("found a jump of the {} at {:.6g}°; expected a motion without one",
                                 sim::cam::derivative_name(found.jump.order), found.jump.place / degree));
  return StepLift(motion.curve);
}

StepLift lift_of(const MeasuredLift& table, std::vector<std::string>& notes) {
  if (table.psi.size() < least_rows)
    throw CamError(
        fmt::format("found a table of {} rows; expected at least {}, one each degree", table.psi.size(), least_rows));
  const double last = table.psi.back();
  if (std::fabs(last * degree - turn) < 0.02 * turn)
    throw CamError(
        fmt::format("found a table that ends at {:.6g} rad; expected {:.6g} rad, one turn: its angles look like "
                    "degrees, for which there is master_unit = \"deg\"",
                    last, turn));
  if (std::fabs(table.psi.front()) > 1e-9 || std::fabs(last - turn) > 1e-9)
    throw CamError(fmt::format("found a table from {:.9g}° to {:.9g}°; expected 0° to 360°, both among its rows",
                               table.psi.front() / degree, last / degree));
  sim::cam::PointTable points{.master = table.psi, .slave = table.way};
  points.interpolation.ends = table.splits.empty() ? sim::cam::SplineEnds::periodic : sim::cam::SplineEnds::natural;
  points.splits = table.splits;
  if (const auto problem = problem_of(points); !problem.empty()) throw CamError(problem);
  StepLift lift(table.splits.empty() ? curve_of(points) : split_spline(table));
  compare_column(lift, table, table.speed, 1, notes);
  compare_column(lift, table, table.acceleration, 2, notes);
  return lift;
}

}  // namespace stiction::host::step
