// Slope of viscous friction.
#include <cmath>

#include "host/diagnose/candidate.hpp"
#include "host/diagnose/inverse_dynamics.hpp"

namespace stiction::host::effects {
namespace {

Columns columns(const SearchContext& context, const Motion& motion, double) {
  return {force_change(context.axis, with_viscous(context.axis, viscous_of(context.axis) + 1.0), motion, 1.0)};
}
bool possible(const SearchContext& context, double, const Eigen::VectorXd& w) {
  return viscous_of(context.axis) + w[0] >= 0.0;
}
void describe(const SearchContext& context, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  add_key(finding, "viscous", "_N_s_per_m", {viscous_of(context.axis) + w[0]}, {std::sqrt(c(0, 0))});
}

}  // namespace

const Candidate viscous_mismatch{"viscous_mismatch", no_scan, columns, possible, describe};

}  // namespace stiction::host::effects
