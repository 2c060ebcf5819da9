// Answers to a test signal, of a loop that is known: x(k+1) = a x(k) + b u(k), u = -c x + r, with noise on the measured
// x that the controller feeds back. The plain ratio x/u would be bent by it.
#include "host/response/spectra.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <set>

#include "sim/experiment/test_signal.hpp"

namespace stiction::test {
namespace {

constexpr double a = 0.98, b = 0.05, c = 2.0, period = 1e-3;

host::Log closed_loop(const std::vector<double>& test, double noise, double speed = 0.1) {
  host::Log log;
  log.source = "test";
  log.period = period;
  auto& axis = log.axes.emplace_back();
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0.0, 1.0);
  double x = 0.0;
  for (std::size_t k = 0; k < test.size(); ++k) {
    const double t = static_cast<double>(k) * period, measured = x + noise * normal(random);
    const double u = -c * measured + test[k];
    log.t.push_back(t);
    axis.x.push_back(measured + speed * t);
    axis.i.push_back(u);
    axis.i_inject.push_back(test[k]);
    x = a * x + b * u;
  }
  return log;
}

std::complex<double> plant(double f) { return b / (std::polar(1.0, 2.0 * std::numbers::pi * f * period) - a); }

constexpr auto position = static_cast<std::size_t>(host::Answer::position);
constexpr auto current = static_cast<std::size_t>(host::Answer::current);

std::vector<double> repeated(const std::vector<double>& block, int times) {
  std::vector<double> signal(200, 0.0);
  for (int k = 0; k < times; ++k) signal.insert(signal.end(), block.begin(), block.end());
  signal.insert(signal.end(), 200, 0.0);
  return signal;
}

std::vector<double> block_of_multisine() { return sim::multisine(1000, sim::test_lines(1000, 10, 20.0), 1.0, 3); }

TEST(TestSignal, LinesAreApartAndDoNotFoldOnEachOther) {
  const auto lines = sim::test_lines(8000, 16, 50.0);
  EXPECT_EQ(lines.front(), 1);
  EXPECT_GT(lines.back(), 3600);
  std::set<int> folded;
  for (const int line : lines) EXPECT_TRUE(folded.insert(std::min(line % 500, 500 - line % 500)).second) << line;
  EXPECT_FALSE(folded.contains(0));
}

TEST(TestSignal, HasItsLinesAndItsPeak) {
  const std::vector<int> lines{3, 10};
  const auto signal = sim::multisine(100, lines, 2.5, 1);
  double largest = 0.0;
  for (const double value : signal) largest = std::max(largest, std::abs(value));
  EXPECT_NEAR(largest, 2.5, 1e-12);
  for (int line = 0; line < 50; ++line) {
    std::complex<double> sum = 0.0;
    for (int k = 0; k < 100; ++k)
      sum += signal[static_cast<std::size_t>(k)] * std::polar(1.0, -2.0 * std::numbers::pi * line * k / 100.0);
    if (line == 3 || line == 10)
      EXPECT_GT(std::abs(sum), 10.0);
    else
      EXPECT_LT(std::abs(sum), 1e-9) << line;
  }
}

TEST(Spectra, OfAPeriodicTestSignalAreExactWithoutNoise) {
  const auto log = closed_loop(repeated(block_of_multisine(), 6), 0.0);
  const auto spectra = measure_spectra(log, log.axes[0], 1.0);
  EXPECT_TRUE(spectra.periodic);
  ASSERT_GT(spectra.points.size(), 20u);
  for (const auto& point : spectra.points) {
    const auto measured = point.gain[position] / point.gain[current];
    EXPECT_LT(std::abs(measured / plant(point.frequency) - 1.0), 1e-6) << point.frequency;
    EXPECT_GT(point.coherence[position], 0.999999);
  }
}

// Noise of 0.02 on an answer of 0.05 and less a line, 35 blocks: 1.3 % in the mean, the lines' errors unrelated, so
// that they cancel in the mean of about twenty. The plain ratio of the two signals of the loop would be off by far
// more.
TEST(Spectra, NoiseInTheLoopDoesNotBendThem) {
  const auto log = closed_loop(repeated(block_of_multisine(), 40), 0.02);
  double mean = 0.0;
  std::complex<double> bias = 0.0;
  double count = 0.0;
  for (const auto& point : measure_spectra(log, log.axes[0], 1.0).points) {
    if (point.frequency > 100.0) continue;
    const auto error = point.gain[position] / point.gain[current] / plant(point.frequency) - 1.0;
    mean += std::abs(error);
    bias += error;
    count += 1.0;
  }
  EXPECT_LT(mean / count, 0.03);
  EXPECT_LT(std::abs(bias) / count, 0.01);
}

TEST(Spectra, CoherenceFallsWithTheNoise) {
  const auto mean_coherence = [](double noise) {
    const auto log = closed_loop(repeated(block_of_multisine(), 6), noise);
    double sum = 0.0;
    const auto points = measure_spectra(log, log.axes[0], 1.0).points;
    for (const auto& point : points) sum += point.coherence[position] / static_cast<double>(points.size());
    return sum;
  };
  EXPECT_GT(mean_coherence(1e-4), 0.999);
  EXPECT_LT(mean_coherence(0.1), 0.9);
}

// A band of a fiftieth of a decade holds at least 10 lines above 10 Hz: 5 % of magnitude and phase in the mean.
TEST(Spectra, OfATestSignalThatDoesNotRepeatComeFromWindows) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0.0, 0.5);
  std::vector<double> test(60000);
  for (auto& value : test) value = normal(random);
  const auto log = closed_loop(test, 1e-3);
  const auto spectra = measure_spectra(log, log.axes[0], 1.0);
  EXPECT_FALSE(spectra.periodic);
  double mean = 0.0;
  std::size_t count = 0;
  for (const auto& point : spectra.points) {
    if (point.frequency < 10.0 || point.frequency > 300.0) continue;
    mean += std::abs(point.gain[position] / point.gain[current] / plant(point.frequency) - 1.0);
    ++count;
  }
  ASSERT_GT(count, 50u);
  EXPECT_LT(mean / static_cast<double>(count), 0.05);
}

