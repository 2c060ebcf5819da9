#include "host/log/sampling.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <random>

#include "host/log/csv_log.hpp"
#include "host/log/resample.hpp"
#include "host/log/resolution.hpp"
#include "host/log/stretches.hpp"
#include "host/log/text_file.hpp"

namespace stiction::host {
namespace {

constexpr double amplitude = 0.05, frequency = 12.0;  // m, rad/s
constexpr double blank = std::numeric_limits<double>::quiet_NaN();

double position(double t) { return amplitude * std::sin(frequency * t); }

Log record(const std::vector<double>& t) {
  Log log;
  log.source = "run.csv";
  log.t = t;
  auto& axis = log.axes.emplace_back();
  for (const double time : t) {
    axis.x.push_back(position(time));
    axis.i.push_back(std::cos(frequency * time));
  }
  return log;
}

// `count` stamps of `period` s, each off by a normal deviation of `jitter` s.
std::vector<double> stamps(std::size_t count, double period, double jitter, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> off(0.0, 1.0);
  std::vector<double> t;
  for (std::size_t k = 0; k < count; ++k) t.push_back(static_cast<double>(k) * period + jitter * off(random));
  return t;
}

void read(Log& log, const StampDigits& digits = {}) {
  check_sampling(log, digits, [](std::size_t k) { return fmt::format("run.csv:{}", k + 2); });
}

std::string refusal(Log log) {
  try {
    read(log);
  } catch (const LogError& error) {
    return error.what();
  }
  return "";
}

bool notes(const Log& log, const std::string& part) {
  for (const auto& note : log.notes)
    if (note.find(part) != std::string::npos) return true;
  return false;
}

TEST(Sampling, LeavesAnEvenRecordAsItIsToTheLastBit) {
  const auto before = record(stamps(2000, 1e-3, 2e-6));  // 0.2 % of jitter
  auto log = before;
  read(log);
  EXPECT_EQ(log.t, before.t);
  EXPECT_EQ(log.axes[0].x, before.axes[0].x);
  EXPECT_EQ(log.axes[0].i, before.axes[0].i);
  EXPECT_FALSE(log.clock.resampled);
  EXPECT_TRUE(log.others.empty());
  EXPECT_TRUE(log.notes.empty());
  EXPECT_TRUE(log.axes[0].left_out.empty());
  EXPECT_NEAR(log.clock.jitter, 2e-6, 0.1e-6);
}

// C. A. Hall, J. Approx. Theory 1, 1968: 5/384 max|x''''| h^4, h the longest step; the increments of a spline's ends,
// which follow a parabola, are left out by 20 samples.
TEST(Sampling, MakesAJitteringClockEvenWithinTheErrorOfACubicSpline) {
  const auto t = stamps(1000, 5.3e-3, 0.2 * 5.3e-3);
  auto log = record(t);
  read(log);
  ASSERT_EQ(log.t.size(), t.size());
  EXPECT_TRUE(log.clock.resampled);
  EXPECT_NEAR(log.clock.jitter, 0.2 * 5.3e-3, 0.1 * 0.2 * 5.3e-3);
  double longest = 0.0;
  for (std::size_t k = 1; k < t.size(); ++k) longest = std::max(longest, t[k] - t[k - 1]);
  const double bound = 5.0 / 384.0 * amplitude * std::pow(frequency * longest, 4);
  double worst = 0.0, worst_effort = 0.0;
  for (std::size_t k = 1; k < log.t.size(); ++k) EXPECT_NEAR(log.t[k] - log.t[k - 1], log.period, 1e-12);
  for (std::size_t k = 20; k + 20 < log.t.size(); ++k) {
    worst = std::max(worst, std::abs(log.axes[0].x[k] - position(log.t[k])));
    worst_effort = std::max(worst_effort, std::abs(log.axes[0].i[k] - std::cos(frequency * log.t[k])));
  }
  EXPECT_LT(worst, bound);
  EXPECT_GT(worst, 0.001 * bound);
  // A monotone cubic is flat at a peak: there it is off like a line, by an eighth of the second derivative.
  EXPECT_LT(worst_effort, std::pow(frequency * longest, 2) / 8.0);
}

// What the stamps' digits explain is no jitter: at 190 Hz and with ms a stamp is off by 0.29 ms rms.
TEST(Sampling, TakesOffTheJitterWhatTheDigitsExplain) {
  auto t = stamps(3000, 1.0 / 190.0, 0.0);
  for (double& time : t) time = std::round(time * 1e3) / 1e3;
  auto log = record(t);
  read(log, {1e-3, 17});
  EXPECT_LT(log.clock.jitter, 0.15e-3);
}

TEST(Sampling, SplitsARecordAtItsGapsAndNamesTheStretches) {
  auto t = stamps(1000, 1e-3, 0.0);
  for (std::size_t k = 0; k < t.size(); ++k) t[k] += k >= 600 ? 0.25 : k >= 200 ? 0.004 : 0.0;
  auto log = record(t);
  read(log);
  EXPECT_EQ(log.source, "run.csv, stretch 2 of 3");
  EXPECT_EQ(log.t.size(), 400u);
  EXPECT_FALSE(log.clock.resampled);
  const auto all = stretches_of(log);
  ASSERT_EQ(all.size(), 3u);
  for (std::size_t k = 0; k < all.size(); ++k) {
    EXPECT_EQ(all[k].source, fmt::format("run.csv, stretch {} of 3", k + 1));
    EXPECT_EQ(all[k].clock.stretch, k);
    EXPECT_EQ(all[k].clock.stretches, 3u);
    EXPECT_NEAR(all[k].period, 1e-3, 1e-12);
  }
  EXPECT_EQ(all[0].t.size() + all[1].t.size() + all[2].t.size(), 1000u);
  EXPECT_EQ(all[2].axes[0].x.front(), position(t[600]));
}

TEST(Sampling, SplitsWhereTheRateChanges) {
  std::vector<double> t{0.0};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> late(0.0, 2e-4);
  for (int k = 0; k < 800; ++k) t.push_back(t.back() + (k < 300 ? 5.3e-3 : 3.5e-3) + late(random));
  auto log = record(t);
  read(log);
  const auto all = stretches_of(log);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_NEAR(static_cast<double>(all[0].t.size()), 301.0, 2.0);
  EXPECT_NEAR(all[0].period, 5.4e-3, 5e-5);
  EXPECT_NEAR(all[1].period, 3.6e-3, 5e-5);
}

// The jitter of 20 % explains a step of 1.5: nothing is lost there.
TEST(Sampling, DoesNotTakeJitterForGaps) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    auto log = record(stamps(2000, 5e-3, 0.2 * 5e-3, seed));
    std::vector<double> rising = log.t;
    std::ranges::sort(rising);
    log = record(rising);
    read(log);
    EXPECT_EQ(log.clock.stretches, 1u) << "seed " << seed;
  }
}

