#include "host/log/uneven_clock.hpp"

#include <algorithm>
#include <cmath>

#include "host/log/statistics.hpp"

namespace stiction::host {
namespace {

constexpr std::ptrdiff_t beside = 10;    // steps on either side, of which the usual one is the median
constexpr std::size_t of_one_rate = 20;  // steps before and behind a change of rate
constexpr double least_gap = 1.5;        // of the usual step
constexpr double least_change = 0.1;     // of the rate
constexpr double sure = 6.0;             // standard deviations
// The median of n normal values has 1.25 standard deviations over the root of n; a difference of two the root of two.
const double change_error = 1.25 * std::sqrt(2.0 / static_cast<double>(of_one_rate));

double median_of(const std::vector<double>& values, std::ptrdiff_t begin, std::ptrdiff_t end,
                 std::vector<double>& scratch) {
  const auto size = static_cast<std::ptrdiff_t>(values.size());
  scratch.assign(values.begin() + std::clamp<std::ptrdiff_t>(begin, 0, size),
                 values.begin() + std::clamp<std::ptrdiff_t>(end, 0, size));
  return median(scratch);
}

// The last step before each change of rate.
std::vector<std::size_t> changes_of_rate(const std::vector<double>& steps, double spread) {
  std::vector<std::size_t> changes;
  std::vector<double> scratch;
  const double least = std::max(least_change, sure * change_error * spread);
  double most = 0.0;
  std::size_t at = 0;
  for (std::size_t k = of_one_rate; k + of_one_rate <= steps.size(); ++k) {
    const auto here = static_cast<std::ptrdiff_t>(k);
    const double before = median_of(steps, here - std::ptrdiff_t{of_one_rate}, here, scratch);
    const double behind = median_of(steps, here, here + std::ptrdiff_t{of_one_rate}, scratch);
    // The medians differ alike over half a window; the steps right here tell the place.
    const double change = std::abs(std::log(behind / before));
    const double here_too = std::abs(std::log(steps[k] / steps[k - 1]));
    if (change > least && here_too > 0.5 * change && here_too >= most) most = here_too, at = k;
    if (at > 0 && (change <= least || k + of_one_rate == steps.size())) {
      changes.push_back(at - 1);
      at = 0;
      most = 0.0;
    }
  }
  return changes;
}

}  // namespace

std::vector<Segment> segments_of(std::span<const double> t, const StampDigits& digits) {
  std::vector<double> steps(t.size() - 1), usual(steps.size()), off(steps.size()), scratch;
  for (std::size_t k = 0; k < steps.size(); ++k) steps[k] = t[k + 1] - t[k];
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const auto here = static_cast<std::ptrdiff_t>(k);
    usual[k] = median_of(steps, here - beside, here + beside + 1, scratch);
    off[k] = std::abs(steps[k] / usual[k] - 1.0);
  }
  const double spread = 1.4826 * median(off);  // relative standard deviation of the steps
  std::vector<std::size_t> breaks = changes_of_rate(steps, spread);
  const double allowed = std::max(least_gap, 1.0 + sure * spread);
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const double rounding = digits.resolution_at(t[k]);
    // Stamps coarser than half a step can only be whole steps: rounding explains nothing then.
    if (steps[k] > allowed * usual[k] + (rounding <= 0.5 * usual[k] ? rounding : 0.0)) breaks.push_back(k);
  }
  std::ranges::sort(breaks);
  std::vector<Segment> segments;
  std::size_t begin = 0;
  for (const std::size_t k : breaks) {
    if (k + 1 == begin) continue;
    segments.push_back({begin, k + 1});
    begin = k + 1;
  }
  segments.push_back({begin, t.size()});
  return segments;
}

double jitter_of(std::span<const double> t, const StampDigits& digits) {
  if (t.size() < 3) return 0.0;
  double sum = 0.0;
  for (std::size_t k = 1; k + 1 < t.size(); ++k) {
    const double off = t[k] - 0.5 * (t[k - 1] + t[k + 1]);
    sum += off * off;
  }
  // A stamp and half of either neighbour: 1 + 1/4 + 1/4 of one stamp's variance.
  const double variance = sum / 1.5 / static_cast<double>(t.size() - 2);
  const double rounding = std::max(digits.resolution_at(t.front()), digits.resolution_at(t.back()));
  const double period = (t.back() - t.front()) / static_cast<double>(t.size() - 1);
  const double jitter = std::sqrt(std::max(0.0, variance - rounding * rounding / 12.0));
  // Below this it is the rounding of double precision, or of digits that the variance holds by chance.
  return jitter > std::max(1e-6 * period, 0.05 * rounding) ? jitter : 0.0;
}

}  // namespace stiction::host
