#include "host/diagnose/judge/closed_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "host/diagnose/describe/diagnosis_charts.hpp"
#include "host/diagnose/judge/position_error.hpp"
#include "host/diagnose/judge/withheld_keys.hpp"
#include "host/diagnose/record/replay_setup.hpp"
#include "host/diagnose/verdict/chart_means.hpp"
#include "host/simulate/control_run.hpp"
#include "sim/effects/cross_axis_coupling/cross_axis_coupling.hpp"

namespace stiction::host {
namespace {

// Of the simulation's position error, rms: what a cause does to the position below that, or below the encoder's
// increment, is small.
constexpr double small_share = 0.01;

// Position error of the held-out log whose baseline is furthest off, over time, first shown around the worst instant;
// and the difference of simulated and measured position below it.
void add_pictures(Verdict& verdict, const std::vector<Log>& logs, const Positions& measured, const Positions& baseline,
                  const Positions& extended) {
  std::size_t log = 0, at = 0;
  double largest = -1.0;
  for (std::size_t k = 0; k < logs.size(); ++k)
    for (auto i = first_compared(logs[k]); i < measured[k].size(); ++i)
      if (const double off = std::abs(measured[k][i] - baseline[k][i]); off > largest) largest = off, log = k, at = i;
  const auto& chosen = logs[log];
  const auto& set = chosen.axes.front().x_set;
  const double shown = std::min(1.0, 0.5 * (chosen.t.back() - chosen.t.front()));  // s, to either side
  sim::Chart error;
  error.title = "Position error on held-out data";
  error.x_label = "time, s";
  const auto deviation = verdict.units.deviation;
  error.y_label = axis_label("set minus actual position", deviation);
  error.caption =
      fmt::format("{}, around the largest deviation of the machine file; double-click shows the whole record.",
                  std::filesystem::path(chosen.source).filename().string());
  const double from = std::clamp(chosen.t[at] - shown, chosen.t.front(), chosen.t.back() - 2.0 * shown);
  error.x_range = std::array{from, from + 2.0 * shown};
  auto difference = error;
  difference.title.clear();
  difference.y_label = axis_label("simulated minus measured", deviation);
  difference.caption.clear();
  difference.levels = {0.0};
  const auto line = [&](sim::Series series, const auto& value) {
    series.x = chosen.t;
    for (std::size_t i = 0; i < chosen.t.size(); ++i) series.y.push_back(deviation.factor * value(i));
    return series;
  };
  sim::Series of_machine{.name = "measured", .x = {}, .y = {}};
  of_machine.role = sim::SeriesRole::measured;
  for (const auto& [series, x] : {std::pair{of_machine, &measured[log]},
                                  {of_machine_file({}), &baseline[log]},
                                  {of_extended({}), &extended[log]}}) {
    if (x == &extended[log] && verdict.findings.empty()) continue;
    const auto& position = *x;
    error.series.push_back(line(series, [&](std::size_t i) { return set[i] - position[i]; }));
    if (x != &measured[log])
      difference.series.push_back(line(series, [&](std::size_t i) { return position[i] - measured[log][i]; }));
  }
  verdict.before_after.insert(verdict.before_after.begin(), {std::move(error), std::move(difference)});
}

// The machine's simulation with what was found, and what each finding does to it.
void judge_findings(Verdict& verdict, const ReplaySetup& setup, const Positions& measured, const Positions& baseline) {
  const auto with = [&](const std::vector<Finding>& findings) {
    return simulated_positions(extended_setup(setup, findings));
  };
  const auto all = verdict.findings.empty() ? baseline : with(verdict.findings);
  verdict.extended.position_error_rms = difference_rms(measured, all, setup.logs);
  for (std::size_t k = 0; k < verdict.findings.size(); ++k) {
    auto others = verdict.findings;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    const auto without = with(others);
    auto& finding = verdict.findings[k];
    finding.holdout.position_error_rms_ratio =
        *verdict.extended.position_error_rms / std::max(difference_rms(measured, without, setup.logs), 1e-15);
    finding.part_error = largest_difference(all, without, setup.logs);
  }
}

// The figures and the picture of the file that is written: without the keys that are withheld.
void judge_file(Verdict& verdict, const ReplaySetup& setup, const Positions& measured, const Positions& baseline) {
  const auto written = written_findings(verdict.findings);
  const auto positions = written.empty() ? baseline : simulated_positions(extended_setup(setup, written));
  verdict.extended.position_error_rms = difference_rms(measured, positions, setup.logs);
  add_pictures(verdict, setup.logs, measured, baseline, positions);
}

}  // namespace

double judge_in_closed_loop(Verdict& verdict, const machine::Machine& machine, std::size_t axis,
                            const std::vector<Log>& held_out, const Disturbance& disturbance) {
  const auto& known = machine.axes[axis].effects;
  const bool coupled =
      std::any_of(known.begin(), known.end(),
                  [](const machine::Effect& effect) { return sim::is_a<sim::CrossAxisCoupling>(effect); }) ||
      std::any_of(verdict.findings.begin(), verdict.findings.end(),
                  [](const Finding& finding) { return sim::is_a<sim::CrossAxisCoupling>(finding.effect); });
  auto setup = replay_setup_of(machine, axis, held_out, coupled);
  if (setup.logs.empty()) return 0.0;
  verdict.closed_loop_withheld = why_not_simulated(machine, axis, held_out, coupled);
  if (!verdict.closed_loop_withheld.empty()) return 0.0;
  Positions measured, baseline;
  for (const auto& log : setup.logs) measured.push_back(log.axes.front().x);
  try {
    baseline = simulated_positions(setup);
  } catch (const FaultTripped& fault) {
    throw LogError(
        fmt::format("{}: found set-points that the simulated machine cannot follow ({}); expected a record of the "
                    "machine in this file",
                    setup.logs.front().source, fault.what()));
  }
  verdict.baseline.position_error_rms = difference_rms(measured, baseline, setup.logs);
  verdict.small_below =
      std::max(setup.machine.axes.front().encoder.increment, small_share * *verdict.baseline.position_error_rms);
  const auto noted = [&](const auto& judge) {
    try {
      judge(verdict, setup, measured, baseline);
    } catch (const FaultTripped& fault) {
      verdict.notes.push_back(fmt::format(
          "The simulation with what was found could not follow the held-out set-points ({}).", fault.what()));
    }
  };
  noted(judge_findings);
  if (verdict.extended.position_error_rms.value_or(HUGE_VAL) > *verdict.baseline.position_error_rms)
    withhold_what_follows_worse(verdict.findings, setup, measured, disturbance);
  noted(judge_file);
  const auto moved = disturbance ? positions_under(disturbance, setup, 0) : std::nullopt;
  return moved ? difference_rms(*moved, baseline, setup.logs) : 0.0;
}

}  // namespace stiction::host
