// The tuner of two pulses on truths that are not its model, by seeds that tuned nothing. `toolchain/test --cam-tuning`
// runs as many cases as are asked for.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "sim/cam/shaping/number_search.hpp"
#include "sim/cam/shaping/two_modes.hpp"
#include "tests/cam_tuning/campaign.hpp"
#include "tests/cam_tuning/production.hpp"
#include "tests/sim/cam/stand/study.hpp"
#include "tests/support/figure.hpp"

namespace stiction::cam_tuning {
namespace {

TEST(RecordTuning, TwoCyclesAreEnoughWithoutKnowingFrequencyOrDelay) {
  const auto found = tuned(
      773031, 100, [](Truth&) {}, 1.56, 1.56);
  EXPECT_GE(found.second.percent(), 85.0);
  EXPECT_EQ(found.third.count, found.cases);
  test::figure("cam tuning: dwell record, 100 cases: J <= 1.56 deg^2 in cycle 2, in cycle 3, worst of them",
               fmt::format("{} %, {} %, {:.2f}, {:.2f} deg^2", found.second.count, found.third.count,
                           found.worst_second, found.worst_third));
}

TEST(RecordTuning, FrictionAtTheMotorThatItDoesNotKnow) {
  for (const double coulomb : {1.0, 2.0}) {
    const auto found = tuned(
        881200 + static_cast<std::uint64_t>(coulomb), 100, [&](Truth& truth) { truth.coulomb = coulomb; }, 3.6, 1.56);
    EXPECT_GE(found.second.percent(), 85.0) << coulomb;
    EXPECT_GE(found.third.percent(), 90.0) << coulomb;
    test::figure(
        fmt::format("cam tuning: {} N m of friction at the motor, 100 cases: J in cycle 2, in cycle 3", coulomb),
        fmt::format("{} % <= 3.6, {} % <= 1.56, worst {:.2f}, {:.2f} deg^2", found.second.count, found.third.count,
                    found.worst_second, found.worst_third));
  }
}

TEST(RecordTuning, ASecondModeIsFoundAndCancelledByFourPulses) {
  for (const int percent : {10, 30}) {
    const auto found = with_two_modes(417700 + static_cast<std::uint64_t>(percent), 100, 0.01 * percent);
    EXPECT_GE(found.third_or_said.percent(), 90.0) << percent;
    EXPECT_GE(found.both_found.percent(), 90.0) << percent;
    test::figure(fmt::format("cam tuning: second mode of {} %, 100 cases: J <= 2.0 deg^2 in cycle 3, both found, worst",
                             percent),
                 fmt::format("{} %, {} %, {:.2f} deg^2", found.third.count, found.both_found.count, found.worst_third));
  }
}

TEST(RecordTuning, BacklashMakesNothingWorse) {
  const auto worse = worsened_by_backlash(990417, 200, 0.01);
  EXPECT_EQ(worse.count, 0);
  test::figure("cam tuning: backlash of 0.01 deg, 200 starts, worse than untuned", fmt::format("{}", worse.count));
}

// The interval of the coverage itself has to reach what is wanted: 98 of 100 may be 95 % or 99.
TEST(RecordTuning, IntervalsHoldTheTruth) {
  const auto found = covered(660219, 200);
  for (const Share& share : {found.frequency, found.damping, found.delay}) {
    EXPECT_GE(bounds(share).high, 90.0) << text(share);
    EXPECT_LE(bounds(share).low, 98.0) << text(share);
  }
  test::figure("cam tuning: 95 % intervals of frequency, damping, delay hold the truth, 200 cases",
               fmt::format("{:.1f}, {:.1f}, {:.1f} %", found.frequency.percent(), found.damping.percent(),
                           found.delay.percent()));
}

TEST(RecordTuning, FrictionIsFoundWithTheDelay) {
  for (const double coulomb : {0.0, 1.0, 2.0}) {
    const Truth truth{.factor = 0.9, .delay = 2.0, .coulomb = coulomb, .seed = 17};
    sim::cam::RecordTuner tuner(task_of(truth), settings_of(truth));
    tuner.learn(run(truth, motion_of(truth), 0).record);
    ASSERT_TRUE(tuner.drive());
    EXPECT_NEAR(tuner.drive()->coulomb / 33.0, coulomb, 0.15) << coulomb;
    EXPECT_NEAR(tuner.drive()->delay, 2e-3, 0.01e-3) << coulomb;
  }
}

// Pulses at the end of the rise would ask for 200 rad/s^2 here, and the axis has 180.
TEST(RecordTuning, PulsesKeepTheLimitsOfTheAxis) {
  const Truth truth{.factor = 1.13, .rise = 120.0, .seed = 3};
  sim::cam::RecordTuner tuner(task_of(truth), settings_of(truth)), boundless(task_of(truth), {resolution, {}});
  const auto first = run(truth, motion_of(truth), 0);
  tuner.learn(first.record);
  boundless.learn(first.record);
  const auto share = settings_of(truth).share_of_limits;
  EXPECT_LE(share(sim::cam::compose(tuner.cam()), 0.0), 1.0);
  EXPECT_GT(share(sim::cam::compose(boundless.cam()), 0.0), 1.0);
  EXPECT_LE(run(truth, sim::cam::compose(tuner.cam()), 1).quality, 4.0);
}

// Frequencies within 20 % and both rises; the number is that of the encoder, from 63 ms behind the rise on.
TEST(NumberTuning, SevenCyclesAreEnoughWithoutARecord) {
  double worst = 0.0;
  std::size_t most = 0;
  int within = 0;
  for (const double rise : {120.0, 180.0})
    for (const double factor : {0.8, 0.9, 1.0, 1.1, 1.2}) {
      const Truth truth{.factor = factor, .rise = rise, .seed = 60 + static_cast<std::uint64_t>(10.0 * factor)};
      std::uint64_t number = 0;
      const auto task = task_of(truth);
      const auto found = sim::cam::search_by_quadratic_form(task, settings_of(truth), [&](const sim::cam::Cam& cam) {
        return std::optional(record_quality(task, run(truth, sim::cam::compose(cam), number++).record));
      });
      const double left = run(truth, sim::cam::compose(found.best), 99).quality;
      within += left <= 2.0;
      worst = std::max(worst, left);
      most = std::max(most, found.trials.size());
    }
  EXPECT_LE(most, 7u);
  EXPECT_EQ(within, 10);
  test::figure("cam tuning: quality number only, ten cases: cycles, J at most, J <= 2.0",
               fmt::format("{}, {:.2f} deg^2, {} of 10", most, worst, within));
}

// Drawn machines, since the ten above have been looked at while the search was made.
TEST(NumberTuning, SoAreTheyOnDrawnMachines) {
  const auto found = by_number(550288, 60);
  EXPECT_LE(found.most, 7u);
  EXPECT_GE(found.within.percent(), 90.0);
  test::figure("cam tuning: quality number only, 60 drawn cases: J <= 2.0 deg^2, worst",
               fmt::format("{} of {}, {:.2f} deg^2", found.within.count, found.within.of, found.worst));
}

// Drawn machines, since the nine below have been looked at. What begins with less than a few increments of the encoder
// does not show its decay well enough (docs/limits.md).
TEST(RunningTuning, SoAreDrawnMachinesThatDoNotStop) {
  const auto found = without_stop(611953, 40);
  EXPECT_GE(found.second.percent(), 90.0);
  EXPECT_GE(found.always.percent(), 80.0);
  EXPECT_LE(std::max(found.worst_second, found.worst_later), 1.56);
  test::figure("cam tuning: running on, 40 drawn cases: J <= 0.6 deg^2 in cycle 2, always, worst of them",
               fmt::format("{} of {}, {} of {}, {:.2f}, {:.2f} deg^2", found.second.count, found.second.of,
                           found.always.count, found.always.of, found.worst_second, found.worst_later));
}

// 15 % of the stiffness in 2000 cycles: what the first tuning alone leaves of it, and what production makes of it.
TEST(RunningTuning, AGearThatWarmsIsFollowedInProduction) {
  std::mt19937_64 random(918273);
  Truth truth = drawn(random);
  while (run(truth, motion_of(truth), 0).quality <= 1.56) truth = drawn(random);
  const auto with = followed(truth, 0.15, 2000, true), without = followed(truth, 0.15, 2000, false);
  EXPECT_LE(with.worst, 3.6);
  EXPECT_GE(without.worst, 10.0);
  test::figure("cam tuning: gear that loses 15 % of its stiffness in 2000 cycles: J at most, without following",
               fmt::format("{:.2f}, {:.1f} deg^2", with.worst, without.worst));
}

// The machine runs on: behind twelve cycles of the untuned motion, each next one has what the tuner made of the last.
TEST(RunningTuning, OneCycleLaterTheLoadIsStillAndStaysSo) {
  double worst = 0.0, later = 0.0, settled = 0.0, of_worst = 0.0;
  int cases = 0, within = 0;
  for (const double rise : {120.0, 180.0})
    for (const double factor : {0.8, 0.9, 1.0, 1.1, 1.2}) {
      const Truth truth{
          .factor = factor, .rise = rise, .delay = 2.5, .seed = 70 + static_cast<std::uint64_t>(10.0 * factor)};
      const auto [qualities, settling] = tuned_running(truth);
      if (qualities[0] <= 1.56) continue;  // it needs no tuning
      ++cases;
      within += *std::max_element(qualities.begin() + 1, qualities.end()) <= 0.6;
      if (qualities[1] > worst) worst = qualities[1], of_worst = settling[1];
      settled = std::max(settled, *std::max_element(settling.begin() + 1, settling.end()));
      later = std::max(later, *std::max_element(qualities.begin() + 2, qualities.end()));
    }
  EXPECT_EQ(within, cases);
  EXPECT_LE(worst, 0.6);
  EXPECT_LE(later, 0.6);
  EXPECT_LE(settled, 0.6);
  test::figure(
      "cam tuning: running on: J in the cycle behind the record, in those behind it, at most, within 0.6 always",
      fmt::format("{:.2f}, {:.2f} deg^2, {} of {}", worst, later, within, cases));
  fmt::print("J behind the first 20 degrees of the dwell, in the worst cycle and at most: {:.2f}, {:.2f} deg^2\n",
             of_worst, settled);
}

// A cycle that has not been run is what the search asks for.
TEST(NumberTuning, AsksForTheNextCycle) {
  const auto task = task_of({});
  std::size_t asked = 0;
  const auto found = sim::cam::search_by_quadratic_form(
      task, {}, [&](const sim::cam::Cam&) { return asked++ < 2 ? std::optional(1.0) : std::nullopt; });
  EXPECT_EQ(found.trials.size(), 2u);
  ASSERT_TRUE(found.next);
  EXPECT_EQ(asked, 3u);
}

TEST(RecordTuning, WhatCannotBeTunedIsRefusedOrLeftAlone) {
  sim::cam::RecordTuner tuner(task_of({}), {resolution, {}});
  // A record that ends with the rise.
  sim::cam::CycleRecord half;
  for (int k = 0; k < 1000; ++k) {
    half.master.push_back(k * 1e-3);
    half.position.push_back(0.0);
  }
  EXPECT_THROW(tuner.learn(half), sim::cam::CamError);
  // One without a vibration, but for the encoder's noise.
  sim::cam::CycleRecord still;
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0.0, 0.003 * degree);
  for (int k = 0; k < 6284; ++k) {
    still.master.push_back(k * 1e-3);
    still.position.push_back(30.0 * degree + noise(random));
  }
  const auto cycle = tuner.learn(still);
  EXPECT_TRUE(tuner.done());
  EXPECT_NE(cycle.note.find("nothing is changed"), std::string::npos);
  EXPECT_FALSE(tuner.pulses());
  const auto task =
      shaping_task(sim::cam::indexing("parabola", 30.0, 35.0), sim::cam::study_drive(), stand_speed, 0.2, {});
  EXPECT_THROW(sim::cam::RecordTuner(task, {resolution, {}}), sim::cam::CamError);
}

// Two damped sines of known amplitudes about a constant, with the encoder's noise.
sim::cam::DwellRecord two_sines(double first, double second, double share, double length, double phase = 1.1) {
  sim::cam::DwellRecord record;
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0.0, 0.003 * degree);
  const double turn = 2.0 * 3.141592653589793;
  for (double t = 0.05; t < 0.05 + length; t += 0.25e-3) {
    record.time.push_back(t);
    const double a = std::exp(-0.014 * turn * first * t) * std::cos(turn * first * t + 0.4);
    const double b = std::exp(-0.01 * turn * second * t) * std::sin(turn * second * t + phase);
    record.position.push_back(0.3 * degree * (a + share * b) + 0.1 * degree + noise(random));
  }
  return record;
}

