#include "host/response/spectra.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "host/response/bursts.hpp"

namespace stiction::host {
namespace {

constexpr double pause = 5e-3;                 // s without test signal between two stretches of it
constexpr std::size_t fewest_periods = 3;      // one settles, two are compared
constexpr std::size_t blocks_wanted = 5;       // of which the first settles
constexpr double least_line = 0.02;            // amplitude of a line against the largest one
constexpr std::size_t fewest_samples = 16384;  // of a test signal that does not repeat itself
constexpr double windows_wanted = 6.0;         // without overlap
constexpr double bands_per_decade = 50.0;

// The signals of an axis as they answer: what the set-points explain is taken off where the log has them.
struct Channels {
  std::vector<double> test;
  std::array<std::vector<double>, answers> answer;
};

std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b) {
  auto result = a;
  if (!b.empty())
    for (std::size_t k = 0; k < a.size(); ++k) result[k] -= b[k];
  return result;
}

Channels channels_of(const Log& log, const AxisLog& axis, double force_constant) {
  Channels c;
  const bool voltage = axis.i_inject.empty();
  c.test = voltage ? axis.u_inject : axis.i_inject;
  if (std::all_of(c.test.begin(), c.test.end(), [](double value) { return value == 0.0; }))
    throw ResponseError(fmt::format(
        "{}: found {}; expected a log recorded with a test signal on the controller's output, in a column "
        "i_inject[A] or u_inject[V]",
        place_of(log, axis), c.test.empty() ? "no i_inject and no u_inject" : "a test signal that is always zero"));
  auto& [position, velocity, current, current_error, controller] = c.answer;
  position = difference(axis.x, axis.x_set);
  if (!axis.v.empty()) velocity = difference(axis.v, axis.v_set);
  current = axis.i;
  if (current.empty())
    for (const double force : axis.force) current.push_back(force / force_constant);
  if (!axis.i_set.empty() && !current.empty()) current_error = difference(axis.i_set, current);
  if (const auto& set = voltage ? axis.u : axis.i_set; !set.empty()) controller = difference(set, c.test);
  return c;
}

// Takes the straight line off that goes through the means of the blocks: what an axis does without the test signal.
void remove_trend(std::vector<double>& values, std::size_t block) {
  const std::size_t blocks = values.size() / block;
  std::vector<double> means(blocks, 0.0);
  for (std::size_t b = 0; b < blocks; ++b)
    for (std::size_t k = 0; k < block; ++k) means[b] += values[b * block + k] / static_cast<double>(block);
  double above = 0.0, below = 0.0, mean = 0.0;
  const double middle = 0.5 * static_cast<double>(blocks - 1);
  for (std::size_t b = 0; b < blocks; ++b) {
    const double from_middle = static_cast<double>(b) - middle;
    above += from_middle * means[b];
    below += from_middle * from_middle;
    mean += means[b] / static_cast<double>(blocks);
  }
  const double slope = below > 0.0 ? above / below / static_cast<double>(block) : 0.0;
  const double centre = 0.5 * static_cast<double>(blocks * block - 1);
  for (std::size_t k = 0; k < values.size(); ++k) values[k] -= mean + slope * (static_cast<double>(k) - centre);
}

using Spectrum = std::vector<std::complex<double>>;

struct Sums {
  double frequency = 0.0;  // weighted with the test signal's power
  double test = 0.0;
  std::array<std::complex<double>, answers> cross{};
  std::array<double, answers> power{};
  std::size_t blocks = 0;
};

class Collector {
 public:
  explicit Collector(const Channels& channels, double period) : channels_(channels), period_(period) {}

