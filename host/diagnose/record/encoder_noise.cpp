#include "host/diagnose/record/encoder_noise.hpp"

#include <algorithm>
#include <cmath>

#include "host/identify/motion.hpp"

namespace stiction::host {
namespace {

constexpr double of_white_noise = 70.0;     // 1 + 16 + 36 + 16 + 1
constexpr std::size_t least_moving = 1000;  // samples, whose variance is known to 5 %
constexpr double alike = 1.1;               // of variances: twice that error

struct Variance {
  double sum = 0.0;
  std::size_t count = 0;
  double mean() const { return sum / static_cast<double>(count); }
};

// Of fourth differences, where the steps of the encoder change from sample to sample, as a noise does.
void add_moving(Variance& variance, const std::vector<double>& x, double increment) {
  for (std::size_t k = 4; k < x.size(); ++k) {
    if (std::abs(x[k] - x[k - 4]) < 4.0 * increment) continue;
    const double difference = x[k] - 4.0 * x[k - 1] + 6.0 * x[k - 2] - 4.0 * x[k - 3] + x[k - 4];
    variance.sum += difference * difference;
    ++variance.count;
  }
}

}  // namespace

std::optional<double> encoder_noise(const std::vector<Log>& logs, const std::vector<Log>& without_noise,
                                    const machine::AxisModel& axis) {
  Variance measured, simulated;
  for (std::size_t k = 0; k < without_noise.size(); ++k) {
    add_moving(measured, channels_of(logs[k], axis).x, axis.encoder.increment);
    add_moving(simulated, channels_of(without_noise[k], axis).x, axis.encoder.increment);
  }
  if (std::min(measured.count, simulated.count) < least_moving) return std::nullopt;
  if (measured.mean() < alike * simulated.mean()) return 0.0;
  return std::sqrt((measured.mean() - simulated.mean()) / of_white_noise);
}

}  // namespace stiction::host
