// The polynomials through any boundary values: of 5th degree for the tasks of VDI 2143 other than R-R, of 7th degree
// with the jerk. Each half counts from its own end, so that both ends are exact. A boundary value that the task does
// not leave free is 0.
#pragma once

#include "sim/cam/hermite.hpp"
#include "sim/cam/law.hpp"

namespace stiction::sim::cam {

struct UnitEnds {
  EndState start, end;
};

inline UnitEnds unit_ends(const LawValues& values) {
  const auto given = [&](std::string_view key) { return values.contains(key) ? value(values, key) : 0.0; };
  return {{0.0, given("start_slope"), given("start_acceleration"), given("start_jerk")},
          {1.0, given("end_slope"), given("end_acceleration"), given("end_jerk")}};
}

template <std::vector<double> (*through)(const EndState&, const EndState&)>
Curve hermite_law(const LawValues& values) {
  const auto [start, end] = unit_ends(values);
  Piece second = polynomial_piece(0.5, 1.0, through(end.reversed(), start.reversed()));
  second.from_end = true;
  return Curve({polynomial_piece(0.0, 0.5, through(start, end)), second});
}

}  // namespace stiction::sim::cam
