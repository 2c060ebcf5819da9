#include "sim/plant/effects/friction_level.hpp"

#include <numeric>

namespace stiction::sim {

double coulomb_of(const FrictionParameters& parameters) {
  return std::visit(
      []<class P>(const P& p) {
        if constexpr (std::is_same_v<P, MaxwellSlip::Parameters>)
          return std::accumulate(p.level.begin(), p.level.end(), 0.0);
        else
          return p.coulomb;
      },
      parameters);
}

double viscous_of(const FrictionParameters& parameters) {
  return std::visit([](const auto& p) { return p.viscous; }, parameters);
}

void set_coulomb(Friction& friction, double coulomb) {
  auto& parameters = friction.models.at(friction.use);
  const double scale = coulomb / coulomb_of(parameters);
  std::visit(
      [&]<class P>(P& p) {
        if constexpr (std::is_same_v<P, MaxwellSlip::Parameters>)
          for (double& level : p.level) level *= scale;
        else
          p.coulomb = coulomb;
      },
      parameters);
}

void set_viscous(Friction& friction, double viscous) {
  std::visit([&](auto& p) { p.viscous = viscous; }, friction.models.at(friction.use));
}

}  // namespace stiction::sim
