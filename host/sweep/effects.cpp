// Main effects and interactions as shares of variance: of what a figure varies by, how much is between the values of a
// key (Fisher's correlation ratio). Of rows that are drawn, chance alone gives a share of (levels - 1) / (rows - 1),
// which is taken off (Kelley 1935).
#include "host/sweep/effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace stiction::host {
namespace {

// Wide groups smooth what a figure does within them, narrow ones have few rows.
constexpr std::size_t groups_of_main(std::size_t rows) { return rows < 2000 ? 10 : 20; }
constexpr std::size_t groups_of_pairs = 5;
constexpr std::size_t most_interactions = 10;

// Which group each row belongs to.
struct Grouping {
  std::vector<std::uint32_t> of_row;
  std::size_t groups = 0;
  std::vector<std::string> names;
  std::vector<double> at;
};

// Groups of equal size by the numbers of a key.
Grouping by_rank(const std::vector<double>& numbers, std::size_t groups) {
  std::vector<std::uint32_t> order(numbers.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return numbers[a] != numbers[b] ? numbers[a] < numbers[b] : a < b;
  });
  Grouping result;
  result.groups = std::min(groups, numbers.size());
  result.of_row.resize(numbers.size());
  result.at.assign(result.groups, 0.0);
  std::vector<std::size_t> count(result.groups);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto group = k * result.groups / order.size();
    result.of_row[order[k]] = static_cast<std::uint32_t>(group);
    result.at[group] += numbers[order[k]];
    ++count[group];
  }
  for (std::size_t g = 0; g < result.groups; ++g) {
    result.at[g] /= static_cast<double>(count[g]);
    result.names.push_back(fmt::format("{:.4g}", result.at[g]));
  }
  return result;
}

Grouping by_value(const VariedKey& key) {
  Grouping result;
  result.of_row = key.levels;
  result.groups = key.names.size();
  result.names = key.names;
  result.at = key.at;
  return result;
}

Grouping grouping_of(const VariedKey& key, std::size_t groups) {
  if (key.drawn) return by_rank(key.numbers, groups);
  return by_value(key);
}

struct Means {
  std::vector<double> mean;
  std::vector<std::size_t> count;
};

// Of the rows that have the figure.
Means means_of(const std::vector<double>& figure, const Grouping& grouping) {
  Means means{std::vector<double>(grouping.groups), std::vector<std::size_t>(grouping.groups)};
  for (std::size_t k = 0; k < figure.size(); ++k) {
    if (!std::isfinite(figure[k])) continue;
    means.mean[grouping.of_row[k]] += figure[k];
    ++means.count[grouping.of_row[k]];
  }
  for (std::size_t g = 0; g < grouping.groups; ++g)
    means.mean[g] = means.count[g] > 0 ? means.mean[g] / static_cast<double>(means.count[g])
                                       : std::numeric_limits<double>::quiet_NaN();
  return means;
}

// The share of the variance about `mean`, whose sum of squares is `total`, that lies between the groups.
double share_between(const Means& means, double mean, double total, std::uint64_t rows, bool chance) {
  if (!(total > 0.0)) return 0.0;
  double between = 0.0;
  std::size_t groups = 0;
  for (std::size_t g = 0; g < means.mean.size(); ++g) {
    if (means.count[g] == 0) continue;
    between += static_cast<double>(means.count[g]) * (means.mean[g] - mean) * (means.mean[g] - mean);
    ++groups;
  }
  const double share = std::min(between / total, 1.0);
  if (!chance) return share;
  if (rows <= groups) return 0.0;
  return std::max(0.0, 1.0 - (1.0 - share) * static_cast<double>(rows - 1) / static_cast<double>(rows - groups));
}

Grouping crossed(const Grouping& one, const Grouping& other) {
  Grouping result;
  result.groups = one.groups * other.groups;
  result.of_row.resize(one.of_row.size());
  for (std::size_t k = 0; k < one.of_row.size(); ++k)
    result.of_row[k] = static_cast<std::uint32_t>(one.of_row[k] * other.groups + other.of_row[k]);
  return result;
}

}  // namespace

FigureEffects effects_on(const SweepFigure& figure, const std::vector<double>& values,
                         const std::vector<VariedKey>& keys) {
  FigureEffects result;
  result.figure = figure;
  result.least = std::numeric_limits<double>::infinity();
  result.most = -result.least;
  double sum = 0.0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    ++result.rows;
    sum += value;
    result.least = std::min(result.least, value);
    result.most = std::max(result.most, value);
  }
  if (result.rows == 0) {
    result.mean = result.deviation = result.least = result.most = std::numeric_limits<double>::quiet_NaN();
    return result;
  }
  result.mean = sum / static_cast<double>(result.rows);
  double total = 0.0;
  for (const double value : values)
    if (std::isfinite(value)) total += (value - result.mean) * (value - result.mean);
  result.deviation = result.rows > 1 ? std::sqrt(total / static_cast<double>(result.rows - 1)) : 0.0;
  // What is equal but for rounding does not vary.
  if (result.deviation <= 1e-12 * std::abs(result.mean)) total = 0.0;
  const bool chance = std::any_of(keys.begin(), keys.end(), [](const VariedKey& key) { return key.drawn; });
  std::vector<Grouping> pairs;
  std::vector<double> alone;
  for (const auto& key : keys) {
    const auto grouping = grouping_of(key, groups_of_main(values.size()));
    const auto means = means_of(values, grouping);
    result.main.push_back({key.column, share_between(means, result.mean, total, result.rows, chance), grouping.names,
                           grouping.at, means.mean});
    pairs.push_back(grouping_of(key, groups_of_pairs));
    alone.push_back(share_between(means_of(values, pairs.back()), result.mean, total, result.rows, chance));
  }
  for (std::size_t a = 0; a < keys.size(); ++a)
    for (std::size_t b = a + 1; b < keys.size(); ++b) {
      const auto both = crossed(pairs[a], pairs[b]);
      if (chance && both.groups * 2 > result.rows) continue;  // too few rows in each to tell
      const double share =
          share_between(means_of(values, both), result.mean, total, result.rows, chance) - alone[a] - alone[b];
      result.interactions.push_back({keys[a].column, keys[b].column, std::max(share, 0.0)});
    }
  const auto stronger = [](const auto& one, const auto& other) { return one.share > other.share; };
  std::stable_sort(result.main.begin(), result.main.end(), stronger);
  std::stable_sort(result.interactions.begin(), result.interactions.end(), stronger);
  if (result.interactions.size() > most_interactions) result.interactions.resize(most_interactions);
  return result;
}

std::vector<ParetoPoint> pareto_front(const std::vector<double>& first, const std::vector<double>& second,
                                      std::uint64_t stride) {
  std::vector<std::uint64_t> order;
  for (std::uint64_t k = 0; k < first.size(); ++k)
    if (std::isfinite(first[k]) && std::isfinite(second[k])) order.push_back(k);
  std::sort(order.begin(), order.end(), [&](std::uint64_t a, std::uint64_t b) {
    if (first[a] != first[b]) return first[a] < first[b];
    if (second[a] != second[b]) return second[a] < second[b];
    return a < b;
  });
  std::vector<ParetoPoint> front;
  double best = std::numeric_limits<double>::infinity();
  for (const auto k : order) {
    if (second[k] >= best) continue;
    best = second[k];
    front.push_back({k * stride, first[k], second[k]});
  }
  return front;
}

}  // namespace stiction::host
