#include "host/tune/tuning_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "firmware/machine/model/motor_force.hpp"

namespace stiction::host {
namespace {

constexpr double metre_per_minute = 60.0;
constexpr double magnification = 1000.0;

// "16": of a feed in m/min, for names and words.
std::string feed_text(double feed) { return fmt::format("{:g}", std::round(feed * metre_per_minute * 1e6) * 1e-6); }

// An error (m) in micrometres, with two digits or without decimals.
std::string error_text(double error) {
  const double um = 1e6 * error;
  return um < 100.0 ? fmt::format("{:.2g}", um) : fmt::format("{:.0f}", um);
}

std::string timing_sentence(const machine::Machine& machine, const std::string& axis, const JudgedLap& lap) {
  return fmt::format(
      "{}: with a look-ahead of {:.0f} us the current comes {} ({:+.0f} us, standard error {:.0f} us over {} "
      "reversals).",
      axis, 1e6 * lap.look_ahead, lap.timing.verdict(machine.timing.fast_period), 1e6 * lap.timing.late,
      1e6 * lap.timing.standard_error, lap.timing.reversals);
}

std::string_view unit_on(const machine::Machine& machine, std::size_t axis) {
  return machine::effort_of(machine.axes[axis].motor).unit;
}

std::vector<std::string> findings(const TunedCompensations& all) {
  std::vector<std::string> sentences;
  for (const auto& [k, tuning] : all.tuned) {
    const auto& axis = all.machine.axes[k].name;
    const auto& friction = tuning.friction;
    sentences.push_back(fmt::format(
        "{}: {} presliding element{} to {:.3g} {unit} of Coulomb friction. Of {:.3g} {unit} rms "
        "without the part of the mass, elements and sliding curve leave a residual of {:.2g} {unit} rms.",
        axis, friction.friction.level.size(), friction.friction.level.size() == 1 ? " comes" : "s sum up",
        friction.coulomb, friction.current_rms, friction.residual_rms, fmt::arg("unit", unit_on(all.machine, k))));
    for (const auto& lap : tuning.laps) sentences.push_back(timing_sentence(all.machine, axis, lap));
    for (const auto& note : friction.notes) sentences.push_back(fmt::format("{}: {}.", axis, note));
    if (tuning.pulse)
      sentences.push_back(fmt::format(
          "{}: with the best of {} speed pulses the error is {} um instead of {} um at {} m/min: "
          "{:.3g} mm/s, {:.2g} ms long, {:.2g} ms after the reversal.",
          axis, tuning.pulse->evaluations, error_text(tuning.pulse->error), error_text(tuning.pulse->error_off),
          feed_text(all.drawn.feed), 1e3 * tuning.pulse->pulse.amplitude, 1e3 * tuning.pulse->pulse.duration,
          1e3 * tuning.pulse->pulse.delay));
  }
  for (const auto& circle : all.circles)
    if (circle.dropped)
      sentences.push_back(
          fmt::format("At {} m/min the learned table made the error grow and was dropped.", feed_text(circle.feed)));
  return sentences;
}

std::vector<sim::Figure> figures(const TunedCompensations& all) {
  std::vector<sim::Figure> list;
  for (std::size_t k = 0; k < all.machine.axes.size(); ++k)
    for (const auto& circle : all.circles) {
      const auto& axis = all.machine.axes[k].name;
      const auto name = fmt::format("{}_{}_{}_m_per_min", axis, name_of(circle.kind), feed_text(circle.feed));
      const auto text = fmt::format("{} at {} m/min, {}", axis, feed_text(circle.feed), words_of(circle.kind));
      list.push_back({"peak_error_" + name, "um", "largest error, " + text, 1e6 * circle.peak_error[k], {}});
      const auto effort = machine::effort_of(all.machine.axes[k].motor);
      list.push_back({fmt::format("peak_{}_{}", effort.name, name),
                      std::string(effort.unit),
                      fmt::format("largest {}, {}", effort.name, text),
                      circle.peak_current[k],
                      {}});
    }
  return list;
}

// The path of two axes with its deviation from the circle magnified.
sim::Chart circle_chart(const TunedCompensations& all) {
  sim::Chart chart;
  const double radius = all.drawn.radius;
  chart.title =
      fmt::format("Circle at {} m/min, deviations magnified {:g} times", feed_text(all.drawn.feed), magnification);
  chart.x_label = all.machine.axes[0].name + ", mm";
  chart.y_label = all.machine.axes[1].name + ", mm";
  chart.caption =
      "Errors of servo and friction at the encoder (ISO 230-4, Annex E). Quadrant errors appear at the four reversals.";
  chart.same_scale = true;
  const double turn = all.drawn.direction == sim::Direction::counter_clockwise ? 1.0 : -1.0;
  for (const auto& circle : all.circles) {
    if (circle.angle.empty()) continue;
    sim::Series series{.name = words_of(circle.kind), .x = {}, .y = {}};
    for (std::size_t i = 0; i < circle.angle.size(); ++i) {
      const double c = std::cos(circle.angle[i]), s = turn * std::sin(circle.angle[i]);
      // The error is set less actual.
      const double deviation = -(circle.error[0][i] * c + circle.error[1][i] * s);
      const double shown = radius + magnification * deviation;
      series.x.push_back(1e3 * shown * c);
      series.y.push_back(1e3 * shown * s);
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

sim::Chart error_chart(const TunedCompensations& all, std::size_t axis) {
  sim::Chart chart;
  chart.title =
      fmt::format("Error of {} over a lap at {} m/min", all.machine.axes[axis].name, feed_text(all.drawn.feed));
  chart.x_label = all.machine.axes.size() == 1 ? "phase of the sine, deg" : "angle along the circle, deg";
  chart.y_label = "set minus actual position, um";
  chart.shape = {.wide = true, .height = sim::Shape::Height::low};
  for (const auto& circle : all.circles) {
    if (circle.angle.empty()) continue;
    sim::Series series{.name = words_of(circle.kind), .x = {}, .y = {}};
    for (std::size_t i = 0; i < circle.angle.size(); ++i) {
      series.x.push_back((circle.angle[i] - circle.angle.front()) * 180.0 / std::numbers::pi + 45.0);
      series.y.push_back(1e6 * circle.error[axis][i]);
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

sim::Chart feed_chart(const TunedCompensations& all, std::size_t axis) {
  sim::Chart chart;
  chart.title = "Largest error of " + all.machine.axes[axis].name + " over the feed";
  chart.x_label = "feed, m/min";
  chart.y_label = "largest error of a lap, um";
  chart.caption = "One set of parameters for all feeds.";
  for (const auto& circle : all.circles) {
    auto known = std::find_if(chart.series.begin(), chart.series.end(),
                              [&](const sim::Series& each) { return each.name == words_of(circle.kind); });
    if (known == chart.series.end())
      known = chart.series.insert(chart.series.end(), sim::Series{.name = words_of(circle.kind), .x = {}, .y = {}});
    known->x.push_back(metre_per_minute * circle.feed);
    known->y.push_back(1e6 * circle.peak_error[axis]);
  }
  return chart;
}

sim::Chart presliding_chart(const machine::AxisModel& of, const machine::FrictionFeedforwardParameters& friction) {
  const auto& axis = of.name;
  const auto effort = machine::effort_of(of.motor);
  sim::Chart chart;
  chart.title = "Presliding of " + axis;
  chart.x_label = "displacement since the reversal, um";
  chart.y_label = fmt::format("{}, {}", effort.name, effort.unit);
  chart.caption = "Stop elements found from the logs, from sliding in one direction to sliding in the other.";
  chart.logarithmic_x = true;
  sim::Series series{.name = "found", .x = {}, .y = {}};
  for (double way = 0.1e-6; way < 1.2 * friction.distance.back(); way *= 1.1) {
    double current = 0.0;
    for (std::size_t e = 0; e < friction.level.size(); ++e)
      current += friction.level[e] * (std::min(2.0 * way / friction.distance[e], 2.0) - 1.0);
    series.x.push_back(1e6 * way);
    series.y.push_back(current);
  }
  chart.series = {std::move(series)};
  return chart;
}

sim::Chart sliding_chart(const machine::AxisModel& of, const FrictionTuning& tuning) {
  const auto& axis = of.name;
  const auto effort = machine::effort_of(of.motor);
  sim::Chart chart;
  chart.title = "Sliding friction of " + axis;
  chart.x_label = "speed, m/min";
  chart.y_label = fmt::format("{} against the motion, {}", effort.name, effort.unit);
  chart.caption = "Coulomb level and sliding curve.";
  sim::Series forward{.name = "forward", .x = {}, .y = {}}, backward{.name = "backward", .x = {}, .y = {}};
  for (std::size_t i = 0; i < tuning.friction.speed.size(); ++i) {
    for (auto* series : {&forward, &backward}) series->x.push_back(metre_per_minute * tuning.friction.speed[i]);
    forward.y.push_back(tuning.coulomb + tuning.friction.forward[i]);
    backward.y.push_back(tuning.coulomb + tuning.friction.backward[i]);
  }
  chart.series = {std::move(forward), std::move(backward)};
  return chart;
}

}  // namespace

sim::ExperimentResult tuning_result(const TunedCompensations& all) {
  sim::ExperimentResult result;
  result.experiment = "tune-friction";
  result.title = "Friction compensation";
  result.signals = "fixed";
  result.question = "By how much does each compensation reduce the error at reversals, with one set of parameters?";
  result.findings = findings(all);
  result.figures = figures(all);
  if (all.machine.axes.size() == 2) result.charts.push_back(circle_chart(all));
  for (std::size_t k = 0; k < all.machine.axes.size(); ++k) result.charts.push_back(feed_chart(all, k));
  for (std::size_t k = 0; k < all.machine.axes.size(); ++k) result.charts.push_back(error_chart(all, k));
  for (const auto& [k, tuning] : all.tuned) {
    result.charts.push_back(presliding_chart(all.machine.axes[k], tuning.friction.friction));
    result.charts.push_back(sliding_chart(all.machine.axes[k], tuning.friction));
  }
  return result;
}

}  // namespace stiction::host
