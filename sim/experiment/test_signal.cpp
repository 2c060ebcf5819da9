#include "sim/experiment/test_signal.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <set>

namespace stiction::sim {

std::vector<int> test_lines(int period, int slow_ratio, double per_decade) {
  const int slow = period / slow_ratio;  // line of the slow sample rate
  const auto folded = [slow](int line) { return std::min(line % slow, slow - line % slow); };
  const auto highest = static_cast<int>(0.95 * 0.5 * period);
  const double ratio = std::pow(10.0, 1.0 / per_decade);
  std::vector<int> lines;
  std::set<int> taken;
  double wanted = 1.0;
  for (int line = 1; line <= highest; ++line) {
    if (line < wanted || folded(line) == 0 || !taken.insert(folded(line)).second) continue;
    lines.push_back(line);
    wanted = line * ratio;
  }
  return lines;
}

std::vector<double> multisine(int period, std::span<const int> lines, double peak, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> phase(0.0, 2.0 * std::numbers::pi);
  std::vector<double> signal(static_cast<std::size_t>(period), 0.0);
  for (const int line : lines) {
    const auto turn = std::polar(1.0, 2.0 * std::numbers::pi * line / period);
    auto now = std::polar(1.0, phase(random));
    for (auto& value : signal) {
      value += now.real();
      now *= turn;
    }
  }
  double largest = 0.0;
  for (const double value : signal) largest = std::max(largest, std::abs(value));
  for (auto& value : signal) value *= peak / largest;
  return signal;
}

}  // namespace stiction::sim
