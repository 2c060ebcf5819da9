// The figures of an experiment beside what their sources say, as reports and terminals print them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

// Numbers are texts with the digits that the expectation needs; the figures of one text and unit have equally many.
struct FigureRow {
  std::string text;      // what the figure is, without the friction model
  std::string friction;  // the model that its text names; empty: none
  std::string unit;
  std::string value;
  std::string expected, tolerance, source;  // empty where nothing is expected
  std::optional<bool> holds;
  std::optional<double> offset;  // from the expected value, in tolerances; empty without a tolerance
};

// Figures of the same text and unit stand together, in the order of their first.
std::vector<FigureRow> figure_rows(const sim::ExperimentResult& result);

// "13 of 14 figures as expected", the one or two that differ behind it; another sentence for a result without
// expectations.
std::string verdict(const sim::ExperimentResult& result);

}  // namespace stiction::host
