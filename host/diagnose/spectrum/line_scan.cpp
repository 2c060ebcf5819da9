#include "host/diagnose/spectrum/line_scan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "host/diagnose/record/encoder_error_response.hpp"
#include "host/diagnose/spectrum/wave_sums.hpp"

namespace stiction::host {
namespace {

using Complex = std::complex<double>;

constexpr double lowest_frequency = 1.0;  // Hz; below it a record of some seconds holds drift, not a line
constexpr double band = 0.4;              // of the rows' rate
constexpr std::size_t surroundings = 64;  // lines to either side whose median is the noise around one
constexpr double most_cycles = 400.0;     // of the stroke
constexpr double shortest_pitch = 5e-4;   // m
constexpr double least_seen = 0.1;        // of the carrier's square must be in rows slow enough for a pitch
constexpr double shortest_signal = 2e-6;  // m
constexpr double longest_signal = 1e-3;   // m
// m, of linear scales and of inductive and magnetic ones
constexpr std::array usual_signals{2e-6,   4e-6,   8e-6,   10e-6,  16e-6,  20e-6,  40e-6,  50e-6, 80e-6,
                                   100e-6, 128e-6, 200e-6, 250e-6, 400e-6, 500e-6, 512e-6, 1e-3};
constexpr double stretch_cycles = 48.0;  // of a stretch of rows that is looked at by itself
// Orders that stretches of slow rows show, each then looked at over all rows. A weak error can stand out less than some
// stretches' noise: of three that were not among the first two, two are among the first six.
constexpr std::size_t slow_orders = 6;

// The count of lines with the highest value over the median of their surroundings, apart by `apart` lines.
std::vector<std::size_t> outstanding(const std::vector<double>& power, std::size_t count, std::size_t apart) {
  std::vector<std::pair<double, std::size_t>> ratios;
  std::vector<double> around;
  double median = 0.0;
  for (std::size_t k = 0; k < power.size(); ++k) {
    if (k % 16 == 0) {  // the surroundings change slowly
      const std::size_t from = k > surroundings * apart ? k - surroundings * apart : 0;
      const std::size_t to = std::min(power.size(), k + surroundings * apart + 1);
      around.assign(power.begin() + static_cast<std::ptrdiff_t>(from), power.begin() + static_cast<std::ptrdiff_t>(to));
      const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
      std::nth_element(around.begin(), middle, around.end());
      median = std::max(*middle, 1e-300);
    }
    ratios.emplace_back(power[k] / median, k);
  }
  std::sort(ratios.begin(), ratios.end(), std::greater<>());
  std::vector<std::size_t> chosen;
  for (const auto& [ratio, k] : ratios) {
    if (chosen.size() == count) break;
    if (std::all_of(chosen.begin(), chosen.end(),
                    [&, line = k](std::size_t c) { return (c > line ? c - line : line - c) >= apart; }))
      chosen.push_back(k);
  }
  return chosen;
}

std::size_t record_end(const LogRows& rows, std::size_t record) {
  return record + 1 < rows.logs().size() ? rows.logs()[record + 1] : static_cast<std::size_t>(rows.rows());
}

// |W|^2 of a whitening over the rows' frequencies up to the band's end, in a table.
class WhitenedGain {
 public:
  WhitenedGain(const Whitening& whitening, double row_period) : step_(band / steps / row_period) {
    for (std::size_t k = 0; k <= steps; ++k)
      table_.push_back(whitening.gain_square(band * static_cast<double>(k) / static_cast<double>(steps)));
  }
  // Hz, up to the band's end.
  double at(double frequency) const { return table_[std::min(static_cast<std::size_t>(frequency / step_), steps)]; }

