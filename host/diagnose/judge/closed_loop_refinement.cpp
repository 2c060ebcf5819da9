#include "host/diagnose/judge/closed_loop_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/diagnose/classes/candidate_columns.hpp"
#include "sim/effects/effects.hpp"

namespace stiction::host {
namespace {

constexpr int most_steps = 3;
constexpr int halvings = 2;
constexpr double settled = 1e-4;  // of the residual's square: a smaller gain ends the steps
constexpr double far = 0.02;      // a smaller gain leaves the slopes as they are: each costs a run

// One number among a finding's parameters.
struct Free {
  std::size_t finding;
  std::size_t parameter;  // of the finding
  std::string key;        // of the effect
  std::size_t index;      // of the key's values
};

class ClosedLoopFit {
 public:
  ClosedLoopFit(std::vector<Finding> findings, const SearchResult& found, EffectResponse& response, const LogRows& rows,
                const Eigen::VectorXd& target, const SearchContext& context)
      : findings_(std::move(findings)), response_(response), rows_(rows), target_(target) {
    bool whitened = true;
    for (std::size_t k = 0; k < findings_.size(); ++k) {
      const auto& term = found.terms[k];
      whitened = whitened && term.whitened;
      // What runs in silence do not know: a phase of each record, or a response under disturbances.
      if (const auto& candidate = candidates()[term.candidate]; candidate.per_record || candidate.replays)
        target_ -= weighted_columns(rows, context, candidate, term.shape, term.coefficients);
      else
        free_parameters(k);
    }
    if (whitened) whitening_ = Whitening(found.residual, rows.logs());
  }

  // Returns the square that is left, infinity where nothing is free. Where no step gains, the findings stay as they
  // were.
  double run() {
    if (free_.empty()) return std::numeric_limits<double>::infinity();
    Eigen::VectorXd force = simulated(start());
    double left = square(target_ - force);
    const double before = left;
    Eigen::VectorXd at = start();
    Eigen::MatrixXd slopes = slopes_at(at, force);
    for (int step = 0; step < most_steps; ++step) {
      Eigen::VectorXd way = evidence_of(force, slopes).fit(all()).coefficients;
      double gained = 0.0;
      for (int half = 0; half <= halvings && gained <= 0.0; ++half, way *= 0.5) {
        const Eigen::VectorXd next = at + way, next_force = simulated(next);
        if (const double next_left = square(target_ - next_force); next_left < left) {
          gained = (left - next_left) / left;
          at = next, force = next_force, left = next_left;
        }
      }
      if (gained <= settled) break;
      if (gained > far) slopes = slopes_at(at, force);
    }
    if (left < before)
      write(at, evidence_of(force, slopes).interval_covariance(all(), Eigen::VectorXd::Zero(at.size())));
    return left;
  }
  const std::vector<Finding>& findings() const { return findings_; }
  // Of a residual (N, of the rows), whitened as the findings were found; infinite where it is.
  double square(const Eigen::VectorXd& residual) const {
    const double left = whitening_(residual).squaredNorm();
    return std::isfinite(left) ? left : std::numeric_limits<double>::infinity();
  }

 private:
  void free_parameters(std::size_t finding) {
    effects_.push_back(findings_[finding].row());
    of_finding_.push_back(finding);
    const auto& parameters = findings_[finding].parameters;
    for (std::size_t p = 0; p < parameters.size(); ++p)
      for (std::size_t i = 0; i < parameters[p].standard_errors.size(); ++i)
        free_.push_back({effects_.size() - 1, p, parameters[p].key, i});
  }

