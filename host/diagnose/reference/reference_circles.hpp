// The circles of a reference diagnosis: largest error and current of each axis, as run_circle() measures them in double
// precision, each circle of an axis driven once.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/diagnose/verdict/verdict.hpp"

namespace stiction::host {

// For machines with two axes that differ in their effects alone, as those of one diagnosis.
class ReferenceCircles {
 public:
  // Of both axes of `machine` on the circle at `feed` (m/s). Throws InfeasibleMotion, FaultTripped.
  std::array<RowFigures, 2> at(const machine::Machine& machine, double feed);

 private:
  using Effects = std::vector<std::pair<std::string, machine::KeyedValues>>;
  struct Key {
    std::size_t axis;
    double feed;
    Effects effects;
    auto operator<=>(const Key&) const = default;
  };

  std::map<Key, RowFigures> driven_;
};

}  // namespace stiction::host
