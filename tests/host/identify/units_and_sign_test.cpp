// The units of a log's columns and the direction that is counted as positive are choices of who recorded it: an axis is
// identified and replayed alike, whatever they are.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "host/identify/own_identification.hpp"
#include "host/log/csv_log.hpp"
#include "host/simulate/replay.hpp"
#include "sim/machine_file.hpp"
#include "tests/support/moved_axis.hpp"
#include "tests/support/rotary_joint.hpp"

namespace stiction::test {
namespace {

using host::AxisLog;
using host::Identification;
using host::Log;

constexpr double degree = std::numbers::pi / 180.0;

std::string machine_of(const MovedAxis& axis) {
  const bool rotary = axis.rotary;
  return fmt::format(R"(schema = "stiction.machine/1"
name = "moved"
[axis.A]
kind = "{}"
{} = "{} {}"
travel = "10 {}"
max_velocity = "{} {}/s"
max_acceleration = "100 {}/s^2"
{}[axis.A.motor]
model = "force"
{}_constant = "{} {}/V"
[axis.A.encoder]
increment = "{} {}"
[axis.A.controller]
structure = "unknown"
[axis.A.friction]
use = "coulomb_viscous"
[axis.A.friction.coulomb_viscous]
coulomb = "{} {}"
viscous = "{} {}"
)",
                     rotary ? "rotary" : "linear", rotary ? "inertia" : "mass", axis.mass, rotary ? "kg m^2" : "kg",
                     rotary ? "rad" : "m", axis.speeds.back(), rotary ? "rad" : "m", rotary ? "rad" : "m",
                     rotary ? "[axis.A.gravity]\nmoment = \"1 N m\"\n" : "", rotary ? "torque" : "force", axis.per_unit,
                     rotary ? "N m" : "N", axis.increment, rotary ? "rad" : "m", axis.coulomb, rotary ? "N m" : "N",
                     axis.viscous, rotary ? "N m s/rad" : "N s/m");
}

// As its file has it with columns in these units.
Log in_units(const Log& log, const std::string& unit, double per_unit, bool millivolts) {
  std::string text = fmt::format("t[s],x_set[{0}],x[{0}],u[{1}]\n", unit, millivolts ? "mV" : "V");
  const auto& axis = log.axes[0];
  for (std::size_t k = 0; k < log.t.size(); ++k)
    text += fmt::format("{},{},{},{}\n", log.t[k], axis.x_set[k] / per_unit, axis.x[k] / per_unit,
                        axis.u[k] * (millivolts ? 1e3 : 1.0));
  return host::parse_csv_log(text, "moved.csv");
}

Log mirrored(Log log) {
  for (auto& axis : log.axes)
    for (auto* values : {&axis.x_set, &axis.v_set, &axis.a_set, &axis.x, &axis.u})
      for (double& value : *values) value = -value;
  return log;
}

Identification identified(const MovedAxis& moved_axis, const Log& log) {
  const auto axis = sim::parse_machine("moved.toml", machine_of(moved_axis)).axes.at(0);
  const host::IdentifyOptions options{"coulomb_viscous", host::Amperes::amplitude, {}, true, {}};
  return host::in_own_units(host::identify_logs(host::linear_logs({log}, axis), axis, options), axis);
}

// Six axes, drawn: mass, friction, offset and weight over a factor of three each.
std::vector<MovedAxis> drawn_axes() {
  std::mt19937 random(20);
  const auto factor = [&] { return std::pow(3.0, std::uniform_real_distribution<>(-0.5, 0.5)(random)); };
  std::vector<MovedAxis> all;
  for (int k = 0; k < 3; ++k) {
    all.push_back({.mass = 80.0 * factor(),
                   .coulomb = 20.0 * factor(),
                   .viscous = 150.0 * factor(),
                   .constant = 4.0 * factor(),
                   .volts = true});
    all.push_back({.rotary = true,
                   .mass = 5e-3 * factor(),
                   .coulomb = 0.02 * factor(),
                   .viscous = 0.01 * factor(),
                   .moment = 0.4 * factor(),
                   .per_unit = 0.1,
                   .increment = 2.0 * std::numbers::pi / 4096.0,
                   .speeds = {0.5, 1.0, 2.0, 4.0},
                   .stroke = 1.5,
                   .acceleration = 60.0,
                   .volts = true});
  }
  return all;
}

// Every parameter, its interval, and what is not determined; `sides`: what is of one direction is of the other one.
void expect_same(const Identification& a, const Identification& b, bool sides, double tolerance) {
  ASSERT_EQ(a.parameters.size(), b.parameters.size());
  EXPECT_EQ(a.not_determined.size(), b.not_determined.size());
  const auto other = [&](std::string name) {
    for (const auto& [from, to] : {std::pair{"_positive_", "_negative_"}, {"_negative_", "_positive_"}})
      if (const auto at = name.find(from); sides && at != std::string::npos) return name.replace(at, 10, to);
    return name;
  };
  for (const auto& p : a.parameters) {
    const auto* q = b.find(other(p.name));
    ASSERT_NE(q, nullptr) << p.name;
    const bool turns = sides && p.name.starts_with("constant_");
    const double half = 0.5 * (p.ci95.high - p.ci95.low), sign = turns ? -1.0 : 1.0;
    EXPECT_NEAR(p.value, sign * q->value, tolerance * half) << p.name;
    EXPECT_NEAR(p.ci95.low, turns ? -q->ci95.high : q->ci95.low, tolerance * half) << p.name;
  }
}

// A conversion moves the last digit of a value, and by it a row at the edge of standstill may count or not: that is a
// hundredth of an interval, not more.
TEST(UnitsAndSign, AnAxisIsIdentifiedAlikeInAnyUnits) {
  for (const auto& axis : drawn_axes()) {
    const auto log = moved(axis);
    const auto plain = identified(axis, in_units(log, axis.rotary ? "rad" : "m", 1.0, false));
    EXPECT_NE(plain.find(axis.rotary ? "inertia_kg_m2" : "mass_kg"), nullptr);
    expect_same(plain, identified(axis, in_units(log, axis.rotary ? "deg" : "mm", axis.rotary ? degree : 1e-3, true)),
                false, 0.02);
  }
}

TEST(UnitsAndSign, AnAxisIsIdentifiedAlikeInBothSenses) {
  for (const auto& axis : drawn_axes()) {
    const auto log = moved(axis);
    expect_same(identified(axis, log), identified(axis, mirrored(log)), true, 1e-6);
  }
}

Log followed() {
  Log log;
  log.source = "sine.csv";
  log.period = 1e-3;
  auto& axis = log.axes.emplace_back();
  axis.rotary = true;
  for (int k = 0; k < 2000; ++k) {
    const double t = 1e-3 * k;
    log.t.push_back(t);
    axis.x_set.push_back(0.5 * (1.0 - std::cos(6.0 * t)));
    axis.x.push_back(axis.x_set.back());
    axis.u.push_back(0.0);
  }
  return log;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b, double sign) {
  double most = a.size() == b.size() ? 0.0 : 1.0;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) most = std::max(most, std::abs(a[k] - sign * b[k]));
  return most;
}

TEST(UnitsAndSign, ALogIsReplayedAlikeInAnyUnitsAndBothSenses) {
  // A continuous encoder: to which of two increments a value between them is rounded has a sense.
  auto text = rotary_joint;
  text.replace(text.find("counts = 4096"), 13, "increment = \"0 rad\"");
  const auto joint = sim::parse_machine("joint.toml", text);
  const auto log = followed();
  const auto run = [&](const Log& each) { return host::replay<machine::DoubleSignals>(joint, each).axes[0]; };
  const auto plain = run(in_units(log, "rad", 1.0, false));
  const auto degrees = run(in_units(log, "deg", degree, true));
  const auto turned = run(mirrored(in_units(log, "rad", 1.0, false)));
  EXPECT_GT(*std::max_element(plain.x.begin(), plain.x.end()), 0.9);
  EXPECT_LT(largest_difference(plain.x, degrees.x, 1.0), 1e-9);
  EXPECT_LT(largest_difference(plain.u, degrees.u, 1.0), 1e-6);
  EXPECT_LT(largest_difference(plain.x, turned.x, -1.0), 1e-9);
  EXPECT_LT(largest_difference(plain.u, turned.u, -1.0), 1e-6);
}

}  // namespace
}  // namespace stiction::test
