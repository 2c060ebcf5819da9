#include "host/identify/measured_machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/machine/configuration/double_signals.hpp"
#include "host/simulate/circle.hpp"
#include "sim/plant/friction/maxwell_slip.hpp"
#include "sim/plant/friction/parameters.hpp"

namespace stiction::host {
namespace {

bool at_calibration_feed(double feed) { return std::abs(feed - calibration_feed) < 1e-6 * calibration_feed; }

sim::CircleRun circle(const machine::Machine& machine, double feed) {
  sim::CircleSettings settings;
  settings.feed = feed;
  return run_circle<machine::DoubleSignals>(machine, settings);
}

// Scales of both axes at once, as one circle moves both: bisection of the displacement in its logarithm for the error,
// which falls with it, and in each step the friction for the current, which is close to linear in it.
class Calibration {
 public:
  Calibration(const machine::Machine& machine, const PermittedRows& rows)
      : machine_(machine), rows_(rows), result_{fit_steady_curve(rows.steady), presliding_curve(rows.presliding), {}} {
    machine_.circle_references.clear();  // no row but those permitted can take part
    for (const auto& axis : machine.axes) result_.axes.push_back({axis.name, 1.0, 1.0, 0.0, 0.0, {}});
  }

  MeasuredMachine run() {
    start_currents();
    std::array<double, 2> low{least_displacement, least_displacement}, high{most_displacement, most_displacement};
    for (int i = 0; i < halvings; ++i) {
      for (std::size_t k = 0; k < 2; ++k) result_.axes[k].displacement = std::sqrt(low[k] * high[k]);
      simulate();
      correct_currents();
      simulate();
      correct_currents();
      for (std::size_t k = 0; k < 2; ++k)
        (result_.axes[k].error > rows_.circle[k].error ? low : high)[k] = result_.axes[k].displacement;
    }
    simulate();
    for (std::size_t k = 0; k < 2; ++k) check(result_.axes[k], rows_.circle[k]);
    return result_;
  }

 private:
  static constexpr double least_displacement = 0.1, most_displacement = 1000.0;
  // To 0.45 % of the displacement; the error moves by less than 0.02 um over that, or by a step of the position
  // controller's quantizer.
  static constexpr int halvings = 11;

  void simulate() {
    for (auto& axis : result_.axes)
      axis.friction = friction_elements(result_.sliding, result_.presliding, axis.force, axis.displacement);
    const auto run = circle(with_friction(machine_, result_), calibration_feed);
    for (std::size_t k = 0; k < 2; ++k) {
      result_.axes[k].error = run.axes[k].peak_error;
      result_.axes[k].current = run.axes[k].peak_current;
    }
  }

  // How the current grows with the friction, by two circles.
  void start_currents() {
    simulate();
    for (std::size_t k = 0; k < 2; ++k) {
      slope_[k] = -result_.axes[k].current;
      result_.axes[k].force = 2.0;
    }
    simulate();
    for (std::size_t k = 0; k < 2; ++k) slope_[k] += result_.axes[k].current;
    correct_currents();
  }

  void correct_currents() {
    for (std::size_t k = 0; k < 2; ++k) {
      auto& axis = result_.axes[k];
      axis.force = std::max(0.05, axis.force + (rows_.circle[k].current - axis.current) / slope_[k]);
    }
  }

  static void check(const CalibratedAxis& axis, const machine::CircleReference& wanted) {
    if (std::abs(axis.error / wanted.error - 1.0) < 0.01 && std::abs(axis.current / wanted.current - 1.0) < 0.01)
      return;
    throw MissingRows(
        fmt::format("axis {}: found no friction that gives {:.2f} um and {:.2f} A (nearest {:.2f} um, {:.2f} A); "
                    "expected a row that friction can explain",
                    axis.axis, wanted.error * 1e6, wanted.current, axis.error * 1e6, axis.current));
  }

