// Forces with a residual's spectrum: what else acts on an axis while an effect does. Within an increment of its
// position controller an axis hunts, and a gap smaller than that shows in how it does: a run in silence always hunts
// the same way, a record never does. What they have in common is the mean over runs under such forces.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/diagnose/statistics/whitening.hpp"

namespace stiction::host {

class Disturbance {
 public:
  // None.
  Disturbance() = default;
  // `residual`: N, in rows of several logs, 0 in those that do not count, `period` s apart; `logs`: first row of each.
  // Of one that comes in bursts, its quieter half: what bursts is an effect.
  Disturbance(const Eigen::VectorXd& residual, std::span<const std::size_t> logs, double period);

  explicit operator bool() const { return deviation_ > 0.0; }
  double mean_square() const { return mean_square_; }  // N^2
  // N at the times `t` (s, rising): one draw of many, by `seed`; linear between rows.
  std::vector<double> drawn(std::span<const double> t, std::uint64_t seed) const;

 private:
  Whitening spectrum_;
  double mean_square_ = 0.0;
  double deviation_ = 0.0;  // N, of what is left of the residual once it is white
  double period_ = 0.0;     // s
};

}  // namespace stiction::host
