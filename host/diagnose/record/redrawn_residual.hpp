// Forces that a residual could as well have been: its innovations with signs that are drawn, coloured as the residual
// is (the wild bootstrap of an autoregression: Wu 1986; Gonçalves, Kilian 2004). Where the residual is large these are
// too: set-points between the samples of a slow log are known least where the axis begins and ends to accelerate, and a
// cause that acts just there has to say more than that. Of a force that stays the loop leaves no motion: the mean of a
// log is no disturbance.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/diagnose/statistics/whitening.hpp"

namespace stiction::host {

class RedrawnResidual {
 public:
  // `residual`: N, in `rows`, 0 in those that do not count, `period` s apart; `time`: s, of each row, from its log's
  // start.
  RedrawnResidual(const Eigen::VectorXd& residual, const NoiseRows& rows, const Eigen::VectorXd& time, double period);

  // N at the times `t` (s, rising) of a `log`: one draw of many, by `seed`; linear between rows.
  std::vector<double> drawn(std::size_t log, std::span<const double> t, std::uint64_t seed) const;

 private:
  Whitening spectrum_;
  std::vector<Eigen::VectorXd> innovations_;  // N, of each log
  std::vector<std::size_t> first_;            // row of each log
  std::vector<double> begins_;                // s, of its first row
  double period_;                             // s
};

}  // namespace stiction::host
