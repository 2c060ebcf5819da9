#include "host/diagnose/record/encoder_noise.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "host/identify/motion.hpp"

namespace stiction::host {
namespace {

constexpr double of_white_noise = 70.0;     // 1 + 16 + 36 + 16 + 1
constexpr std::size_t least_moving = 1000;  // samples, whose variance is known to 5 %
constexpr double alike = 1.1;               // of variances: twice that error
constexpr double longest_period = 1e-3;     // s: fourth differences of slower records know what forces do to the axis
constexpr double far_out = 6.0;             // standard deviations: a blow in a gap, a spike, a lost sample
constexpr double of_median = 0.6745;        // the median of a normal value's size, standard deviations

// Fourth differences where the steps of the encoder change from sample to sample, as a noise does.
void add_moving(std::vector<double>& differences, const std::vector<double>& x, double increment) {
  for (std::size_t k = 4; k < x.size(); ++k)
    if (std::abs(x[k] - x[k - 4]) >= 4.0 * increment)
      differences.push_back(std::abs(x[k] - 4.0 * x[k - 1] + 6.0 * x[k - 2] - 4.0 * x[k - 3] + x[k - 4]));
}

// Without those that are far out; the least deviation is that of the steps.
double variance_of(std::vector<double> differences, double increment) {
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  const double steps = increment * std::sqrt(of_white_noise / 12.0);
  const double most = far_out * std::max(*middle / of_median, steps);
  std::erase_if(differences, [&](double difference) { return difference > most; });
  return std::inner_product(differences.begin(), differences.end(), differences.begin(), 0.0) /
         static_cast<double>(differences.size());
}

}  // namespace

std::optional<double> encoder_noise(const std::vector<Log>& logs, const std::vector<Log>& without_noise,
                                    const machine::AxisModel& axis) {
  std::vector<double> measured, simulated;
  for (std::size_t k = 0; k < without_noise.size(); ++k) {
    if (logs[k].period > longest_period * (1.0 + 1e-6)) return std::nullopt;
    add_moving(measured, channels_of(logs[k], axis).x, axis.encoder.increment);
    add_moving(simulated, channels_of(without_noise[k], axis).x, axis.encoder.increment);
  }
  if (std::min(measured.size(), simulated.size()) < least_moving) return std::nullopt;
  const double with = variance_of(std::move(measured), axis.encoder.increment);
  const double without = variance_of(std::move(simulated), axis.encoder.increment);
  return with < alike * without ? 0.0 : std::sqrt((with - without) / of_white_noise);
}

}  // namespace stiction::host
