// A piece of a motion between two joints: a polynomial, sines and, in a few laws, the integral of an exponential. Every
// law and every table of points is a list of such pieces, so that derivatives of any order, extremes, jumps, residual
// amplitudes and the bound of a table are each written once.
//
// Within a piece the motion is a function of t = rate * (distance from one of its ends), which for most laws is 0 to 1
// or 0 to 1/2, whatever length and stroke the piece is given. A mirrored piece counts from its right end: the second
// half of a symmetric law is then as exact as the first.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/cam/bell.hpp"
#include "sim/cam/interval.hpp"

namespace stiction::sim::cam {

// amplitude * sin(rate * t + phase), angles in rad.
struct Wave {
  double amplitude;
  double rate;
  double phase;
};

struct Piece {
  double begin = 0.0;  // of the master
  double end = 0.0;
  double rate = 1.0;                 // t for each unit of the master
  bool from_end = false;             // t counts from `end` backwards
  std::vector<double> polynomial{};  // coefficients of t^0, t^1, ...
  std::vector<Wave> waves{};
  std::vector<Bell> bells{};

  double length() const { return end - begin; }
  double local(double x) const { return (from_end ? end - x : x - begin) * rate; }
  // dt/dx to the power `order`.
  double chain(int order) const;

  // The derivative of `order` (0: the motion itself) at the master's place `x`, in slave units over master units to
  // the power `order`. Exact to a few units of the last place of the largest term.
  double derivative(double x, int order) const;
};

// The motion and two derivatives of a piece over a part of it as a Taylor polynomial in the master's distance from the
// part's middle, with a bound of its remainder for each of them.
struct TaylorModel {
  double middle = 0.0;
  double radius = 0.0;                 // half of the part's length
  std::vector<Interval> coefficients;  // each holds the exact one
  double remainder[3] = {0.0, 0.0, 0.0};
};

// The Taylor model of `piece` between the master's places `begin` and `end`, both inside of it, up to the power
// `order`, at least 3. The remainder of a sine is that of its series; a polynomial has none where `order` is at least
// its degree; for an exponential see Bell::remainder.
TaylorModel taylor_model(const Piece& piece, double begin, double end, std::size_t order);

// The same motion over a different part of the master: x -> begin + stretch * (x - from), and the slave's
// gain * y + offset. `stretch` is positive.
struct Placement {
  double from = 0.0;     // the master's place that comes to `begin`
  double begin = 0.0;    // where it comes to
  double stretch = 1.0;  // new length over the old
  double gain = 1.0;
  double offset = 0.0;
};
Piece placed(const Piece& piece, const Placement& placement);

// The motion read backwards, y(about - x): `about` is the sum of the ends of the whole motion.
Piece mirrored(const Piece& piece, double about);

// Adds slope * (x - from) to the motion of `piece`; slope in slave units over master units, `from` of the master.
void add_line(Piece& piece, double slope, double from);

}  // namespace stiction::sim::cam