  // Whole periods of the test signal, without the first ones.
  void add_periodic(const Burst& burst) {
    const std::size_t periods = periods_of(burst);
    const std::size_t joined = std::max<std::size_t>(1, periods / blocks_wanted);
    const std::size_t block = joined * burst.period, count = periods / joined;
    cut(burst.begin + block, (count - 1) * block, block);
    double largest = 0.0;
    for (std::size_t b = 0; b + 1 < count; ++b) {
      transform(b * block, block, {});
      for (std::size_t line = joined; line < test_.size(); line += joined)
        largest = std::max(largest, std::abs(test_[line]));
      for (std::size_t line = joined; line < test_.size(); line += joined) {
        if (std::abs(test_[line]) < least_line * largest) continue;
        const double frequency = static_cast<double>(line) / (static_cast<double>(block) * period_);
        add(std::llround(frequency * 1e6), frequency, line, true);
      }
    }
    samples_ += (count - 1) * block;
  }

  // Overlapping windows, joined in bands.
  void add_continuous(const Burst& burst) {
    std::size_t block = 1;
    while (static_cast<double>(2 * block) * windows_wanted <= static_cast<double>(burst.size())) block *= 2;
    std::vector<double> window(block);
    for (std::size_t k = 0; k < block; ++k)
      window[k] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(block));
    cut(burst.begin, burst.size() / block * block, block);
    for (std::size_t begin = 0; begin + block <= cut_.test.size(); begin += block / 2) {
      transform(begin, block, window);
      std::int64_t last = 0;
      for (std::size_t line = 2; line < test_.size() * 19 / 20; ++line) {  // two lines wide is the window's own peak
        const double frequency = static_cast<double>(line) / (static_cast<double>(block) * period_);
        const auto band = std::llround(std::log10(frequency) * bands_per_decade) + (std::int64_t{1} << 20);
        add(band, frequency, line, band != last);
        last = band;
      }
    }
    samples_ += burst.size();
  }

  static std::size_t periods_of(const Burst& burst) {
    // A last value of zero looks like the pause behind it.
    return burst.period == 0 ? 0 : (burst.size() + 1) / burst.period;
  }

  double seconds() const { return static_cast<double>(samples_) * period_; }

  std::vector<AnswerPoint> points() const {
    std::vector<AnswerPoint> result;
    double strongest = 0.0;
    for (const auto& [key, sums] : sums_) strongest = std::max(strongest, sums.test / static_cast<double>(sums.blocks));
    for (const auto& [key, sums] : sums_) {
      if (sums.blocks < 2 || sums.test < 1e-6 * strongest * static_cast<double>(sums.blocks)) continue;
      AnswerPoint point;
      point.frequency = sums.frequency / sums.test;
      point.blocks = sums.blocks;
      for (std::size_t a = 0; a < answers; ++a) {
        point.gain[a] = sums.cross[a] / sums.test;
        if (sums.power[a] > 0.0) point.coherence[a] = std::norm(sums.cross[a]) / (sums.test * sums.power[a]);
      }
      result.push_back(point);
    }
    std::sort(result.begin(), result.end(), [](const auto& a, const auto& b) { return a.frequency < b.frequency; });
    return result;
  }

 private:
  void cut(std::size_t begin, std::size_t count, std::size_t block) {
    const auto part = [&](const std::vector<double>& values) {
      std::vector<double> result;
      if (values.empty()) return result;
      const auto first = values.begin() + static_cast<std::ptrdiff_t>(begin);
      result.assign(first, first + static_cast<std::ptrdiff_t>(count));
      return result;
    };
    cut_.test = part(channels_.test);
    for (std::size_t a = 0; a < answers; ++a) {
      cut_.answer[a] = part(channels_.answer[a]);
      if (!cut_.answer[a].empty()) remove_trend(cut_.answer[a], block);
    }
  }

  Spectrum spectrum(const std::vector<double>& values, std::size_t begin, std::size_t block,
                    const std::vector<double>& window) {
    std::vector<double> piece(values.begin() + static_cast<std::ptrdiff_t>(begin),
                              values.begin() + static_cast<std::ptrdiff_t>(begin + block));
    for (std::size_t k = 0; k < window.size(); ++k) piece[k] *= window[k];
    Spectrum result;
    fft_.fwd(result, piece);
    result.resize(block / 2);
    return result;
  }

