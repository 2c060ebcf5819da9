// The sentence at the head of the circle's report: see circle_finding.hpp.
#include "host/report/circle_finding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <vector>

#include "host/report/circle_table.hpp"
#include "host/report/reference_lookup.hpp"
#include "sim/plant/friction/friction.hpp"

namespace stiction::host {
namespace {

bool acts(const machine::Machine& machine, const CircleTableRow& row) {
  return std::any_of(machine.axes.begin(), machine.axes.end(),
                     [&](const auto& axis) { return axis.name == row.axis && axis.friction.use == row.friction; });
}

double middle_feed(const std::vector<CircleTableRow>& table, bool measured_only) {
  std::vector<double> feeds;
  for (const auto& row : table)
    if ((row.error.measured || !measured_only) &&
        std::none_of(feeds.begin(), feeds.end(), [&](double feed) { return same_feed(feed, row.feed); }))
      feeds.push_back(row.feed);
  if (feeds.empty()) return middle_feed(table, false);
  std::sort(feeds.begin(), feeds.end());
  return feeds[(feeds.size() - 1) / 2];
}

std::string beside(const CircleTableRow& row) {
  if (row.error.measured) return fmt::format("; the measured value is {:.1f} µm", *row.error.measured * 1e6);
  if (row.error.published) return fmt::format("; the published simulation gives {:.1f} µm", *row.error.published * 1e6);
  return "; no measured or published value is available";
}

// "9 % (X) and 12 % (Y)" of the model that acts on each axis; empty when no axis has one.
std::string mean_errors(const std::vector<CircleTableRow>& rows) {
  std::vector<std::string> parts;
  for (const auto& mean : mean_deviations(rows))
    if (mean.error) parts.push_back(fmt::format("{:.0f} % ({})", *mean.error * 100.0, mean.axis));
  return fmt::format("{}", fmt::join(parts, " and "));
}

// The one model of all rows, if it is one.
std::optional<std::string> only_model(const std::vector<CircleTableRow>& rows) {
  for (const auto& row : rows)
    if (row.friction != rows.front().friction) return std::nullopt;
  return friction_label(rows.front().friction);
}

}  // namespace

std::string friction_label(std::string_view name) {
  std::string label(name);
  for (const auto& law : sim::friction_tables())
    if (law.name == name) label = law.text;
  return label;
}

CircleFinding circle_finding(const sim::CircleResult& result, const machine::Machine& machine) {
  if (result.runs.empty()) throw std::invalid_argument("a circle report needs at least one run");
  const auto all = circle_table(result, machine);
  auto rows = all;
  std::erase_if(rows, [&](const auto& row) { return !acts(machine, row); });
  if (rows.empty()) rows = all;

  const double feed = middle_feed(rows, true);
  const CircleTableRow* largest = nullptr;
  for (const auto& row : rows)
    if (same_feed(row.feed, feed) && (!largest || row.error.simulated > largest->error.simulated)) largest = &row;

  CircleFinding finding;
  finding.feed = feed;
  finding.sentence =
      fmt::format("At {:.4g} m/min the largest {} error is {:.1f} µm ({}, {}){}", feed * 60.0,
                  result.runs.front().is_circle() ? "quadrant" : "following", largest->error.simulated * 1e6,
                  largest->axis, friction_label(largest->friction), beside(*largest));
  const auto model = only_model(rows);
  const auto errors = model ? mean_errors(rows) : std::string();
  if (!errors.empty())
    finding.sentence += fmt::format(", and over all measured feeds the simulation deviates by {} on average", errors);
  finding.sentence += ".";
  return finding;
}

}  // namespace stiction::host
