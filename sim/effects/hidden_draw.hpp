// How a hidden effect is drawn: its values from a seed, of a strength that a careful record shows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>

#include "firmware/machine/model/machine.hpp"
#include "firmware/machine/model/value_table.hpp"

namespace stiction::sim {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}

  double between(double low, double high) {
    // Not a distribution of the library: its draws differ from one to another.
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }
  double sign() { return (random_() >> 63) != 0 ? 1.0 : -1.0; }
  std::size_t index(std::size_t count) { return static_cast<std::size_t>(random_() % count); }

 private:
  std::mt19937_64 random_;
};

struct HiddenDraw {
  // Values by key that this axis can have.
  machine::KeyedValues (*values)(const machine::AxisModel&, Draw&) = nullptr;
  // Whether `simulate commissioning --hide` may draw it: its place among those that do, so that a seed keeps its
  // meaning whatever the vocabulary gains. None: the records of the commissioning do not show it.
  std::optional<int> demonstrated{};
};

}  // namespace stiction::sim
