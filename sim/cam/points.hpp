// Tables of points as laws: measured motions, or those of other makers. Two columns are master and slave; a third and a
// fourth are the slave's speed and acceleration over the master, and are believed only where they are.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/cam/law.hpp"
#include "sim/cam/spline.hpp"

namespace stiction::sim::cam {

// How a table without derivatives is interpolated.
struct Interpolation {
  SplineDegree degree = SplineDegree::cubic;
  SplineEnds ends = SplineEnds::natural;
  EndState first{}, last{};  // of clamped ends: speed, and acceleration of a quintic spline
};

struct PointTable {
  std::vector<double> master{};        // rising
  std::vector<double> slave{};         // as many
  std::vector<double> speed{};         // as many, or none
  std::vector<double> acceleration{};  // as many, or none; only with speeds
  Interpolation interpolation{};
  std::vector<double> splits{};  // masters of inner points where derivatives jump: a spline ends and begins there
};

// The names of the interpolations in motion files: "natural", "clamped", "periodic", and the same with "quintic_".
std::vector<std::string_view> interpolation_names();
std::optional<Interpolation> interpolation_of(std::string_view name);
std::string name_of(const Interpolation& interpolation);

// What is wrong with the numbers of a table, "found ...; expected ...": fewer than two points, masters that do not
// rise, what is not a number, columns of different length, a split at no inner point, and columns of speed or
// acceleration that are not the derivative of the column before. Empty where nothing is.
std::string problem_of(const PointTable& table);

// The motion through the points: through given derivatives by Hermite polynomials, else by splines. Throws CamError
// with problem_of().
Curve curve_of(const PointTable& table);

}  // namespace stiction::sim::cam
