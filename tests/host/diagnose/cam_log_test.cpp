// Logs of an electronic cam: a motion that repeats, begins in the middle of itself, and shares the encoder's places
// with the simulation of its machine file.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>
#include <string>

#include "host/diagnose/diagnose.hpp"
#include "host/diagnose/record/cycle_mean.hpp"
#include "host/diagnose/record/record.hpp"
#include "host/diagnose/record/record_rows.hpp"
#include "host/diagnose/verdict/verdict_json.hpp"
#include "host/identify/own_identification.hpp"
#include "host/simulate/cam_run.hpp"
#include "host/simulate/replay.hpp"
#include "sim/cam/motion.hpp"
#include "sim/cam/motion_file.hpp"
#include "sim/machine_file.hpp"
#include "tests/host/diagnose/cam_record.hpp"
#include "tests/support/figure.hpp"

namespace stiction::host {
namespace {

const std::filesystem::path source = STICTION_SOURCE_DIR;

// The simulation begins with the record and hunts as it does for a while: columns of that motion had a part of the
// record's own hunting, which looked like an elastic mode.
TEST(CamLog, OfAMachineAsItsFileSaysNamesNothing) {
  DiagnoseInput input;
  input.machine = sim::read_machine((source / "firmware/machine/shipped/servo-joint.toml").string(), {});
  input.next_measurement = false;
  input.logs.push_back(cam_log(input.machine, 20.0, 4));
  input.held_out.push_back(cam_log(input.machine, 26.0, 2));
  const auto verdict = diagnose(input);
  EXPECT_TRUE(verdict.findings.empty()) << verdict_text(verdict);
}

// The load swings on from cycle to cycle, and a record of a running machine begins in the midst of it.
TEST(CamLog, OfAStandIsFollowedThroughTheCyclesBeforeIt) {
  const auto log = linear_logs({cam_log(cam_stand(), 130.0, 3)}, cam_stand().axes).front();
  const auto rms_from = [&](const Log& record) {
    const auto again = replay_linear_as_held(cam_stand(), record);
    double square = 0.0;
    for (std::size_t k = 0; k < log.t.size(); ++k)
      square += std::pow(again.axes.front().x[k] - log.axes.front().x[k], 2) / static_cast<double>(log.t.size());
    return std::sqrt(square);
  };
  auto without = log;
  without.axes.front().master.clear();
  const double increment = cam_stand().axes.front().encoder.increment;
  EXPECT_LT(rms_from(log), increment);
  EXPECT_GT(rms_from(without), 20.0 * increment);
}

// Five times as much as the noise, thrice in a cycle: a force of the place, whatever its cause.
TEST(CamLog, WhatComesBackInEachCycleIsNoDisturbance) {
  const auto axis = cam_stand().axes.front();
  Record record;
  record.logs = linear_logs({cam_log(cam_stand(), 130.0, 9, 16)}, axis);
  measure(record, axis, signals_in(host::RowBand::usual, record.logs));
  std::mt19937_64 random(7);
  std::normal_distribution<> noise;
  Eigen::VectorXd values(record.rows.rows()), wave(values.size());
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    wave[k] = std::sin(3.0 * 2.0 * std::numbers::pi * record.rows.time[k] * 130.0 / 60.0);
    values[k] = 5.0 * wave[k] + noise(random);
  }
  const auto left = without_cycle_mean(values, record.rows, record.logs, axis);
  EXPECT_NEAR(left.norm(), std::sqrt(static_cast<double>(left.size())), 0.05 * left.norm());
  EXPECT_LT(std::abs(left.dot(wave)), 0.05 * left.norm() * wave.norm());
}

TEST(CamLog, OfASlaveBehindItsMasterNamesTheDelay) {
  constexpr double delay = 0.3e-3;
  auto late = cam_stand();
  late.axes.front().effects = {{"master_delay", {{"delay", {delay}}}}};
  DiagnoseInput input;
  input.machine = cam_stand();
  input.next_measurement = false;
  input.logs.push_back(cam_log(late, 130.0, 9, 16));
  input.held_out.push_back(cam_log(late, 100.0, 6, 16));
  const auto verdict = diagnose(input);
  ASSERT_EQ(verdict.findings.size(), 1u) << verdict_text(verdict);
  const auto& finding = verdict.findings.front();
  EXPECT_EQ(finding.effect.name(), "master_delay");
  EXPECT_NEAR(finding.values.at("delay").front(), delay, 20e-6);
  test::figure("delay of a slave behind its master, off the true one",
               fmt::format("{:.1f} us (bound 20 us)", 1e6 * std::abs(finding.values.at("delay").front() - delay)));
  const auto has = [&](std::string_view title) {
    return std::any_of(verdict.before_after.begin(), verdict.before_after.end(),
                       [&](const sim::Chart& chart) { return chart.title == title; });
  };
  for (const auto* title : {"Following error over the master", "Residual force over the master",
                            "Residual force in orders of the master", "Residual force in orders of the motor"})
    EXPECT_TRUE(has(title)) << title;
}

}  // namespace
}  // namespace stiction::host
