// The measured EMPS axis against its published model: what is named holds in both halves of the record, and what it
// gains is measured on thirds that took no part. The record is not part of this repository (no licence text); it is
// looked for beside it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "host/diagnose/diagnose.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/identify/log_rows.hpp"
#include "host/log/read_log.hpp"
#include "sim/effects/effects.hpp"
#include "sim/effects/encoder_subdivision_error/encoder_subdivision_error.hpp"
#include "sim/effects/time_skew/time_skew.hpp"
#include "sim/machine_file.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

std::filesystem::path record() {
  if (const char* place = std::getenv("STICTION_EMPS")) return place;
  return std::filesystem::path(STICTION_SOURCE_DIR) / ".." / "shared" / "data" / "emps.csv";
}

host::Log part(const host::Log& log, double from, double to) {
  const auto size = static_cast<double>(log.t.size());
  const auto begin = static_cast<std::ptrdiff_t>(from * size), end = static_cast<std::ptrdiff_t>(to * size);
  const auto cut = [&](std::vector<double>& values) {
    if (!values.empty()) values = {values.begin() + begin, values.begin() + end};
  };
  host::Log piece = log;
  cut(piece.t);
  for (auto& axis : piece.axes)
    for (const auto& channel : host::log_channels) cut(axis.*channel.values);
  return piece;
}

class EmpsDiagnosis : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(record()))
      GTEST_SKIP() << record()
                   << " is not there: fetch the EMPS record from the benchmark's site "
                      "(nonlinearbenchmark.org) and name it in $STICTION_EMPS";
    log_ = host::read_log(record());
    machine_ = sim::read_machine(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/emps.toml");
  }
  host::Verdict diagnose(const std::vector<host::Log>& logs, const std::vector<host::Log>& held_out,
                         bool closed_loop) const {
    host::DiagnoseInput input;
    input.machine = machine_;
    input.logs = logs;
    input.held_out = held_out;
    input.closed_loop = closed_loop;
    return host::diagnose(input);
  }
  static std::string names(const host::Verdict& verdict) {
    std::string text;
    for (const auto& f : verdict.findings) {
      text += fmt::format("{}{}(", text.empty() ? "" : " ", f.effect.name());
      for (const auto& p : f.parameters) text += fmt::format("{} {:.4g} ", p.name(), p.values.front());
      text.back() = ')';
    }
    return text;
  }
  host::Log log_;
  machine::Machine machine_;
};

TEST_F(EmpsDiagnosis, cuts_the_residual_force_in_cross_validation) {
  double before = 0.0, after = 0.0, position_before = 0.0, position_after = 0.0;
  for (int k = 0; k < 3; ++k) {
    std::vector<host::Log> training;
    for (int other = 0; other < 3; ++other)
      if (other != k) training.push_back(part(log_, other / 3.0, (other + 1) / 3.0));
    const auto verdict = diagnose(training, {part(log_, k / 3.0, (k + 1) / 3.0)}, true);
    ASSERT_TRUE(verdict.extended.position_error_rms.has_value());
    figure(fmt::format("EMPS, diagnosis judged on third {}", k + 1),
           fmt::format("force {:.2f} to {:.2f} N rms, position {:.2f} to {:.2f} um; {}", verdict.baseline.force_rms,
                       verdict.extended.force_rms, 1e6 * *verdict.baseline.position_error_rms,
                       1e6 * *verdict.extended.position_error_rms, names(verdict)));
    before += std::pow(verdict.baseline.force_rms, 2);
    after += std::pow(verdict.extended.force_rms, 2);
    position_before += std::pow(*verdict.baseline.position_error_rms, 2) / 3.0;
    position_after += std::pow(*verdict.extended.position_error_rms, 2) / 3.0;
  }
  figure("EMPS, diagnosis: residual force variance cut, each third held out in turn",
         fmt::format("{:.0f} % (bound 74 %)", 100.0 * (1.0 - after / before)));
  figure("EMPS, diagnosis: closed-loop position, each third held out in turn",
         fmt::format("{:.2f} um rms, published model {:.2f} um (bound 0.91 um)", 1e6 * std::sqrt(position_after),
                     1e6 * std::sqrt(position_before)));
  EXPECT_GE(1.0 - after / before, 0.74);
  EXPECT_LE(std::sqrt(position_after), 0.91e-6);
}

// Residual force (N rms) of a part of the record, with these effects in the machine file beside its own; no nuisance is
// estimated.
double residual_rms(const host::Log& log, const machine::Machine& machine,
                    const std::vector<machine::Effect>& effects) {
  auto axis = machine.axes.front();
  axis.effects.insert(axis.effects.end(), effects.begin(), effects.end());
  const double late = sim::record_delay(axis) / log.period;
  auto shifted = log;
  auto& u = shifted.axes.front().u;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double place = std::clamp(static_cast<double>(i) + late, 0.0, static_cast<double>(u.size() - 1));
    const auto k = std::min(static_cast<std::size_t>(place), u.size() - 2);
    const double share = place - static_cast<double>(k);
    u[i] = (1.0 - share) * log.axes.front().u[k] + share * log.axes.front().u[k + 1];
  }
  // What an encoder reads is known only with its errors taken off.
  auto& x = shifted.axes.front().x;
  for (const auto& error : sim::effects_of<sim::EncoderSubdivisionError>(axis)) {
    const sim::EncoderSubdivisionError read(error);
    for (double& each : x) each -= read.at(each).value;
  }
  host::SignalSettings settings;
  settings.row_rate = 250.0;
  const auto plant = sim::plant_axis(axis);
  const host::LogRows rows({host::motion_of(shifted, shifted.axes.front(), plant, host::Amperes::amplitude, settings)},
                           settings);
  const Eigen::VectorXd left = rows.force - rows.stacked([&](const auto& m) { return host::force_along(plant, m); });
  return std::sqrt(left.squaredNorm() / static_cast<double>(left.size()));
}

TEST_F(EmpsDiagnosis, names_what_holds_in_both_halves) {
  const auto verdict = diagnose({log_}, {}, false);
  ASSERT_FALSE(verdict.findings.empty());
  figure("EMPS, diagnosis of the record", names(verdict));
  std::vector<machine::Effect> all;
  for (const auto& finding : verdict.findings) all.push_back(finding.row());
  for (int half = 0; half < 2; ++half) {
    const auto log = part(log_, 0.5 * half, 0.5 * (half + 1));
    const double with = residual_rms(log, machine_, all);
    std::string text = fmt::format("{:.2f} N rms, published model {:.2f} N", with, residual_rms(log, machine_, {}));
    for (std::size_t k = 0; k < all.size(); ++k) {
      auto others = all;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
      const double without = residual_rms(log, machine_, others);
      text += fmt::format("; without {} {:.2f} N", all[k].name, without);
      EXPECT_LT(with, without) << all[k].name << ", half " << half + 1;
    }
    figure(fmt::format("EMPS, causes of the whole record in half {}", half + 1), text);
  }
}

}  // namespace
}  // namespace stiction::test
