// All cases of the proof, run on all processors: what each compensation leaves of the error, and the figures over them.
#pragma once

#include <string>
#include <vector>

#include "tests/compensation/proof.hpp"

namespace stiction::compensation {

// One motion of one axis: off, (a), (b), (c). m.
struct Row {
  std::string truth, change;  // of the machine; what changed after it was tuned, empty: nothing
  char axis = 'X';
  double feed = 0.0;    // m/min; 0: no circle
  double radius = 0.0;  // m; of small reversals the amplitude
  bool held = true;     // whether the figures asked for hold for this truth
  Outcome off, pulse, friction, learning;
  bool with_pulse = false;
  double coulomb = 0.0;  // A
};

struct StandstillRow {
  std::string truth;
  char axis = 'X';
  Standstill off, friction, learning;
};

struct LShapeRow {
  std::string truth;
  // m, restart in the same and in the opposite direction
  double same_off = 0.0, same_friction = 0.0, same_learning = 0.0;
  double opposite_off = 0.0, opposite_friction = 0.0, opposite_learning = 0.0;
};

struct Proof {
  std::vector<TunedAxis> tuned;  // X and Y of each truth, in order
  std::vector<Row> circles;      // radius 90 mm, five feeds
  std::vector<Row> radii;        // other radii
  int refused = 0;               // circles that the machine cannot drive
  std::vector<Row> changed;      // friction, mass, delay off
  std::vector<Row> small;        // small reversals
  std::vector<StandstillRow> standstill;
  std::vector<LShapeRow> l_shape;
};

// `quick`: two truths, without the pulse, other radii and long standstill; for the tests.
Proof run_proof(bool quick);

struct Figure {
  std::string text;
  std::string value;
  bool met = false;
};
std::vector<Figure> figures(const Proof& proof);

}  // namespace stiction::compensation
