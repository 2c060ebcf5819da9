#include "host/sweep/results.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "host/sweep/effects.hpp"

namespace stiction::host {
namespace {

constexpr std::size_t most_failures = 10;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

std::size_t figure_named(const SweepPlan& plan, const std::string& name) {
  for (std::size_t f = 0; f < plan.figures.size(); ++f)
    if (plan.figures[f].name == name) return f;
  return 0;
}

// Every `stride`-th of `values`.
std::vector<double> thinned(std::vector<double> values, std::uint64_t stride) {
  if (stride == 1) return values;
  std::vector<double> some;
  for (std::uint64_t k = 0; k < values.size(); k += stride) some.push_back(values[k]);
  return some;
}

std::vector<VariedKey> varied_keys(const SweepSpec& spec, const SweepRows& rows, std::uint64_t stride) {
  std::vector<VariedKey> keys;
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < spec.keys.size(); ++k) {
    const auto& key = spec.keys[k];
    if (!key.varies()) continue;
    VariedKey varied;
    varied.column = key.column();
    varied.drawn = key.drawn.has_value();
    varied.names = key.values;
    varied.at = key.numeric ? key.numbers : std::vector<double>(key.values.size(), not_a_number);
    keys.push_back(std::move(varied));
    places.push_back(k);
  }
  for (std::uint64_t index = 0; index < rows.size(); index += stride) {
    const auto row = rows.values(index);
    for (std::size_t k = 0; k < keys.size(); ++k) {
      auto& key = keys[k];
      if (key.drawn) {
        key.numbers.push_back(row.numbers[places[k]]);
        continue;
      }
      const auto found = std::find(key.names.begin(), key.names.end(), row.texts[places[k]]);
      key.levels.push_back(static_cast<std::uint32_t>(found - key.names.begin()));
    }
  }
  return keys;
}

void count_failures(SweepSummary& summary, const ChunkFiles& files) {
  std::map<std::string, std::uint64_t> numbers;
  files.for_each([&](std::uint64_t, const ChunkResult& chunk) {
    for (const auto& message : chunk.message) {
      if (message.empty()) continue;
      ++summary.failed;
      // Messages that differ by a time or a value alone are many: the first are kept, which bounds the memory.
      if (numbers.contains(message) || numbers.size() < 1000) ++numbers[message];
    }
  });
  summary.failures.assign(numbers.begin(), numbers.end());
  std::stable_sort(summary.failures.begin(), summary.failures.end(),
                   [](const auto& one, const auto& other) { return one.second > other.second; });
  if (summary.failures.size() > most_failures) summary.failures.resize(most_failures);
}

void find_worst(SweepSummary& summary, const SweepSpec& spec, const SweepRows& rows, const SweepPlan& plan,
                const ChunkFiles& files) {
  const auto place = figure_named(plan, !spec.worst.empty()    ? spec.worst
                                        : !spec.robust.empty() ? spec.robust
                                                               : std::string());
  summary.worst = plan.figures[place];
  summary.worst_value = not_a_number;
  const auto values = files.column(place);
  for (std::uint64_t k = 0; k < values.size(); ++k)
    if (std::isfinite(values[k]) && !(values[k] <= summary.worst_value)) {
      summary.worst_value = values[k];
      summary.worst_row = k;
    }
  summary.worst_command = rows.command_line(rows.row(summary.worst_row));
}

RobustChoice robust_choice(const SweepSpec& spec, const SweepRows& rows, const SweepPlan& plan,
                           const ChunkFiles& files) {
  RobustChoice result;
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < spec.keys.size(); ++k)
    if (spec.keys[k].design) {
      places.push_back(k);
      result.keys.push_back(spec.keys[k].column());
    }
  const auto values = files.column(figure_named(plan, spec.robust));
  std::map<std::vector<std::string>, std::size_t> known;
  for (std::uint64_t index = 0; index < rows.size(); ++index) {
    const auto row = rows.values(index);
    std::vector<std::string> design;
    for (const auto k : places) design.push_back(row.texts[k]);
    const auto [found, added] = known.emplace(design, result.choices.size());
    const double value = std::isfinite(values[index]) ? values[index] : std::numeric_limits<double>::infinity();
    if (added) result.choices.push_back({std::move(design), value, index});
    auto& choice = result.choices[found->second];
    if (value > choice.worst) {
      choice.worst = value;
      choice.row = index;
    }
  }
  for (std::size_t k = 1; k < result.choices.size(); ++k)
    if (result.choices[k].worst < result.choices[result.best].worst) result.best = k;
  return result;
}

}  // namespace

SweepSummary summarize(const SweepSpec& spec, const SweepRows& rows, const SweepPlan& plan, const ChunkFiles& files) {
  SweepSummary summary;
  summary.rows = plan.rows;
  count_failures(summary, files);
  const std::uint64_t stride = (plan.rows + most_analysed_rows - 1) / most_analysed_rows;
  const auto keys = varied_keys(spec, rows, stride);
  for (std::size_t f = 0; f < plan.figures.size(); ++f)
    summary.effects.push_back(effects_on(plan.figures[f], thinned(files.column(f), stride), keys));
  if (!spec.pareto.empty())
    summary.pareto = pareto_front(thinned(files.column(figure_named(plan, spec.pareto[0])), stride),
                                  thinned(files.column(figure_named(plan, spec.pareto[1])), stride), stride);
  find_worst(summary, spec, rows, plan, files);
  if (!spec.robust.empty()) summary.robust.push_back(robust_choice(spec, rows, plan, files));
  return summary;
}

}  // namespace stiction::host
