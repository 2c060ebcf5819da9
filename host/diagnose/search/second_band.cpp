#include "host/diagnose/search/second_band.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "host/diagnose/classes/candidate_columns.hpp"
#include "host/diagnose/record/record_rows.hpp"
#include "host/diagnose/statistics/evidence.hpp"
#include "host/identify/filter.hpp"

namespace stiction::host {
namespace {

constexpr double edge = 30.0;             // Hz
constexpr int filter_order = 4;           // each way
constexpr double least_certain = 0.25;    // standard error of a ratio from which on the band says nothing
constexpr double contradiction = 3.0;     // standard errors
constexpr double least_difference = 0.1;  // of the size

Eigen::VectorXd below_edge(const LogRows& rows, const Eigen::VectorXd& column) {
  Eigen::VectorXd filtered(column.size());
  for (std::size_t k = 0; k < rows.logs().size(); ++k) {
    const std::size_t begin = rows.logs()[k];
    const std::size_t end = rows.end(k);
    const auto lowpass = butterworth(filter_order, 2.0 * edge * rows.period(k));
    const auto part = filter_both_ways(lowpass, {column.data() + begin, end - begin}, default_padding(lowpass));
    std::copy(part.begin(), part.end(), filtered.data() + begin);
  }
  return filtered;
}

}  // namespace

void compare_bands(Verdict& verdict, std::span<const Term> terms, const LogRows& rows, const Eigen::VectorXd& target,
                   const SearchContext& context) {
  if (terms.empty()) return;
  for (std::size_t k = 0; k < rows.logs().size(); ++k)
    if (2.0 * edge * rows.period(k) >= 0.9) return;  // the rows hold no more than this band
  std::vector<Eigen::VectorXd> forces;
  for (const auto& term : terms)
    forces.push_back(
        below_edge(rows, weighted_columns(rows, context, candidates()[term.candidate], term.shape, term.coefficients)));
  Evidence evidence(below_edge(rows, target),
                    blocks_of(rows.velocity, rows.logs(), static_cast<std::size_t>(rows.rows() / 60 + 1)));
  evidence.add(forces);
  ColumnIndices all(terms.size());
  std::iota(all.begin(), all.end(), 0);
  const auto ratios = evidence.fit(all).coefficients;
  const auto covariance = evidence.covariance(all, ratios);
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const double ratio = ratios[i], error = std::sqrt(covariance(i, i));
    if (!(error < least_certain)) continue;
    auto& finding = verdict.findings[k];
    finding.evidence +=
        fmt::format(" Amplitude below {:g} Hz: {:.2f} of the fitted one, with a 95 % interval of +- {:.2f}.", edge,
                    ratio, 2.0 * error);
    if (std::abs(ratio - 1.0) > std::max(contradiction * error, least_difference))
      verdict.notes.push_back(fmt::format(
          "{} depends on the frequency band: its amplitude below {:g} Hz is {:.2f} of that up to {:.0f} Hz, "
          "with a 95 % interval of +- {:.2f}. This cause does not depend on frequency by definition, which "
          "indicates an additional one that does, such as a delay or an elastic part.",
          finding.effect.name(), edge, ratio, end_of_band(context.signals), 2.0 * error));
  }
}

}  // namespace stiction::host
