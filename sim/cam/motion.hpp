// A cam: the motion of a slave over one cycle of a master, as a list of segments that follow each other, with switch
// tracks. SI: a rotary master or slave in rad, a linear one in m; derivatives are over the master.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/cam/law.hpp"
#include "sim/cam/points.hpp"

namespace stiction::sim::cam {

enum class Coordinate { linear, rotary };

// What is forced where two segments meet; what is not follows from the laws.
struct Boundary {
  std::optional<double> speed, acceleration, jerk;

  bool any() const { return speed || acceleration || jerk; }
};

struct Segment {
  double length = 0.0;                 // of the master, above 0
  double stroke = 0.0;                 // of the slave; of a rise-return the height of its peak
  std::string law = "linear";          // of the table, or "points"
  LawValues values{};                  // of its parameters, where they differ from the defaults
  Boundary end{};                      // where this segment meets the next one
  std::optional<PointTable> points{};  // of the law "points": over the segment's own length, from 0

  // What the slave has moved by at the end.
  double rise() const;
};

// Cam switches after PLCopen: on from each first to its last position of the master; first > last is on around the
// seam, and from one place around to the same one always.
struct Track {
  struct Window {
    double first = 0.0, last = 0.0;
  };
  std::string name;
  std::vector<Window> windows;
  double on_compensation = 0.0;   // s; negative switches earlier
  double off_compensation = 0.0;  // s
  double hysteresis = 0.0;        // of the master
};

struct Cam {
  std::string name;
  Coordinate master = Coordinate::rotary, slave = Coordinate::rotary;
  bool periodic = true;
  double start = 0.0;              // the slave's position at the master's 0
  std::optional<double> modulo{};  // of an endless slave: whole multiples of it are the same place
  Boundary begin{};                // of a cam that runs once
  std::vector<Segment> segments{};
  std::vector<Track> tracks{};

  double cycle() const;  // the sum of the lengths
  // The master's place where segment `k` begins; of k = their number the cycle.
  double begin_of(std::size_t k) const;
  // The slave's position there.
  double position_of(std::size_t k) const;
};

// What is wrong with `cam`, "found ...; expected ...": no segment, one without length, an unknown law, values that it
// does not take, points that do not cover their segment, a periodic cam that does not close. Empty where nothing is.
std::string problem_of(const Cam& cam);

// A segment's curve, with its place in the cam.
struct ComposedSegment {
  std::size_t first_piece = 0, end_piece = 0;  // of the whole curve's pieces
};

struct Motion {
  Cam cam;
  Curve curve;
  std::vector<ComposedSegment> segments;

  // Which segment the piece `k` belongs to.
  std::size_t segment_of(std::size_t piece) const;
};

// The whole curve of a cam. A Hermite segment takes at each end what is forced there, else what its neighbour ends
// with, else rest. Throws CamError with problem_of(), and for a forced value that a segment cannot have.
Motion compose(const Cam& cam);

// Whether `track` is on at the master's place `x` of a cycle of that length, at the master's `speed` in its unit over
// s. `was_on`: before, for the hysteresis.
bool is_on(const Track& track, double x, double cycle, double speed, bool was_on);

}  // namespace stiction::sim::cam
