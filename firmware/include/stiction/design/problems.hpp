// What is wrong with a design, each as a sentence: parameter, what was found, what was expected, with units. A list of
// fixed capacity: no heap and no exceptions, so that a target can look at its own design at start-up.
#pragma once

#include <array>
#include <cstddef>

#include "stiction/design/text.hpp"

namespace stiction::design {

// A parameter of a design, or what is computed from it.
struct Quantity {
  const char* key;   // as in a machine file: "velocity_controller.gain"
  const char* what;  // what has the value: "gain * period / time"; "": the parameter itself
  const char* unit;  // "": a number or ratio
};

struct Problem {
  Quantity quantity{};
  double found = 0.0;
  const char* expected = "";  // "at most"
  double bound = 0.0;         // in the unit of what was found
  const char* reason = "";    // what follows the bound

  // "velocity_controller.gain: found 0 A s/m; expected more than 0 A s/m."
  constexpr Text<320> sentence() const {
    Text<320> text;
    text << quantity.key << ": found ";
    if (*quantity.what != '\0') text << quantity.what << " = ";
    write(text, found);
    text << "; expected " << expected << " ";
    write(text, bound);
    text << reason;
    return text;
  }

 private:
  constexpr void write(Text<320>& text, double value) const {
    text << value;
    if (*quantity.unit != '\0') text << " " << quantity.unit;
  }
};

class Problems {
 public:
  static constexpr std::size_t capacity = 16;

  constexpr bool empty() const { return count_ == 0; }
  constexpr std::size_t size() const { return count_ < capacity ? count_ : capacity; }
  constexpr std::size_t found() const { return count_; }  // with those that the list has no room for
  constexpr const Problem& operator[](std::size_t k) const { return list_[k]; }
  constexpr const Problem* begin() const { return list_.data(); }
  constexpr const Problem* end() const { return list_.data() + size(); }

  constexpr void add(const Problem& problem) {
    if (count_ < capacity) list_[count_] = problem;
    ++count_;
  }

 private:
  std::array<Problem, capacity> list_{};
  std::size_t count_ = 0;
};

}  // namespace stiction::design
