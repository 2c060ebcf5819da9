// What of a residual force acted on the axis, by frequency. A force on the carriage moves it as well: the position is
// the second sensor of every force. The noise of a current's sensor is in the record alone; and in a limit
// cycle a small force is enough for a large residual, since no run of the file is in it as the record was.
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <span>

#include "host/diagnose/statistics/octaves.hpp"

namespace stiction::host {

class ForceOnAxis {
 public:
  // All of every force.
  ForceOnAxis() = default;
  // Before anything is known of the residual: all of it. `residual`: N, and `speed`: m/s, what of the record's speed
  // the file's own run has not; both in rows of several logs, 0 in those that do not count; `logs`: first row of each.
  ForceOnAxis(const Eigen::VectorXd& residual, const Eigen::VectorXd& speed, std::span<const std::size_t> logs);

  struct Parts {
    Eigen::VectorXd on_axis;      // N, of the rows
    Eigen::VectorXd in_record{};  // N, likewise, which moved nothing; empty: none
  };
  // The parts of a `force`, N of the same rows: in each octave no more than there is of the residual.
  Parts parts_of(const Eigen::VectorXd& force) const;

  // What an exact machine makes of such a force: m/s and N, of the rows, beyond the file's own run.
  struct Answer {
    Eigen::VectorXd speed, left;
  };
  // Exact machines under the first part of the residual made these `answers`: in octaves in which they move more than
  // the record does, less of it acted.
  void take_answers(std::span<const Answer> answers);
  // The same, once that is known: what those leave less of than the record does is in the record alone.
  void take_remainders(std::span<const Answer> answers);

 private:
  Eigen::VectorXd limited(const Eigen::VectorXd& force, const Octaves::Powers& limits) const;

  Octaves octaves_;
  Octaves::Powers residual_, speed_;     // N^2, m^2/s^2, of the record; empty: nothing is known
  Octaves::Powers on_axis_, in_record_;  // N^2
};

}  // namespace stiction::host
