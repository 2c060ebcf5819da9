// The set-point with which the load itself follows a law: the drive's equations solved for it. Exact at the frequency
// that they are solved for, with a tail in the dwell that dies as the drive's zeros do.
#pragma once

#include "sim/cam/shaping/task.hpp"

namespace stiction::sim::cam {

// For the load of a `task` on the `law` of the library, which has four continuous derivatives. None where the tail is
// longer than the dwell.
std::optional<Curve> inverse_lift(const ShapingTask& task, std::string_view law);

}  // namespace stiction::sim::cam
