#include "host/diagnose/reference/reference_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/diagnose/verdict/chart_means.hpp"
#include "sim/effects/coulomb_mismatch/coulomb_mismatch.hpp"
#include "sim/effects/effects.hpp"
#include "sim/effects/presliding_hysteresis/presliding_hysteresis.hpp"
#include "sim/effects/viscous_mismatch/viscous_mismatch.hpp"
#include "sim/effects/viscous_nonlinear/viscous_nonlinear.hpp"
#include "sim/plant/friction/friction.hpp"

namespace stiction::host {
namespace {

using Of = double (*)(const RowFigures&);

double error_of(const RowFigures& f) { return f.error * 1e6; }
double current_of(const RowFigures& f) { return f.current; }

// One axis over the feed: what the simulation is off the measured row.
sim::Chart deviation(const ReferenceRows& reference, const std::string& axis, bool error) {
  sim::Chart chart;
  chart.title = fmt::format("{}: {}", axis, error ? "error at reversals" : "largest current");
  chart.x_label = "feed, m/min";
  chart.y_label = error ? "simulated minus measured, µm" : "simulated relative to measured, %";
  chart.logarithmic_x = true;
  chart.levels = {0.0};
  sim::Series before = of_machine_file({}), after = of_extended({}),
              published{.name = "published", .x = {}, .y = {}, .points = true};
  const auto off = [&](const RowFigures& simulated, const RowFigures& measured) {
    return error ? error_of(simulated) - error_of(measured) : 100.0 * (simulated.current / measured.current - 1.0);
  };
  for (const auto& row : reference.rows) {
    if (row.axis != axis) continue;
    const double feed = row.feed * 60.0;
    before.x.push_back(feed);
    before.y.push_back(off(row.machine_file, row.measured));
    after.x.push_back(feed);
    after.y.push_back(off(row.extended, row.measured));
    if (!row.published) continue;
    published.x.push_back(feed);
    published.y.push_back(off(*row.published, row.measured));
    if (row.training)
      chart.distances.push_back({feed, chart.levels.front(), off(row.extended, row.measured), "training"});
  }
  chart.series = {before, after, published};
  return chart;
}

// A finding's part in every row of its axis.
sim::Chart shares(const ReferenceRows& reference, const Finding& finding, bool error) {
  const Of value = error ? error_of : current_of;
  sim::Chart chart;
  chart.title = error ? "Effect on the error at reversals" : "Effect on the largest current";
  chart.x_label = "feed, m/min";
  chart.y_label = error ? "change by this cause, µm" : "change by this cause, A";
  chart.caption = error ? "Difference between the extended simulation with and without this cause."
                        : "Difference between the extended simulation with and without this cause, and deviation of "
                          "the machine file.";
  chart.logarithmic_x = true;
  chart.levels = {0.0};
  sim::Series by{.name = "by this cause", .x = {}, .y = {}},
      lacks{.name = "measured less machine file", .x = {}, .y = {}, .points = true};
  for (const auto& row : reference.rows) {
    if (row.axis != finding.axis) continue;
    for (const auto& share : row.shares)
      if (share.effect == finding.effect) {
        by.x.push_back(row.feed * 60.0);
        by.y.push_back(value(share.by));
        lacks.x.push_back(row.feed * 60.0);
        lacks.y.push_back(value(row.measured) - value(row.machine_file));
      }
  }
  chart.series = {by, lacks};
  return chart;
}

// Friction over speed: the rows, the file, the extended one, and the extended one without this cause.
sim::Chart sliding(const machine::Machine& machine, const ReferenceExtension& extension, const AxisExtension& axis,
                   const Finding& finding) {
  sim::Chart chart;
  chart.title = "Friction over speed";
  chart.x_label = "speed, m/min";
  chart.y_label = "friction force, N";
  chart.logarithmic_x = true;
  const auto own =
      std::find_if(machine.axes.begin(), machine.axes.end(), [&](const auto& each) { return each.name == axis.axis; });
  const auto file = file_law(*own);
  const auto& law = extension.sliding.law;
  const SlidingLaw extended{axis.force * law.coulomb, axis.force * law.viscous, axis.force * law.rise,
                            law.rise_velocity};
  auto without = extended;
  if (sim::is_a<sim::CoulombMismatch>(finding.effect)) without.coulomb = file.coulomb;
  if (sim::is_a<sim::ViscousMismatch>(finding.effect)) without.viscous = file.viscous;
  if (sim::is_a<sim::ViscousNonlinear>(finding.effect)) without.rise = 0.0;
  sim::Series rows{.name = axis.own_rows ? "measured" : "measured on " + axis.law_from + ", scaled",
                   .x = {},
                   .y = {},
                   .points = true};
  if (axis.own_rows) rows.role = sim::SeriesRole::measured;
  for (const auto& row : machine.steady_friction_references)
    if (row.axis == axis.law_from) {
      rows.x.push_back(row.velocity * 60.0);
      rows.y.push_back(axis.force * row.current * own->motor.force_constant);
    }
  chart.series = {std::move(rows)};
  for (auto [line, each] : {std::pair{of_machine_file({}), file},
                            {of_extended({}), extended},
                            {sim::Series{.name = "without this cause", .x = {}, .y = {}}, without}}) {
    for (double v = 3e-4; v < 0.42; v *= 1.05) {
      line.x.push_back(v * 60.0);
      line.y.push_back(each.at(v));
    }
    chart.series.push_back(std::move(line));
  }
  return chart;
}

sim::Chart contact(const machine::Machine& machine, const AxisExtension& axis, const Finding& finding) {
  sim::Chart chart;
  chart.title = "Force before sliding";
  chart.x_label = "displacement, µm";
  chart.y_label = "share of Coulomb friction, %";
  chart.caption = "First loading against the previous motion.";
  const auto keys = sim::parameters_of<sim::PreslidingHysteresis>(finding.values);
  const double stiffness = keys.stiffness.value(), distance = keys.distance;
  const double coulomb = stiffness * axis.displacement / axis.stiffness_per_force;
  sim::Series extended = of_extended({}), file = of_machine_file({}),
              rows{.name = "rows of presliding, scaled", .x = {}, .y = {}, .points = true};
  const auto elements = sim::presliding_elements(coulomb, stiffness, distance);
  const double longest = 2.0 * distance;
  const auto own =
      std::find_if(machine.axes.begin(), machine.axes.end(), [&](const auto& each) { return each.name == axis.axis; });
  for (int k = 0; k <= 200; ++k) {
    const double x = longest * std::pow(k / 200.0, 2);
    double force = 0.0;
    for (std::size_t j = 0; j < elements.stiffness.size(); ++j)
      force += std::min(elements.stiffness[j] * x, elements.level[j]);
    extended.x.push_back(x * 1e6);
    extended.y.push_back(100.0 * force / coulomb);
    file.x.push_back(x);
  }
  file.y = sim::contact_force(own->friction, file.x);
  for (double& x : file.x) x *= 1e6;
  for (double& y : file.y) y *= 100.0 / sim::coulomb_of(own->friction);
  if (file.y.empty()) file.x.clear();
  double most = 0.0;
  for (const auto& row : machine.presliding_references)
    if (!row.same_direction) most = std::max(most, row.force);
  for (const auto& row : machine.presliding_references)
    if (!row.same_direction) {
      rows.x.push_back(row.displacement * axis.displacement * 1e6);
      rows.y.push_back(100.0 * row.force / most);
    }
  chart.series = {extended};
  if (!file.x.empty()) chart.series.push_back(file);
  chart.series.push_back(rows);
  return chart;
}

}  // namespace

void add_reference_charts(Verdict& verdict, const machine::Machine& machine, const ReferenceExtension& extension) {
  for (const bool error : {false, true})
    for (const auto& axis : machine.axes)
      verdict.before_after.push_back(deviation(*verdict.reference, axis.name, error));
  for (auto& finding : verdict.findings) {
    const auto axis = std::find_if(extension.axes.begin(), extension.axes.end(),
                                   [&](const auto& each) { return each.axis == finding.axis; });
    const bool of_contact = sim::is_a<sim::PreslidingHysteresis>(finding.effect);
    finding.charts.push_back(of_contact ? contact(machine, *axis, finding)
                                        : sliding(machine, extension, *axis, finding));
    finding.charts.push_back(shares(*verdict.reference, finding, of_contact));
  }
}

}  // namespace stiction::host
