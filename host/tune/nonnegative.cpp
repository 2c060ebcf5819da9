#include "host/tune/nonnegative.hpp"

#include <vector>

#include "host/algebra/least_squares.hpp"

namespace stiction::host {
namespace {

using Index = Eigen::Index;

// The unbounded minimum over the unknowns in `active`; the others are zero.
Eigen::VectorXd minimum_over(const Eigen::MatrixXd& normal, const Eigen::VectorXd& right,
                             const std::vector<Index>& active) {
  Eigen::VectorXd w = Eigen::VectorXd::Zero(right.size());
  const Eigen::MatrixXd part = normal(active, active);
  const Eigen::VectorXd solved = solve_symmetric(part, right(active));
  for (std::size_t k = 0; k < active.size(); ++k) w[active[k]] = solved[static_cast<Index>(k)];
  return w;
}

}  // namespace

Eigen::VectorXd solve_nonnegative(const Eigen::MatrixXd& normal, const Eigen::VectorXd& right, Index bounded) {
  const Index n = right.size();
  std::vector<bool> in(static_cast<std::size_t>(n), false);
  for (Index k = bounded; k < n; ++k) in[static_cast<std::size_t>(k)] = true;
  const auto active = [&] {
    std::vector<Index> list;
    for (Index k = 0; k < n; ++k)
      if (in[static_cast<std::size_t>(k)]) list.push_back(k);
    return list;
  };
  Eigen::VectorXd w = minimum_over(normal, right, active());
  const double enough = 1e-10 * right.lpNorm<Eigen::Infinity>();
  // Each round lets one unknown in; three rounds an unknown are far more than it ever takes.
  for (Index round = 0; round < 3 * n; ++round) {
    const Eigen::VectorXd slope = right - normal * w;
    Index best = -1;
    for (Index k = 0; k < bounded; ++k)
      if (!in[static_cast<std::size_t>(k)] && slope[k] > enough && (best < 0 || slope[k] > slope[best])) best = k;
    if (best < 0) break;
    in[static_cast<std::size_t>(best)] = true;
    for (Index step = 0; step <= n; ++step) {
      const Eigen::VectorXd wanted = minimum_over(normal, right, active());
      // As far towards it as no unknown becomes negative; what reaches zero leaves.
      double share = 1.0;
      for (Index k = 0; k < bounded; ++k)
        if (in[static_cast<std::size_t>(k)] && wanted[k] <= 0.0 && w[k] > wanted[k])
          share = std::min(share, w[k] / (w[k] - wanted[k]));
      w += share * (wanted - w);
      if (share >= 1.0) break;
      for (Index k = 0; k < bounded; ++k)
        if (in[static_cast<std::size_t>(k)] && w[k] <= 1e-14) {
          in[static_cast<std::size_t>(k)] = false;
          w[k] = 0.0;
        }
    }
  }
  return w;
}

}  // namespace stiction::host
