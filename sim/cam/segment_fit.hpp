// One segment of a table: its coefficients, and the proof of its error. Private to segment_table.cpp.
#pragma once

#include <cstdint>
#include <limits>

#include "sim/cam/hermite.hpp"
#include "sim/cam/piece.hpp"
#include "sim/cam/segment_table.hpp"

namespace stiction::sim::cam {

// A part of a piece between two phases of the drive.
struct Part {
  const Piece* piece = nullptr;
  std::uint64_t begin = 0, end = 0;  // 2^-32 cycles; end up to 2^32
};

struct FittedSegment {
  CamTable::Segment segment;
  TableBound bound;
};

// Position, speed and acceleration, over units of the master, with which the segment of `part` begins in the drive's
// integers; of a motion with that `cycle`, positions in 2^-`position_bits` of the slave's unit.
EndState segment_begin(const Part& part, double cycle, int position_bits);

// The same of the motion itself at both ends of `part`.
EndState part_begin(const Part& part, double cycle);
EndState part_end(const Part& part, double cycle);

// The segment of `part` of a motion with that `cycle`, its position in 2^-`position_bits` of the slave's unit. It ends
// with `end`: with what the next segment begins with, rounding included, nothing jumps between them. The bound is that
// of an output that is not rounded to the header's scales; where the position's is above `tolerance` the others are
// left out.
FittedSegment fit_segment(const Part& part, double cycle, int position_bits, const EndState& end,
                          double tolerance = std::numeric_limits<double>::infinity());

// The errors of position and acceleration of `part` of a motion with that `cycle` without the rounding of coefficients:
// what halving improves.
TableBound smooth_error(const Part& part, double cycle);

// 2^exponent, for -1000 to 1000.
double power_of_two(int exponent);

}  // namespace stiction::sim::cam
