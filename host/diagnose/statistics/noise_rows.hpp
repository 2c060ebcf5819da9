// The rows of a residual as its noise has them. At rest friction holds the axis: what wanders there moves nothing, and
// its spectrum is another one than that of the axis in motion.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "host/identify/log_rows.hpp"

namespace stiction::host {

struct NoiseRows {
  NoiseRows(const LogRows& rows) : logs(rows.logs()), at_rest(rows.at_rest()) {}
  // `of_logs`: first row of each; all rows are alike.
  NoiseRows(std::span<const std::size_t> of_logs) : logs(of_logs) {}
  NoiseRows(const std::vector<std::size_t>& of_logs) : logs(of_logs) {}

  std::span<const std::size_t> logs;  // first row of each
  std::span<const double> at_rest;    // 1 for a row at rest, else 0; empty: all rows are alike
};

// Behind the last row of log number `log`. `logs`: first row of each; `rows`: of all.
inline std::size_t end_of(std::span<const std::size_t> logs, std::size_t log, Eigen::Index rows) {
  return log + 1 < logs.size() ? logs[log + 1] : static_cast<std::size_t>(rows);
}

}  // namespace stiction::host
