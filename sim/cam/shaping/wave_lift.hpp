// A lift that sends the load off by half of the way and takes up what comes back (O'Connor 2006): the shaft's first
// element is all that it needs to know, and no sensor at the load is asked. The wave that comes back,
//   b = G (y - G (q - b)),  G = w^2 / (s^2 + w s + w^2),  w^2 = 2 k_H / I_Z,
// of the motor q and the load y, is added to half of a 3-4-5 polynomial; both end at half of the stroke.
#pragma once

#include "sim/cam/shaping/task.hpp"

namespace stiction::sim::cam {

// For the drive of a `task`, in simulation. The polynomial is as long as lets the sum come to rest within the rise.
// None where the shortest that is tried does not.
std::optional<Curve> wave_lift(const ShapingTask& task);

}  // namespace stiction::sim::cam
