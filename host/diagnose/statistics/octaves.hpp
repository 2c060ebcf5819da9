// Powers of rows by octave of frequency, counted down from half their rate.
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <span>
#include <vector>

namespace stiction::host {

class Octaves {
 public:
  // Of no rows.
  Octaves() = default;
  // For `rows` of several logs; `logs`: first row of each.
  Octaves(std::span<const std::size_t> logs, Eigen::Index rows);

  using Powers = std::vector<double>;  // of each octave, the highest first
  std::size_t count() const { return count_; }
  // Squares of the `values`, one a row, summed over all rows.
  Powers of(const Eigen::VectorXd& values) const;
  // The `values` with each octave times its gain.
  Eigen::VectorXd scaled(const Eigen::VectorXd& values, const Powers& gains) const;

 private:
  std::vector<std::size_t> logs_;
  std::size_t count_ = 1;
};

}  // namespace stiction::host