TEST(TwoModes, BothAreFoundWithTheirAmplitudes) {
  const auto record = two_sines(14.5, 40.0, 0.2, 0.18);
  const auto one = sim::cam::fit_dwell(record, 90.0);
  ASSERT_TRUE(one);
  const auto both = fit_two_modes(record, one->mode, resolution, false);
  ASSERT_TRUE(both);
  const double turn = 2.0 * 3.141592653589793;
  EXPECT_NEAR(both->modes[0].mode.pole.imag() / turn, 14.5, 0.02);
  EXPECT_NEAR(both->modes[1].mode.pole.imag() / turn, 40.0, 0.1);
  EXPECT_NEAR(both->modes[0].peak_to_peak(), 0.6 * degree, 0.01 * degree);
  EXPECT_NEAR(both->modes[1].peak_to_peak(), 0.12 * degree, 0.005 * degree);
  EXPECT_NEAR(std::arg(both->modes[0].residual), 0.4, 0.02);
  EXPECT_NEAR(both->modes[0].offset, 0.1 * degree, 0.001 * degree);
  // There is one mode alone in a record of one.
  const auto alone = two_sines(14.5, 40.0, 0.0, 0.18);
  EXPECT_FALSE(fit_two_modes(alone, sim::cam::fit_dwell(alone, 90.0)->mode, resolution, false));
}

