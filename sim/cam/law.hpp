// What a lift law is: its names, the task it is for, its parameters, its formula with the source, and the curve of it
// on [0, 1]. The table of all laws is laws.hpp.
//
// Unit lift y = f(x), f(0) = 0, f(1) = 1 (Dostrasil 2014, chapter 2); of a rise-return f(0) = f(1) = 0 with a peak
// of 1.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/machine/model/value_table.hpp"
#include "sim/cam/curve.hpp"

namespace stiction::sim::cam {

// What can be wrong with a motion; what() says what was found and what was expected.
class CamError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// What one end of a segment must be (VDI 2143): at rest; at constant speed, so without acceleration; a reversal, so
// without speed; or in any motion.
enum class End : char { rest = 'R', constant_speed = 'G', reversal = 'U', motion = 'B' };

enum class LawKind { rise, rise_return, periodic };

// Which boundary values a law takes where segments meet.
enum class EndValues {
  own,     // none: its ends are what they are
  slopes,  // the speeds y1_a and y1_b of VDI 2143, and lambda and c with them
  second,  // speed and acceleration
  third    // and jerk
};

using LawValues = machine::KeyedValues;

struct Law {
  int number;  // in the list of docs/cam.md
  std::string_view name;
  std::string_view english;  // aliases, separated by commas; empty: none
  std::string_view german;
  LawKind kind;
  End start, end;
  EndValues ends;
  std::vector<machine::ValueKey> parameters;
  std::string_view formula;
  std::string_view source;
  Curve (*make)(const LawValues&);  // every parameter is given and in its range
};

// "R-R": start and end of the law's task.
std::string task_of(const Law& law);
std::string_view name_of(LawKind kind);

// A parameter of unit laws: `key`, the `range` of a value, the default `fallback` and what it is (`text`).
inline machine::ValueKey law_parameter(std::string_view key, machine::Range range, double fallback,
                                       std::string_view text) {
  return {key, "1", "", range, false, false, fallback, text, "", false};
}

// Of slopes, accelerations and coefficients of unit laws: beyond what any motion has, and products of them are numbers.
constexpr machine::Range law_range() { return {-1e6, 1e6}; }

// The first value of `key`, which is there.
inline double value(const LawValues& values, std::string_view key) { return values.find(key)->second.front(); }

}  // namespace stiction::sim::cam
