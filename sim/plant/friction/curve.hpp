// Friction as it was measured: force over speed, a curve for each direction, straight between its nodes and beyond them
// as the last piece runs. At standstill it sticks up to the curve's value there: as friction model A it balances the
// applied force, and a zero crossing inside a step is caught. In motion each step is solved implicitly, exactly on each
// piece.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "sim/number/arithmetic.hpp"
#include "sim/plant/friction/law.hpp"

namespace stiction::sim {

struct CurveParameters {
  std::vector<double> speed;
  std::vector<double> forward;
  std::vector<double> backward;
};

template <class Real = double>
class Curve {
 public:
  using Scalar = Real;
  using Parameters = CurveParameters;
  static constexpr std::string_view name = "curve";
  static constexpr std::string_view label = "Measured curve";
  static constexpr std::array<machine::Parameter<Parameters>, 3> parameters{{
      {.key = "speed",
       .unit = "m/s",
       .range = machine::not_negative(),
       .member = &Parameters::speed,
       .fallback = {},
       .text = "speeds of the nodes, rising; below the first one friction is as at it",
       .rising = true},
      {.key = "forward",
       .unit = "N",
       .range = machine::not_negative(),
       .member = &Parameters::forward,
       .fallback = {},
       .text = "friction against motion in +x at these speeds",
       .as_long_as = "speed"},
      {.key = "backward",
       .unit = "N",
       .range = machine::not_negative(),
       .member = &Parameters::backward,
       .fallback = {},
       .text = "friction against motion in -x at these speeds, positive too",
       .as_long_as = "speed"},
  }};
  // The mean of both directions at the lowest speed.
  static double coulomb(const Parameters& p) { return 0.5 * (p.forward.front() + p.backward.front()); }
  // The mean slope from the lowest to the highest speed.
  static double viscous(const Parameters& p) {
    const double range = p.speed.back() - p.speed.front();
    return range == 0.0 ? 0.0 : (0.5 * (p.forward.back() + p.backward.back()) - coulomb(p)) / range;
  }
  // Both curves are moved as they are, but not below zero.
  static void set_coulomb(Parameters& p, double coulomb) { raise(p, coulomb - Curve::coulomb(p), 0.0); }
  // Both curves are turned about their lowest speed.
  static void set_viscous(Parameters& p, double viscous) {
    if (p.speed.size() == 1) {  // a slope needs a second node
      p.speed.push_back(p.speed.front() + 1.0);
      p.forward.push_back(p.forward.front());
      p.backward.push_back(p.backward.front());
    }
    raise(p, 0.0, viscous - Curve::viscous(p));
  }

  // As many values in each direction as speeds, at least one.
  Curve(const Parameters& p, Body body)
      : mass_(body.mass),
        step_(body.step),
        forward_(pieces(p.speed, p.forward)),
        backward_(pieces(p.speed, p.backward)) {}

  Real advance(Real velocity, Real force) {
    if (velocity == 0.0) return start(force, step_);
    const Real direction = copy_sign(Real(1.0), velocity);
    const Real next = slide(velocity, force, direction, step_);
    if (next * direction > 0.0) return next;
    return start(force, step_ - step_ * velocity / (velocity - next));
  }
  Real steady_force(Real velocity, Real direction) const {
    const Real way = velocity == 0.0 ? direction : copy_sign(Real(1.0), velocity);
    if (way == 0.0) return 0.0;
    const auto& pieces = way > 0.0 ? forward_ : backward_;
    const Real speed = absolute(velocity);
    std::size_t k = 0;
    while (k + 1 < pieces.size() && speed > pieces[k + 1].from) ++k;
    return direction * (pieces[k].force + pieces[k].slope * std::max<Real>(speed - pieces[k].from, 0.0));
  }
  std::optional<Contact> contact() const { return {}; }

 private:
  struct Piece {
    Real from;   // m/s
    Real force;  // N there
    Real slope;  // N s/m
  };

  static std::vector<Piece> pieces(const std::vector<double>& speed, const std::vector<double>& force) {
    std::vector<Piece> made{{0.0, force.front(), 0.0}};
    for (std::size_t k = 0; k + 1 < speed.size(); ++k)
      made.push_back({speed[k], force[k], (force[k + 1] - force[k]) / (speed[k + 1] - speed[k])});
    return made;
  }
  static void raise(Parameters& p, double level, double slope) {
    for (std::size_t k = 0; k < p.speed.size(); ++k) {
      const double by = level + slope * (p.speed[k] - p.speed.front());
      p.forward[k] = std::max(p.forward[k] + by, 0.0);
      p.backward[k] = std::max(p.backward[k] + by, 0.0);
    }
  }
  Real start(Real force, Real duration) const {
    const Real level = (force > 0.0 ? forward_ : backward_).front().force;
    if (absolute(force) <= level) return 0.0;
    return slide(0.0, force, copy_sign(Real(1.0), force), duration);
  }
  // The velocity at the end of `duration`; against `direction` where the motion ends within it.
  Real slide(Real velocity, Real force, Real direction, Real duration) const {
    const auto& pieces = direction > 0.0 ? forward_ : backward_;
    const Real gain = duration / mass_, target = (velocity + gain * force) * direction;
    Real speed = target - gain * pieces.front().force;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      const Piece& piece = pieces[k];
      // A curve that falls faster than the mass can follow in a step is crossed at once.
      const Real inertia = std::max<Real>(1.0 + gain * piece.slope, 1e-3);
      speed = (target - gain * (piece.force - piece.slope * piece.from)) / inertia;
      if (k + 1 == pieces.size() || speed <= pieces[k + 1].from) break;
    }
    return direction * speed;
  }

  Real mass_, step_;
  std::vector<Piece> forward_, backward_;
};

}  // namespace stiction::sim
