#include "host/diagnose/statistics/coherent_mean.hpp"

#include <algorithm>
#include <bit>
#include <unsupported/Eigen/FFT>

namespace stiction::host {
namespace {

// Bands of a third of an octave, of at least this many lines.
constexpr double ratio = 1.26;
constexpr Eigen::Index fewest_lines = 24;

}  // namespace

void CoherentMean::add(std::span<const double> run) {
  if (runs_++ == 0) {
    samples_ = run.size();
    first_.assign(run.begin(), run.end());
    return;
  }
  if (runs_ == 2) transform(first_);
  transform(run);
}

void CoherentMean::transform(std::span<const double> run) {
  Eigen::VectorXd padded =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(std::bit_ceil(std::max<std::size_t>(samples_, 2))));
  padded.head(static_cast<Eigen::Index>(samples_)) =
      Eigen::Map<const Eigen::VectorXd>(run.data(), static_cast<Eigen::Index>(samples_));
  Eigen::FFT<double> fft;
  Eigen::VectorXcd spectrum;
  fft.fwd(spectrum, padded);
  if (sum_.size() == 0) {
    sum_ = Eigen::VectorXcd::Zero(spectrum.size());
    squares_ = Eigen::VectorXd::Zero(spectrum.size());
  }
  sum_ += spectrum;
  squares_ += spectrum.cwiseAbs2();
}

double CoherentMean::Band::share() const { return mean > 0.0 ? std::max(1.0 - own / mean, 0.0) : 0.0; }

// Of the lines from 0 to half the rate.
std::vector<CoherentMean::Band> CoherentMean::bands() const {
  std::vector<Band> all;
  const Eigen::Index lines = sum_.size() / 2 + 1;
  const auto n = static_cast<double>(runs_);
  for (Eigen::Index begin = 0; begin < lines;) {
    auto end = std::max(begin + fewest_lines, static_cast<Eigen::Index>(ratio * static_cast<double>(begin)));
    if (lines - end < fewest_lines) end = lines;
    Band band{begin, end - begin};
    band.mean = sum_.segment(begin, band.length).squaredNorm() / (n * n);
    if (runs_ > 1) band.own = (squares_.segment(begin, band.length).sum() / n - band.mean) / (n - 1.0);
    all.push_back(band);
    begin = end;
  }
  return all;
}

double CoherentMean::chance() const {
  if (runs_ < 2) return 0.0;
  double sum = 0.0;
  for (const auto& band : bands()) sum += 2.0 * band.own;
  return sum / static_cast<double>(sum_.size()) / static_cast<double>(samples_);
}

std::vector<double> CoherentMean::estimate() const {
  if (runs_ == 1) return first_;
  Eigen::VectorXcd spectrum = sum_ / static_cast<double>(runs_);
  const Eigen::Index lines = spectrum.size();
  for (const auto& band : bands())
    for (Eigen::Index k = band.begin; k < band.begin + band.length; ++k) {
      spectrum[k] *= band.share();
      if (k > 0 && 2 * k < lines) spectrum[lines - k] = std::conj(spectrum[k]);
    }
  Eigen::FFT<double> fft;
  Eigen::VectorXd signal;
  fft.inv(signal, spectrum);
  return {signal.data(), signal.data() + samples_};
}

}  // namespace stiction::host
