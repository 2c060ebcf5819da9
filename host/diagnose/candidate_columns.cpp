#include "host/diagnose/candidate_columns.hpp"

namespace stiction::host {

std::vector<Eigen::VectorXd> group_columns(const LogRows& rows, const Scene& scene, const Candidate& candidate,
                                           double nonlinear) {
  const auto shared = shared_columns(rows, scene, candidate, nonlinear);
  if (!candidate.per_record) return shared;
  std::vector<Eigen::VectorXd> own;
  for (std::size_t r = 0; r < rows.logs().size(); ++r) {
    const auto begin = static_cast<Eigen::Index>(rows.logs()[r]);
    const auto end = r + 1 < rows.logs().size() ? static_cast<Eigen::Index>(rows.logs()[r + 1]) : rows.rows();
    for (const auto& column : shared) {
      own.emplace_back(Eigen::VectorXd::Zero(rows.rows()));
      own.back().segment(begin, end - begin) = column.segment(begin, end - begin);
    }
  }
  return own;
}

std::vector<Eigen::VectorXd> shared_columns(const LogRows& rows, const Scene& scene, const Candidate& candidate,
                                            double nonlinear) {
  std::vector<Columns> of_motion;
  for (const auto& motion : rows.motions()) of_motion.push_back(candidate.columns(scene, motion, nonlinear));
  std::vector<Eigen::VectorXd> stacked;
  for (std::size_t c = 0; c < of_motion.front().size(); ++c)
    stacked.push_back(rows.stacked([&](const Motion& motion) {
      const auto index = static_cast<std::size_t>(&motion - rows.motions().data());
      return of_motion[index][c];
    }));
  return stacked;
}

Eigen::VectorXd weighted_columns(const LogRows& rows, const Scene& scene, const Candidate& candidate, double nonlinear,
                                 const Eigen::VectorXd& weights) {
  const auto columns = group_columns(rows, scene, candidate, nonlinear);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(rows.rows());
  for (std::size_t c = 0; c < columns.size(); ++c) sum += weights[static_cast<Eigen::Index>(c)] * columns[c];
  return sum;
}

}  // namespace stiction::host
