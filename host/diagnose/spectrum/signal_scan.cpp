#include "host/diagnose/spectrum/signal_scan.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "host/diagnose/record/encoder_error_response.hpp"
#include "host/diagnose/spectrum/wave_sums.hpp"
#include "host/identify/filter.hpp"

namespace stiction::host {
namespace {

using Complex = std::complex<double>;

constexpr double shortest_signal = 2e-6;                    // m
constexpr double least_increments = 4.0;                    // in a signal that is divided
constexpr double longest_signal = 1e-3;                     // m, of inductive and magnetic scales
constexpr double fewest_signals = 200.0;                    // a turn
constexpr std::size_t most_signals = std::size_t{1} << 19;  // steps of an order, which take 32 MB
constexpr double slowest_seen = 4.0;                        // Hz, at which a row moves along the signal at all
constexpr double log_step = 4e-4;                           // between neighbours of the tables below
constexpr std::size_t smoothed = 25;                        // of them to either side: 1 % of an order

// What rows show more slowly is any slow force's as well.
constexpr double slow = 0.03;  // of their rate
constexpr int slow_order = 2;

double fast_share(double cycles) { return 1.0 - 1.0 / (1.0 + std::pow(cycles / slow, 2 * slow_order)); }

// The rows of each record less what is slow in them.
Eigen::VectorXd fast_part(const LogRows& rows, Eigen::VectorXd values) {
  for (std::size_t r = 0; r < rows.logs().size(); ++r) {
    const std::size_t begin = rows.logs()[r];
    const std::size_t end = rows.end(r);
    const auto lowpass = butterworth(slow_order, 2.0 * slow);
    const std::vector<double> all(values.data() + begin, values.data() + end);
    const auto slow_part = filter_both_ways(lowpass, all, default_padding(lowpass));
    for (std::size_t i = 0; i < all.size(); ++i) values[static_cast<Eigen::Index>(begin + i)] -= slow_part[i];
  }
  return values;
}

// Rows at a steady speed that is no crawl show a line of one frequency, as the steps of a coarse encoder do that pass
// at that speed; where the axis accelerates each signal period sweeps its own way. 1 for those that count, 0 for
// others.
constexpr double steady = 0.1;  // of the largest acceleration
constexpr double crawl = 0.1;   // of the longest signal period, in the shortest time that the rows show

Eigen::VectorXd telling_rows(const LogRows& rows, double longest) {
  const double least = steady * rows.acceleration.cwiseAbs().maxCoeff();
  Eigen::VectorXd telling = rows.counts();
  for (std::size_t r = 0; r < rows.logs().size(); ++r) {
    const std::size_t end = rows.end(r);
    const double fastest = crawl * longest * rows_band / rows.period(r);
    for (auto i = static_cast<Eigen::Index>(rows.logs()[r]); i < static_cast<Eigen::Index>(end); ++i)
      if (std::abs(rows.velocity[i]) > fastest && std::abs(rows.acceleration[i]) < least) telling[i] = 0.0;
  }
  return telling;
}

// The square of the whitened column of an error of 1 m at each order, as its expectation over the signal's phase: the
// sum over rows of what the row's speed makes of the order. With the logarithms of speeds and orders that is a
// correlation.
class ColumnSquares {
 public:
  // `telling`: 1 for rows that count; `lowest`, `highest`: orders, 1/m.
  ColumnSquares(const LogRows& rows, const Whitening& whitening, const machine::AxisModel& axis,
                const machine::Timing& timing, const SignalSettings& settings, const Eigen::VectorXd& telling,
                double lowest, double highest)
      : lowest_(std::log(lowest)) {
    const double fastest = rows.velocity.cwiseAbs().maxCoeff(), slowest = slowest_seen / highest;
    if (!(fastest > slowest)) return;
    const auto steps = [](double from, double to) {
      return static_cast<std::size_t>(std::log(to / from) / log_step) + 2;
    };
    const std::size_t speeds = steps(slowest, fastest), orders = steps(lowest, highest);
    const std::size_t points = power_of_two(speeds + orders);
    all_.assign(orders, 0.0);
    for (std::size_t r = 0; r < rows.logs().size(); ++r) {
      const auto begin = static_cast<Eigen::Index>(rows.logs()[r]);
      const auto end = static_cast<Eigen::Index>(rows.end(r));
      std::vector<double> of_speeds(points, 0.0), of_frequencies(points, 0.0);
      for (Eigen::Index i = begin; i < end; ++i) {
        const double weight = (whitening.weight().size() > 0 ? whitening.weight()[i] : 1.0) * telling[i];
        if (const double v = std::abs(rows.velocity[i]); v > slowest)
          of_speeds[static_cast<std::size_t>(std::log(v / slowest) / log_step)] += weight * weight;
      }
      const SeenEncoderError seen(rows.motions()[r], axis, timing, settings.difference_points, settings.cutoff);
      for (std::size_t k = 0; k < speeds + orders; ++k) {
        const double frequency = slowest * lowest * std::exp(log_step * static_cast<double>(k));
        if (frequency < slowest_seen) continue;
        const double shown = seen.shown_at(frequency);
        if (shown <= rows_band / rows.period(r))
          of_frequencies[k] = std::norm(seen.response(frequency) * fast_share(shown * rows.period(r))) *
                              whitening.gain_square(shown * rows.period(r));
      }
      add(of_speeds, of_frequencies);
    }
    smooth();
  }

