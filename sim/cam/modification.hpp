// The modifications of a symmetric law after VDI 2143, part 1: a part of constant speed in the middle (c), a turning
// point out of the middle (lambda), and speeds at both ends (y1_a, y1_b). In closed form, with t1 = c lambda,
// t2 = c (1 - lambda), the peak slope Cv of the law, and
//   V = [1 - (1 - 1/Cv)(y1_a t1 + y1_b t2)] / (c/Cv + 1 - c)
//   y' = y1_a + (V - y1_a) f'(x / 2 t1) / Cv           for x < t1
//   y' = V                                             in the middle
//   y' = y1_b + (V - y1_b) f'((1-x) / 2 t2) / Cv       for x > 1 - t2
// (this project's own derivation; docs/cam.md). c = 1, lambda = 1/2 and no slopes return the law. The meaning of c is
// that of Lenze's manual on cam data: c = 1 has no middle part.
#pragma once

#include "sim/cam/curve.hpp"

namespace stiction::sim::cam {

struct Modification {
  double c = 1.0;            // share of the interval that accelerates and brakes: 0.001 to 1
  double lambda = 0.5;       // share of it that accelerates: 0.001 to 0.999
  double start_slope = 0.0;  // y1_a, of the unit law
  double end_slope = 0.0;    // y1_b

  friend bool operator==(const Modification&, const Modification&) = default;
};

// `law` on [0, 1], symmetric, with a joint at 1/2, where its acceleration is zero or jumps. A jump there stays.
Curve modified(const Curve& law, const Modification& how);

}  // namespace stiction::sim::cam
