// Fewer samples of a record for drawing: see decimate.hpp.
#include "host/report/decimate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <stdexcept>

namespace stiction::host {
namespace {

constexpr double quarter = std::numbers::pi / 2.0;
// A glitch of 50 ms is 1.7 degrees wide at 3.2 m/min and 25 degrees at 48: the bins narrow to a twentieth at the
// reversal and to a tenth 2 degrees from it. Of 300 bins a lap one is 0.14 degrees wide there, 2.7 degrees far from it.
constexpr double glitch_density = 20.0;
constexpr double glitch_width = 2.0 * std::numbers::pi / 180.0;

// Bins a degree, up to a factor.
double density(double angle) {
  const double from_reversal = std::remainder(angle, quarter) / glitch_width;
  return 1.0 + glitch_density / (1.0 + from_reversal * from_reversal);
}

// First instant of each bin, and the end: every bin holds the same integral of the density.
std::vector<std::size_t> bin_edges(std::span<const double> angle, std::size_t bins) {
  std::vector<double> filled(angle.size(), 0.0);
  for (std::size_t i = 1; i < angle.size(); ++i) {
    const double step = std::remainder(angle[i] - angle[i - 1], 2.0 * std::numbers::pi);
    filled[i] = filled[i - 1] + std::abs(step) * density(angle[i - 1] + 0.5 * step);
  }
  std::vector<std::size_t> edges;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    const double begin = filled.back() * static_cast<double>(bin) / static_cast<double>(bins);
    edges.push_back(static_cast<std::size_t>(std::lower_bound(filled.begin(), filled.end(), begin) - filled.begin()));
  }
  edges.push_back(angle.size());
  return edges;
}

void sort_once(std::vector<std::size_t>& indices) {
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
}

std::vector<std::size_t> all_of(std::size_t size) {
  std::vector<std::size_t> all(size);
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

std::size_t farthest_from_mean(std::span<const double> channel, std::size_t begin, std::size_t end) {
  const auto bin = channel.subspan(begin, end - begin);
  const double mean = std::accumulate(bin.begin(), bin.end(), 0.0) / static_cast<double>(bin.size());
  const auto nearer = [&](double a, double b) { return std::abs(a - mean) < std::abs(b - mean); };
  return begin + static_cast<std::size_t>(std::max_element(bin.begin(), bin.end(), nearer) - bin.begin());
}

// The ends, the extremes of each channel, and one instant a bin and channel; instants that coincide count once.
std::vector<std::size_t> select_with(std::size_t bins, std::span<const double> angle,
                                     std::span<const std::span<const double>> channels) {
  std::vector<std::size_t> kept{0, angle.size() - 1};
  const auto edges = bin_edges(angle, bins);
  for (const auto& channel : channels) {
    const auto [low, high] = std::minmax_element(channel.begin(), channel.end());
    kept.push_back(static_cast<std::size_t>(low - channel.begin()));
    kept.push_back(static_cast<std::size_t>(high - channel.begin()));
    for (std::size_t bin = 0; bin + 1 < edges.size(); ++bin)
      if (edges[bin] < edges[bin + 1]) kept.push_back(farthest_from_mean(channel, edges[bin], edges[bin + 1]));
  }
  sort_once(kept);
  return kept;
}

// Appends the smallest and the largest finite value between two indices.
void keep_extremes(std::span<const double> values, std::size_t begin, std::size_t end, std::vector<std::size_t>& kept) {
  std::optional<std::size_t> low, high;
  for (std::size_t i = begin; i < end; ++i) {
    if (!std::isfinite(values[i])) continue;
    if (!low || values[i] < values[*low]) low = i;
    if (!high || values[i] > values[*high]) high = i;
  }
  if (low) kept.insert(kept.end(), {*low, *high});
}

}  // namespace

std::vector<std::size_t> select_instants(std::span<const double> angle,
                                         std::span<const std::span<const double>> channels, std::size_t limit) {
  for (const auto& channel : channels)
    if (channel.size() != angle.size()) throw std::invalid_argument("a lap's channels differ in length");
  if (limit < 3 * channels.size() + 2) throw std::invalid_argument("the limit leaves no instant for a bin");

  if (angle.size() <= limit || channels.empty()) return all_of(angle.size());
  // Where the channels are smooth, their extremes coincide at the bins' edges: more bins fit than in the worst case.
  std::size_t fits = (limit - 2 - 2 * channels.size()) / channels.size(), too_many = limit;
  auto kept = select_with(fits, angle, channels);
  while (too_many - fits > fits / 20 + 1) {
    const std::size_t bins = (fits + too_many) / 2;
    auto more = select_with(bins, angle, channels);
    if (more.size() > limit) {
      too_many = bins;
    } else {
      fits = bins;
      kept = std::move(more);
    }
  }
  return kept;
}

std::vector<std::size_t> select_extremes(std::span<const double> x, std::span<const double> y, std::size_t limit) {
  if (x.size() != y.size()) throw std::invalid_argument("a line's x and y differ in length");
  constexpr std::size_t per_bin = 5;  // extremes of y and of x, one gap
  if (limit < 2 + per_bin) throw std::invalid_argument("the limit leaves no point for a bin");
  if (x.size() <= limit) return all_of(x.size());

  const bool turns_back = !std::is_sorted(x.begin(), x.end()) && !std::is_sorted(x.rbegin(), x.rend());
  const auto is_gap = [&](std::size_t i) { return !std::isfinite(x[i]) || !std::isfinite(y[i]); };
  const auto indices = all_of(x.size());
  const bool has_gaps = std::any_of(indices.begin(), indices.end(), is_gap);
  const std::size_t bins = (limit - 2) / (2 + (turns_back ? 2 : 0) + (has_gaps ? 1 : 0));
  std::vector<std::size_t> kept{0, x.size() - 1};
  for (std::size_t bin = 0; bin < bins; ++bin) {
    const std::size_t begin = x.size() * bin / bins, end = x.size() * (bin + 1) / bins;
    keep_extremes(y, begin, end, kept);
    if (turns_back) keep_extremes(x, begin, end, kept);
    const auto gap = std::find_if(indices.begin() + static_cast<std::ptrdiff_t>(begin),
                                  indices.begin() + static_cast<std::ptrdiff_t>(end), is_gap);
    if (gap != indices.begin() + static_cast<std::ptrdiff_t>(end)) kept.push_back(*gap);
  }
  sort_once(kept);
  return kept;
}

}  // namespace stiction::host
