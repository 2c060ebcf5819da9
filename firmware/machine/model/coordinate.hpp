// The coordinate of an axis or of its motor: a length or an angle. All programs work on linear axes; a rotary one is
// the linear axis that moves alike on a circle, on which a radian is `radius` metres long. Its quantities are in their
// own units in files and on pages only, and come from there and go there through this table.
#pragma once

#include <string_view>
#include <vector>

namespace stiction::machine {

enum class AxisKind { linear, rotary };

// How a quantity is given here that a linear axis has in some SI unit.
struct OwnQuantity {
  std::string_view key;     // "inertia" of "mass"
  std::string_view unit;    // "N m s/rad" of "N s/m"
  double factor = 1.0;      // of the linear axis' value in one here
  bool reciprocal = false;  // that value is `factor` over the one here: a pitch from the number of pole pairs

  double to_linear(double value) const { return reciprocal ? (value > 0.0 ? factor / value : 0.0) : value * factor; }
  double from_linear(double value) const { return reciprocal ? (value > 0.0 ? factor / value : 0.0) : value / factor; }
};

struct Coordinate {
  AxisKind kind = AxisKind::linear;
  double radius = 1.0;  // m, the way of a radian; of a linear coordinate 1

  bool rotary() const { return kind == AxisKind::rotary; }

  // A value in `unit` (SI) of a linear axis, whatever its key is. Exact for a radius that is a power of two.
  OwnQuantity own(std::string_view unit) const;

  // The same of a key of machine.hpp that a linear axis calls `key`.
  OwnQuantity own(std::string_view key, std::string_view unit) const;
};

// What changes its spelling with angles in place of lengths: units of quantities, and keys of machine.hpp.
struct SpelledPair {
  std::string_view linear, rotary;
};
std::vector<SpelledPair> rotary_units();
std::vector<SpelledPair> rotary_keys();

}  // namespace stiction::machine
