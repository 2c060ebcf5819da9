#include "host/diagnose/search/judgement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/diagnose/classes/candidate.hpp"

namespace stiction::host {
namespace {

// Over the number of candidates; held-out data have the last word.
constexpr double significance = 0.05, nearly_significant = 0.1;
constexpr double least_gain = 0.01;  // of the cross-validated residual
// What is beyond doubt may be smaller: an elastic mode shows in a few accelerations of a whitened record.
constexpr double beyond_doubt = 1e-3;      // of the limit of the p-value
constexpr double least_sure_gain = 0.003;  // of the cross-validated residual

// What columns take off the cross-validated residual.
struct CrossValidated {
  double gain = 0.0;  // share
  bool odd = false;   // owed to one block in fifty: one odd event names no cause
};

// `own`: the last of `with`. Beside the fiftieth of the blocks that gain most, the others must gain a fifth of what is
// expected of them: a saturation shows in a few accelerations, but in all of those.
CrossValidated cross_validate(const Evidence& evidence, const ColumnIndices& without, const ColumnIndices& with,
                              const ColumnIndices& own) {
  constexpr double least_expected = 0.02;  // of the force's square: no cause is named by one event alone
  auto gains = evidence.held_out(without);
  const auto left = evidence.held_out(with);
  const double before = std::accumulate(gains.begin(), gains.end(), 0.0);
  for (std::size_t k = 0; k < gains.size(); ++k) gains[k] -= left[k];
  const double gained = std::accumulate(gains.begin(), gains.end(), 0.0);
  const auto expected =
      evidence.bearing(own, evidence.fit(with).coefficients.tail(static_cast<Eigen::Index>(own.size())));
  std::vector<std::size_t> order(gains.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return gains[a] < gains[b]; });
  const auto others = order.size() - std::max<std::size_t>(1, order.size() / 50);
  double gained_there = 0.0, expected_there = 0.0;
  for (std::size_t k = 0; k < others; ++k) gained_there += gains[order[k]], expected_there += expected[order[k]];
  expected_there /= std::max(std::accumulate(expected.begin(), expected.end(), 0.0), 1e-300);
  return {gained / before, expected_there < least_expected || !(gained_there > 0.2 * expected_there * gained)};
}

// The columns' size along their weights of all rows, over that, from the blocks in use; `own` are the last of `with`.
double size_in(const Evidence& evidence, const std::vector<bool>& use, const ColumnIndices& with,
               const ColumnIndices& own, const Eigen::VectorXd& coefficients) {
  const auto part = evidence.fit(with, use).coefficients;
  // In the metric of the columns' lengths.
  double product = 0.0, square = 0.0;
  for (std::size_t k = 0; k < own.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(with.size() - own.size() + k);
    if (part[i] == 0.0) continue;  // weights of a record that has no rows in use
    const double length = evidence.column_square(own[k]);
    product += length * part[i] * coefficients[i];
    square += length * coefficients[i] * coefficients[i];
  }
  return square > 0.0 ? product / square : 0.0;
}

// Whether a half of the blocks, which should find the size 1, contradicts it: it finds less than nothing, and its share
// of what bears on the columns lets it know better.
bool contradicts(double size, const std::vector<double>& bearing, const std::vector<bool>& half, double deviations) {
  double all = 0.0, own = 0.0;
  for (std::size_t b = 0; b < bearing.size(); ++b) {
    all += bearing[b];
    if (half[b]) own += bearing[b];
  }
  const double error = 1.0 / (deviations * std::sqrt(std::max(own / all, 1e-12)));
  return size < std::min(0.0, 1.0 - 3.0 * error);
}

}  // namespace

Judgement judge_columns(const Evidence& evidence, const Evidence& plain, const ColumnIndices& others,
                        const ColumnIndices& own, double trials) {
  Judgement result;
  auto with = others;
  with.insert(with.end(), own.begin(), own.end());
  const auto coefficients = evidence.fit(with).coefficients;
  const auto count = static_cast<Eigen::Index>(own.size()), first_own = static_cast<Eigen::Index>(others.size());
  const auto test = evidence.test(with, coefficients, first_own, count);
  result.p_value = std::min(1.0, trials * test.p_value);

  // Off the force itself, or off what whitening leaves of it: a wave of minutes is much of the first and little of the
  // second, a push of milliseconds the other way round.
  const auto white = cross_validate(evidence, others, with, own), as_is = cross_validate(plain, others, with, own);
  const auto& larger = white.gain > as_is.gain ? white : as_is;
  result.gain = larger.gain;

  std::vector<bool> first(evidence.blocks()), second(evidence.blocks());
  for (std::size_t k = 0; k < first.size(); ++k) second[k] = !(first[k] = k < first.size() / 2);
  result.first_half = size_in(evidence, first, with, own, coefficients);
  result.second_half = size_in(evidence, second, with, own, coefficients);

  const auto bearing = evidence.bearing(own, coefficients.tail(count));
  const double deviations = std::sqrt(test.wald * static_cast<double>(count));

  const double among = static_cast<double>(candidates().size()), limit = significance / among;
  result.nearly = result.p_value >= limit && result.p_value < nearly_significant / among;
  if (!(result.p_value < limit))
    result.rejection_reason = fmt::format("not significant: p = {:.2g}, expected below {:.2g}", result.p_value, limit);
  else if (const double least = result.p_value < beyond_doubt * limit ? least_sure_gain : least_gain;
           !(result.gain > least))
    result.rejection_reason = fmt::format("reduces the cross-validated residual by {:.2g} %; expected more than {:g} %",
                                          100.0 * result.gain, 100.0 * least);
  else if (larger.odd)
    result.rejection_reason = fmt::format(
        "a fiftieth of the {} blocks of rows causes nearly all of the improvement, which indicates a single event",
        evidence.blocks());
  else if (contradicts(result.first_half, bearing, first, deviations) ||
           contradicts(result.second_half, bearing, second, deviations))
    result.rejection_reason = "the two halves of the records contradict each other";
  return result;
}

}  // namespace stiction::host
