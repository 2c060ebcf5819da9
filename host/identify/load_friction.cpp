#include "host/identify/load_friction.hpp"

#include <algorithm>
#include <cmath>

#include "host/identify/band.hpp"
#include "host/identify/fit_support.hpp"

namespace stiction::host {

bool rises_with_weight(const LogRows& rows, LevelModel model, const Held& held) {
  constexpr double model_error = 0.05;  // of the level
  constexpr double certain = 1.96;
  if (std::any_of(rows.motions().begin(), rows.motions().end(), [](const Motion& m) { return m.constant.empty(); }))
    return false;
  const auto plain = equations_of(rows, model);
  model.rises_with_weight = true;
  const auto risen = equations_of(rows, model);
  const auto blocks = blocks_for(rows, rows.force - plain.columns * fitting::weights_of(plain.columns, rows.force));
  const InstrumentFit without(plain, blocks, held), with(risen, blocks, held);
  const double rise = with.weights()[fitting::risen_level], weight = with.weights()[fitting::one];
  return weight != 0.0 && rise > certain * with.errors()[fitting::risen_level] &&
         rise > model_error * friction_level(risen.columns, with.weights()) && with.held_out() < without.held_out();
}

void add_load_coefficient(FrictionFit& fit, const Eigen::MatrixXd& replicates) {
  fitting::add(fit, "load_coefficient", fit.weights.transpose(), replicates,
               [](const auto& w) { return w[fitting::risen_level] / std::abs(w[fitting::one]); });
}

}  // namespace stiction::host
