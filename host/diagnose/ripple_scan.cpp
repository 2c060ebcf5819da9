#include "host/diagnose/ripple_scan.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace stiction::host {
namespace {

using Complex = std::complex<double>;

constexpr double most_cycles = 400.0;    // of the stroke
constexpr double shortest_pitch = 5e-4;  // m
constexpr double least_share = 0.2;      // of the rows must see a pitch slower than the band's edge

// What a sine and a cosine of one pitch take off the whitened residual's square. A wave that the rows see at a slowly
// changing frequency f comes out of the whitening |W(f)| times as large, so that no wave has to be whitened itself.
double gain(const std::vector<Complex>& wave, const Eigen::VectorXd& residual, const std::vector<double>& weight) {
  double cc = 0.0, ss = 0.0, cs = 0.0, cr = 0.0, sr = 0.0;
  for (std::size_t i = 0; i < wave.size(); ++i) {
    if (weight[i] == 0.0) continue;
    const double c = wave[i].real(), s = wave[i].imag(), r = residual[static_cast<Eigen::Index>(i)];
    cc += weight[i] * c * c;
    ss += weight[i] * s * s;
    cs += weight[i] * c * s;
    cr += c * r;
    sr += s * r;
  }
  const double determinant = cc * ss - cs * cs;
  if (determinant <= 1e-6 * cc * ss) return 0.0;
  return (ss * cr * cr - 2.0 * cs * cr * sr + cc * sr * sr) / determinant;
}

struct Peak {
  double order, gain;  // 1/pitch, N^2
};

}  // namespace

PitchScan scan_pitches(const LogRows& rows, const Eigen::VectorXd& residual, const Whitening& whitening,
                       std::span<const double> known, std::size_t count) {
  const auto x = rows.sampled([](const Motion& m) { return m.x; });
  const double stroke = x.maxCoeff() - x.minCoeff();
  PitchScan scan;
  if (!(stroke > 2.0 * shortest_pitch)) return scan;
  const double band = 0.4 / rows.period(0);  // Hz, that the rows hold
  std::vector<double> speeds(static_cast<std::size_t>(x.size()));
  for (std::size_t i = 0; i < speeds.size(); ++i) speeds[i] = std::abs(rows.velocity[static_cast<Eigen::Index>(i)]);
  auto sorted = speeds;
  const auto slow = sorted.begin() + static_cast<std::ptrdiff_t>(least_share * static_cast<double>(sorted.size()));
  std::nth_element(sorted.begin(), slow, sorted.end());
  const double fastest_seen = std::max(*slow, 1e-6);

  const double lowest = 1.0 / stroke, step = 0.125 / stroke;
  const double highest = std::min({most_cycles / stroke, 1.0 / shortest_pitch, band / fastest_seen});
  std::vector<Complex> wave(speeds.size()), turn(speeds.size());
  for (std::size_t i = 0; i < wave.size(); ++i) {
    const double angle = 2.0 * std::numbers::pi * (x[static_cast<Eigen::Index>(i)] - x.minCoeff());
    wave[i] = std::polar(1.0, angle * lowest);
    turn[i] = std::polar(1.0, angle * step);
  }
  // |W|^2 over the rows' frequencies, in a table.
  constexpr std::size_t steps = 512;
  std::vector<double> gain_square(steps + 1);
  for (std::size_t k = 0; k <= steps; ++k)
    gain_square[k] = whitening.gain_square(0.5 * static_cast<double>(k) / static_cast<double>(steps));
  const auto weights_at = [&](double order) {
    std::vector<double> weight(speeds.size(), 0.0);
    for (std::size_t i = 0; i < weight.size(); ++i) {
      const double frequency = speeds[i] * order;
      if (frequency < band) weight[i] = gain_square[static_cast<std::size_t>(2.0 * steps * frequency * rows.period(0))];
    }
    return weight;
  };
  const Eigen::VectorXd weighed = whitening.transposed(whitening(residual));
  std::vector<Peak> all;
  for (double order = lowest; order <= highest; order += step) {
    all.push_back({order, gain(wave, weighed, weights_at(order))});
    for (std::size_t i = 0; i < wave.size(); ++i) wave[i] *= turn[i];
  }
  scan.trials = all.size() / 8 + 1;
  std::vector<Peak> peaks;
  for (std::size_t k = 0; k < all.size(); ++k)
    if ((k == 0 || all[k].gain >= all[k - 1].gain) && (k + 1 == all.size() || all[k].gain > all[k + 1].gain))
      peaks.push_back(all[k]);
  std::sort(peaks.begin(), peaks.end(), [](const Peak& a, const Peak& b) { return a.gain > b.gain; });
  for (const auto& peak : peaks)
    if (scan.pitches.size() < count) scan.pitches.push_back(1.0 / peak.order);
  for (const double pitch : known)
    if (pitch > shortest_pitch && pitch < stroke) scan.pitches.push_back(pitch);
  return scan;
}

}  // namespace stiction::host
