// The law whose speed is proportional to exp(-k / (4 x (1 - x))); every derivative is zero at both ends (bell.hpp).
#pragma once

#include "sim/cam/law.hpp"

namespace stiction::sim::cam {

inline Curve exponential_law(const LawValues& values) {
  return symmetric({Piece{.begin = 0.0, .end = 0.5, .bells = {Bell(1.0, value(values, "k"))}}});
}

}  // namespace stiction::sim::cam
