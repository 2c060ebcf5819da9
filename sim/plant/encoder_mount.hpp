// Elastic mount of the encoder's rider (Mendricky 2006, 3.15-3.18): m_j x_j'' + b_j (x_j' - x') + k_j (x_j - x) = 0,
// light enough not to act back on the carriage. In the deflection d = x_j - x it is d'' + 2 zeta w d' + w^2 d = -x'',
// which takes its exact step for an acceleration held over the step: with s = (d, d') and the change of the carriage's
// velocity c, s+ = A s + b c.
//
// A state is needed once a tick only, so what is kept is not s but y of the same dynamics in as few operations as there
// can be: y+ = tr(A) y - det(A) y- + c. By the theorem of Cayley and Hamilton s = b y + (A - tr(A) I) b y-.
#pragma once

#include <cmath>
#include <complex>
#include <numbers>
#include <optional>

#include "firmware/machine/model/machine.hpp"

namespace stiction::sim {

// A template over the number in which it computes: a double, or a batch whose lanes are mounts.
template <class Real>
class EncoderMountModelOf {
 public:
  // Without parameters the mount is rigid.
  EncoderMountModelOf(const std::optional<machine::EncoderMountParameters>& mount, double step) {
    if (!mount) return;
    const double w = 2.0 * std::numbers::pi * mount->natural_frequency;
    const double decay = mount->damping_ratio * w;
    // Imaginary above critical damping: sine and cosine of it are hyperbolic then.
    const auto damped = w * std::sqrt(std::complex<double>(1.0 - mount->damping_ratio * mount->damping_ratio));
    const double e = std::exp(-decay * step);
    const double c = std::cos(damped * step).real();
    const double s = damped == 0.0 ? step : (std::sin(damped * step) / damped).real();
    const double a11 = e * (c + decay * s), a12 = e * s;
    const double a21 = -e * w * w * s, a22 = e * (c - decay * s);
    const double rest_per_change = -1.0 / (w * w * step);  // the deflection that the acceleration would hold
    const double b1 = (1.0 - a11) * rest_per_change, b2 = -a21 * rest_per_change;
    trace_ = 2.0 * e * c;
    determinant_ = e * e;
    deflection_ = {b1, a12 * b2 - a22 * b1};
    velocity_ = {b2, a21 * b1 - a11 * b2};
  }

  // One step in which the carriage's velocity changes evenly by `change` (m/s).
  void advance(Real change) {
    const Real next = trace_ * y_ - determinant_ * before_ + change;
    before_ = y_;
    y_ = next;
  }

  Real deflection() const { return of_state(deflection_); }  // m, x_j - x
  Real velocity() const { return of_state(velocity_); }      // m/s, x_j' - x'

 private:
  struct Weights {
    Real y = 0.0, before = 0.0;
  };
  Real of_state(const Weights& w) const { return w.y * y_ + w.before * before_; }

  Real trace_ = 0.0, determinant_ = 0.0;
  Weights deflection_, velocity_;
  Real y_ = 0.0, before_ = 0.0;
};
using EncoderMountModel = EncoderMountModelOf<double>;

}  // namespace stiction::sim
