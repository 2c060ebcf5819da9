// The figures of a circle beside the machine's published and measured rows, and their mean deviations: what the
// report's table shows. SI units; deviations are fractions, (measured - simulated) / measured.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "sim/experiment/circle_result.hpp"

namespace stiction::host {

// One quantity of one row. An empty optional: the machine has no such row.
struct ComparedFigure {
  double simulated = 0.0;
  std::optional<double> published;
  std::optional<double> measured;
  bool differs = false;  // from the published simulation, by the rule of circle_table()

  std::optional<double> deviation() const;            // of this simulation from the measurement
  std::optional<double> published_deviation() const;  // of the published simulation from the measurement
};

struct CircleTableRow {
  std::string axis;
  std::string friction;
  double feed = 0.0;  // m/s
  sim::Direction direction = sim::Direction::counter_clockwise;
  ComparedFigure error;            // m, unquantised
  ComparedFigure error_quantised;  // m
  ComparedFigure current;          // A
};

// Mean absolute deviations over a model's rows on one axis; empty without a measured (and published) row.
struct MeanDeviation {
  std::string axis;
  std::string friction;
  std::optional<double> error, error_quantised, error_published;
  std::optional<double> current, current_published;
};

// Rows by axis, then model and feed in the order of the runs. A quantised error differs from the published one when it
// is off by more than half the position controller's increment (published errors are whole increments), a current when
// it is off by more than 5 %.
std::vector<CircleTableRow> circle_table(const sim::CircleResult& result, const machine::Machine& machine);

// In the order of the table.
std::vector<MeanDeviation> mean_deviations(const std::vector<CircleTableRow>& table);

}  // namespace stiction::host
