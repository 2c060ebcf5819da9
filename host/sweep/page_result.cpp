// The summary of a sweep as figures, charts and sentences of a page.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "host/sweep/results.hpp"

namespace stiction::host {
namespace {

constexpr double per_cent = 100.0;
constexpr double worth_a_chart = 0.01;  // share of variance
constexpr std::size_t most_charts = 6;  // of main effects

std::string with_unit(double value, const std::string& unit) {
  return unit.empty() ? fmt::format("{:.4g}", value) : fmt::format("{:.4g} {}", value, unit);
}

void add_figures(sim::ExperimentResult& result, const FigureEffects& effects) {
  const auto& figure = effects.figure;
  const auto add = [&](const char* what, double value) {
    result.figures.push_back(
        {fmt::format("{}_{}", figure.name, what), figure.unit, fmt::format("{}: {}", figure.name, what), value, {}});
  };
  add("mean", effects.mean);
  add("deviation", effects.deviation);
  add("least", effects.least);
  add("most", effects.most);
}

void add_effects(sim::ExperimentResult& result, const FigureEffects& effects) {
  std::vector<std::string> told;
  for (const auto& effect : effects.main)
    told.push_back(fmt::format("{} {:.0f} %", effect.key, effect.share * per_cent));
  if (!told.empty())
    result.findings.push_back(
        fmt::format("Main effects on {}, as shares of its variance: {}.", effects.figure.name, fmt::join(told, ", ")));
  told.clear();
  for (const auto& pair : effects.interactions)
    if (pair.share >= worth_a_chart)
      told.push_back(fmt::format("{} with {} {:.0f} %", pair.first, pair.second, pair.share * per_cent));
  if (!told.empty())
    result.findings.push_back(
        fmt::format("Interactions on {}, beyond the main effects: {}.", effects.figure.name, fmt::join(told, ", ")));
}

void add_effect_charts(sim::ExperimentResult& result, const FigureEffects& effects) {
  std::size_t charts = 0;
  for (const auto& effect : effects.main) {
    if (effect.share < worth_a_chart || charts++ >= most_charts) continue;
    sim::Series series{effect.key, {}, {}, effect.at.size() <= 12};
    std::string names;
    for (std::size_t k = 0; k < effect.mean.size(); ++k) {
      if (!std::isfinite(effect.mean[k])) continue;
      const bool text = !std::isfinite(effect.at[k]);
      series.x.push_back(text ? static_cast<double>(k + 1) : effect.at[k]);
      series.y.push_back(effect.mean[k]);
      if (text) names += fmt::format("{}{} {}", names.empty() ? "" : ", ", k + 1, effect.levels[k]);
    }
    sim::Chart chart;
    chart.title = fmt::format("{} over {}", effects.figure.name, effect.key);
    chart.x_label = effect.key;
    chart.y_label = effects.figure.column();
    chart.caption = fmt::format("Mean over all other keys; {:.0f} % of the variance{}{}.", effect.share * per_cent,
                                names.empty() ? "" : ". Levels: ", names);
    chart.series.push_back(std::move(series));
    result.charts.push_back(std::move(chart));
  }
}

void add_pareto(sim::ExperimentResult& result, const SweepPlan& plan, const SweepSpec& spec,
                const SweepSummary& summary) {
  const auto column = [&](const std::string& name) {
    for (const auto& figure : plan.figures)
      if (figure.name == name) return figure.column();
    return name;
  };
  sim::Series front{"not beaten in both", {}, {}, true};
  for (const auto& point : summary.pareto) {
    front.x.push_back(point.first);
    front.y.push_back(point.second);
  }
  sim::Chart chart;
  chart.title = fmt::format("Pareto front of {} and {}", spec.pareto[0], spec.pareto[1]);
  chart.x_label = column(spec.pareto[0]);
  chart.y_label = column(spec.pareto[1]);
  chart.caption = "Each point is a row that no other row beats in both figures.";
  chart.series.push_back(std::move(front));
  result.charts.push_back(std::move(chart));
  result.findings.push_back(fmt::format("{} rows are on the Pareto front of {} and {}.", summary.pareto.size(),
                                        spec.pareto[0], spec.pareto[1]));
}

void add_robust(sim::ExperimentResult& result, const RobustChoice& robust, const SweepFigure& figure) {
  const auto words = [&](const DesignChoice& choice) {
    std::vector<std::string> all;
    for (std::size_t k = 0; k < robust.keys.size(); ++k)
      all.push_back(fmt::format("{} {}", robust.keys[k], choice.values[k]));
    return fmt::format("{}", fmt::join(all, ", "));
  };
  const auto& nominal = robust.choices.front();
  const auto& best = robust.choices[robust.best];
  result.figures.push_back({"worst_nominal",
                            figure.unit,
                            fmt::format("{}: worst case of the first choice", figure.name),
                            nominal.worst,
                            {}});
  result.figures.push_back(
      {"worst_robust", figure.unit, fmt::format("{}: worst case of the robust choice", figure.name), best.worst, {}});
  result.findings.push_back(fmt::format(
      "The first choice ({}) has the worst {} {}; the smallest worst case, {}, is that of {}.", words(nominal),
      figure.name, with_unit(nominal.worst, figure.unit), with_unit(best.worst, figure.unit), words(best)));
}

}  // namespace

sim::ExperimentResult sweep_result(const SweepSpec& spec, const SweepPlan& plan, const SweepSummary& summary) {
  sim::ExperimentResult result;
  result.experiment = "sweep";
  result.title = fmt::format("Sweep: {}", spec.name);
  result.question = fmt::format("What do the keys of {} do to the figures of `stiction {}`?", spec.name, spec.command);
  result.findings.push_back(fmt::format("{} rows were run; {} of them failed.", summary.rows, summary.failed));
  for (const auto& [message, number] : summary.failures)
    result.findings.push_back(fmt::format("{} rows failed with: {}.", number, message));
  if (std::isfinite(summary.worst_value))
    result.findings.push_back(fmt::format("The worst {} is {}, in row {}. This command repeats it: {}",
                                          summary.worst.name, with_unit(summary.worst_value, summary.worst.unit),
                                          summary.worst_row, summary.worst_command));
  for (const auto& robust : summary.robust) add_robust(result, robust, summary.worst);
  for (const auto& effects : summary.effects) {
    add_figures(result, effects);
    add_effects(result, effects);
  }
  for (const auto& effects : summary.effects)
    if (effects.figure.column() == summary.worst.column()) add_effect_charts(result, effects);
  if (!summary.pareto.empty()) add_pareto(result, plan, spec, summary);
  return result;
}

}  // namespace stiction::host