 private:
  static constexpr std::size_t steps = 256;
  double step_;
  std::vector<double> table_;
};

// Rows in a row of one record that see an order: slower than the band and some periods long.
struct Stretch {
  std::size_t begin, end;
};
std::vector<Stretch> stretches(const LogRows& rows, const Eigen::VectorXd& x, double order, double longest) {
  const double fastest = band / rows.period(0) / order;
  std::vector<Stretch> found;
  for (std::size_t r = 0; r < rows.logs().size(); ++r) {
    const std::size_t end = record_end(rows, r);
    for (std::size_t i = rows.logs()[r]; i < end;) {
      const std::size_t begin = i;
      double low = x[static_cast<Eigen::Index>(i)], high = low;
      for (; i < end && std::abs(rows.velocity[static_cast<Eigen::Index>(i)]) < fastest; ++i) {
        low = std::min(low, x[static_cast<Eigen::Index>(i)]);
        high = std::max(high, x[static_cast<Eigen::Index>(i)]);
        if (high - low > longest) break;
      }
      if ((high - low) * order > 3.0 && i - begin > 16) found.push_back({begin, i});
      if (i == begin) ++i;
    }
  }
  return found;
}

// Of the stretches, the gain at orders first, first + step, ..; the columns grow with the speed squared. `weighed`: the
// residual, whitened and taken back (Whitening::transposed).
std::vector<double> gains(const LogRows& rows, const Eigen::VectorXd& weighed, const WhitenedGain& whitened,
                          const Eigen::VectorXd& x, const std::vector<Stretch>& in, double first, double step,
                          std::size_t count) {
  const double middle = first + 0.5 * step * static_cast<double>(count);
  std::vector<double> all(count, 0.0);
  PhasorBank waves;
  for (const auto& s : in) {
    waves.clear();
    for (std::size_t i = s.begin; i < s.end; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const double way = 2.0 * std::numbers::pi * (x[row] - x[static_cast<Eigen::Index>(s.begin)]);
      const double weight = rows.velocity[row] * rows.velocity[row];
      waves.add(weight * weighed[row], weight * weight * whitened.at(std::abs(rows.velocity[row]) * middle),
                std::polar(1.0, way * first), std::polar(1.0, way * step));
    }
    for (double& sum : all) sum += waves.gain();
  }
  return all;
}

// What an error of the encoder's reading takes off the residual, of all rows in which the log shows it within the band.
class ShownError {
 public:
  ShownError(const LogRows& rows, const Eigen::VectorXd& weighed, const WhitenedGain& whitened,
             const Eigen::VectorXd& x, const machine::AxisModel& axis, const machine::Timing& timing)
      : rows_(rows), weighed_(weighed), whitened_(whitened), x_(x) {
    const auto& motions = rows.motions();
    for (const auto& motion : motions) {
      responses_.emplace_back(axis, timing, motion.period);
      const auto same =
          std::find_if(motions.begin(), motions.end(), [&](const Motion& m) { return m.period == motion.period; });
      table_.push_back(static_cast<std::size_t>(same - motions.begin()));
      auto& table = drive_.emplace_back();
      if (table_.back() + 1 < drive_.size()) continue;
      for (double f = 0.0; f < highest_shown; f += frequency_step)
        table.push_back(f < 0.5 / motion.period ? 0.0 : responses_.back().drive(f));
    }
  }

  // Of orders first, first + step, .., near enough to one another that the same rows show them.
  std::vector<double> gains(double first, double step, std::size_t count) {
    const double length = step * static_cast<double>(count);
    if (step != step_ || length != length_) turn_by(step, length);
    stand_at(first);
    next_ = first + length;
    auto waves = shown(first + 0.5 * step * static_cast<double>(count - 1));
    std::vector<double> all;
    for (std::size_t k = 0; k < count; ++k) all.push_back(waves.gain());
    return all;
  }

 private:
  static constexpr double slowest_shown = 4.0;    // Hz, at which a row moves along the signal at all
  static constexpr double highest_shown = 32e3;   // Hz
  static constexpr double frequency_step = 10.0;  // Hz, of the drive's answer