TEST(Sampling, ListsAndDropsStretchesThatAreTooShort) {
  auto t = stamps(500, 1e-3, 0.0);
  for (std::size_t k = 0; k < t.size(); ++k) t[k] += k >= 490 ? 0.5 : 0.0;
  auto log = record(t);
  read(log);
  EXPECT_EQ(log.t.size(), 490u);
  EXPECT_TRUE(log.others.empty());
  EXPECT_TRUE(notes(log, "10 from run.csv:492")) << log.notes.size();
}

TEST(Sampling, RefusesStampsThatRepeatOrFallWithTheirLine) {
  auto t = stamps(100, 1e-3, 0.0);
  t[40] = t[39];
  EXPECT_TRUE(refusal(record(t)).starts_with("run.csv:42: found the time 0.039 s")) << refusal(record(t));
  t[40] = t[38];
  EXPECT_TRUE(refusal(record(t)).starts_with("run.csv:42: ")) << refusal(record(t));
  t[40] = blank;
  EXPECT_TRUE(refusal(record(t)).starts_with("run.csv:42: found no time")) << refusal(record(t));
}

TEST(Sampling, TrimsARecordToWhereItsPositionAndEffortAre) {
  auto log = record(stamps(1000, 1e-3, 0.0));
  for (std::size_t k = 0; k < 30; ++k) log.axes[0].x[k] = blank;
  for (std::size_t k = 950; k < 1000; ++k) log.axes[0].i[k] = blank;
  read(log);
  EXPECT_EQ(log.t.size(), 920u);
  EXPECT_EQ(log.axes[0].x.front(), position(0.03));
  EXPECT_TRUE(log.axes[0].left_out.empty());
  EXPECT_TRUE(notes(log, "30 rows before and 50 behind"));
}

