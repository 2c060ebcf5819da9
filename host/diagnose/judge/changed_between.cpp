#include "host/diagnose/judge/changed_between.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/algebra/least_squares.hpp"
#include "host/diagnose/classes/candidate_columns.hpp"
#include "host/diagnose/statistics/fisher.hpp"
#include "host/diagnose/statistics/whitening.hpp"
#include "host/identify/regression.hpp"

namespace stiction::host {
namespace {

// For all parameters together (Bonferroni).
constexpr double level = 0.01;
// Of the held-out force, rms: what moves it by less changes no judgement.
constexpr double relevant = 0.01;

// What a day or a workpiece changes, of what this axis has.
std::vector<std::size_t> state_candidates(const SearchContext& context) {
  std::vector<std::size_t> all;
  for (std::size_t k = 0; k < candidates().size(); ++k)
    if (candidates()[k].of_state && !candidates()[k].grid(context).empty()) all.push_back(k);
  return all;
}

// Its column (N per unit of weight) in the rows.
Eigen::VectorXd column_of(const LogRows& rows, const SearchContext& context, std::size_t candidate) {
  const auto& each = candidates()[candidate];
  return shared_columns(rows, context, each, each.grid(context).front()).front();
}

Eigen::VectorXd behind(const Eigen::VectorXd& first, const Eigen::VectorXd& second) {
  Eigen::VectorXd both(first.size() + second.size());
  both << first, second;
  return both;
}

std::vector<std::size_t> behind(std::vector<std::size_t> first, const std::vector<std::size_t>& second,
                                Eigen::Index rows) {
  for (const auto begin : second) first.push_back(begin + static_cast<std::size_t>(rows));
  return first;
}

struct Difference {
  double weight = 0.0, square = 0.0;  // of its error
  double deviations() const { return square > 0.0 ? weight / std::sqrt(square) : 0.0; }
};

// White rows of some records with a column a parameter.
struct WhiteRows {
  Eigen::MatrixXd columns;
  Eigen::VectorXd force;
  std::vector<std::size_t> logs;  // first row of each
  std::vector<RowBlock> blocks;

