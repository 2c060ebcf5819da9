// Friction model A, classical (Mendricky 2006, 4.2): at standstill the friction balances the applied force up to the
// static level; in motion F = (F_C + mu_v |v|) sgn(v). Sticking is exact: a zero crossing inside a step is caught, so
// the velocity is zero to the bit while the carriage sticks.
#pragma once

#include <array>
#include <cmath>

#include "sim/parameter.hpp"
#include "sim/plant/friction/body.hpp"

namespace stiction::sim {

class Classical {
 public:
  struct Parameters {
    double coulomb = 0.0;
    double static_ratio = 1.0;
    double viscous = 0.0;
  };
  static constexpr std::string_view name = "classical";
  static constexpr std::string_view label = "A classical";
  static constexpr std::array<Parameter<Parameters>, 3> parameters{{
      {"coulomb", "N", not_negative(), &Parameters::coulomb, {}, "Coulomb friction F_C"},
      {"static_ratio", "1", {1.0, 10.0}, &Parameters::static_ratio, 1.0, "static over Coulomb friction, F_Ts / F_C"},
      {"viscous", "N s/m", not_negative(), &Parameters::viscous, {}, "viscous friction mu_v"},
  }};

  Classical(const Parameters& p, Body body) : p_(p), body_(body) {}

  // Velocity (m/s) one step later, under `force` (N), the sum of all forces but friction.
  double advance(double velocity, double force) {
    if (velocity == 0.0) return start(force, body_.step);
    const double direction = std::copysign(1.0, velocity);
    const double next = slide(velocity, force, direction, body_.step);
    if (next * direction > 0.0) return next;
    const double until_stop = body_.step * velocity / (velocity - next);
    return start(force, body_.step - until_stop);
  }

 private:
  double start(double force, double duration) const {
    if (std::abs(force) <= p_.coulomb * p_.static_ratio) return 0.0;
    return slide(0.0, force, std::copysign(1.0, force), duration);
  }
  double slide(double velocity, double force, double direction, double duration) const {
    const double gain = duration / body_.mass;
    return (velocity + gain * (force - p_.coulomb * direction)) / (1.0 + gain * p_.viscous);
  }

  Parameters p_;
  Body body_;
};

}  // namespace stiction::sim
