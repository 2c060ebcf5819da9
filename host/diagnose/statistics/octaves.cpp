#include "host/diagnose/statistics/octaves.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <unsupported/Eigen/FFT>

namespace stiction::host {
namespace {

// The lowest octave has so many lines of the longest log, and what is below them, that a ratio of two powers is known
// to a third.
constexpr double lines_of_lowest = 20.0;

// Rows of a log up to which the transform takes them as they are. It costs their number times its largest prime factor:
// longer ones have zeros behind them, to a power of two.
constexpr std::size_t longest_as_it_is = 8192;

Eigen::VectorXcd spectrum_of(Eigen::FFT<double>& fft, const Eigen::VectorXd& values) {
  const auto count = static_cast<std::size_t>(values.size());
  Eigen::VectorXd padded =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count <= longest_as_it_is ? count : std::bit_ceil(count)));
  padded.head(values.size()) = values;
  Eigen::VectorXcd spectrum;
  fft.fwd(spectrum, padded);
  return spectrum;
}

std::size_t octave_of(Eigen::Index line, Eigen::Index lines, std::size_t count) {
  const auto from_ends = static_cast<double>(std::min(line, lines - line));
  const double down = std::log2(0.5 * static_cast<double>(lines) / std::max(from_ends, 0.5));
  return std::min(static_cast<std::size_t>(std::max(down, 0.0)), count - 1);
}

// Calls `use` with the first row and the values of each log.
template <class Use>
void by_each_log(const Eigen::VectorXd& values, std::span<const std::size_t> logs, const Use& use) {
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const auto begin = static_cast<Eigen::Index>(logs[k]);
    const auto end = k + 1 < logs.size() ? static_cast<Eigen::Index>(logs[k + 1]) : values.size();
    if (end > begin) use(begin, Eigen::VectorXd(values.segment(begin, end - begin)));
  }
}

}  // namespace

Octaves::Octaves(std::span<const std::size_t> logs, Eigen::Index rows) : logs_(logs.begin(), logs.end()) {
  Eigen::Index longest = 0;
  by_each_log(Eigen::VectorXd::Zero(rows), logs_,
              [&](Eigen::Index, const Eigen::VectorXd& own) { longest = std::max(longest, own.size()); });
  // Below an octave's lower end are as many lines as in it.
  count_ = 1 + static_cast<std::size_t>(
                   std::max(std::log2(std::max(0.5 * static_cast<double>(longest) / lines_of_lowest, 1.0)), 0.0));
}

Octaves::Powers Octaves::of(const Eigen::VectorXd& values) const {
  Powers powers(count_, 0.0);
  Eigen::FFT<double> fft;
  by_each_log(values, logs_, [&](Eigen::Index, const Eigen::VectorXd& own) {
    const auto spectrum = spectrum_of(fft, own);
    const auto lines = spectrum.size();
    for (Eigen::Index i = 0; i < lines; ++i)
      powers[octave_of(i, lines, count_)] += std::norm(spectrum[i]) / static_cast<double>(lines);
  });
  return powers;
}

Eigen::VectorXd Octaves::scaled(const Eigen::VectorXd& values, const Powers& gains) const {
  Eigen::VectorXd all = values;
  Eigen::FFT<double> fft;
  by_each_log(values, logs_, [&](Eigen::Index begin, const Eigen::VectorXd& own) {
    auto spectrum = spectrum_of(fft, own);
    const auto lines = spectrum.size();
    for (Eigen::Index i = 0; i < lines; ++i) spectrum[i] *= gains[octave_of(i, lines, count_)];
    Eigen::VectorXd scaled(lines);
    fft.inv(scaled, spectrum);
    all.segment(begin, own.size()) = scaled.head(own.size());
  });
  return all;
}

}  // namespace stiction::host
