// Time stamps of a log: strictly increasing and uniform within the digits they were written with.
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

// A step may differ from the others by this part of them beyond what the digits explain. Clocks of drives are far
// better; 1 % of a sample moves no measured value by more than its noise.
inline constexpr double step_tolerance = 0.01;

// Fills log.period from log.t, whose steps are known to be positive. Throws LogError when there are fewer than 2
// samples, or when steps differ: samples missing, jitter, a change of rate.
// `place`: what a message names for sample k, "run.csv:17"; place(size) is the end. `digits`: how the stamps were
// written.
void check_sampling(Log& log, const StampDigits& digits, const std::function<std::string(std::size_t)>& place);

}  // namespace stiction::host
