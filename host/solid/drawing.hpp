// The outlines of both cams as `stiction cam step` draws them (cams_r2000.dxf): cubic splines on a layer for each cam,
// in mm, and what the head of the drawing says.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace stiction::host::solid {

struct Spline {
  int degree = 0;
  std::vector<double> knots;                  // each as often as it counts
  std::vector<std::array<double, 2>> points;  // control points, mm
};

struct Drawing {
  std::vector<std::string> head;                // comments, in their order
  std::array<std::vector<Spline>, 2> outlines;  // of cam 1 and cam 2, from corner to corner
  std::array<double, 2> widths{};               // mm, as the head states them; 0: it does not
};

// Of the file's `text`; `file`: its name in messages. Throws std::runtime_error "FILE: found ...; expected ..." for a
// text without outlines of both cams.
Drawing read_drawing(const std::string& file, const std::string& text);

}  // namespace stiction::host::solid