  static Complex wave_at(double turns) { return std::polar(1.0, 2.0 * std::numbers::pi * std::remainder(turns, 1.0)); }

  void turn_by(double step, double length) {
    step_ = step;
    length_ = length;
    turns_.clear();
    long_turns_.clear();
    for (const double place : x_) {
      turns_.push_back(wave_at(place * step));
      long_turns_.push_back(wave_at(place * length));
    }
    next_ = -1.0;
  }

  // Each row's wave at the order `first`, from the last ones where it follows on them: sine and cosine cost more.
  void stand_at(double first) {
    const bool follows = first == next_;
    waves_.resize(turns_.size());
    for (std::size_t i = 0; i < waves_.size(); ++i) {
      const Complex w = waves_[i], turn = long_turns_[i];
      waves_[i] = follows ? Complex(w.real() * turn.real() - w.imag() * turn.imag(),
                                    w.real() * turn.imag() + w.imag() * turn.real())
                          : wave_at(x_[static_cast<Eigen::Index>(i)] * first);
    }
  }

  // The rows that show the order `middle`, with their response to it.
  PhasorBank shown(double middle) const {
    PhasorBank waves;
    for (std::size_t r = 0; r < rows_.logs().size(); ++r) {
      const auto& drive = drive_[table_[r]];
      for (std::size_t i = rows_.logs()[r]; i < record_end(rows_, r); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        const double v = rows_.velocity[row], frequency = std::abs(v) * middle;
        if (frequency < slowest_shown || frequency >= highest_shown) continue;
        const double shown = responses_[r].shown_at(frequency);
        if (shown > band / rows_.period(r)) continue;
        const double w = 2.0 * std::numbers::pi * shown;
        const Complex response =
            drive[static_cast<std::size_t>(frequency / frequency_step)] + responses_[r].mass() * w * w;
        waves.add(weighed_[row], whitened_.at(shown), (v < 0.0 ? std::conj(response) : response) * waves_[i],
                  turns_[i]);
      }
    }
    return waves;
  }

