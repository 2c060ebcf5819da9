// Moving a level of a motion: where the slave is between two segments that move, rests included, so that a dwell stays
// one when the position of its begin or its end is dragged.
#pragma once

#include <cstddef>

#include "sim/cam/motion.hpp"

namespace stiction::host {

// `cam` with the end of its segment `at` at the slave's `position`, together with all boundaries that rests connect to
// it. The segments that move before and behind the level take the difference; behind the last one the modulo of an
// endless cam does. Returns a new cam. Throws sim::cam::CamError where nothing can take it, and for a cam that does not
// hold together then.
sim::cam::Cam with_level(const sim::cam::Cam& cam, std::size_t at, double position);

// `cam` with that `length` of the whole cycle, of the master, above 0: every segment and every place of a switch track
// keeps its share of it. Throws sim::cam::CamError.
sim::cam::Cam with_cycle(const sim::cam::Cam& cam, double length);

}  // namespace stiction::host
