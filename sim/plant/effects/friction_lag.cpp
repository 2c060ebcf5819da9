#include "sim/plant/effects/friction_lag.hpp"

#include <algorithm>
#include <cmath>

namespace stiction::sim {
namespace {

struct Sliding {
  SlidingFriction operator()(const CoulombViscous::Parameters& p) const { return viscous(p.viscous); }
  SlidingFriction operator()(const Classical::Parameters& p) const { return viscous(p.viscous); }
  SlidingFriction operator()(const LinearRamp::Parameters& p) const {
    return [slope = p.viscous, edge = p.coulomb / p.slope](double v, double) {
      return std::copysign(slope * std::max(std::abs(v) - edge, 0.0), v);
    };
  }
  // Below `creeping` a straight line: an explicit step cannot follow the root's infinite slope at standstill.
  SlidingFriction operator()(const Parabolic::Parameters& p) const {
    constexpr double creeping = 1e-3;  // m/s
    const double exponent = 1.0 / p.order, slope = std::pow(creeping, exponent - 1.0);
    return [p, exponent, slope](double v, double) {
      const double speed = std::abs(v);
      const double root = speed < creeping ? slope * speed : std::pow(speed, exponent);
      return std::copysign(p.force_at_1_m_per_s * root, v) + p.viscous * v;
    };
  }
  SlidingFriction operator()(const LuGre::Parameters& p) const {
    return [p, fall = (p.static_ratio - 1.0) * p.coulomb](double v, double direction) {
      const double ratio = v / p.stribeck_velocity;
      return p.viscous * v + (fall == 0.0 ? 0.0 : fall * std::exp(-ratio * ratio) * direction);
    };
  }
  SlidingFriction operator()(const MaxwellSlip::Parameters& p) const {
    return [p](double v, double) {
      const double rise = p.rise == 0.0 ? 0.0 : -p.rise * std::expm1(-std::abs(v) / p.rise_velocity);
      return p.viscous * v + std::copysign(rise, v);
    };
  }
  static SlidingFriction viscous(double slope) {
    return [slope](double v, double) { return slope * v; };
  }
};

}  // namespace

SlidingFriction sliding_friction(const FrictionParameters& parameters) { return std::visit(Sliding{}, parameters); }

}  // namespace stiction::sim
