#include "host/simulate/expected_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "firmware/machine/file/machine_file.hpp"
#include "firmware/machine/file/units.hpp"

namespace stiction::host {
namespace {

bool same_options(const std::map<std::string, double>& a, const std::map<std::string, double>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](const auto& x, const auto& y) {
           return x.first == y.first && std::abs(x.second - y.second) <= 1e-9 * std::abs(y.second);
         });
}

bool is_for(const machine::ExpectedFigure& row, const sim::Figure& figure) {
  return row.figure == name_without_model(figure) && (!row.friction || *row.friction == figure.friction) &&
         (figure.axis.empty() || row.axis == figure.axis);
}

double in_unit_of(const machine::ExpectedFigure& row, const char* key, const std::string& text,
                  const sim::Figure& figure) {
  try {
    return machine::parse_quantity(text, figure.unit.empty() ? "1" : figure.unit);
  } catch (const machine::UnitError& error) {
    throw machine::MachineFileError(fmt::format("{}.{}: found \"{}\" ({}); expected a value in {}, the unit of {}",
                                                row.place, key, text, error.what(),
                                                figure.unit.empty() ? "no unit" : figure.unit, row.figure));
  }
}

// Whether the run had figures of the row's axis and model at all.
bool is_about(const machine::ExpectedFigure& row, const sim::ExperimentResult& result) {
  return std::any_of(result.figures.begin(), result.figures.end(), [&](const sim::Figure& figure) {
    return (!row.friction || *row.friction == figure.friction) && (figure.axis.empty() || row.axis == figure.axis);
  });
}

void name_other_settings(sim::ExperimentResult& result, const std::vector<const machine::ExpectedFigure*>& rows) {
  std::set<std::string> settings;
  for (const auto* row : rows) settings.insert(row->settings);
  for (const auto& text : settings)
    result.findings.push_back(fmt::format("The machine file has expected figures for runs with {}.",
                                          text.empty() ? "no overrides and no options" : text));
}

}  // namespace

std::string name_without_model(const sim::Figure& figure) {
  if (figure.friction.empty()) return figure.name;
  const std::string model = "_" + figure.friction;
  const auto place = figure.name.find(model);
  if (place == std::string::npos) return figure.name;
  return figure.name.substr(0, place) + figure.name.substr(place + model.size());
}

void add_expected_figures(sim::ExperimentResult& result, const machine::Machine& machine,
                          const std::map<std::string, double>& options, bool complete) {
  std::vector<const machine::ExpectedFigure*> others;
  for (const auto& row : machine.expected) {
    if (row.experiment != result.experiment) continue;
    if (!row.in_force || !same_options(row.options, options)) {
      if (is_about(row, result)) others.push_back(&row);
      continue;
    }
    bool found = false;
    for (auto& figure : result.figures) {
      if (!is_for(row, figure)) continue;
      figure.expected = sim::Expectation{in_unit_of(row, "value", row.value, figure),
                                         in_unit_of(row, "tolerance", row.tolerance, figure), row.source};
      found = true;
    }
    if (!found && complete && is_about(row, result))
      result.findings.push_back(
          fmt::format("{}: the figure {} was expected; this run has none of that name.", row.place, row.figure));
  }
  if (complete) name_other_settings(result, others);
}

}  // namespace stiction::host
