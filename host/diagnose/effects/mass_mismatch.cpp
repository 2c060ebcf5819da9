// Moving mass: the force is off by (true mass - mass) a.
#include <cmath>

#include "host/diagnose/candidate.hpp"

namespace stiction::host::effects {
namespace {

Columns columns(const SearchContext&, const Motion& motion, double) { return {motion.a}; }
bool possible(const SearchContext& context, double, const Eigen::VectorXd& w) { return context.axis.mass + w[0] > 0.0; }
void describe(const SearchContext& context, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  add_key(finding, "mass", "_kg", {context.axis.mass + w[0]}, {std::sqrt(c(0, 0))});
}

}  // namespace

const Candidate mass_mismatch{"mass_mismatch", no_scan, columns, possible, describe};

}  // namespace stiction::host::effects
