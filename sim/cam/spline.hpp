// Interpolating splines through points: cubic with continuous acceleration, quintic with continuous fourth derivative
// (de Boor, A Practical Guide to Splines). The unknowns are the derivatives at the nodes; they come from a
// block-tridiagonal system that is solved here and not by a library, since libraries add up in an order that depends on
// the processor, and a motion must give the same table on every host.
#pragma once

#include <vector>

#include "sim/cam/curve.hpp"
#include "sim/cam/hermite.hpp"

namespace stiction::sim::cam {

enum class SplineDegree { cubic, quintic };

enum class SplineEnds {
  natural,  // cubic: no acceleration at the ends; quintic: no third and fourth derivative
  clamped,  // the derivatives of `first` and `last`: speed, and of a quintic spline acceleration
  periodic  // the end goes on as the start, but for the position
};

struct SplineNode {
  double master;
  double slave;
};

// The spline of `degree` through `nodes`, at least two, with rising masters, and with those `ends`. `first` and `last`:
// the derivatives of clamped ends; others leave them alone. Linear in the number of nodes.
Curve spline(const std::vector<SplineNode>& nodes, SplineDegree degree, SplineEnds ends, const EndState& first = {},
             const EndState& last = {});

// The polynomials between nodes whose state is known: cubic where accelerations are not (`degree`), else quintic.
// `nodes`: rising masters; `states`: one for each.
Curve through_states(const std::vector<SplineNode>& nodes, const std::vector<EndState>& states, SplineDegree degree);

}  // namespace stiction::sim::cam