  std::size_t end(std::size_t log) const {
    return log + 1 < logs.size() ? logs[log + 1] : static_cast<std::size_t>(force.size());
  }
  // A column in the rows of the logs from `first` to `last` alone.
  Eigen::VectorXd in_logs(Eigen::Index column, std::size_t first, std::size_t last) const {
    Eigen::VectorXd part = Eigen::VectorXd::Zero(force.size());
    const auto begin = static_cast<Eigen::Index>(logs[first]);
    const auto length = static_cast<Eigen::Index>(end(last)) - begin;
    part.segment(begin, length) = columns.col(column).segment(begin, length);
    return part;
  }
};

// Of the blocks in the logs from `first` on: each is one piece of evidence.
double freedom_of(const WhiteRows& rows, std::size_t first) {
  const auto blocks = std::count_if(rows.blocks.begin(), rows.blocks.end(),
                                    [&](const RowBlock& block) { return block.begin >= rows.logs[first]; });
  return static_cast<double>(std::max<std::ptrdiff_t>(blocks - 1, 1));
}

// The weight of `column` beside those of `others`, and its error from the blocks' sums (Cameron, Gelbach, Miller 2008).
Difference difference(const WhiteRows& rows, const Eigen::MatrixXd& others, const Eigen::VectorXd& column) {
  const PivotedLeastSquares solver(others);
  const Eigen::VectorXd own = column - others * solver.solve(column);
  const double square = own.squaredNorm();
  // What the others hold to their last digits says nothing of its own.
  if (square < 1e-6 * column.squaredNorm() || square == 0.0) return {};
  const Eigen::VectorXd left = rows.force - others * solver.solve(rows.force);
  Difference found{own.dot(left) / square, 0.0};
  const Eigen::VectorXd score = own.cwiseProduct(left - found.weight * own);
  for (const auto& block : rows.blocks) {
    const double sum =
        score.segment(static_cast<Eigen::Index>(block.begin), static_cast<Eigen::Index>(block.end - block.begin)).sum();
    found.square += sum * sum / (square * square);
  }
  return found;
}

// By how much more than by chance one of the first `training` logs differs from the others of them, mean square. A log
// that hardly tells the parameter says little of it (DerSimonian, Laird 1986).
double scatter_among(const WhiteRows& rows, std::size_t training, Eigen::Index column) {
  // The held-out logs have weights of their own, and say nothing here.
  const auto count = rows.columns.cols();
  Eigen::MatrixXd others(rows.force.size(), 2 * count);
  others.leftCols(count) = rows.columns;
  for (Eigen::Index c = 0; c < count; ++c) others.col(count + c) = rows.in_logs(c, training, rows.logs.size() - 1);
  double logs = 0.0, sum = 0.0, squares = 0.0, first = 0.0, second = 0.0;
  for (std::size_t log = 0; training > 1 && log < training; ++log) {
    const auto own = difference(rows, others, rows.in_logs(column, log, log));
    if (own.square <= 0.0) continue;
    const double precision = 1.0 / own.square;
    logs += 1.0;
    sum += precision;
    squares += precision * precision;
    first += precision * own.weight;
    second += precision * own.weight * own.weight;
  }
  const double spread = sum > 0.0 ? sum - squares / sum : 0.0;
  return spread > 0.0 ? std::max((second - first * first / sum - (logs - 1.0)) / spread, 0.0) : 0.0;
}

}  // namespace

std::vector<StateChange> changes_between(const StateRows& training, const StateRows& held_out,
                                         const SearchContext& context, std::span<const Term> terms) {
  const auto parameters = state_candidates(context);
  const auto count = static_cast<Eigen::Index>(parameters.size());
  const auto logs = behind(training.rows.logs(), held_out.rows.logs(), training.rows.rows());
  const std::size_t first = training.rows.logs().size();  // held-out log
  std::vector<Eigen::VectorXd> of_held_out;
  Eigen::MatrixXd columns(training.rows.rows() + held_out.rows.rows(), count);
  for (Eigen::Index c = 0; c < count; ++c) {
    const auto candidate = parameters[static_cast<std::size_t>(c)];
    of_held_out.push_back(column_of(held_out.rows, context, candidate));
    columns.col(c) = behind(column_of(training.rows, context, candidate), of_held_out.back());
  }
  const Eigen::VectorXd force =
      behind(training.left.cwiseProduct(training.rows.counts()), held_out.left.cwiseProduct(held_out.rows.counts()));
  const Eigen::VectorXd common = PivotedLeastSquares(columns).solve(force);
  const Whitening whitening(force - columns * common, logs, Memory::of_spans);
  WhiteRows white{columns, whitening(force), logs, {}};
  for (Eigen::Index c = 0; c < count; ++c) white.columns.col(c) = whitening(columns.col(c));
  const Eigen::VectorXd velocity = behind(training.rows.velocity, held_out.rows.velocity);
  white.blocks = blocks_of(velocity, logs, static_cast<std::size_t>(velocity.size() / 60 + 1));

  const double least = relevant * rms(held_out.rows.force.cwiseProduct(held_out.rows.counts()));
  const double freedom = freedom_of(white, first);
  std::vector<StateChange> changes;
  Eigen::MatrixXd others = white.columns;
  std::vector<bool> taken(parameters.size(), false);
  for (std::size_t round = 0; round < parameters.size(); ++round) {
    // The surest of those that matter; the others are asked again beside it.
    std::optional<std::size_t> surest;
    Difference most;
    for (std::size_t c = 0; c < parameters.size(); ++c) {
      if (taken[c]) continue;
      const auto column = static_cast<Eigen::Index>(c);
      auto found = difference(white, others, white.in_logs(column, first, logs.size() - 1));
      if (std::abs(found.weight) * rms(of_held_out[c]) < least) continue;
      found.square += scatter_among(white, first, column);
      if (std::abs(found.deviations()) <= std::abs(most.deviations())) continue;
      if (student_tails(found.deviations(), freedom) > level / static_cast<double>(parameters.size())) continue;
      surest = c;
      most = found;
    }
    if (!surest) break;
    taken[*surest] = true;
    others.conservativeResize(Eigen::NoChange, others.cols() + 1);
    others.rightCols(1) = white.in_logs(static_cast<Eigen::Index>(*surest), first, logs.size() - 1);
    changes.push_back({parameters[*surest], 0.0, 0.0, std::sqrt(most.square), {}});
  }
  if (changes.empty()) return changes;
  // All together, beside one another.
  const Eigen::VectorXd weights = PivotedLeastSquares(others).solve(white.force);
  for (std::size_t k = 0; k < changes.size(); ++k) {
    auto& change = changes[k];
    const auto at = static_cast<std::size_t>(std::find(parameters.begin(), parameters.end(), change.candidate) -
                                             parameters.begin());
    for (const auto& term : terms)
      if (term.candidate == change.candidate) change.training = term.coefficients[0];
    change.training += weights[static_cast<Eigen::Index>(at)];
    const double more = weights[count + static_cast<Eigen::Index>(k)];
    change.held_out = change.training + more;
    change.force = more * of_held_out[at];
  }
  return changes;
}

ChangedParameter changed_parameter(const SearchContext& context, const StateChange& change) {
  const auto& candidate = candidates()[change.candidate];
  const auto described = [&](double weight) {
    Finding finding(*candidate.effect);
    candidate.describe(context, candidate.grid(context).front(), Eigen::VectorXd::Constant(1, weight),
                       Eigen::MatrixXd::Constant(2, 2, change.error * change.error), finding);
    return finding.parameters.front();
  };
  const auto training = described(change.training), held_out = described(change.held_out);
  return {*candidate.effect,       training.key,
          training.unit,           training.values.front(),
          held_out.values.front(), held_out.standard_errors.front()};
}

}  // namespace stiction::host