// Nearer than half of the reciprocal of the record they look like one, which grows while they come into phase.
TEST(TwoModes, OneThatGrowsIsTwo) {
  const auto growth = [](const sim::cam::DwellRecord& record) {
    const auto fit = sim::cam::fit_dwell(record, 90.0);
    return fit ? growth_of(record, *fit) : -1.0;
  };
  EXPECT_EQ(growth(two_sines(14.5, 40.0, 0.0, 0.18)), 0.0);
  EXPECT_GT(growth(two_sines(14.5, 16.2, 0.8, 0.18, 4.7)), resolution);
}

TEST(TwoModes, TwoThatAreTooNearAreRefusedWithBothFrequencies) {
  const auto record = two_sines(14.5, 17.5, 0.8, 0.18);
  const auto one = sim::cam::fit_dwell(record, 90.0);
  ASSERT_TRUE(one);
  try {
    fit_two_modes(record, one->mode, resolution, false);
    FAIL() << "told apart";
  } catch (const sim::cam::CamError& error) {
    const std::string said = error.what();
    EXPECT_NE(said.find("found two modes at about 14.5"), std::string::npos) << said;
    EXPECT_NE(said.find("expected them 5.6 Hz apart or more"), std::string::npos) << said;
  }
}

}  // namespace
}  // namespace stiction::cam_tuning
