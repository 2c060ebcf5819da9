// A force along the motion that begins at each reversal and dies away with time, whatever the way: friction's contact
// does so with distance.
#include <fmt/format.h>

#include <cmath>

#include "host/diagnose/candidate.hpp"

namespace stiction::host::signatures {
namespace {

constexpr int fewest_reversals = 4;

std::vector<double> grid(const Scene& scene) {
  return scene.reversals < fewest_reversals ? std::vector<double>{} : effects::geometric(5e-3, 0.3, 7);
}
Columns columns(const Scene&, const Motion& motion, double time) {
  std::vector<double> column(motion.v.size(), 0.0);
  double decay = 0.0;  // none before the first reversal
  for (std::size_t i = 1; i < column.size(); ++i) {
    decay *= std::exp(-motion.period / time);
    if (motion.v[i] * motion.v[i - 1] < 0.0) decay = 1.0;
    column[i] = std::copysign(decay, motion.v[i]);
  }
  return {column};
}
std::string looks_like(const Scene&, double time, const Eigen::VectorXd& w) {
  return fmt::format("at reversals: a force of {:.2g} N {} the motion that dies away within {:.2g} ms", std::abs(w[0]),
                     w[0] < 0.0 ? "along" : "against", 1e3 * time);
}

}  // namespace

const Candidate force_after_reversal{.name = "force_after_reversal",
                                     .grid = grid,
                                     .columns = columns,
                                     .possible = effects::any,
                                     .describe = nullptr,
                                     .nonlinear = true,
                                     .looks_like = looks_like};

}  // namespace stiction::host::signatures
