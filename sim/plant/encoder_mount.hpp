// Elastic mount of the encoder's rider (Mendricky 2006, 3.15-3.18): m_j x_j'' + b_j (x_j' - x') + k_j (x_j - x) = 0,
// light enough not to act back on the carriage. In the deflection d = x_j - x it is d'' + 2 zeta w d' + w^2 d = -x'',
// which takes its exact step for an acceleration held over the step.
#pragma once

#include <cmath>
#include <numbers>
#include <optional>

#include "sim/machine/machine.hpp"

namespace stiction::sim {

class EncoderMountModel {
 public:
  // Without parameters the mount is rigid.
  EncoderMountModel(const std::optional<EncoderMount>& mount, double step) {
    if (!mount) return;
    const double w = 2.0 * std::numbers::pi * mount->natural_frequency;
    const double decay = mount->damping_ratio * w;
    const double damped = w * std::sqrt(1.0 - mount->damping_ratio * mount->damping_ratio);
    const double e = std::exp(-decay * step);
    const double c = std::cos(damped * step);
    const double s = std::sin(damped * step) / damped;
    a11_ = e * (c + decay * s);
    a12_ = e * s;
    a21_ = -e * w * w * s;
    a22_ = e * (c - decay * s);
    rest_per_change_ = -1.0 / (w * w * step);
  }

  // One step in which the carriage's velocity changes evenly by `change` (m/s).
  void advance(double change) {
    const double rest = rest_per_change_ * change;  // the deflection that the acceleration would hold
    const double d = deflection_ - rest;
    deflection_ = rest + a11_ * d + a12_ * velocity_;
    velocity_ = a21_ * d + a22_ * velocity_;
  }

  double deflection() const { return deflection_; }  // m, x_j - x
  double velocity() const { return velocity_; }      // m/s, x_j' - x'

 private:
  double a11_ = 0.0, a12_ = 0.0, a21_ = 0.0, a22_ = 0.0;
  double rest_per_change_ = 0.0;
  double deflection_ = 0.0;
  double velocity_ = 0.0;
};

}  // namespace stiction::sim
