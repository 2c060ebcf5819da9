// From a motion to the drive's table of segments (stiction/motion/cam_table.hpp): quintic polynomials through position,
// speed and acceleration at the ends of each part of a piece, with a bound of their error that is proven for every
// phase, not sampled.
//
// The proof, part by part: the motion is a Taylor polynomial with a bounded remainder (piece.hpp), the table's part is
// a polynomial with known integers; their difference is enclosed by interval arithmetic on eight subintervals, and what
// the drive's integers round is added. The error falls by 64 when parts are halved: for a smooth motion it is
// h^6 max|y^(6)| / 46080.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/cam/motion.hpp"
#include "stiction/motion/cam_table.hpp"
#include "stiction/motion/cam_words.hpp"

namespace stiction::sim::cam {

// Errors in the slave's unit (m or rad), and for it over cycles and their square.
struct TableBound {
  double position = 0.0;
  double speed = 0.0;
  double acceleration = 0.0;
};

struct SegmentTable {
  std::vector<std::uint8_t> bytes;
  TableBound bound;            // proven
  std::uint32_t segments = 0;  // of the table
};

// The tolerance of a table that nobody says more of, in the slave's unit: a `share` of the range of positions of
// `motion`.
double table_tolerance(const Motion& motion, double share = 1e-9);

// The table of `motion` whose proven position error is at most `tolerance`, in the slave's unit: parts are halved until
// it is. Throws CamError where that takes more segments than a table holds or is finer than 32-bit coefficients are,
// and for a motion whose position or speed jumps.
SegmentTable table_within(const Motion& motion, double tolerance);

// The table with up to `parts` in each segment of `motion`, or one in each of its pieces where it has more: the part
// with the largest error is halved, which makes the errors alike, as long as that error is above a hundredth of 1e-9 of
// the range of positions and of 1e-5 of the largest acceleration. Throws CamError for a motion whose position or speed
// jumps.
SegmentTable table_of_parts(const Motion& motion, int parts);

using stiction::words_of;

}  // namespace stiction::sim::cam
