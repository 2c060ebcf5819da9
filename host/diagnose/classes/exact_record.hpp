// One record of a machine that is exactly as its file says, and many.
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "host/identify/log_rows.hpp"

namespace stiction::host {

struct ExactRecord {
  Eigen::VectorXd target;             // N, of the rows: what the file does not make of its force
  std::optional<LogRows> regressors;  // where they are not those of the record that it is like
};
// One of many draws, by its number; none where the machine cannot follow under the forces that were drawn.
using ExactRecords = std::function<std::optional<ExactRecord>(std::size_t)>;

// Those of the draws from `begin` to `end` that the machine can follow, in their order, made on all cores. `records`
// may be asked from several threads.
std::vector<ExactRecord> draw(const ExactRecords& records, std::size_t begin, std::size_t end);

}  // namespace stiction::host
