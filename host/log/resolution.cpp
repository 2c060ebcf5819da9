#include "host/log/resolution.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "host/log/statistics.hpp"

namespace stiction::host {
namespace {

constexpr double share = 0.9;               // of the differences that must be whole multiples
constexpr std::size_t fewest_steps = 8;     // differences that show a grid
constexpr std::size_t few_gaps = 256;       // of the smallest, from which grids are proposed
constexpr std::size_t drawn = 5;            // gaps whose common divisor is taken: it is that of all in 96 %
constexpr int draws = 24;                   // so many, as a few gaps lie off the grid
constexpr std::size_t most_kept = 5000;     // differences that are judged
constexpr std::size_t most_sorted = 20000;  // values whose gaps are
constexpr double clear_of_error = 8.0;      // an increment counts above this many times the error of a difference
constexpr std::size_t some_values = 500;
constexpr double slack_of_some = 0.15;  // what the share among so few may be less

// Sizes of the differences between neighbours that are not equal, evenly picked where there are very many.
std::vector<double> steps_of(std::span<const double> values, double error) {
  std::vector<double> steps;
  const std::size_t stride = 1 + values.size() / most_kept;
  for (std::size_t k = 1; k < values.size(); k += stride)
    if (const double step = std::abs(values[k] - values[k - 1]); step > error) steps.push_back(step);
  return steps;
}

// Distances between different values, in the order of their size.
std::vector<double> sorted_gaps(const std::vector<double>& all, double error) {
  std::vector<double> values;
  for (std::size_t k = 0; k < all.size(); k += 1 + all.size() / most_sorted) values.push_back(all[k]);
  std::ranges::sort(values);
  std::vector<double> gaps;
  double last = values.empty() ? 0.0 : values.front();
  for (const double value : values) {
    if (value - last <= error) continue;
    gaps.push_back(value - last);
    last = value;
  }
  std::ranges::sort(gaps);
  return gaps;
}

// A number and how far it may be off.
struct Uncertain {
  double value = 0.0, error = 0.0;
};

// Euclid's algorithm: a rest is as uncertain as what it was taken from and, by the quotient, as what was taken. The
// divisor then is as certain as the larger number, of which it is a whole part.
Uncertain common_divisor(Uncertain a, Uncertain b) {
  if (a.value < b.value) std::swap(a, b);
  const auto larger = a;
  while (b.value > 0.5 * clear_of_error * b.error) {
    const double quotient = std::round(a.value / b.value);
    a = std::exchange(b, {std::abs(a.value - quotient * b.value), a.error + quotient * b.error});
  }
  const double count = std::round(larger.value / a.value);
  return {larger.value / count, larger.error / count};
}

// The increment by least squares over the steps of few counts first, whose counts are certain, then over larger ones.
double refined(double increment, const std::vector<double>& steps, double error) {
  for (double counts = 4.0; counts < 1e6; counts *= 4.0) {
    double product = 0.0, square = 0.0;
    for (const double step : steps) {
      const double n = std::round(step / increment);
      if (n < 1.0 || n > counts || std::abs(step - n * increment) > 2.0 * error) continue;
      product += n * step;
      square += n * n;
    }
    if (square > 0.0) increment = product / square;
  }
  return increment;
}

double on_grid(double increment, const std::vector<double>& steps, double error) {
  std::size_t on = 0;
  for (const double step : steps)
    on += std::abs(step - std::round(step / increment) * increment) <= error + 1e-9 * increment;
  return static_cast<double>(on) / static_cast<double>(steps.size());
}

// The largest grid that the steps lie on and the values that they lead to, whose gaps these are; each is known within
// `error`. A ramp of one speed has equal steps without a grid: its values tell. 0: none.
double grid_of(const std::vector<double>& gaps, std::vector<double> steps, double error) {
  std::erase_if(steps, [&](double step) { return step <= error; });
  if (steps.size() < fewest_steps || gaps.empty()) return 0.0;
  auto all = steps;
  all.insert(all.end(), gaps.begin(), gaps.end());
  // The smallest gaps are of few counts, so that Euclid's quotients are small.
  const std::size_t few = std::min(gaps.size(), few_gaps);
  std::vector<double> some;
  for (std::size_t k = 0; k < all.size(); k += 1 + all.size() / some_values) some.push_back(all[k]);
  std::mt19937 random(1);
  double best = 0.0;
  for (int draw = 0; draw < draws; ++draw) {
    Uncertain common{gaps[random() % few], error};
    for (std::size_t k = 1; k < drawn; ++k) common = common_divisor(common, {gaps[random() % few], error});
    if (common.value < clear_of_error * error || common.value <= 1.001 * best) continue;
    // Most draws are of no grid, which a few of the values show as well as all.
    if (on_grid(refined(common.value, some, error), some, error) < share - slack_of_some) continue;
    const double divisor = refined(common.value, all, error);
    if (divisor > best && on_grid(divisor, steps, error) >= share && on_grid(divisor, gaps, error) >= share)
      best = divisor;
  }
  return best;
}

}  // namespace

double increment_of(std::span<const double> all) {
  std::vector<double> values;
  double largest = 0.0;
  for (const double value : all)
    if (std::isfinite(value)) values.push_back(value), largest = std::max(largest, std::abs(value));
  // What double precision and the conversion of a unit leave in a difference.
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * largest;
  const auto steps = steps_of(values, rounding);
  double increment = grid_of(sorted_gaps(values, rounding), steps, rounding);
  // Counts written in decimals, or kept in single precision on the way, are off the grid of the counts.
  for (const double coarser :
       {1.01 * increment, 1.01 * increment + double{std::numeric_limits<float>::epsilon()} * largest})
    if (coarser > rounding)
      if (const double counts = grid_of(sorted_gaps(values, coarser), steps, coarser); counts > 0.0) increment = counts;
  return increment;
}

double increment_of(const AxisLog& axis, std::vector<double> AxisLog::*channel) {
  if (!axis.increments.empty())
    for (std::size_t k = 0; k < log_channels.size(); ++k)
      if (log_channels[k].values == channel) return axis.increments[k];
  return increment_of(std::span<const double>(axis.*channel));
}

double noise_of(std::span<const double> values) {
  double least = 0.0;
  std::vector<double> difference(values.begin(), values.end());
  double binomial = 1.0;  // sum of the squared weights of the difference: 2, 6, 20, ...
  for (std::size_t order = 1; order <= 6 && values.size() > 4 * order; ++order) {
    for (std::size_t k = 0; k + order < values.size(); ++k) difference[k] = difference[k + 1] - difference[k];
    binomial *= 2.0 * (2.0 * static_cast<double>(order) - 1.0) / static_cast<double>(order);
    std::vector<double> sizes;
    for (std::size_t k = 0; k + order < values.size(); ++k) {
      bool changes = false;
      for (std::size_t m = k; m < k + order; ++m) changes = changes || values[m + 1] != values[m];
      if (changes && std::isfinite(difference[k])) sizes.push_back(std::abs(difference[k]));
    }
    if (sizes.size() < 16) continue;
    // 1.4826 times the median of the magnitudes is the standard deviation of a normal variable.
    const double noise = 1.4826 * median(sizes) / std::sqrt(binomial);
    if (least == 0.0 || noise < least) least = noise;
  }
  return least;
}

}  // namespace stiction::host
