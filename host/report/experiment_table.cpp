// An experiment's figures beside what their sources say: see experiment_table.hpp.
#include "host/report/experiment_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "host/report/circle_finding.hpp"
#include "host/report/typeset.hpp"

namespace stiction::host {
namespace {

constexpr int most_decimals = 6;

// Decimals with which the place of a number's `digits`-th significant digit is the last one.
int decimals_for(double value, int digits) {
  if (!std::isfinite(value) || value == 0.0) return 0;
  return std::clamp(digits - 1 - static_cast<int>(std::floor(std::log10(std::abs(value)))), 0, most_decimals);
}

// Decimals of a number as its source prints it.
int own_decimals(double value) {
  for (int decimals = 0; decimals < most_decimals; ++decimals)
    if (std::abs(std::strtod(fmt::format("{:.{}f}", value, decimals).c_str(), nullptr) - value) <=
        1e-9 * std::abs(value))
      return decimals;
  return most_decimals;
}

// The tolerance shows up to a third of its size, the expected value as its source prints it, at most one digit further;
// so does a tolerance that has no more digits than that.
int decimals_of(const sim::Expectation& expected) {
  const int own = own_decimals(expected.value);
  if (expected.tolerance <= 0.0) return own;
  const int needed = decimals_for(expected.tolerance / 3.0, 1), most = std::min(needed + 1, most_decimals);
  const int of_tolerance = own_decimals(expected.tolerance);
  return std::clamp(of_tolerance <= most ? std::max(own, of_tolerance) : own, needed, most);
}

struct Group {
  std::string text, unit;
  std::vector<const sim::Figure*> figures;
};

std::vector<Group> grouped(const sim::ExperimentResult& result) {
  std::vector<Group> groups;
  for (const auto& figure : result.figures) {
    const auto text = split_model(figure.text).text;
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const Group& each) { return each.text == text && each.unit == figure.unit; });
    if (group == groups.end()) group = groups.insert(groups.end(), {text, figure.unit, {}});
    group->figures.push_back(&figure);
  }
  return groups;
}

int decimals_of(const Group& group) {
  int decimals = 0;
  double largest = 0.0;
  bool expected = false;
  for (const auto* figure : group.figures) {
    largest = std::max(largest, std::abs(figure->value));
    if (!figure->expected) continue;
    decimals = std::max(decimals, decimals_of(*figure->expected));
    expected = true;
  }
  if (expected) return decimals;
  return group.unit.empty() ? std::min(decimals_for(largest, 4), own_decimals(largest)) : decimals_for(largest, 4);
}

std::string print(double value, int decimals) {
  auto text = fmt::format("{:.{}f}", value, decimals);
  const bool reads_zero = text.find_first_not_of("-0.") == std::string::npos;
  if (std::abs(value) >= 1e9 || (reads_zero && value != 0.0 && decimals == most_decimals))
    return fmt::format("{:.3e}", value);
  return reads_zero && text.starts_with('-') ? text.substr(1) : text;
}

FigureRow row_of(const sim::Figure& figure, int decimals) {
  auto [friction, text] = split_model(figure.text);
  FigureRow row{std::move(text), std::move(friction), figure.unit, print(figure.value, decimals), "", "", "", {}, {}};
  if (!figure.expected) return row;
  const auto& [value, tolerance, source] = *figure.expected;
  row.expected = print(value, decimals);
  row.tolerance = print(tolerance, decimals);
  row.source = source;
  row.holds = figure.holds();
  if (tolerance > 0.0 && std::isfinite(figure.value)) row.offset = (figure.value - value) / tolerance;
  return row;
}

}  // namespace

std::vector<FigureRow> figure_rows(const sim::ExperimentResult& result) {
  std::vector<FigureRow> rows;
  for (const auto& group : grouped(result)) {
    const int decimals = decimals_of(group);
    for (const auto* figure : group.figures) rows.push_back(row_of(*figure, decimals));
  }
  return rows;
}

std::string verdict(const sim::ExperimentResult& result) {
  std::size_t expected = 0;
  std::vector<std::string> differing;
  for (const auto& row : figure_rows(result)) {
    expected += row.holds.has_value();
    if (!row.holds.value_or(true))
      differing.push_back(row.friction.empty() ? row.text
                          : row.text.empty()   ? friction_label(row.friction)
                                               : fmt::format("{} ({})", row.text, friction_label(row.friction)));
  }
  if (expected == 0) return "The machine file states no expected figures for this run.";
  auto text = fmt::format("{} of {} figures are as expected", expected - differing.size(), expected);
  if (differing.size() == 1 || differing.size() == 2)
    text += fmt::format("; different: {}", fmt::join(differing, ", "));
  return text + ".";
}

}  // namespace stiction::host
