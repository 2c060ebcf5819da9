// The sum of curves over one rise, each at its own place, and a motion with it in place of its own rise: what the
// methods against residual vibration are made of.
#pragma once

#include <vector>

#include "sim/cam/motion.hpp"

namespace stiction::sim::cam {

class Lift {
 public:
  // Adds `gain` times the derivative of that `order` of `curve`, over the master. Before its beginning a curve has the
  // value there, behind its end the one there; their derivatives are 0.
  void add(Curve curve, double gain = 1.0, int order = 0);
  // Adds a constant `value`.
  void add(double value) { constant_ += value; }

  // The derivative of `order` at the master's place `x`, at a joint on that `side`.
  double derivative(double x, int order, Side side = Side::right) const;
  // The same lift between the master's places `begin` and `end` as polynomials of the fifth degree through position,
  // speed and acceleration: at every joint, and between them at most a `steps`-th of the length apart.
  Curve sampled(double begin, double end, int steps = 240) const;

 private:
  struct Term {
    Curve curve;
    double gain;
    int order;
  };
  std::vector<Term> terms_;
  double constant_ = 0.0;
};

// A law of the library, by its `name`, as a rise by `stroke` from the master's place `begin` over `length`. Throws
// CamError for an unknown law.
Curve law_curve(std::string_view name, double begin, double length, double stroke);

// `cam` with the curve `lift` in place of what it has between the ends of the lift, as tables of points: a new one
// where the acceleration jumps. The lift begins at a joint of two segments and ends at one, or in a rest, which becomes
// shorter. Throws CamError where it does neither, or where the slave is not where the cam goes on from.
Cam with_lift(const Cam& cam, const Curve& lift);

}  // namespace stiction::sim::cam
