#include "host/diagnose/judge/closed_loop_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/diagnose/classes/candidate_columns.hpp"
#include "host/diagnose/statistics/noise_model.hpp"
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
  double unit;            // that of the linear axis, in which runs have it, in one of the parameter's own
};

double own_unit(const machine::AxisModel& axis, sim::EffectId effect, std::string_view key) {
  const auto known = std::find_if(effect->keys.begin(), effect->keys.end(),
                                  [&](const machine::ValueKey& each) { return each.key == key; });
  return axis.coordinate.own(sim::key_unit(*known, axis)).factor;
}

class ClosedLoopFit {
 public:
  ClosedLoopFit(std::vector<Finding> findings, std::span<const Term> terms, EffectResponse& response,
                const LogRows& rows, const Eigen::VectorXd& target, const SearchContext& context)
      : findings_(std::move(findings)), axis_(context.axis), response_(response), rows_(rows), target_(target) {
    for (std::size_t k = 0; k < findings_.size(); ++k) {
      const auto& term = terms[k];
      if (described_by_runs(term)) {
        free_parameters(k);
        add_starts(candidates()[term.candidate]);
      } else
        target_ -= weighted_columns(rows, context, candidates()[term.candidate], term.shape, term.coefficients);
    }
  }

  // Returns the log likelihood of what is left, minus infinity where nothing is free. Where no step gains, the findings
  // stay as they were. What a coarse description leaves is no noise: the first steps go by the force as it is, those
  // after them by the noise that the first have left.
  double run() {
    if (free_.empty()) return -std::numeric_limits<double>::infinity();
    begin_at_likeliest();
    auto first = around(start());
    first.push_back(start());
    foresee(first);
    const Eigen::VectorXd began = simulated(start());
    Place place{start(), began, {}};
    place.slopes = slopes_at(place.at, began);
    step_on(place);
    whitening_ = noise_of(target_ - place.force, rows_);
    step_on(place);
    const double before = likelihood(target_ - began), after = likelihood(target_ - place.force);
    left_ = target_ - (after > before ? place.force : began);
    if (after > before)
      write(place.at, evidence_of(place).interval_covariance(all(), Eigen::VectorXd::Zero(place.at.size())));
    return std::max(before, after);
  }
  const std::vector<Finding>& findings() const { return findings_; }
  const Eigen::VectorXd& left() const { return left_; }  // N, of the rows

 private:
  // Of a residual (N, of the rows), with the noise that it is itself.
  double likelihood(const Eigen::VectorXd& residual) const {
    return residual.allFinite() ? noise_log_likelihood(residual, rows_) : -std::numeric_limits<double>::infinity();
  }
  // Values of what is free, the force (N, of the rows) that the machine makes of them, and its slopes.
  struct Place {
    Eigen::VectorXd at, force;
    Eigen::MatrixXd slopes;
  };

  // Gauss and Newton's steps, to where none gains.
  void step_on(Place& place) {
    double left = square(target_ - place.force);
    for (int step = 0; step < most_steps; ++step) {
      Eigen::VectorXd way = evidence_of(place).fit(all()).coefficients;
      foresee(halved(place.at, way));
      double gained = 0.0;
      for (int half = 0; half <= halvings && gained <= 0.0; ++half, way *= 0.5) {
        const Eigen::VectorXd next = place.at + way, next_force = simulated(next);
        if (const double next_left = square(target_ - next_force); next_left < left) {
          gained = (left - next_left) / left;
          place.at = next, place.force = next_force, left = next_left;
        }
      }
      if (gained <= settled) return;
      if (gained > far) place.slopes = slopes_at(place.at, place.force);
    }
  }
  // Of a residual (N, of the rows); infinite where it is.
  double square(const Eigen::VectorXd& residual) const {
    const double left = whitening_(residual).squaredNorm();
    return std::isfinite(left) ? left : std::numeric_limits<double>::infinity();
  }

  void free_parameters(std::size_t finding) {
    effects_.push_back(findings_[finding].row());
    of_finding_.push_back(finding);
    const auto& parameters = findings_[finding].parameters;
    for (std::size_t p = 0; p < parameters.size(); ++p)
      for (std::size_t i = 0; i < parameters[p].standard_errors.size(); ++i)
        free_.push_back({effects_.size() - 1, p, parameters[p].key, i,
                         own_unit(axis_, findings_[finding].effect, parameters[p].key)});
  }

