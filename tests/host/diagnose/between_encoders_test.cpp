// Causes between motor and load from the difference of two encoders: on motions in closed form, and on records of the
// test rig for cams.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "host/diagnose/diagnose.hpp"
#include "host/diagnose/judge/encoder_causes.hpp"
#include "host/diagnose/judge/encoder_difference.hpp"
#include "host/diagnose/record/record_rows.hpp"
#include "host/diagnose/verdict/verdict_json.hpp"
#include "host/identify/own_identification.hpp"
#include "sim/effects/effects.hpp"
#include "tests/host/diagnose/cam_record.hpp"
#include "tests/support/figure.hpp"

namespace stiction::host {
namespace {

constexpr double pi = std::numbers::pi;

struct Truth {
  double stiffness = 1.0;  // of the file's
  double wave = 0.0;       // rad at the load, once in a turn of the motor
  double play = 0.0;       // rad
};

// A load that rocks by two sines; where its motor is follows from that: the shaft bends by what accelerates the load.
// The motor's torque moves both.
Log rocking(const machine::AxisModel& axis, const Truth& truth, double frequency, unsigned seed) {
  std::mt19937_64 random(seed);
  const double radius = axis.coordinate.radius;
  std::normal_distribution<> noise(0.0, axis.second_encoder->noise / radius);
  const double inertia = (axis.mass - axis.motor_mass) * radius * radius, of_motor = axis.motor_mass * radius * radius;
  const double stiffness = truth.stiffness * *axis.transmission->stiffness * radius * radius;
  const double ratio = axis.transmission->ratio;
  Log log;
  log.source = "rocking";
  log.period = 5e-4;
  auto& channels = log.axes.emplace_back();
  channels.axis = axis.name;
  channels.rotary = true;
  const double w1 = 2.0 * pi * frequency, w2 = 2.3 * w1;
  const auto load = [&](double t) { return 0.6 * std::sin(w1 * t) + 0.1 * std::sin(w2 * t + 1.0); };
  const auto torque = [&](double t) {
    return inertia * (-0.6 * w1 * w1 * std::sin(w1 * t) - 0.1 * w2 * w2 * std::sin(w2 * t + 1.0));
  };
  const double side = 0.05 * inertia * 0.6 * w1 * w1;  // N m, in which the play is crossed
  const auto motor = [&](double t) {
    return load(t) + torque(t) / stiffness - truth.wave * std::sin(ratio * load(t) + 0.7) +
           0.5 * truth.play * std::tanh(torque(t) / side);
  };
  for (int k = 0; k < 12000; ++k) {
    const double t = k * log.period, h = 1e-4;
    log.t.push_back(t);
    channels.x.push_back(motor(t));
    channels.x_load.push_back(load(t) + noise(random));
    const double acceleration = (motor(t + h) - 2.0 * motor(t) + motor(t - h)) / (h * h);
    channels.force.push_back(of_motor * acceleration + torque(t));
  }
  return log;
}

machine::AxisModel plain_axis() {
  auto axis = cam_stand().axes.front();
  axis.second_encoder->delay = 0.0;
  axis.transmission->damping = 0.0;
  axis = sim::plant_axis(axis);
  return axis;
}

Record record_of(const machine::AxisModel& axis, std::vector<Log> logs, SignalSettings& settings) {
  Record record;
  record.logs = linear_logs(logs, {axis});
  settings = signals_in(host::RowBand::usual, record.logs);
  measure(record, axis, settings);
  return record;
}

EncoderCauses causes_of(const Truth& truth, const machine::AxisModel& axis = plain_axis()) {
  SignalSettings settings;
  const auto training = record_of(axis, {rocking(axis, truth, 1.1, 1), rocking(axis, truth, 1.7, 2)}, settings);
  const auto held_out = record_of(axis, {rocking(axis, truth, 1.4, 3)}, settings);
  return find_between_encoders(*EncoderDifference::of(training, axis, settings),
                               *EncoderDifference::of(held_out, axis, settings), axis, ShownUnits(axis.coordinate), 1);
}

TEST(BetweenEncoders, NothingIsNamedWhereTheShaftIsAsItsFileSays) {
  const auto found = causes_of({});
  EXPECT_TRUE(found.findings.empty()) << found.findings.front().effect.name();
}

TEST(BetweenEncoders, ASofterShaftIsNamedWithItsStiffness) {
  const auto found = causes_of({.stiffness = 0.9});
  ASSERT_EQ(found.findings.size(), 1u);
  const auto& finding = found.findings.front();
  EXPECT_EQ(finding.effect.name(), "shaft_stiffness");
  EXPECT_EQ(finding.residual, Residual::encoders);
  const auto axis = plain_axis();
  const double off = finding.values.at("stiffness").front() / (0.9 * *axis.transmission->stiffness) - 1.0;
  EXPECT_LT(std::abs(off), 0.01);
  EXPECT_LT(*finding.holdout.encoder_rms_ratio, 0.3);
  EXPECT_EQ(finding.charts.size(), 1u);
}

// A load whose encoder is too coarse for its acceleration: the force is the motor's, less what moves that.
TEST(BetweenEncoders, TheMotorIsTheGaugeWhereTheLoadsEncoderIsCoarse) {
  auto axis = plain_axis();
  axis.second_encoder->noise = 0.0035 * axis.coordinate.radius;
  const auto found = causes_of({.stiffness = 0.75}, axis);
  ASSERT_EQ(found.findings.size(), 1u);
  const double stiffness = found.findings.front().values.at("stiffness").front();
  EXPECT_NEAR(stiffness / (0.75 * *axis.transmission->stiffness), 1.0, 0.1);
}

TEST(BetweenEncoders, APlayIsNoStiffness) {
  for (const auto& finding : causes_of({.play = 1e-3}).findings) ADD_FAILURE() << finding.effect.name();
}

TEST(BetweenEncoders, AWheelOffItsCentreIsNamedWithItsOrder) {
  constexpr double amplitude = 5e-4;
  const auto found = causes_of({.wave = amplitude});
  ASSERT_EQ(found.findings.size(), 1u);
  const auto& finding = found.findings.front();
  EXPECT_EQ(finding.effect.name(), "transmission_error");
  EXPECT_EQ(finding.values.at("per").front(), 33.0);
  EXPECT_EQ(finding.values.at("order").front(), 1.0);
  const auto radius = plain_axis().coordinate.radius;
  const double size = std::hypot(finding.values.at("cosine").front(), finding.values.at("sine").front()) / radius;
  EXPECT_NEAR(size, amplitude, 0.05 * amplitude);
}

TEST(BetweenEncoders, BothAreToldApart) {
  const auto found = causes_of({.stiffness = 1.15, .wave = 4e-4});
  ASSERT_EQ(found.findings.size(), 2u);
}

TEST(BetweenEncoders, NeedAnEncoderOnEitherSideInEachRecord) {
  const auto axis = plain_axis();
  SignalSettings settings;
  auto record = record_of(axis, {rocking(axis, {}, 1.1, 1)}, settings);
  EXPECT_TRUE(EncoderDifference::of(record, axis, settings));
  record.logs.front().axes.front().x_load.clear();
  EXPECT_FALSE(EncoderDifference::of(record, axis, settings));
  auto same_side = axis;
  same_side.second_encoder->on = same_side.encoder.on;
  EXPECT_FALSE(EncoderDifference::of(record, same_side, settings));
}

// The rig's own machine with the effect, in closed loop, behind a cam. `asking`: proposes the next measurement too.
Verdict of_rig(std::vector<machine::Effect> effects, bool asking = false) {
  auto rig = cam_stand();
  rig.axes.front().effects = std::move(effects);
  DiagnoseInput input;
  input.machine = cam_stand();
  input.next_measurement = asking;
  input.logs.push_back(cam_log(rig, 130.0, 9, 16));
  input.held_out.push_back(cam_log(rig, 100.0, 6, 16));
  return diagnose(input);
}

TEST(BetweenEncoders, TheRigsShaftIsFoundBehindACam) {
  const double file = *cam_stand().axes.front().transmission->stiffness;
  const auto verdict = of_rig({{"shaft_stiffness", {{"stiffness", {0.88 * file}}}}});
  ASSERT_EQ(verdict.findings.size(), 1u) << verdict_text(verdict);
  const auto& finding = verdict.findings.front();
  EXPECT_EQ(finding.effect.name(), "shaft_stiffness");
  const double off = std::abs(finding.values.at("stiffness").front() / (0.88 * file) - 1.0);
  EXPECT_LT(off, 0.05);
  test::figure("stiffness of a shaft between two encoders behind a cam, off the true one",
               fmt::format("{:.2f} % (bound 5 %)", 100.0 * off));
}

TEST(BetweenEncoders, TheRigsGearIsFoundBehindACam) {
  const double radius = cam_stand().axes.front().coordinate.radius, amplitude = 4e-4 * radius;
  const auto verdict =
      of_rig({{"transmission_error",
               {{"per", {33.0}}, {"order", {2.0}}, {"cosine", {0.6 * amplitude}}, {"sine", {0.8 * amplitude}}}}},
             true);
  ASSERT_EQ(verdict.findings.size(), 1u) << verdict_text(verdict);
  const auto& finding = verdict.findings.front();
  ASSERT_EQ(finding.effect.name(), "transmission_error");
  EXPECT_EQ(finding.values.at("order").front(), 2.0);
  const double size = std::hypot(finding.values.at("cosine").front(), finding.values.at("sine").front());
  const double off = std::abs(size / amplitude - 1.0);
  EXPECT_LT(off, 0.1);
  test::figure("transmission error between two encoders behind a cam, amplitude off the true one",
               fmt::format("{:.1f} % (bound 10 %)", 100.0 * off));
}

}  // namespace
}  // namespace stiction::host
