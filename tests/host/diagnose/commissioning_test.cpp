// The demonstration: an effect drawn from a seed, hidden in the simulated machine, is named from its records. Truth and
// engine share the effects' laws here; what the diagnosis is worth is measured by tests/blind.
#include "host/simulate/commissioning.hpp"

#include <gtest/gtest.h>

#include "host/diagnose/diagnose.hpp"
#include "host/simulate/hidden_effect.hpp"
#include "sim/machine_file.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

// As the demonstration has it.
machine::Machine demonstration_machine() {
  return sim::read_machine(
      std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml",
      {{}, {"axis.X.encoder.velocity=estimated", "axis.X.encoder.noise=2 nm", "axis.X.motor.force_constant=94.2 N/A"}});
}

// How a drive has kept its record.
enum class Kept { all, without_set_points, every_fourth_sample };

void keep(host::Log& log, Kept kept) {
  auto& axis = log.axes.front();
  if (kept == Kept::without_set_points)
    for (auto* values : {&axis.x_set, &axis.v_set, &axis.a_set}) values->clear();
  if (kept != Kept::every_fourth_sample) return;
  const auto thin = [](std::vector<double>& values) {
    std::vector<double> fewer;
    for (std::size_t k = 0; k < values.size(); k += 4) fewer.push_back(values[k]);
    values = std::move(fewer);
  };
  log.period *= 4.0;
  thin(log.t);
  for (const auto& channel : host::log_channels) thin(axis.*channel.values);
}

host::Verdict verdict_of(const std::vector<machine::Effect>& hidden, std::uint64_t seed, Kept kept = Kept::all) {
  host::DiagnoseInput input;
  input.machine = demonstration_machine();
  input.closed_loop = input.next_measurement = false;
  auto machine = input.machine;
  machine.axes.front().effects = hidden;
  for (auto& record : host::record_commissioning(machine, 0, seed)) {
    keep(record.log, kept);
    (record.held_out ? input.held_out : input.logs).push_back(std::move(record.log));
  }
  return host::diagnose(input);
}

TEST(Commissioning, names_and_asks_nothing_where_nothing_is_hidden) {
  const auto verdict = verdict_of({}, 1);
  EXPECT_TRUE(verdict.findings.empty());
  for (const auto& question : verdict.questions) ADD_FAILURE() << question;
  EXPECT_TRUE(verdict.changed.empty());
}

// Of what the analysis itself makes of a record the file's own run knows, also where it has to find its set-points, and
// rows do not come faster than a slow record can fill them.
TEST(Commissioning, names_nothing_in_records_that_are_kept_otherwise) {
  for (const auto kept : {Kept::without_set_points, Kept::every_fourth_sample})
    for (std::uint64_t seed = 1; seed <= 3; ++seed)
      for (const auto& finding : verdict_of({}, seed, kept).findings)
        ADD_FAILURE() << finding.effect.name() << ", kept " << static_cast<int>(kept) << ", seed " << seed;
}

// Expects that the effects of so many seeds are named first in at least `bound` of them.
void expect_named(const std::string& what, int seeds, int bound, Kept kept) {
  int right = 0;
  std::string missed;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto number = static_cast<std::uint64_t>(seed);
    const auto hidden = host::draw_hidden_effect(demonstration_machine().axes.front(), number);
    const auto verdict = verdict_of({hidden}, number, kept);
    const auto found = verdict.findings.empty() ? "nothing" : verdict.findings.front().effect.name();
    if (found == hidden.name)
      ++right;
    else
      missed += fmt::format("; {} found as {} (seed {})", hidden.name, found, seed);
  }
  figure(what, fmt::format("{} of {} (bound {}){}", right, seeds, bound, missed));
  EXPECT_GE(right, bound);
}

TEST(Commissioning, names_what_is_hidden) {
  expect_named("demonstration: hidden effect named first", 12, 9, Kept::all);
}

TEST(Commissioning, names_what_is_hidden_without_set_points) {
  expect_named("demonstration, no set-points: hidden effect named first", 6, 5, Kept::without_set_points);
}

// A contact that gives is softer in the drive's hands than any regressor of the planned motion says: without the steps
// in closed loop its stiffness is 58 % off.
TEST(Commissioning, finds_a_contact_in_closed_loop) {
  constexpr std::uint64_t seed = 7;
  const auto hidden = host::draw_hidden_effect(demonstration_machine().axes.front(), seed);
  ASSERT_EQ(hidden.name, "presliding_hysteresis");
  const auto verdict = verdict_of({hidden}, seed);
  ASSERT_EQ(verdict.findings.size(), 1U);
  const auto found = verdict.findings.front().row();
  ASSERT_EQ(found.name, hidden.name);
  for (const auto* key : {"stiffness", "distance"}) {
    const double value = found.values.at(key).front(), truth = hidden.values.at(key).front();
    figure(fmt::format("demonstration: {} of a hidden contact", key),
           fmt::format("{:.1f} % off", 100.0 * std::abs(value / truth - 1.0)));
    EXPECT_NEAR(value, truth, 0.05 * truth) << key;
  }
}

// From half an increment of the position controller, where a gap shows only in how the axis hunts, to one in which it
// swings for as long as it stands. Of the small one the width is known to a few tenths.
TEST(Commissioning, finds_gaps_small_and_large) {
  for (const double width : {0.5e-6, 3e-6, 10e-6}) {
    const auto verdict = verdict_of({{"backlash", {{"width", {width}}}}}, 1);
    const auto name = fmt::format("demonstration: a gap of {:g} um", 1e6 * width);
    ASSERT_EQ(verdict.findings.size(), 1U) << name;
    const auto& found = verdict.findings.front();
    ASSERT_EQ(found.effect.name(), "backlash") << name;
    const double value = found.parameters.front().values.front(),
                 error = found.parameters.front().standard_errors.front();
    figure(name, fmt::format("{:.2f} +- {:.2f} um", 1e6 * value, 1e6 * error));
    EXPECT_NEAR(value, width, width < 1e-6 ? 0.5 * width : 0.1 * width) << name;
  }
}

TEST(Commissioning, is_the_same_for_the_same_seed) {
  const auto machine = demonstration_machine();
  const auto one = host::draw_hidden_effect(machine.axes.front(), 14);
  EXPECT_EQ(one.name, host::draw_hidden_effect(machine.axes.front(), 14).name);
  EXPECT_EQ(one.values, host::draw_hidden_effect(machine.axes.front(), 14).values);
  const auto records = host::record_commissioning(machine, 0, 3), again = host::record_commissioning(machine, 0, 3);
  ASSERT_EQ(records.size(), static_cast<std::size_t>(host::commissioning_records));
  for (std::size_t k = 0; k < records.size(); ++k) {
    EXPECT_EQ(records[k].log.axes.front().x, again[k].log.axes.front().x);
    EXPECT_EQ(records[k].log.axes.front().i, again[k].log.axes.front().i);
    EXPECT_TRUE(records[k].log.axes.front().external_force.empty());  // the noise is no channel
  }
}

}  // namespace
}  // namespace stiction::test
