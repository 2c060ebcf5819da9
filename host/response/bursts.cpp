#include "host/response/bursts.hpp"

#include <complex>
#include <unsupported/Eigen/FFT>

namespace stiction::host {
namespace {

constexpr double repeats_below = 1e-4;  // of the power: a difference of 1 % rms
constexpr double unlike_above = 0.5;    // of the power, the difference to itself a little later

// Power of signal(k) - signal(k + lag) over that of both parts, for every lag: 0 where the signal repeats itself, 1
// where both are unrelated.
std::vector<double> difference_by_lag(std::span<const double> signal) {
  const std::size_t count = signal.size();
  std::size_t length = 1;
  while (length < 2 * count) length *= 2;
  std::vector<double> padded(length, 0.0), correlation;
  std::copy(signal.begin(), signal.end(), padded.begin());
  std::vector<std::complex<double>> spectrum;
  Eigen::FFT<double> fft;
  fft.fwd(spectrum, padded);
  for (auto& value : spectrum) value = std::norm(value);
  fft.inv(correlation, spectrum);
  std::vector<double> energy(count + 1, 0.0);  // of the samples before
  for (std::size_t k = 0; k < count; ++k) energy[k + 1] = energy[k] + signal[k] * signal[k];
  std::vector<double> difference(count);
  for (std::size_t lag = 0; lag < count; ++lag) {
    const double both = energy[count - lag] + energy[count] - energy[lag];
    difference[lag] = both > 0.0 ? 1.0 - 2.0 * correlation[lag] / both : 1.0;
  }
  return difference;
}

// The smallest lag at which the signal repeats itself after it has become unlike itself; 0: none within the half.
std::size_t period_of(std::span<const double> signal) {
  const auto difference = difference_by_lag(signal);
  const std::size_t longest = signal.size() / 2;
  std::size_t lag = 1;
  while (lag <= longest && difference[lag] < unlike_above) ++lag;
  while (lag <= longest && difference[lag] > repeats_below) ++lag;
  while (lag < longest && difference[lag + 1] < difference[lag]) ++lag;
  return lag <= longest ? lag : 0;
}

}  // namespace

std::vector<Burst> find_bursts(std::span<const double> signal, std::size_t shortest_pause) {
  std::vector<Burst> bursts;
  for (std::size_t k = 0; k < signal.size(); ++k) {
    if (signal[k] == 0.0) continue;
    if (bursts.empty() || k - bursts.back().end >= shortest_pause) bursts.push_back({k, k, 0});
    bursts.back().end = k + 1;
  }
  for (auto& burst : bursts) burst.period = period_of(signal.subspan(burst.begin, burst.size()));
  return bursts;
}

}  // namespace stiction::host
