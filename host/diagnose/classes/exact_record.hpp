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
  // m, at each sample of each motion as the encoder had it, where the regressors are those of that record.
  std::vector<std::vector<double>> read{};
  Eigen::VectorXd speed{};  // m/s, of the rows, beyond that of the file's own run; empty where the way is not known
};
// Those of the draws from a first one to behind a last one that the machine can follow under the forces that were
// drawn, in their order.
using ExactRecords = std::function<std::vector<ExactRecord>(std::size_t begin, std::size_t end)>;

}  // namespace stiction::host
