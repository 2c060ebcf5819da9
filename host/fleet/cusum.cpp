#include "host/fleet/cusum.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace stiction::host {
namespace {

double above(double z) { return 0.5 * std::erfc(z / std::sqrt(2.0)); }

}  // namespace

double Cusum::add(double deviation, std::size_t index) {
  if (sum_ == 0.0) since_ = index;
  sum_ = std::max(sum_ + deviation - reference_, 0.0);
  return sum_;
}

double cusum_false_alarms(double reference, double threshold) {
  // State 0 is the sum 0, state i the sums around i w, with the threshold between the last state and the alarm.
  constexpr std::size_t states = 200;
  const double w = threshold / (static_cast<double>(states) - 0.5);
  // Steps from state i to j depend on j - i alone, except into 0.
  std::vector<double> step(2 * states);
  for (std::size_t k = 0; k < step.size(); ++k) {
    const double move = (static_cast<double>(k) - static_cast<double>(states)) * w + reference;
    step[k] = above(move - 0.5 * w) - above(move + 0.5 * w);
  }
  std::vector<double> now(states, 0.0), next(states);
  now[0] = 1.0;
  double alarms = 0.0;
  // The distribution of sums without alarm settles within some times the square of the threshold.
  for (int turn = 0; turn < 1000; ++turn) {
    double lost = 0.0;
    std::fill(next.begin(), next.end(), 0.0);
    for (std::size_t i = 0; i < states; ++i) {
      const double at = static_cast<double>(i) * w;
      next[0] += now[i] * (1.0 - above(0.5 * w - at + reference));
      lost += now[i] * above(threshold - at + reference);
      for (std::size_t j = 1; j < states; ++j) next[j] += now[i] * step[states + j - i];
    }
    for (auto& share : next) share /= 1.0 - lost;
    now.swap(next);
    const bool settled = std::abs(lost - alarms) <= 1e-9 * lost;
    alarms = lost;
    if (settled) break;
  }
  return alarms;
}

double cusum_threshold(double reference, double probability) {
  double low = 0.01, high = 40.0;
  while (high - low > 1e-4) {
    const double middle = 0.5 * (low + high);
    (cusum_false_alarms(reference, middle) > probability ? low : high) = middle;
  }
  return high;
}

}  // namespace stiction::host
