// How the signals of an axis answer to a test signal, from a log (docs/formats.md), at each frequency, with
// its coherence.
// The test signal is the instrument: every answer is its cross-spectrum with the test signal over the power of that, so
// that what noise and friction feed round the loop does not bend the result, as it does the plain ratio of two signals
// of a closed loop (Soderstrom and Stoica, System Identification, 1989, 10.5).
//
// A test signal that repeats itself is cut into whole periods after the first ones, in which the answer settles: the
// lines of its spectrum do not leak. Any other is cut into overlapping Hann windows (Welch 1967), their spectra joined
// in bands of a fiftieth of a decade. Several stretches of test signal, such as one a sine or one a pass of the axis,
// are averaged or put side by side as their frequencies are.
#pragma once

#include <array>
#include <complex>
#include <stdexcept>
#include <string>
#include <vector>

#include "host/log/log.hpp"

namespace stiction::host {

// A frequency response that cannot be had. what() says what was found and what was expected.
class ResponseError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// What answers to a test signal. `controller` is the output of the velocity controller: the set current (the voltage of
// a force motor) without the test signal in it, so that its coherence is that of the answer alone. `current_error`: set
// current less current.
enum class Answer : std::uint8_t { position, velocity, current, current_error, controller };
inline constexpr std::size_t answers = 5;

// "run.csv: axis X", for messages; "run.csv" where the log has no prefixes.
std::string place_of(const Log& log, const AxisLog& axis);

struct AnswerPoint {
  double frequency = 0.0;                            // Hz
  std::array<std::complex<double>, answers> gain{};  // m, m/s, A, A per ampere (volt) of the test signal
  std::array<double, answers> coherence{};           // 0: unrelated, 1: nothing but the answer
  std::size_t blocks = 0;                            // averaged
};

struct Spectra {
  std::array<bool, answers> known{};  // which of the answers the log has
  std::vector<AnswerPoint> points;    // by rising frequency
  bool periodic = false;
  double seconds = 0.0;  // of test signal that were used
  double slowest = 0.0;  // m/s: the smallest speed while the test signal acted, negative behind a reversal
};

// Of one axis of the log; `force_constant` (N/A) turns F into current where the log has no i. Throws ResponseError when
// the log has no test signal, or too little of it.
Spectra measure_spectra(const Log& log, const AxisLog& axis, double force_constant);

}  // namespace stiction::host
