#include "host/diagnose/classes/candidate_columns.hpp"

#include <iterator>
#include <utility>

namespace stiction::host {

namespace {

// Of each trial.
std::vector<std::vector<Eigen::VectorXd>> shared(const LogRows& rows, const SearchContext& context,
                                                 const std::vector<CandidateAt>& trials) {
  std::vector<std::size_t> counts;
  auto all = rows.stacked_together([&](const Motion& motion) {
    Columns columns;
    counts.clear();
    for (const auto& trial : trials) {
      auto own = trial.candidate->columns(context, motion, trial.shape);
      counts.push_back(own.size());
      std::move(own.begin(), own.end(), std::back_inserter(columns));
    }
    return columns;
  });
  std::vector<std::vector<Eigen::VectorXd>> groups;
  auto next = all.begin();
  for (const std::size_t count : counts) {
    const auto end = next + static_cast<std::ptrdiff_t>(count);
    groups.emplace_back(std::make_move_iterator(next), std::make_move_iterator(end));
    next = end;
  }
  return groups;
}

// In the rows of each record by themselves.
std::vector<Eigen::VectorXd> by_record(const LogRows& rows, const std::vector<Eigen::VectorXd>& shared) {
  std::vector<Eigen::VectorXd> own;
  for (std::size_t r = 0; r < rows.logs().size(); ++r) {
    const auto begin = static_cast<Eigen::Index>(rows.logs()[r]);
    const auto end = static_cast<Eigen::Index>(rows.end(r));
    for (const auto& column : shared) {
      own.emplace_back(Eigen::VectorXd::Zero(rows.rows()));
      own.back().segment(begin, end - begin) = column.segment(begin, end - begin);
    }
  }
  return own;
}

}  // namespace

std::vector<Eigen::VectorXd> shared_columns(const LogRows& rows, const SearchContext& context,
                                            const Candidate& candidate, double shape) {
  return std::move(shared(rows, context, {{&candidate, shape}}).front());
}

std::vector<Eigen::VectorXd> group_columns(const LogRows& rows, const SearchContext& context,
                                           const Candidate& candidate, double shape) {
  return std::move(group_columns(rows, context, {{&candidate, shape}}).front());
}

std::vector<std::vector<Eigen::VectorXd>> group_columns(const LogRows& rows, const SearchContext& context,
                                                        const std::vector<CandidateAt>& trials) {
  auto groups = shared(rows, context, trials);
  for (std::size_t k = 0; k < groups.size(); ++k)
    if (trials[k].candidate->per_record) groups[k] = by_record(rows, groups[k]);
  return groups;
}

Eigen::VectorXd weighted_columns(const LogRows& rows, const SearchContext& context, const Candidate& candidate,
                                 double shape, const Eigen::VectorXd& coefficients) {
  const auto columns = group_columns(rows, context, candidate, shape);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(rows.rows());
  for (std::size_t c = 0; c < columns.size(); ++c) sum += coefficients[static_cast<Eigen::Index>(c)] * columns[c];
  return sum;
}

}  // namespace stiction::host
