// Changes of a cam's list of segments that keep it consistent: lengths add up to a cycle, each segment begins where the
// last one ends, and a periodic cam closes. Every operation returns a new cam and leaves the given one alone. All throw
// CamError, with what was found and expected, for a change after which the list would not be consistent.
#pragma once

#include <cstddef>

#include "sim/cam/motion.hpp"

namespace stiction::sim::cam {

// `segment` behind the last one: the cycle grows by its length. A periodic cam must close again, so that what it rises
// by is 0 or whole multiples of its modulo.
Cam append(const Cam& cam, const Segment& segment);

// `segment` before the segment `at` of `cam`, from whose start it takes length and stroke: cycle and all other
// boundaries stay where they are.
Cam insert(const Cam& cam, std::size_t at, const Segment& segment);

// `cam` without the segment `at`: its neighbour before it, or of the first one the neighbour behind it, takes length
// and rise, so that all other boundaries stay. The last segment of a list cannot be removed.
Cam remove(const Cam& cam, std::size_t at);

// Divides the segment of `cam` around the master's place `x`, which is inside of it, in two of the law "hermite" that
// meet on the curve, with its speed and acceleration there and at both ends.
Cam split(const Cam& cam, double x);

// Moves the boundary behind the segment `at` of `cam`, not the last one, to the master's place `x` and the slave's
// `position`: the segments on both sides change, all other boundaries stay.
Cam drag_boundary(const Cam& cam, std::size_t at, double x, double position);

}  // namespace stiction::sim::cam
