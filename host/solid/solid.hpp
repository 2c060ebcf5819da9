// A cam as a solid of OpenCASCADE: the outline of a drawing, raised by the cam's width.
#pragma once

#include <TopoDS_Shape.hxx>
#include <string>
#include <vector>

#include "host/solid/drawing.hpp"

namespace stiction::host::solid {

// The solid between z = 0 and z = `width`, mm, within `outline`, whose splines follow each other. Throws
// std::runtime_error where they do not close, with the place and the distance.
TopoDS_Shape raised(const std::vector<Spline>& outline, double width);

// What OpenCASCADE finds of a shape.
struct SolidCheck {
  int solids = 0;
  bool valid = false, closed = false;
  double volume = 0.0;  // mm^3, above 0 where the faces look outwards
  double height = 0.0;  // mm, along z
};
SolidCheck check(const TopoDS_Shape& shape);

// The distances of `places`, mm, at half of the height of `shape` from its surface, mm: the largest one.
double largest_distance(const TopoDS_Shape& shape, const std::vector<std::array<double, 2>>& places);

}  // namespace stiction::host::solid