  Eigen::VectorXd start() const {
    Eigen::VectorXd at(static_cast<Eigen::Index>(free_.size()));
    for (std::size_t i = 0; i < free_.size(); ++i)
      at[static_cast<Eigen::Index>(i)] = effects_[free_[i].finding].values.at(free_[i].key)[free_[i].index];
    return at;
  }
  std::vector<machine::Effect> effects_at(const Eigen::VectorXd& at) const {
    auto effects = effects_;
    for (std::size_t i = 0; i < free_.size(); ++i)
      effects[free_[i].finding].values.at(free_[i].key)[free_[i].index] = at[static_cast<Eigen::Index>(i)];
    return effects;
  }
  // N, of the rows; infinite where the effects cannot have these values.
  Eigen::VectorXd simulated(const Eigen::VectorXd& at) {
    const auto effects = effects_at(at);
    try {
      return rows_.stacked([&](const Motion& motion) { return response_.together(motion, effects); });
    } catch (const sim::EffectError&) {
      return Eigen::VectorXd::Constant(rows_.rows(), std::numeric_limits<double>::infinity());
    }
  }
  // Of a parameter, with the others of its finding that have its unit: one of a wave's two may be near 0.
  double size_of(Eigen::Index i, const Eigen::VectorXd& at) const {
    const auto& own = free_[static_cast<std::size_t>(i)];
    const auto unit = [this](const Free& free) {
      return std::string_view(findings_[of_finding_[free.finding]].parameters[free.parameter].unit);
    };
    double square = 0.0;
    for (std::size_t k = 0; k < free_.size(); ++k)
      if (free_[k].finding == own.finding && unit(free_[k]) == unit(own))
        square += at[static_cast<Eigen::Index>(k)] * at[static_cast<Eigen::Index>(k)];
    return std::sqrt(square);
  }
  // By differences over a standard error, within 1e-5 to a tenth of its size; none where the effect cannot have it.
  Eigen::MatrixXd slopes_at(const Eigen::VectorXd& at, const Eigen::VectorXd& force) {
    Eigen::MatrixXd slopes(rows_.rows(), at.size());
    for (Eigen::Index i = 0; i < at.size(); ++i) {
      const auto& free = free_[static_cast<std::size_t>(i)];
      const double error = findings_[of_finding_[free.finding]].parameters[free.parameter].standard_errors[free.index];
      const double size = size_of(i, at);
      double by = std::isfinite(error) && error > 0.0 ? error : 0.01 * size;
      if (size > 0.0) by = std::clamp(by, 1e-5 * size, 0.1 * size);
      Eigen::VectorXd moved = at;
      moved[i] += by;
      const auto there = simulated(moved);
      slopes.col(i) = there.allFinite() ? Eigen::VectorXd((there - force) / by) : Eigen::VectorXd::Zero(rows_.rows());
    }
    return slopes;
  }
  Evidence evidence_of(const Eigen::VectorXd& force, const Eigen::MatrixXd& slopes) const {
    const auto longest = static_cast<std::size_t>(rows_.rows() / 60 + 1);
    Evidence evidence(target_ - force, blocks_of(rows_.velocity, rows_.logs(), longest));
    evidence.whiten(whitening_);
    std::vector<Eigen::VectorXd> columns;
    for (Eigen::Index i = 0; i < slopes.cols(); ++i) columns.emplace_back(slopes.col(i));
    evidence.add(columns);
    return evidence;
  }
  ColumnIndices all() const {
    ColumnIndices indices(free_.size());
    for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<Eigen::Index>(i);
    return indices;
  }
  // Two runs hunt otherwise, which is in their difference too and makes slopes steeper than they are: errors are no
  // smaller than those of the regressors.
  void write(const Eigen::VectorXd& at, const Eigen::MatrixXd& covariance) {
    for (std::size_t i = 0; i < free_.size(); ++i) {
      auto& finding = findings_[of_finding_[free_[i].finding]];
      auto& parameter = finding.parameters[free_[i].parameter];
      const auto k = static_cast<Eigen::Index>(i);
      finding.values.at(free_[i].key)[free_[i].index] = parameter.values[free_[i].index] = at[k];
      auto& error = parameter.standard_errors[free_[i].index];
      error = std::max(error, std::sqrt(std::max(covariance(k, k), 0.0)));
    }
  }

  std::vector<Finding> findings_;
  EffectResponse& response_;
  const LogRows& rows_;
  Eigen::VectorXd target_;
  std::vector<machine::Effect> effects_;  // of the findings that are simulated
  std::vector<std::size_t> of_finding_;
  std::vector<Free> free_;
  Whitening whitening_;
};

}  // namespace

void refine_in_closed_loop(std::vector<Finding>& findings, const SearchResult& found,
                           std::span<EffectResponse> responses, const LogRows& rows, const Eigen::VectorXd& target,
                           const SearchContext& context) {
  const auto start = findings;
  double least = std::numeric_limits<double>::infinity();
  for (auto& response : responses) {
    ClosedLoopFit fit(start, found, response, rows, target, context);
    least = std::min(least, fit.square(found.residual));
    if (const double left = fit.run(); left < least) {
      least = left;
      findings = fit.findings();
    }
  }
}

}  // namespace stiction::host