  double at(double order) const {
    const double at = (std::log(order) - lowest_) / log_step;
    const auto k = std::min(static_cast<std::size_t>(std::max(at, 0.0)), all_.size() - 2);
    const double part = std::min(at - static_cast<double>(k), 1.0);
    return (1.0 - part) * all_[k] + part * all_[k + 1];
  }
  explicit operator bool() const { return !all_.empty(); }

 private:
  void add(const std::vector<double>& of_speeds, const std::vector<double>& of_frequencies) {
    Eigen::FFT<double> fft;
    std::vector<Complex> one, other;
    fft.fwd(one, of_speeds);
    fft.fwd(other, of_frequencies);
    for (std::size_t k = 0; k < one.size(); ++k) other[k] *= std::conj(one[k]);
    fft.inv(one, other);
    for (std::size_t k = 0; k < all_.size(); ++k) all_[k] += std::max(one[k].real(), 0.0);
  }

  // A row that accelerates shows a stretch of frequencies, not one.
  void smooth() {
    std::vector<double> sums{0.0};
    for (const double value : all_) sums.push_back(sums.back() + value);
    for (std::size_t k = 0; k < all_.size(); ++k) {
      const std::size_t from = k > smoothed ? k - smoothed : 0, to = std::min(k + smoothed + 1, all_.size());
      all_[k] = (sums[to] - sums[from]) / static_cast<double>(to - from);
    }
  }

  double lowest_;
  std::vector<double> all_;
};

// Of the residual, weights by which any error of the reading shows in it, over where the axis was.
SeenEncoderError::Weights over_place(const LogRows& rows, const Eigen::VectorXd& residual, const Whitening& whitening,
                                     const machine::AxisModel& axis, const machine::Timing& timing,
                                     const SignalSettings& settings, const Eigen::VectorXd& telling) {
  const Eigen::VectorXd white = whitening(residual).cwiseProduct(telling);
  const auto weights = rows.transposed(fast_part(rows, whitening.transposed(white)));
  SeenEncoderError::Weights all;
  const auto append = [](Eigen::VectorXd& to, const Eigen::VectorXd& more) {
    to.conservativeResize(to.size() + more.size());
    to.tail(more.size()) = more;
  };
  for (std::size_t r = 0; r < weights.size(); ++r) {
    const SeenEncoderError seen(rows.motions()[r], axis, timing, settings.difference_points, settings.cutoff);
    const auto of_ticks = seen.transposed(weights[r]);
    append(all.place, of_ticks.place);
    append(all.position, of_ticks.position);
    append(all.slope, of_ticks.slope);
  }
  return all;
}

}  // namespace

LineScan scan_signal_periods(const LogRows& rows, const Eigen::VectorXd& residual, const Whitening& whitening,
                             const machine::AxisModel& axis, const machine::Timing& timing,
                             const SignalSettings& settings, std::size_t count) {
  LineScan scan;
  const double longest =
      axis.coordinate.rotary() ? 2.0 * std::numbers::pi * axis.coordinate.radius / fewest_signals : longest_signal;
  const Eigen::VectorXd telling = telling_rows(rows, longest);
  const auto weights = over_place(rows, residual, whitening, axis, timing, settings, telling);
  if (weights.place.size() == 0) return scan;
  const Eigen::VectorXd way = weights.place.array() - weights.place.minCoeff();
  scan.extent = way.maxCoeff();
  const double shortest = std::max(shortest_signal, least_increments * axis.encoder.increment);
  if (!(scan.extent > longest) || !(shortest < longest)) return scan;
  const double step = 0.5 / scan.extent;
  const auto lowest = static_cast<std::size_t>(1.0 / longest / step),
             highest = std::min(static_cast<std::size_t>(1.0 / shortest / step), most_signals);
  if (lowest >= highest) return scan;
  const ColumnSquares squares(rows, whitening, axis, timing, settings, telling, step * static_cast<double>(lowest),
                              step * static_cast<double>(highest));
  if (!squares) return scan;
  WavePower spectrum(step, highest);
  spectrum.transform(way, weights.position, weights.slope);
  std::vector<double> gains;
  double largest = 0.0;
  for (std::size_t k = lowest; k < highest; ++k) {
    gains.push_back(squares.at(step * static_cast<double>(k)));
    largest = std::max(largest, gains.back());
  }
  // What the rows hardly show is no more than rounding.
  for (std::size_t k = 0; k < gains.size(); ++k)
    gains[k] = gains[k] > 1e-9 * largest ? 2.0 * spectrum.at(lowest + k) / gains[k] : 0.0;
  scan.trials = gains.size() / 2 + 1;
  for (; scan.periods.size() < count;) {
    const auto best = std::max_element(gains.begin(), gains.end());
    if (*best <= 0.0) break;
    const auto k = static_cast<std::size_t>(best - gains.begin());
    scan.periods.push_back(1.0 / (step * static_cast<double>(lowest + k)));
    // Neighbours lead to one and the same.
    for (std::size_t near = k > 3 ? k - 3 : 0; near < std::min(k + 4, gains.size()); ++near) gains[near] = 0.0;
  }
  return scan;
}

}  // namespace stiction::host
