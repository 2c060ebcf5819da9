// Keys and units of the motion file, for its reader and its writer.
#pragma once

#include <string_view>

#include "sim/cam/motion.hpp"

namespace stiction::sim::cam {

// The SI unit of a coordinate.
constexpr std::string_view unit_of(Coordinate coordinate) { return coordinate == Coordinate::linear ? "m" : "rad"; }
constexpr std::string_view name_of(Coordinate coordinate) {
  return coordinate == Coordinate::linear ? "linear" : "rotary";
}

// The SI unit of a derivative of the slave over the master, of `order` 1 to 3; "1" where both are alike and it is 1.
inline std::string derivative_unit(Coordinate slave, Coordinate master, int order) {
  const bool rotary = master == Coordinate::rotary;
  if (slave == master && order == 1) return "1";
  std::string unit(slave == master ? "1" : unit_of(slave));
  const int power = slave == master ? order - 1 : order;
  unit += std::string("/") + (rotary ? "rad" : "m");
  return power == 1 ? unit : unit + "^" + static_cast<char>('0' + power);
}

}  // namespace stiction::sim::cam