TEST(Sampling, LeavesABlankCellOutOfEveryFit) {
  auto log = record(stamps(1000, 1e-3, 0.0));
  log.axes[0].x[400] = blank;
  log.axes[0].i[401] = blank;
  read(log);
  ASSERT_EQ(log.axes[0].left_out.size(), 1000u);
  EXPECT_EQ(std::ranges::count(log.axes[0].left_out, true), 2);
  EXPECT_TRUE(log.axes[0].left_out[400] && log.axes[0].left_out[401]);
  EXPECT_NEAR(log.axes[0].x[400], position(0.4), 1e-5);
}

TEST(Sampling, KeepsTheRowsOfASlowerPosition) {
  auto log = record(stamps(1000, 1e-3, 0.0));
  for (std::size_t k = 0; k < 1000; ++k)
    if (k % 4 != 0) log.axes[0].x[k] = blank;
  read(log);
  EXPECT_EQ(log.t.size(), 250u);
  EXPECT_NEAR(log.period, 4e-3, 1e-12);
  EXPECT_TRUE(log.axes[0].left_out.empty());
}

TEST(Sampling, TakesAChannelWithoutValuesAsAbsentAndFillsASlowOne) {
  auto log = record(stamps(1000, 1e-3, 0.0));
  log.axes[0].u.assign(1000, blank);
  log.axes[0].temperature.assign(1000, blank);
  for (std::size_t k = 0; k < 1000; k += 100) log.axes[0].temperature[k] = 20.0 + static_cast<double>(k) * 1e-3;
  read(log);
  EXPECT_TRUE(log.axes[0].u.empty());
  EXPECT_TRUE(notes(log, "u[V] has no value in any row"));
  EXPECT_NEAR(log.axes[0].temperature[450], 20.45, 1e-12);
  EXPECT_TRUE(log.axes[0].left_out.empty());
}

TEST(Sampling, IntegratesASpeedWithoutAPosition) {
  auto log = record(stamps(1000, 1e-3, 0.0));
  for (const double t : log.t) log.axes[0].v.push_back(amplitude * frequency * std::cos(frequency * t));
  log.axes[0].x.clear();
  read(log);
  ASSERT_EQ(log.axes[0].x.size(), 1000u);
  // The trapezoidal rule: h^2/12 of the change of the speed's derivative.
  const double bound = 1e-6 / 12.0 * 2.0 * amplitude * frequency * frequency;
  for (std::size_t k = 0; k < 1000; ++k) EXPECT_NEAR(log.axes[0].x[k], position(log.t[k]), bound);
  EXPECT_TRUE(notes(log, "x is integrated from v"));
}

TEST(Sampling, LeavesOutAClippedEffortAndNothingOfARoundedPeak) {
  auto log = record(stamps(2000, 1e-3, 0.0));
  auto sine = log;
  for (double& i : sine.axes[0].i) i = 0.01 * std::round(i / 0.01);
  read(sine);
  EXPECT_TRUE(sine.axes[0].left_out.empty());
  std::size_t clipped = 0;
  for (double& i : log.axes[0].i) {
    clipped += std::abs(i) >= 0.8;
    i = std::clamp(i, -0.8, 0.8);
  }
  read(log);
  ASSERT_EQ(log.axes[0].left_out.size(), 2000u);
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(log.axes[0].left_out, true)), clipped);
}

