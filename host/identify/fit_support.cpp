#include "host/identify/fit_support.hpp"

#include <algorithm>
#include <cmath>

namespace stiction::host::fitting {
namespace {

// A block holds at least this many correlation lengths, so that blocks are nearly independent, and at least as many
// rows as the anti-aliasing filter correlates.
constexpr double correlation_lengths = 3.0;
constexpr std::size_t least_rows = 10;
constexpr std::size_t least_blocks_of_fit = 8;
constexpr double separable = 20.0;    // variance inflation up to which speed and its sign count as told apart
constexpr double worth_while = 0.01;  // of the value; less is noise of the test itself in one record of thirty

// By how much the other columns inflate the variance of the level's weight (its variance inflation factor).
double inflation_of_level(const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd others(columns.rows(), 3);
  others << columns.col(acceleration), columns.col(velocity), columns.col(one);
  const Eigen::VectorXd own = columns.col(level), left = own - others * weights_of(others, own);
  return own.squaredNorm() / left.squaredNorm();
}

}  // namespace

Eigen::VectorXd weights_of(const Eigen::MatrixXd& columns, const Eigen::VectorXd& force) {
  const BlockRegression whole(columns, force, {{0, static_cast<std::size_t>(columns.rows())}});
  return whole.solve();
}

std::vector<double> replicate(const Eigen::MatrixXd& replicates, const OfWeights& of) {
  std::vector<double> values;
  for (Eigen::Index r = 0; r < replicates.rows(); ++r) values.push_back(of(replicates.row(r)));
  return values;
}

void add(FrictionFit& fit, const char* name, const Eigen::RowVectorXd& centre, const Eigen::MatrixXd& replicates,
         const OfWeights& of) {
  fit.parameters.push_back({name, of(centre), replicate(replicates, of)});
}

void choose_blocks(FrictionFit& fit, const LogRows& rows) {
  fit.correlation = correlation_length(fit.residual, rows.logs());
  const auto shortest = static_cast<std::size_t>(std::ceil(correlation_lengths * fit.correlation));
  fit.blocks = blocks_of(rows.velocity, rows.logs(), std::max(shortest, least_rows));
}

void add_sliding_parameters(FrictionFit& fit, const Eigen::RowVectorXd& centre, const Eigen::MatrixXd& replicates) {
  add(fit, "mass_kg", centre, replicates, [](const auto& w) { return w[acceleration]; });
  add(fit, "coulomb_N", centre, replicates, [](const auto& w) { return w[level]; });
  add(fit, "viscous_N_s_per_m", centre, replicates, [](const auto& w) { return w[velocity]; });
  add(fit, "constant_force_N", centre, replicates, [](const auto& w) { return w[one]; });
}

Eigen::VectorXd steady_sliding(const LogRows& rows) {
  constexpr double slowest = 0.05, reach = 0.03;  // of the highest speed; s
  double highest = 0.0;
  for (const auto& motion : rows.motions())
    for (const double v : motion.v) highest = std::max(highest, std::abs(v));
  return rows.sampled([&](const Motion& m) {
    const auto far = static_cast<std::size_t>(std::lround(reach / m.period));
    std::vector<double> sliding(m.v.size(), 1.0);
    for (std::size_t i = 0; i < m.v.size(); ++i) {
      if (std::abs(m.v[i]) > slowest * highest) continue;
      // Everything between two slow samples that lie close together is cleared once.
      const std::size_t begin = i > far ? i - far : 0, end = std::min(i + far + 1, m.v.size());
      for (std::size_t k = i > 0 && sliding[i - 1] == 0.0 ? i : begin; k < end; ++k) sliding[k] = 0.0;
    }
    return sliding;
  });
}

void check_against_sliding(FrictionFit& fit, const LogRows& rows, const FitSettings& settings) {
  const Eigen::VectorXd sliding = steady_sliding(rows);
  Eigen::MatrixXd columns(rows.rows(), 4);
  for (const auto c : {acceleration, velocity, one, level}) columns.col(c) = fit.columns.col(c).cwiseProduct(sliding);
  const Eigen::VectorXd force = rows.force.cwiseProduct(sliding);
  std::vector<RowBlock> with_rows;
  for (const auto& block : fit.blocks)
    if (sliding.segment(static_cast<Eigen::Index>(block.begin), static_cast<Eigen::Index>(block.end - block.begin))
            .maxCoeff() > 0.0)
      with_rows.push_back(block);
  if (with_rows.size() < least_blocks_of_fit) return;
  // Rows of one speed do not tell its friction from the level, so that they contradict nothing.
  if (!(inflation_of_level(columns) < separable)) return;
  const BlockRegression paired(columns, force, fit.blocks);
  const Eigen::RowVectorXd centre = paired.solve().transpose();
  FrictionFit alone;
  add_sliding_parameters(alone, centre, paired.bootstrap(settings.replicates, settings.seed));
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& a = alone.parameters[k];
    const auto& b = fit.at(a.name);
    double variance = 0.0;
    for (std::size_t r = 0; r < a.replicates.size(); ++r)
      variance += std::pow(a.replicates[r] - a.value - (b.replicates[r] - b.value), 2);
    variance /= static_cast<double>(a.replicates.size());
    const double apart = std::abs(a.value - b.value);
    if (apart > 3.0 * std::sqrt(variance) && apart > worth_while * std::abs(b.value)) fit.sliding_only = true;
  }
  if (!fit.sliding_only) return;
  alone.parameters.clear();
  add_sliding_parameters(alone, centre,
                         BlockRegression(columns, force, with_rows).bootstrap(settings.replicates, settings.seed));
  for (auto& parameter : alone.parameters)
    *std::find_if(fit.parameters.begin(), fit.parameters.end(),
                  [&](const auto& p) { return p.name == parameter.name; }) = parameter;
}

}  // namespace stiction::host::fitting