  // Other values of the effect that was freed last.
  void add_starts(const Candidate& candidate) {
    if (candidate.starts == nullptr) return;
    for (auto& values : candidate.starts(effects_.back().values)) {
      starts_.push_back(effects_);
      starts_.back().back().values = std::move(values);
    }
  }
  // Of the effects as their columns have them, and with the values from which one may begin.
  void begin_at_likeliest() {
    if (starts_.empty()) return;
    for (auto& each : starts_)
      each.insert(each.end(), effects_.begin() + static_cast<std::ptrdiff_t>(each.size()), effects_.end());
    response_.foresee(rows_.motions(), starts_);
    auto best = effects_;
    double most = likelihood(target_ - simulated(effects_));
    for (const auto& each : starts_)
      if (const double now = likelihood(target_ - simulated(each)); now > most) most = now, best = each;
    effects_ = std::move(best);
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
  Eigen::VectorXd simulated(const Eigen::VectorXd& at) { return simulated(effects_at(at)); }
  Eigen::VectorXd simulated(const std::vector<machine::Effect>& effects) {
    try {
      response_.foresee(rows_.motions(), {&effects, 1});
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
  // A standard error of a parameter, within 1e-5 to a tenth of its size.
  double step_of(Eigen::Index i, const Eigen::VectorXd& at) const {
    const auto& free = free_[static_cast<std::size_t>(i)];
    const double error =
        free.unit * findings_[of_finding_[free.finding]].parameters[free.parameter].standard_errors[free.index];
    const double size = size_of(i, at);
    const double by = std::isfinite(error) && error > 0.0 ? error : 0.01 * size;
    return size > 0.0 ? std::clamp(by, 1e-5 * size, 0.1 * size) : by;
  }
  Eigen::VectorXd moved(const Eigen::VectorXd& at, Eigen::Index i) const {
    Eigen::VectorXd there = at;
    there[i] += step_of(i, at);
    return there;
  }
  // The places that a step may lead to.
  static std::vector<Eigen::VectorXd> halved(const Eigen::VectorXd& at, Eigen::VectorXd way) {
    std::vector<Eigen::VectorXd> places;
    for (int half = 0; half <= halvings; ++half, way *= 0.5) places.emplace_back(at + way);
    return places;
  }
  // Those from which the slopes are told.
  std::vector<Eigen::VectorXd> around(const Eigen::VectorXd& at) const {
    std::vector<Eigen::VectorXd> places;
    for (Eigen::Index i = 0; i < at.size(); ++i) places.push_back(moved(at, i));
    return places;
  }
  // Simulates at once what simulated() will be asked for.
  void foresee(const std::vector<Eigen::VectorXd>& places) {
    std::vector<std::vector<machine::Effect>> sets;
    for (const auto& at : places) sets.push_back(effects_at(at));
    try {
      response_.foresee(rows_.motions(), sets);
    } catch (const sim::EffectError&) {  // of one of them: each is asked by itself
    }
  }
  // By differences; none where the effect cannot have the value.
  Eigen::MatrixXd slopes_at(const Eigen::VectorXd& at, const Eigen::VectorXd& force) {
    foresee(around(at));
    Eigen::MatrixXd slopes(rows_.rows(), at.size());
    for (Eigen::Index i = 0; i < at.size(); ++i) {
      const double by = step_of(i, at);
      const auto there = simulated(moved(at, i));
      slopes.col(i) = there.allFinite() ? Eigen::VectorXd((there - force) / by) : Eigen::VectorXd::Zero(rows_.rows());
    }
    return slopes;
  }
  Evidence evidence_of(const Place& place) const {
    const auto longest = static_cast<std::size_t>(rows_.rows() / 60 + 1);
    Evidence evidence(target_ - place.force, blocks_of(rows_.velocity, rows_.logs(), longest));
    evidence.whiten(whitening_);
    std::vector<Eigen::VectorXd> columns;
    for (Eigen::Index i = 0; i < place.slopes.cols(); ++i) columns.emplace_back(place.slopes.col(i));
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
      finding.values.at(free_[i].key)[free_[i].index] = at[k];
      parameter.values[free_[i].index] = at[k] / free_[i].unit;
      auto& error = parameter.standard_errors[free_[i].index];
      error = std::max(error, std::sqrt(std::max(covariance(k, k), 0.0)) / free_[i].unit);
    }
  }

  std::vector<Finding> findings_;
  const machine::AxisModel& axis_;
  EffectResponse& response_;
  const LogRows& rows_;
  Eigen::VectorXd target_, left_;
  std::vector<machine::Effect> effects_;                // of the findings that are simulated
  std::vector<std::vector<machine::Effect>> starts_{};  // the same with other values
  std::vector<std::size_t> of_finding_;
  std::vector<Free> free_;
  Whitening whitening_;
};

}  // namespace

// What runs in silence do not know: a phase of each record, the session's clock, or a response under disturbances.
bool described_by_runs(const Term& term) {
  const auto& candidate = candidates()[term.candidate];
  return !candidate.outside() && !candidate.per_record && !candidate.through_session && !candidate.replays;
}

ClosedLoopRefinement refine_in_closed_loop(std::vector<Finding> findings, std::span<const Term> terms,
                                           std::span<EffectResponse> responses, const LogRows& rows,
                                           const Eigen::VectorXd& target, Eigen::VectorXd left,
                                           const SearchContext& context) {
  ClosedLoopRefinement best{findings, std::move(left)};
  double most = noise_log_likelihood(best.left, rows);
  for (std::size_t k = 0; k < responses.size(); ++k) {
    ClosedLoopFit fit(findings, terms, responses[k], rows, target, context);
    if (const double likelihood = fit.run(); likelihood > most) {
      most = likelihood;
      best = {fit.findings(), fit.left(), k};
    }
  }
  return best;
}

}  // namespace stiction::host