  machine::Machine machine_;
  const PermittedRows& rows_;
  MeasuredMachine result_;
  std::array<double, 2> slope_{};  // A, of the current over the scale of the friction
};

}  // namespace

PermittedRows permitted_rows(const machine::Machine& machine) {
  PermittedRows rows;
  for (const auto& axis : machine.axes) {
    for (const auto& row : machine.steady_friction_references)
      if (row.axis == axis.name) rows.steady.push_back({row.velocity, row.current * axis.motor.force_constant});
    const auto row =
        std::find_if(machine.circle_references.begin(), machine.circle_references.end(),
                     [&](const machine::CircleReference& candidate) {
                       return candidate.measured && candidate.axis == axis.name && at_calibration_feed(candidate.feed);
                     });
    if (row == machine.circle_references.end())
      throw MissingRows(fmt::format("axis {}: found no measured [[reference.circle]] row at {:g} m/min; expected one",
                                    axis.name, calibration_feed * 60.0));
    rows.circle.push_back(*row);
  }
  if (rows.circle.size() != 2)
    throw MissingRows(fmt::format("found a machine with {} axes; expected 2", rows.circle.size()));
  for (const auto& row : machine.presliding_references)
    rows.presliding.push_back({row.same_direction, row.force, row.displacement});
  return rows;
}

MeasuredMachine identify_measured_machine(const machine::Machine& machine) {
  const auto rows = permitted_rows(machine);
  return Calibration(machine, rows).run();
}

machine::Machine with_friction(machine::Machine machine, const MeasuredMachine& identified) {
  const std::string model(sim::MaxwellSlip<>::name);
  for (std::size_t k = 0; k < machine.axes.size(); ++k) {
    machine.axes[k].friction.models[model] = sim::values_of<sim::MaxwellSlip<>>(identified.axes[k].friction);
    machine.axes[k].friction.use = model;
  }
  return machine;
}

std::vector<PredictedRow> predict_circles(const machine::Machine& machine, const MeasuredMachine& identified) {
  const auto simulated = with_friction(machine, identified);
  std::vector<double> feeds;
  for (const auto& row : machine.circle_references)
    if (row.measured && std::find(feeds.begin(), feeds.end(), row.feed) == feeds.end()) feeds.push_back(row.feed);
  std::vector<sim::CircleRun> runs;
  for (const double feed : feeds) runs.push_back(circle(simulated, feed));

  std::vector<PredictedRow> rows;
  for (const auto& row : machine.circle_references) {
    if (!row.measured) continue;
    const auto& run = runs[static_cast<std::size_t>(std::find(feeds.begin(), feeds.end(), row.feed) - feeds.begin())];
    const auto& lap = run.axes[run.axes[0].axis == row.axis ? 0 : 1];
    rows.push_back(
        {row.axis, row.feed, !at_calibration_feed(row.feed), lap.peak_error, row.error, lap.peak_current, row.current});
  }
  return rows;
}

std::vector<HeldOutScore> held_out_scores(const std::vector<PredictedRow>& rows) {
  std::vector<HeldOutScore> scores;
  std::vector<int> counts;
  for (const auto& row : rows) {
    if (!row.held_out) continue;
    auto score = std::find_if(scores.begin(), scores.end(), [&](const auto& s) { return s.axis == row.axis; });
    if (score == scores.end()) {
      score = scores.insert(score, {row.axis, 0.0, 0.0});
      counts.push_back(0);
    }
    score->error += std::abs(row.error / row.measured_error - 1.0);
    score->current += std::abs(row.current / row.measured_current - 1.0);
    ++counts[static_cast<std::size_t>(score - scores.begin())];
  }
  for (std::size_t i = 0; i < scores.size(); ++i) {
    scores[i].error /= counts[i];
    scores[i].current /= counts[i];
  }
  return scores;
}

double mean_of(const std::vector<HeldOutScore>& scores) {
  double sum = 0.0;
  for (const auto& score : scores) sum += score.error + score.current;
  return sum / (2.0 * static_cast<double>(scores.size()));
}

}  // namespace stiction::host
