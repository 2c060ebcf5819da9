#include "host/diagnose/spectrum/line_scan.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "host/diagnose/spectrum/wave_sums.hpp"

namespace stiction::host {
namespace {

using Complex = std::complex<double>;

constexpr double lowest_frequency = 1.0;  // Hz; below it a record of some seconds holds drift, not a line
constexpr std::size_t surroundings =
    64;  // lines apart, about as many to either side, whose median is the noise around one
constexpr double most_cycles = 400.0;    // of the stroke
constexpr double shortest_pitch = 5e-4;  // m
constexpr double least_seen = 0.1;       // of the carrier's square must be in rows slow enough for a pitch

// The count of lines with the highest value over the median of their surroundings, apart by `apart` lines.
std::vector<std::size_t> outstanding(std::vector<double> power, std::size_t count, std::size_t apart) {
  const std::size_t around = surroundings * apart;
  std::vector<double> medians, near;
  for (std::size_t k = 0; k < power.size(); k += around) {
    const std::size_t from = k > around / 2 ? k - around / 2 : 0, to = std::min(power.size(), k + around + around / 2);
    near.assign(power.begin() + static_cast<std::ptrdiff_t>(from), power.begin() + static_cast<std::ptrdiff_t>(to));
    const auto middle = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
    std::nth_element(near.begin(), middle, near.end());
    medians.push_back(std::max(*middle, 1e-300));
  }
  for (std::size_t k = 0; k < power.size(); ++k) power[k] /= medians[k / around];
  std::vector<std::size_t> chosen;
  while (chosen.size() < count) {
    const auto highest = std::max_element(power.begin(), power.end());
    if (highest == power.end() || *highest <= 0.0) break;
    chosen.push_back(static_cast<std::size_t>(highest - power.begin()));
    const std::size_t from = chosen.back() > apart - 1 ? chosen.back() - (apart - 1) : 0;
    std::fill(power.begin() + static_cast<std::ptrdiff_t>(from),
              power.begin() + static_cast<std::ptrdiff_t>(std::min(power.size(), chosen.back() + apart)), 0.0);
  }
  return chosen;
}

// |W|^2 of a whitening over the rows' frequencies up to the band's end, in a table.
class WhitenedGain {
 public:
  WhitenedGain(const Whitening& whitening, double row_period) : step_(rows_band / steps / row_period) {
    for (std::size_t k = 0; k <= steps; ++k)
      table_.push_back(whitening.gain_square(rows_band * static_cast<double>(k) / static_cast<double>(steps)));
  }
  // Hz, up to the band's end.
  double at(double frequency) const { return table_[std::min(static_cast<std::size_t>(frequency / step_), steps)]; }

 private:
  static constexpr std::size_t steps = 256;
  double step_;
  std::vector<double> table_;
};

}  // namespace

LineScan scan_times(const LogRows& rows, const Eigen::VectorXd& residual, std::size_t count) {
  std::size_t longest = 0;
  for (std::size_t r = 0; r < rows.logs().size(); ++r) longest = std::max(longest, rows.end(r) - rows.logs()[r]);
  LineScan scan;
  scan.extent = static_cast<double>(longest) * rows.period(0);
  if (scan.extent * lowest_frequency < 1.0) return scan;
  const std::size_t points = power_of_two(4 * longest);  // a quarter of a line apart
  std::vector<double> power(points / 2, 0.0);
  Eigen::FFT<double> fft;
  for (std::size_t r = 0; r < rows.logs().size(); ++r) {
    const std::size_t begin = rows.logs()[r], length = rows.end(r) - begin;
    std::vector<Complex> padded(points), spectrum;
    for (std::size_t i = 0; i < length; ++i) padded[i] = residual[static_cast<Eigen::Index>(begin + i)];
    fft.fwd(spectrum, padded);
    for (std::size_t k = 0; k < power.size(); ++k)
      power[k] += 2.0 * std::norm(spectrum[k]) / static_cast<double>(std::max<std::size_t>(length, 1));
  }
  const double step = 1.0 / (static_cast<double>(points) * rows.period(0));
  const auto lowest = static_cast<std::size_t>(lowest_frequency / step) + 1;
  const auto highest = std::min(power.size(), static_cast<std::size_t>(rows_band / rows.period(0) / step));
  if (highest <= lowest) return scan;
  const auto lines = outstanding(
      {power.begin() + static_cast<std::ptrdiff_t>(lowest), power.begin() + static_cast<std::ptrdiff_t>(highest)},
      count, 8);
  for (const auto k : lines) scan.periods.push_back(1.0 / (step * static_cast<double>(lowest + k)));
  scan.trials = static_cast<std::size_t>(scan.extent * rows_band / rows.period(0)) + 1;
  return scan;
}

LineScan scan_pitches(const LogRows& rows, const Eigen::VectorXd& residual, const Whitening& whitening,
                      const Eigen::VectorXd& carrier, std::span<const double> known, std::size_t count) {
  Eigen::VectorXd x = rows.sampled([](const Motion& m) { return m.x; });
  x.array() -= x.minCoeff();
  LineScan scan;
  scan.extent = x.maxCoeff();
  if (!(scan.extent > 2.0 * shortest_pitch)) return scan;
  const double step = 0.125 / scan.extent, highest = std::min(most_cycles / scan.extent, 1.0 / shortest_pitch);
  const Eigen::VectorXd moments = whitening.transposed(whitening(residual)).cwiseProduct(carrier);
  std::vector<double> all(static_cast<std::size_t>(highest / step), 0.0);
  const WhitenedGain whitened(whitening, rows.period(0));
  // By thirds of an octave, each of the rows that are slow enough for its shortest pitch.
  std::size_t end = all.size();
  for (std::size_t from = 8, to = from; from < all.size(); from = to) {
    to = std::min(static_cast<std::size_t>(std::ceil(static_cast<double>(from) * std::cbrt(2.0))), all.size());
    const double top = step * static_cast<double>(to), middle = step * 0.5 * static_cast<double>(from + to);
    Eigen::VectorXd moment = moments, square = carrier.cwiseAbs2();
    double seen = 0.0;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double speed = std::abs(rows.velocity[i]);
      if (speed * top > rows_band / rows.period(0))
        moment[i] = square[i] = 0.0;
      else
        seen += square[i], square[i] *= whitened.at(speed * middle);
    }
    if (seen < least_seen * carrier.squaredNorm()) {
      end = from;
      break;
    }
    WaveSums sums(step, 2.0 * top);
    sums.transform(x, moment, square);
    const double all_square = square.sum();
    for (std::size_t k = from; k < to; ++k) all[k] = gain_of(sums.one(k), sums.other(2 * k), all_square);
  }
  scan.trials = end / 8 + 1;
  std::vector<std::size_t> peaks;
  for (std::size_t k = 1; k + 1 < end; ++k)
    if (all[k] > 0.0 && all[k] >= all[k - 1] && all[k] > all[k + 1]) peaks.push_back(k);
  std::sort(peaks.begin(), peaks.end(), [&](std::size_t a, std::size_t b) { return all[a] > all[b]; });
  for (const auto k : peaks)
    if (scan.periods.size() < count) scan.periods.push_back(1.0 / (step * static_cast<double>(k)));
  for (const double pitch : known)
    if (pitch > shortest_pitch && pitch < scan.extent) scan.periods.push_back(pitch);
  return scan;
}

}  // namespace stiction::host