  void transform(std::size_t begin, std::size_t block, const std::vector<double>& window) {
    test_ = spectrum(cut_.test, begin, block, window);
    for (std::size_t a = 0; a < answers; ++a)
      if (!cut_.answer[a].empty()) answer_[a] = spectrum(cut_.answer[a], begin, block, window);
  }

  void add(std::int64_t key, double frequency, std::size_t line, bool new_block) {
    auto& sums = sums_[key];
    const auto test = test_[line];
    sums.frequency += frequency * std::norm(test);
    sums.test += std::norm(test);
    sums.blocks += new_block;
    for (std::size_t a = 0; a < answers; ++a) {
      if (answer_[a].empty()) continue;
      sums.cross[a] += answer_[a][line] * std::conj(test);
      sums.power[a] += std::norm(answer_[a][line]);
    }
  }

  const Channels& channels_;
  double period_;
  Channels cut_;
  Eigen::FFT<double> fft_;
  Spectrum test_;
  std::array<Spectrum, answers> answer_;
  std::map<std::int64_t, Sums> sums_;
  std::size_t samples_ = 0;
};

// The smallest speed in the direction of the motion, over about a millisecond each.
double slowest_speed(const Log& log, const AxisLog& axis, const std::vector<Burst>& bursts) {
  const auto span = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(1e-3 / log.period)));
  double slowest = HUGE_VAL;
  for (const auto& burst : bursts) {
    if (burst.size() <= span) continue;
    const double way = axis.x[burst.end - 1] - axis.x[burst.begin];
    for (std::size_t k = burst.begin; k + span < burst.end; ++k)
      slowest = std::min(
          slowest, std::copysign(1.0, way) * (axis.x[k + span] - axis.x[k]) / (static_cast<double>(span) * log.period));
  }
  return slowest;
}

}  // namespace

std::string place_of(const Log& log, const AxisLog& axis) {
  return axis.axis.empty() ? log.source : log.source + ": axis " + axis.axis;
}

Spectra measure_spectra(const Log& log, const AxisLog& axis, double force_constant) {
  const auto channels = channels_of(log, axis, force_constant);
  const auto shortest_pause = std::max<std::size_t>(5, static_cast<std::size_t>(std::lround(pause / log.period)));
  const auto bursts = find_bursts(channels.test, shortest_pause);
  Spectra result;
  for (std::size_t a = 0; a < answers; ++a) result.known[a] = !channels.answer[a].empty();
  result.slowest = slowest_speed(log, axis, bursts);
  Collector collector(channels, log.period);
  std::size_t most_periods = 0, longest = 0;
  for (const auto& burst : bursts) {
    most_periods = std::max(most_periods, Collector::periods_of(burst));
    longest = std::max(longest, burst.size());
    if (Collector::periods_of(burst) >= fewest_periods) {
      collector.add_periodic(burst);
      result.periodic = true;
    } else if (burst.period == 0 && burst.size() >= fewest_samples) {
      collector.add_continuous(burst);
    }
  }
  result.seconds = collector.seconds();
  result.points = collector.points();
  if (result.points.size() < 2)
    throw ResponseError(
        most_periods > 0 ? fmt::format("{}: found {} periods of the test signal; expected at least {} in a row: the "
                                       "first is for settling, the others are compared",
                                       place_of(log, axis), most_periods, fewest_periods)
                         : fmt::format("{}: found a test signal of {:.3g} s that does not repeat itself; expected {} "
                                       "periods of one, or at least {} samples ({:.3g} s)",
                                       place_of(log, axis), static_cast<double>(longest) * log.period, fewest_periods,
                                       fewest_samples, static_cast<double>(fewest_samples) * log.period));
  return result;
}

}  // namespace stiction::host
