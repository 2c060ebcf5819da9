#include "sim/cam/points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stiction::sim::cam {
namespace {

struct NamedInterpolation {
  std::string_view name;
  SplineDegree degree;
  SplineEnds ends;
};

constexpr NamedInterpolation named_interpolations[] = {
    {"natural", SplineDegree::cubic, SplineEnds::natural},
    {"clamped", SplineDegree::cubic, SplineEnds::clamped},
    {"periodic", SplineDegree::cubic, SplineEnds::periodic},
    {"quintic_natural", SplineDegree::quintic, SplineEnds::natural},
    {"quintic_clamped", SplineDegree::quintic, SplineEnds::clamped},
    {"quintic_periodic", SplineDegree::quintic, SplineEnds::periodic},
};

// A column that is a derivative, summed up by trapezoids, gives the column before it but for the curvature within the
// intervals. A tenth of the whole motion is more than any table has of that, and less than a wrong unit makes.
constexpr double integral_tolerance = 0.1;

// Of a point: beyond what any machine has, and products of it are numbers.
constexpr double largest_value = 1e9;

std::string problem_of_numbers(const PointTable& table) {
  const auto n = table.master.size();
  if (n < 2) return fmt::format("found {}; expected two points or more", n == 1 ? "one point" : "no point");
  for (const auto* column : {&table.slave, &table.speed, &table.acceleration})
    if (column->size() != n && !(column->empty() && column != &table.slave))
      return fmt::format("found a column of {} values next to one of {}; expected as many", column->size(), n);
  if (table.speed.empty() && !table.acceleration.empty()) return "found accelerations without speeds; expected both";
  for (const auto* column : {&table.master, &table.slave, &table.speed, &table.acceleration})
    for (std::size_t i = 0; i < column->size(); ++i)
      if (!(std::fabs((*column)[i]) <= largest_value))
        return fmt::format("found {} in point {}; expected a number up to {}", (*column)[i], i + 1, largest_value);
  for (std::size_t i = 1; i < n; ++i)
    if (!(table.master[i] > table.master[i - 1]))
      return fmt::format("found a master of {} behind {} (point {}); expected rising masters", table.master[i],
                         table.master[i - 1], i + 1);
  return {};
}

std::string problem_of_derivative(const std::vector<double>& master, const std::vector<double>& column,
                                  const std::vector<double>& derivative, std::string_view name) {
  if (derivative.empty()) return {};
  double off = 0.0, moved = 0.0, summed = 0.0;
  for (std::size_t i = 1; i < master.size(); ++i) {
    const double step = column[i] - column[i - 1];
    const double sum = 0.5 * (derivative[i] + derivative[i - 1]) * (master[i] - master[i - 1]);
    off += std::fabs(step - sum), moved += std::fabs(step), summed += std::fabs(sum);
  }
  if (off <= integral_tolerance * std::max(moved, summed)) return {};
  return fmt::format(
      "found {0}s that sum up to {1:.3g} where the {2} moves by {3:.3g}; expected the derivative over the "
      "master{4}",
      name, summed, name == "speed" ? "slave" : "speed", moved,
      summed > 0.0 && moved > 0.0 && std::fabs(std::log(summed / moved)) > std::log(2.0) ? ", in the same units" : "");
}

std::string problem_of_splits(const PointTable& table) {
  for (const double split : table.splits)
    if (std::find(table.master.begin() + 1, table.master.end() - 1, split) == table.master.end() - 1)
      return fmt::format("found a split at {}; expected the master of an inner point", split);
  if (!table.splits.empty() && table.interpolation.ends == SplineEnds::periodic)
    return "found splits in a periodic spline; expected natural or clamped ends";
  return {};
}

// Between splits a spline of its own, which has natural ends there.
Curve split_spline(const PointTable& table, const std::vector<SplineNode>& nodes) {
  const auto& how = table.interpolation;
  std::vector<Piece> pieces;
  std::size_t begin = 0;
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const bool last = i + 1 == nodes.size();
    if (!last && std::find(table.splits.begin(), table.splits.end(), nodes[i].master) == table.splits.end()) continue;
    const std::vector<SplineNode> part(nodes.begin() + static_cast<std::ptrdiff_t>(begin),
                                       nodes.begin() + static_cast<std::ptrdiff_t>(i + 1));
    const bool whole = begin == 0 && last;
    const Curve curve =
        whole ? spline(part, how.degree, how.ends, how.first, how.last) : spline(part, how.degree, SplineEnds::natural);
    pieces.insert(pieces.end(), curve.pieces().begin(), curve.pieces().end());
    begin = i;
  }
  return Curve(std::move(pieces));
}

}  // namespace

std::vector<std::string_view> interpolation_names() {
  std::vector<std::string_view> names;
  for (const auto& row : named_interpolations) names.push_back(row.name);
  return names;
}

std::optional<Interpolation> interpolation_of(std::string_view name) {
  for (const auto& row : named_interpolations)
    if (row.name == name) return Interpolation{row.degree, row.ends, {}, {}};
  return std::nullopt;
}

std::string name_of(const Interpolation& interpolation) {
  for (const auto& row : named_interpolations)
    if (row.degree == interpolation.degree && row.ends == interpolation.ends) return std::string(row.name);
  return {};
}

std::string problem_of(const PointTable& table) {
  if (auto problem = problem_of_numbers(table); !problem.empty()) return problem;
  if (auto problem = problem_of_derivative(table.master, table.slave, table.speed, "speed"); !problem.empty())
    return problem;
  if (auto problem = problem_of_derivative(table.master, table.speed, table.acceleration, "acceleration");
      !problem.empty())
    return problem;
  return problem_of_splits(table);
}

Curve curve_of(const PointTable& table) {
  if (const auto problem = problem_of(table); !problem.empty()) throw CamError("points: " + problem);
  std::vector<SplineNode> nodes;
  for (std::size_t i = 0; i < table.master.size(); ++i) nodes.push_back({table.master[i], table.slave[i]});
  if (table.speed.empty()) return split_spline(table, nodes);
  std::vector<EndState> states;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    states.push_back({0.0, table.speed[i], table.acceleration.empty() ? 0.0 : table.acceleration[i], 0.0});
  return through_states(nodes, states, table.acceleration.empty() ? SplineDegree::cubic : SplineDegree::quintic);
}

}  // namespace stiction::sim::cam