TEST(Spectra, TellTheSmallestSpeedWhileTheTestSignalActs) {
  const auto test = repeated(block_of_multisine(), 5);
  auto log = closed_loop(test, 0.0, 100.0);
  EXPECT_GT(measure_spectra(log, log.axes[0], 1.0).slowest, 0.0);
  log = closed_loop(test, 0.0, 0.1);
  EXPECT_LT(measure_spectra(log, log.axes[0], 1.0).slowest, 0.0);
}

void expect_refused(const host::Log& log, const std::string& message) {
  try {
    measure_spectra(log, log.axes[0], 1.0);
    FAIL() << "not refused; expected: " << message;
  } catch (const host::ResponseError& refusal) {
    EXPECT_NE(std::string(refusal.what()).find(message), std::string::npos) << refusal.what();
  }
}

TEST(Spectra, ALogWithoutEnoughTestSignalIsRefusedWithWhatToRecord) {
  auto log = closed_loop(repeated(block_of_multisine(), 2), 0.0);
  expect_refused(log, "found 2 periods of the test signal; expected at least 3 in a row");
  auto short_noise = std::vector<double>(300);
  for (std::size_t k = 0; k < short_noise.size(); ++k)
    short_noise[k] = std::sin(1e-3 * static_cast<double>(k * k) + 1.0);
  expect_refused(closed_loop(short_noise, 0.0), "found a test signal of 0.3 s that does not repeat itself");
  std::fill(log.axes[0].i_inject.begin(), log.axes[0].i_inject.end(), 0.0);
  expect_refused(log, "found a test signal that is always zero; expected a log recorded with a test signal");
  log.axes[0].i_inject.clear();
  expect_refused(log, "found no i_inject and no u_inject; expected");
}

}  // namespace
}  // namespace stiction::test