TEST(Sampling, LeavesOutAPositionThatStopsWithinASampleAtItsEndButNotADwell) {
  auto dwell = record(stamps(2000, 1e-3, 0.0));
  for (std::size_t k = 0; k < 2000; ++k) {
    const double s = std::min(1.0, dwell.t[k]);
    dwell.axes[0].x[k] = 1e-6 * std::round(1e6 * 0.1 * s * s * (3.0 - 2.0 * s));
  }
  auto clipped = dwell;
  for (double& x : clipped.axes[0].x) x = std::min(x, 0.06);
  read(dwell);
  EXPECT_TRUE(dwell.axes[0].left_out.empty());
  read(clipped);
  EXPECT_GT(std::ranges::count(clipped.axes[0].left_out, true), 1000);
}

TEST(Resample, DoesNotRingAtAJump) {
  std::vector<double> t, values, at;
  for (int k = 0; k < 100; ++k) t.push_back(k * 1e-3 + 1e-4 * (k % 3)), values.push_back(k < 50 ? -1.0 : 2.0);
  for (int k = 0; k < 9800; ++k) at.push_back(k * 1e-5);
  EXPECT_EQ(interpolation_of(values, true, 0.0), Interpolation::monotone);
  for (const auto how : {Interpolation::monotone, Interpolation::line, Interpolation::held})
    for (const double value : interpolated(t, values, at, how)) {
      EXPECT_GE(value, -1.0);
      EXPECT_LE(value, 2.0);
    }
}

TEST(Resample, TakesALineWhereTheCountsAreCoarse) {
  std::vector<double> coarse, fine;
  for (int k = 0; k < 1000; ++k) {
    const double x = 0.05 * std::sin(2.0 * k * 5e-3);
    coarse.push_back(1e-4 * std::round(x / 1e-4));
    fine.push_back(1e-8 * std::round(x / 1e-8));
  }
  EXPECT_EQ(interpolation_of(coarse, true, increment_of(std::span<const double>(coarse))), Interpolation::line);
  EXPECT_EQ(interpolation_of(fine, true, increment_of(std::span<const double>(fine))), Interpolation::spline);
}

// The pendulum's twelve records, judged where they are.
TEST(Sampling, ReadsThePendulumsRecords) {
  const std::filesystem::path folder = std::filesystem::path(STICTION_SOURCE_DIR) / "../shared/data/xl330";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not here";
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".csv") continue;
    ++files;
    auto text = read_text_file(entry.path());
    for (const std::string unit : {"x_set[rad]", "x[rad]"}) {
      const auto at = text.find("," + unit) + 1;
      text.replace(at, unit.size(), unit.substr(0, unit.find('[')) + "[m]");
    }
    const auto name = entry.path().stem().string();
    const auto log = parse_csv_log(text, name);
    const bool dropped = name.ends_with("lift_and_drop");  // the motor is switched off: the rate changes
    EXPECT_EQ(log.clock.stretches, dropped ? 2u : 1u) << name;
    for (const auto& stretch : stretches_of(log)) {
      EXPECT_TRUE(stretch.clock.resampled) << name;
      EXPECT_GT(stretch.clock.jitter, 10e-6) << name;
      EXPECT_LT(stretch.clock.jitter, 300e-6) << name;
      EXPECT_NEAR(increment_of(stretch.axes[0], &AxisLog::x), 2.0 * std::numbers::pi / 4096.0, 1e-6) << name;
    }
    const auto left_out = std::ranges::count(log.axes[0].left_out, true);
    if (name.starts_with("k800") || dropped)
      EXPECT_GT(left_out, 30) << name;
    else
      EXPECT_EQ(left_out, 0) << name;
  }
  EXPECT_EQ(files, 12);
}

}  // namespace
}  // namespace stiction::host
