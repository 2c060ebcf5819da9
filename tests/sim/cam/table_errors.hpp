// The errors of the drive's table against the motion in double precision, measured at many phases.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "sim/cam/characteristics.hpp"
#include "sim/cam/laws.hpp"
#include "sim/cam/segment_table.hpp"

namespace stiction::sim::cam {

inline CamTable opened(const SegmentTable& table) {
  CamTable read;
  if (CamTable::read(table.bytes, read) != CamTableProblem::none) throw CamError("a table that cannot be read");
  return read;
}

// Largest errors of `count` phases, in the slave's unit and for it over the master.
inline TableBound measured(const Motion& motion, const CamTable& table, std::uint64_t count) {
  TableBound largest;
  const auto& h = table.header();
  const double cycle = motion.cam.cycle();
  const double position = std::ldexp(1.0, -h.position_bits), speed = std::ldexp(1.0, -h.speed_bits),
               acceleration = std::ldexp(1.0, -h.acceleration_bits);
  // Steps of an odd number go through all phases evenly; the golden section spreads any beginning of them.
  std::uint32_t phase = 0;
  for (std::uint64_t k = 0; k < count; ++k, phase += 2654435769u) {
    const auto out = table.evaluate(phase);
    const double x = phase * 0x1p-32 * cycle;
    const Piece& piece = motion.curve.pieces()[motion.curve.piece_at(x)];
    const auto off = [](double& most, double error) { most = std::fmax(most, std::fabs(error)); };
    off(largest.position, static_cast<double>(out.position) * position - piece.derivative(x, 0));
    off(largest.speed, static_cast<double>(out.speed) * speed - piece.derivative(x, 1) * cycle);
    off(largest.acceleration,
        static_cast<double>(out.acceleration) * acceleration - piece.derivative(x, 2) * cycle * cycle);
  }
  return largest;
}

// A rise by `law` over half a cycle of 2 pi and a way back to the start, or a rise and return over all of it.
inline Motion motion_of(const Law& law) {
  Cam cam{.name = "law"};
  LawValues values;
  if (law.name == "polynomial") values["coefficients"] = {0.0, 0.0, 10.0, -15.0, 6.0};
  if (law.name == "power_polynomial") values["powers"] = {4.0, 5.0, 6.0, 7.0};
  const double stroke = std::numbers::pi / 2;
  if (law.kind == LawKind::rise) {
    cam.segments = {{.length = std::numbers::pi, .stroke = stroke, .law = std::string(law.name), .values = values},
                    {.length = std::numbers::pi, .stroke = -stroke, .law = "hermite_septic"}};
  } else {
    cam.segments = {{.length = 2 * std::numbers::pi, .stroke = stroke, .law = std::string(law.name)}};
  }
  return compose(cam);
}

// What a table of 64 segments a rise makes of a law: errors over the stroke and over the peaks of speed and
// acceleration, and how far the proven bounds are above the measured errors.
struct LawTable {
  std::uint32_t segments = 0;
  double position = 0.0, speed = 0.0, acceleration = 0.0;
  double least_excess = std::numeric_limits<double>::infinity(), most_excess = 0.0;
};

// Of `law`, at `count` phases.
inline LawTable law_table(const Law& law, std::uint64_t count) {
  const Motion motion = motion_of(law);
  const SegmentTable table = table_of_parts(motion, law.kind == LawKind::rise ? 64 : 128);
  const TableBound error = measured(motion, opened(table), count);
  const double stroke = std::numbers::pi / 2, cycle = motion.cam.cycle();
  const double speed = extremes(motion.curve, 1).magnitude() * cycle;
  const double acceleration = std::fmax(extremes(motion.curve, 2).magnitude() * cycle * cycle, stroke);
  LawTable made{table.segments, error.position / stroke, error.speed / speed, error.acceleration / acceleration};
  const double pairs[][2] = {{table.bound.position, error.position},
                             {table.bound.speed, error.speed},
                             {table.bound.acceleration, error.acceleration}};
  for (const auto& [proven, found] : pairs) {
    if (found > 0.0) made.least_excess = std::fmin(made.least_excess, proven / found);
    // A motion that the table holds exactly is measured at the rounding of its doubles.
    if (found > 1e-13 * stroke) made.most_excess = std::fmax(made.most_excess, proven / found);
  }
  return made;
}

}  // namespace stiction::sim::cam
