#include "host/diagnose/judge/left_out.hpp"

#include <algorithm>

namespace stiction::host {
namespace {

// Each costs a search.
constexpr std::size_t most_parts = 4;

// The rows, and none that counts of the logs number `part`, `part` + `parts`, ...
LogRows rows_without(const LogRows& rows, std::size_t part, std::size_t parts) {
  Eigen::VectorXd counts = rows.counts();
  for (std::size_t log = part; log < rows.logs().size(); log += parts) {
    const auto begin = static_cast<Eigen::Index>(rows.logs()[log]);
    counts.segment(begin, static_cast<Eigen::Index>(rows.end(log)) - begin).setZero();
  }
  LogRows kept = rows;
  kept.weigh(std::move(counts));
  return kept;
}

}  // namespace

std::vector<NamedIn> named_without_each_log(const LogRows& rows, const Eigen::VectorXd& target,
                                            const SearchContext& context, const std::vector<Term>& terms) {
  const std::size_t parts = std::min(rows.logs().size(), most_parts);
  if (parts < 2 || terms.empty()) return {};
  std::vector<NamedIn> named(terms.size(), NamedIn{0, parts});
  for (std::size_t part = 0; part < parts; ++part) {
    const auto kept = rows_without(rows, part, parts);
    SearchContext own = context;
    static_cast<Scans&>(own) = Scans{};
    own.disturb = nullptr;  // which would change what the search that found the terms has
    own.exact_records = nullptr;
    const auto found = search_causes(kept, target.cwiseProduct(kept.counts()), own);
    for (std::size_t k = 0; k < terms.size(); ++k)
      named[k].named += std::any_of(found.terms.begin(), found.terms.end(),
                                    [&](const Term& term) { return one_cause(term.candidate, terms[k].candidate); });
  }
  return named;
}

}  // namespace stiction::host