  const LogRows& rows_;
  const Eigen::VectorXd& weighed_;
  const WhitenedGain& whitened_;
  const Eigen::VectorXd& x_;
  std::vector<EncoderErrorResponse> responses_;
  std::vector<std::vector<Complex>> drive_;  // of the motions whose period is the first of its kind
  std::vector<std::size_t> table_;           // which of them each motion has
  double step_ = -1.0, length_ = -1.0;       // of the last orders, and from the first of them to the next first
  double next_ = -1.0;                       // the order that follows on them
  std::vector<Complex> turns_, long_turns_;  // of each row by the step and by the length
  std::vector<Complex> waves_;               // of each row at the first order
};

}  // namespace

LineScan scan_times(const LogRows& rows, const Eigen::VectorXd& residual, std::size_t count) {
  std::size_t longest = 0;
  for (std::size_t r = 0; r < rows.logs().size(); ++r)
    longest = std::max(longest, record_end(rows, r) - rows.logs()[r]);
  LineScan scan;
  scan.extent = static_cast<double>(longest) * rows.period(0);
  if (scan.extent * lowest_frequency < 1.0) return scan;
  const std::size_t points = power_of_two(4 * longest);  // a quarter of a line apart
  std::vector<double> power(points / 2, 0.0);
  Eigen::FFT<double> fft;
  for (std::size_t r = 0; r < rows.logs().size(); ++r) {
    const std::size_t begin = rows.logs()[r], length = record_end(rows, r) - begin;
    std::vector<Complex> padded(points), spectrum;
    for (std::size_t i = 0; i < length; ++i) padded[i] = residual[static_cast<Eigen::Index>(begin + i)];
    fft.fwd(spectrum, padded);
    for (std::size_t k = 0; k < power.size(); ++k)
      power[k] += 2.0 * std::norm(spectrum[k]) / static_cast<double>(std::max<std::size_t>(length, 1));
  }
  const double step = 1.0 / (static_cast<double>(points) * rows.period(0));
  const auto lowest = static_cast<std::size_t>(lowest_frequency / step) + 1;
  const auto highest = std::min(power.size(), static_cast<std::size_t>(band / rows.period(0) / step));
  if (highest <= lowest) return scan;
  power = {power.begin() + static_cast<std::ptrdiff_t>(lowest), power.begin() + static_cast<std::ptrdiff_t>(highest)};
  for (const auto k : outstanding(power, count, 8))
    scan.periods.push_back(1.0 / (step * static_cast<double>(lowest + k)));
  scan.trials = static_cast<std::size_t>(scan.extent * band / rows.period(0)) + 1;
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
      if (speed * top > band / rows.period(0))
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

// First over stretches of slow rows of some fifty periods, each with its own phase. Around what stands out, and at the
// usual periods, then over all rows that show the error at all, which tell periods apart as finely as their extent
// allows.
LineScan scan_signal_periods(const LogRows& rows, const Eigen::VectorXd& residual, const Whitening& whitening,
                             const machine::AxisModel& axis, const machine::Timing& timing, std::size_t count) {
  const auto x = rows.sampled([](const Motion& m) { return m.x; });
  LineScan scan;
  scan.extent = x.maxCoeff() - x.minCoeff();
  if (!(scan.extent > 0.0)) return scan;
  struct Peak {
    double order, height;
  };
  const auto higher = [](const Peak& a, const Peak& b) { return a.height > b.height; };
  std::vector<Peak> slow;
  const Eigen::VectorXd white = whitening(residual), weighed = whitening.transposed(white);
  const WhitenedGain whitened(whitening, rows.period(0));
  const double variance = white.squaredNorm() / static_cast<double>(white.size());
  for (double order = 1.0 / longest_signal; order < 1.0 / shortest_signal; order *= 2.0) {
    const auto in = stretches(rows, x, 2.0 * order, stretch_cycles / order);
    if (in.empty()) break;
    const double step = 0.125 * order / stretch_cycles;
    const auto found = gains(rows, weighed, whitened, x, in, order, step, static_cast<std::size_t>(order / step));
    scan.trials += found.size() / 8 + 1;
    for (const auto k : outstanding(found, count, 8))
      slow.push_back(
          {order + step * static_cast<double>(k), found[k] / variance - 2.0 * static_cast<double>(in.size())});
  }
  std::sort(slow.begin(), slow.end(), higher);
  slow.resize(std::min(slow.size(), slow_orders));
  ShownError shown(rows, weighed, whitened, x, axis, timing);
  std::vector<Peak> peaks;
  for (const auto& peak : slow) {
    constexpr std::size_t together = 16;
    const double step = 0.25 / scan.extent, reach = std::min(peak.order / stretch_cycles, 320.0 * step);
    Peak best{peak.order, 0.0};
    for (double first = peak.order - reach; first <= peak.order + reach; first += step * together) {
      const auto heights = shown.gains(first, step, together);
      const auto highest = std::max_element(heights.begin(), heights.end());
      if (*highest > best.height) best = {first + step * static_cast<double>(highest - heights.begin()), *highest};
    }
    peaks.push_back(best);
  }
  for (const double period : usual_signals) peaks.push_back({1.0 / period, shown.gains(1.0 / period, 0.0, 1).front()});
  std::sort(peaks.begin(), peaks.end(), higher);
  const auto apart = [&](double order) {  // neighbours lead to one and the same
    return std::all_of(scan.periods.begin(), scan.periods.end(),
                       [&](double period) { return std::abs(order - 1.0 / period) * scan.extent > 1.0; });
  };
  for (const auto& peak : peaks)
    if (scan.periods.size() < count && peak.height > 0.0 && apart(peak.order)) scan.periods.push_back(1.0 / peak.order);
  return scan;
}

}  // namespace stiction::host
