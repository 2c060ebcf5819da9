// From time stamps as they were written to logs with an even clock.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "host/log/log.hpp"

namespace stiction::host {

// With how many digits stamps were written: what a format keeps of a time. A stamp is off by no more than one unit of
// its last digit.
struct StampDigits {
  double finest = 0.0;                   // s, one unit of the last decimal written anywhere in the column
  int significant = 17;                  // the most significant digits written anywhere in the column
  double resolution_at(double t) const;  // s
};

// Takes a stamp as it was written ("2.500e-03", also with a decimal comma) into account; `unit` is that of the text in
// s. Begin with no digits: {0.0, 0}.
void count_digits(std::string_view stamp, StampDigits& digits, double unit);

// A step may differ from the others by this part of them beyond what the digits explain before the samples are
// interpolated. Clocks of drives are far better; 1 % of a sample moves no measured value by more than its noise.
inline constexpr double step_tolerance = 0.01;

// A stretch of a broken record is used from this many samples on: below it no filter settles.
inline constexpr std::size_t shortest_stretch = 20;

// The one reading step, which every reader ends with. Makes of a table of samples with their stamps as written a log
// whose clock is even, without blank cells:
// * stamps that repeat or fall are refused with their place;
// * blank cells (NaN) are trimmed, interpolated and left out (blank_cells.hpp);
// * a speed without a position is integrated;
// * the record is split at gaps and changes of rate (uneven_clock.hpp): `log` is the longest stretch, log.others has
//   the rest, and stretches below `shortest_stretch` are dropped;
// * a stretch whose steps differ by more than `step_tolerance` beyond the digits is resampled (resample.hpp); others
//   stay as they are to the last bit;
// * samples at which a channel stands at the end of its range are left out (limits.hpp).
// Sets log.period, log.clock and log.notes. `log`: t and channels of one length, or no channel at all; `digits`: how
// the stamps were written; `place`: the name of sample k in messages, "run.csv:17"; place(size) is the end. Throws
// LogError: fewer than 2 samples, stamps that do not rise, no stretch long enough.
void check_sampling(Log& log, const StampDigits& digits, const std::function<std::string(std::size_t)>& place);

}  // namespace stiction::host
