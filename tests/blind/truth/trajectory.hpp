// Set-points that the truth axis follows: pieces from rest to rest, one after the other.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/experiment/set_point.hpp"
#include "tests/blind/truth/random.hpp"

namespace stiction::blind {

// One piece. A move goes `length` m at most `speed` m/s with a sin^2 acceleration of at most `acceleration`; swings are
// x = length/2 (1 - cos phi), `cycles` of them at `frequency` Hz, with a soft start and end. length 0: a rest of `rest`
// s.
struct Piece {
  enum class Kind { rest, move, swing } kind = Kind::rest;
  double length = 0.0;
  double speed = 0.0;         // m/s, of a move
  double acceleration = 2.0;  // m/s^2, of a move
  double frequency = 1.0;     // Hz, of a swing
  int cycles = 1;
  double rest = 0.0;  // s
};

class Trajectory {
 public:
  Trajectory(std::string name, double start, std::vector<Piece> pieces);
  const std::string& name() const { return name_; }
  double duration() const { return duration_; }  // s
  sim::AxisSetPoint at(double t) const;          // rest before and after

 private:
  struct Placed {
    Piece piece;
    double begin, duration, from;
  };
  std::string name_;
  double duration_ = 0.0, end_ = 0.0, start_ = 0.0;
  std::vector<Placed> placed_;
};

// What a commissioning engineer records: constant speeds both ways; swings like a circle's at several feeds with
// positioning moves; small reversals of 5 to 200 um. Drawn at random.
std::vector<Trajectory> training_trajectories(Random& random);
// Of other kinds and other speeds, feeds, strokes and amplitudes.
std::vector<Trajectory> holdout_trajectories(Random& random);

}  // namespace stiction::blind
