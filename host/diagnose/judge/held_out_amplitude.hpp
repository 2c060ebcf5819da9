// How much of a force that some records showed others show again.
#pragma once

#include <Eigen/Dense>
#include <span>

#include "host/diagnose/statistics/level.hpp"
#include "host/identify/regression.hpp"

namespace stiction::host {

struct HeldOutAmplitude {
  double size = 0.0;       // 1: as large again; about 0 of what fitted the first records' noise alone
  double deviation = 0.0;  // standard error of that; 0: the force does not act in these records
  // Twice the logarithm of how much better the records agree with none of the force than with all of it (Kass, Raftery,
  // J. Am. Stat. Assoc. 90, 1995: beyond 6 strongly); 0 where it does not act.
  double against() const { return deviation > 0.0 ? (1.0 - 2.0 * size) / (deviation * deviation) : 0.0; }
  // Whether they may show the full size: noise takes a true one further down in the level of the design.
  bool may_be_all() const { return 1.0 - size <= normal_exceeded_at_level * deviation; }
};

// `force`, `residual`: N, of rows, the second with the force still in it; `logs`: first row of each log; `blocks`:
// pieces of evidence. The standard error is the larger of two: by blocks, which knows where the noise is large; and by
// what the force finds in the rest of each log when that is turned round by a part of its length (time-shifted
// surrogates: Andrzejak et al., Phys. Rev. E 68, 2003), which knows how long a slow noise keeps its sign.
HeldOutAmplitude repetition_of(const Eigen::VectorXd& force, const Eigen::VectorXd& residual,
                               std::span<const std::size_t> logs, std::span<const RowBlock> blocks);

}  // namespace stiction::host
