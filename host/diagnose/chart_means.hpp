// Means of a quantity in ranges of another, as series of a chart.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>
#include <string>

#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

// Mean of `values` in equally filled ranges of `over` (times `scale` in the chart).
inline sim::Series means(std::string name, const Eigen::VectorXd& over, double scale, const Eigen::VectorXd& values,
                         std::size_t ranges = 60) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(over.size()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return over[a] < over[b]; });
  sim::Series series{.name = std::move(name), .x = {}, .y = {}};
  for (std::size_t k = 0; k < ranges; ++k) {
    const std::size_t from = order.size() * k / ranges, to = order.size() * (k + 1) / ranges;
    if (to == from) continue;
    double x = 0.0, y = 0.0;
    for (std::size_t i = from; i < to; ++i) {
      x += over[order[i]] / static_cast<double>(to - from);
      y += values[order[i]] / static_cast<double>(to - from);
    }
    series.x.push_back(scale * x);
    series.y.push_back(y);
  }
  return series;
}

}  // namespace stiction::host
