// Means of a quantity in ranges of another, as series of a chart.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>
#include <string>

#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

// Mean of `values` in equally filled ranges of `over` (times `scale` in the chart). `name` of the series.
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

// Mean of `values` in ranges of `over` of equal width: for what repeats along it. Ranges with fewer than three values
// are left away. `name` of the series; `scale`: of `over` in the chart.
inline sim::Series even_means(std::string name, const Eigen::VectorXd& over, double scale,
                              const Eigen::VectorXd& values, std::size_t ranges = 160) {
  const double low = over.minCoeff(), width = (over.maxCoeff() - low) / static_cast<double>(ranges);
  std::vector<double> sum(ranges, 0.0), count(ranges, 0.0);
  for (Eigen::Index i = 0; i < over.size(); ++i) {
    const auto k = std::min(static_cast<std::size_t>((over[i] - low) / std::max(width, 1e-300)), ranges - 1);
    sum[k] += values[i];
    count[k] += 1.0;
  }
  sim::Series series{.name = std::move(name), .x = {}, .y = {}};
  for (std::size_t k = 0; k < ranges; ++k) {
    if (count[k] < 3.0) continue;
    series.x.push_back(scale * (low + (static_cast<double>(k) + 0.5) * width));
    series.y.push_back(sum[k] / count[k]);
  }
  return series;
}

// The simulations of a diagnosis, in every chart by the same name and colour: of the machine file, and of the extended.
inline sim::Series of_machine_file(sim::Series series) {
  series.name = "machine file";
  series.role = sim::SeriesRole::before;
  return series;
}
inline sim::Series of_extended(sim::Series series) {
  series.name = "extended";
  series.role = sim::SeriesRole::after;
  return series;
}

}  // namespace stiction::host
