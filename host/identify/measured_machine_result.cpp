#include "host/identify/measured_machine_result.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <optional>

namespace stiction::host {
namespace {

const machine::CircleReference* published_lugre(const machine::Machine& machine, const PredictedRow& row) {
  for (const auto& reference : machine.circle_references)
    if (!reference.measured && reference.friction == "lugre" && reference.axis == row.axis &&
        reference.feed == row.feed)
      return &reference;
  return nullptr;
}

void add_parameters(const MeasuredMachine& m, sim::ExperimentResult& result) {
  const auto add = [&](std::string name, const char* unit, std::string text, double value) {
    result.figures.push_back({std::move(name), unit, std::move(text), value, {}});
  };
  add("creeping_friction", "N", "friction of X as the speed goes to zero", m.sliding.creeping);
  add("rise", "N", "rise from creeping to sliding", m.sliding.rise);
  add("rise_velocity", "mm/s", "speed with 63 % of the rise", m.sliding.rise_velocity * 1e3);
  add("viscous", "N s/m", "viscous friction", m.sliding.viscous);
  add("sliding_deviation", "N", "measured steady friction about the curve, rms", m.sliding.deviation);
  add("presliding_coulomb", "N", "greatest force of the test rig contact against the previous motion",
      m.presliding.coulomb());
  for (const auto& axis : m.axes) {
    add("force_scale_" + axis.axis, "", "scale of the friction, " + axis.axis, axis.force);
    add("displacement_scale_" + axis.axis, "", "scale of the displacements, " + axis.axis, axis.displacement);
    add("calibrated_error_" + axis.axis, "um", "peak error at 16 m/min, " + axis.axis, axis.error * 1e6);
    add("calibrated_current_" + axis.axis, "A", "peak current at 16 m/min, " + axis.axis, axis.current);
  }
}

void add_scores(const MeasuredMachineStudy& study, sim::ExperimentResult& result) {
  const auto scores = held_out_scores(study.rows);
  const auto add = [&](const std::string& name, const std::string& text, double share, const std::string& axis = {}) {
    result.figures.push_back({name, "%", text, share * 100.0, {}, {}, axis});
  };
  for (const auto& score : scores) {
    add("held_out_error_" + score.axis,
        "peak errors of the held-out feeds against the measurement, mean, " + score.axis, score.error, score.axis);
    add("held_out_current_" + score.axis,
        "peak currents of the held-out feeds against the measurement, mean, " + score.axis, score.current, score.axis);
  }
  add("held_out_mean", "mean of all quantities, held-out feeds", mean_of(scores));
  add("standstill_current_kept", "L-shaped path: current of Y at standstill over its creeping friction",
      study.kept_share());
  add("same_direction_restart",
      "L-shaped path: error of the restart in the same direction over that in the opposite one", study.restart_share());
}

// Measured, published and simulated values over the feed, of all axes.
sim::Chart over_feed(const machine::Machine& machine, const MeasuredMachineStudy& study, bool error) {
  sim::Chart chart{error ? "Quadrant error over feed" : "Peak current over feed",
                   "feed, m/min",
                   error ? "peak error, um" : "peak current, A",
                   "The model was calibrated at 16 m/min; the other feeds are predicted.",
                   false,
                   {}};
  for (const auto& axis : study.identified.axes) {
    sim::Series measured{axis.axis + " measured", {}, {}, true},
        published{axis.axis + " published LuGre", {}, {}, true}, ours{axis.axis + " simulated", {}, {}, false};
    for (const auto& row : study.rows) {
      if (row.axis != axis.axis) continue;
      const auto add = [&](sim::Series& series, double e, double i) {
        series.x.push_back(row.feed * 60.0);
        series.y.push_back(error ? e * 1e6 : i);
      };
      add(measured, row.measured_error, row.measured_current);
      add(ours, row.error, row.current);
      if (const auto* reference = published_lugre(machine, row)) add(published, reference->error, reference->current);
    }
    chart.series.insert(chart.series.end(), {measured, published, ours});
  }
  return chart;
}

sim::Chart sliding_chart(const PermittedRows& rows, const SteadyCurve& curve) {
  sim::Chart chart{"Friction over speed",
                   "speed, mm/s",
                   "friction force, N",
                   fmt::format("Points: steady friction of the machine file. Curve: {:.1f} N + {:.1f} N (1 - exp(-v / "
                               "{:.1f} mm/s)) + {:.0f} N s/m v.",
                               curve.creeping, curve.rise, curve.rise_velocity * 1e3, curve.viscous),
                   true,
                   {}};
  sim::Series points{"measured", {}, {}, true}, line{"fitted", {}, {}, false};
  points.role = sim::SeriesRole::measured;
  for (const auto& point : rows.steady) {
    points.x.push_back(point.velocity * 1e3);
    points.y.push_back(point.force);
  }
  for (double v = 2e-4; v < 0.85; v *= 1.05) {
    line.x.push_back(v * 1e3);
    line.y.push_back(curve.at(v));
  }
  chart.series = {std::move(points), std::move(line)};
  return chart;
}

sim::Chart presliding_chart(const PermittedRows& rows, const PreslidingCurve& curve) {
  sim::Chart chart{"Force before sliding",
                   "displacement, um",
                   "force, N",
                   "Points: presliding of the machine file, loaded after coasting to rest. The first loading of the "
                   "model follows the points against "
                   "the previous motion; it does not explain those in its direction.",
                   false,
                   {}};
  for (const bool same : {true, false}) {
    sim::Series points{
        same ? "in the direction of the previous motion, measured" : "against it, measured", {}, {}, true};
    for (const auto& point : rows.presliding) {
      if (point.same_direction != same) continue;
      points.x.push_back(point.displacement * 1e6);
      points.y.push_back(point.force);
    }
    chart.series.push_back(std::move(points));
  }
  sim::Series line{"model, unscaled", {0.0}, {0.0}, false};
  for (std::size_t i = 0; i < curve.force.size(); ++i) {
    line.x.push_back(curve.displacement[i] * 1e6);
    line.y.push_back(curve.force[i]);
  }
  chart.series.push_back(std::move(line));
  return chart;
}

std::vector<std::string> findings(const MeasuredMachineStudy& study) {
  const auto scores = held_out_scores(study.rows);
  std::vector<std::string> sentences;
  sentences.push_back(
      fmt::format("Calibrated at 16 m/min, the model deviates by {:.1f} % on average at the other feeds.",
                  mean_of(scores) * 100.0));
  const auto worst = std::max_element(study.rows.begin(), study.rows.end(), [](const auto& a, const auto& b) {
    const auto off = [](const PredictedRow& row) { return std::abs(row.error / row.measured_error - 1.0); };
    return off(a) < off(b);
  });
  sentences.push_back(
      fmt::format("The largest deviation of a peak error is that of {} at {:g} m/min: {:.1f} um, measured {:.1f} um.",
                  worst->axis, worst->feed * 60.0, worst->error * 1e6, worst->measured_error * 1e6));
  sentences.push_back(
      fmt::format("On the L-shaped path Y keeps {:.2f} A at standstill, {:.0f} % of its creeping friction; its error "
                  "at the restart is {:.1f} um in the same direction and {:.1f} um in the opposite one.",
                  study.l_shape.kept_current(), study.kept_share() * 100.0, study.l_shape.same_error * 1e6,
                  study.l_shape.opposite_error * 1e6));
  sentences.push_back(fmt::format(
      "The calibration makes the contact {:.1f} (X) and {:.1f} (Y) times softer than the test rig of "
      "the presliding rows. Small reversals of the machine itself would determine its presliding, and restarts after "
      "standstills of several durations its memory.",
      study.identified.axes[0].displacement, study.identified.axes[1].displacement));
  return sentences;
}

}  // namespace

MeasuredMachineStudy study_measured_machine(const machine::Machine& circle, const machine::Machine& l_shape) {
  MeasuredMachineStudy study{identify_measured_machine(circle), {}, {}};
  study.rows = predict_circles(circle, study.identified);
  study.l_shape = drive_l_shape(with_friction(l_shape, study.identified));
  const auto& level = study.identified.axes[1].friction.level;
  study.creeping_current_of_y = std::accumulate(level.begin(), level.end(), 0.0) / circle.axes[1].motor.force_constant;
  return study;
}

sim::ExperimentResult measured_machine_result(const machine::Machine& machine, const MeasuredMachineStudy& study) {
  sim::ExperimentResult result{
      "identify-reference",
      "Friction model of the measured machine",
      "double",
      "The parameters come from the rows of steady friction and presliding in the machine file and from two numbers "
      "per "
      "axis at 16 m/min; the other feeds of the measured circles are predicted (structure: docs/friction_model.md).",
      findings(study),
      {},
      {}};
  add_parameters(study.identified, result);
  add_scores(study, result);
  const auto rows = permitted_rows(machine);
  auto error = study.l_shape.error, current = study.l_shape.current;
  error.name = current.name = "simulated";
  result.charts = {
      over_feed(machine, study, true),
      over_feed(machine, study, false),
      sliding_chart(rows, study.identified.sliding),
      presliding_chart(rows, study.identified.presliding),
      {"L-shaped path: error of Y", "time, s", "error at the encoder, um", "", false, {std::move(error)}},
      {"L-shaped path: current of Y", "time, s", "motor force / force constant, A", "", false, {std::move(current)}}};
  return result;
}

std::string prediction_text(const machine::Machine& machine, const MeasuredMachineStudy& study) {
  std::string text =
      "                     peak error, um                         peak current, A\n"
      "axis  m/min  measured  published  simulated      %    measured  published  simulated      %\n";
  for (const auto& row : study.rows) {
    const auto* published = published_lugre(machine, row);
    const auto cell = [&](double machine::CircleReference::*member, double scale) {
      return published ? fmt::format("{:.1f}", published->*member * scale) : std::string("-");
    };
    text +=
        fmt::format("{:<4} {:>6.1f} {:>9.1f} {:>10} {:>10.2f} {:>+6.1f} {:>11.1f} {:>10} {:>10.2f} {:>+6.1f}{}\n",
                    row.axis, row.feed * 60.0, row.measured_error * 1e6, cell(&machine::CircleReference::error, 1e6),
                    row.error * 1e6, (row.error / row.measured_error - 1.0) * 100.0, row.measured_current,
                    cell(&machine::CircleReference::current, 1.0), row.current,
                    (row.current / row.measured_current - 1.0) * 100.0, row.held_out ? "" : "  (calibration)");
  }
  return text;
}

std::string friction_toml(const MeasuredMachine& identified) {
  const auto list = [](const std::vector<double>& values, const char* unit) {
    std::vector<std::string> texts;
    for (const double value : values) texts.push_back(fmt::format("\"{:.6g} {}\"", value, unit));
    return fmt::format("[{}]", fmt::join(texts, ", "));
  };
  std::string text;
  for (const auto& axis : identified.axes) {
    const auto& p = axis.friction;
    text += fmt::format(
        "[axis.{}.friction.maxwell_slip]\nstiffness = {}\nlevel = {}\nviscous = \"{:.6g} N s/m\"\n"
        "rise = \"{:.6g} N\"\nrise_velocity = \"{:.6g} m/s\"\n\n",
        axis.axis, list(p.stiffness, "N/m"), list(p.level, "N"), p.viscous, p.rise, p.rise_velocity);
  }
  return text;
}

}  // namespace stiction::host
