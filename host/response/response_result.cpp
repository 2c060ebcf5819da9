#include "host/response/response_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/log/shown_units.hpp"

namespace stiction::host {
namespace {

constexpr double lowest_shown = -60.0;  // dB

double decibel(double magnitude) { return 20.0 * std::log10(magnitude); }

// The three loops of an axis, in the order in which they are shown.
struct LoopName {
  const char* name;  // of --loop and of figures
  const char* title;
  const char* caption;
  const LoopResponse* (*of)(const AxisResponse&);
};
constexpr std::array<LoopName, 3> loop_names{{
    {"current", "Current loop",
     "Open: current to current error. Closed: current to set current. Coherence: of the current error.",
     [](const AxisResponse& r) { return r.current ? &*r.current : nullptr; }},
    {"velocity", "Velocity loop",
     "Open: speed to speed error, position loop open. Closed: speed to set speed. Coherence: of the controller output.",
     [](const AxisResponse& r) { return &r.velocity; }},
    {"position", "Position loop",
     "Open: position to following error. Closed: position to set position, without "
     "feedforward. Coherence: of the position.",
     [](const AxisResponse& r) { return &r.position; }},
}};

sim::Series magnitude_series(const char* name, const Curve& curve) {
  sim::Series series{name, curve.frequency, {}, false};
  for (const auto& z : curve.value) series.y.push_back(decibel(std::abs(z)));
  return series;
}

// Without jumps; between -270 and 90 deg where the magnitude is nearest to 1.
sim::Series phase_series(const char* name, const Curve& curve) {
  sim::Series series{name, curve.frequency, {}, false};
  double phase = 0.0, anchor = 0.0, nearest = HUGE_VAL;
  for (std::size_t k = 0; k < curve.value.size(); ++k) {
    phase += k == 0 ? std::arg(curve.value[0]) : std::arg(curve.value[k] / curve.value[k - 1]);
    series.y.push_back(phase * 180.0 / std::numbers::pi);
    if (const double far = std::abs(std::log(std::abs(curve.value[k]))); far < nearest) {
      nearest = far;
      anchor = series.y.back();
    }
  }
  const double turns = 360.0 * std::round((anchor + 90.0) / 360.0);
  for (auto& value : series.y) value -= turns;
  return series;
}

// The three charts of a Bode plot.
struct Bode {
  sim::Chart magnitude, phase, coherence;
};

Bode bode(const std::string& title, const std::string& caption, const std::string& y_label, bool wide) {
  using Height = sim::Shape::Height;
  Bode b;
  for (auto* chart : {&b.magnitude, &b.phase, &b.coherence}) {
    chart->x_label = "frequency, Hz";
    chart->logarithmic_x = true;
    chart->shape = {wide, Height::low};
  }
  b.magnitude.title = title;
  b.magnitude.y_label = y_label;
  b.phase.y_label = "phase, deg";
  b.phase.y_step = 90.0;
  b.phase.y_range = {-360.0, 45.0};
  b.phase.levels = {-180.0};
  b.coherence.y_label = "coherence";
  b.coherence.y_range = {0.0, 1.05};
  b.coherence.y_step = 0.5;
  b.coherence.shape.height = Height::flat;
  b.coherence.caption = caption;
  return b;
}

// Down to -60 dB, up to the next 20 dB.
std::array<double, 2> magnitude_range(const sim::Chart& chart) {
  double highest = 0.0;
  for (const auto& series : chart.series)
    for (const double y : series.y)
      if (std::isfinite(y)) highest = std::max(highest, y);
  return {lowest_shown, 20.0 * std::ceil(highest / 20.0 + 0.1)};
}

Bode loop_bode(const LoopName& name, const AxisResponse& response, const LoopResponse& loop, bool wide) {
  auto b = bode(fmt::format("{}, {}", name.title, response.axis), name.caption, "magnitude, dB", wide);
  b.magnitude.series = {magnitude_series("open loop", loop.open), magnitude_series("closed loop", loop.closed)};
  b.phase.series = {phase_series("open loop", loop.open), phase_series("closed loop", loop.closed)};
  b.coherence.series = {{"coherence", loop.open.frequency, loop.coherence, false}};
  b.magnitude.y_range = magnitude_range(b.magnitude);
  b.magnitude.y_step = 20.0;
  b.magnitude.levels = {0.0};
  if (loop.gain)
    b.magnitude.distances.push_back({loop.gain->frequency, -decibel(loop.gain->factor), 0.0,
                                     fmt::format("gain margin {:.1f} dB", decibel(loop.gain->factor))});
  if (loop.phase)
    b.phase.distances.push_back({loop.phase->frequency, -180.0, -180.0 + loop.phase->degrees,
                                 fmt::format("phase margin {:.0f} deg", loop.phase->degrees)});
  return b;
}

Bode plant_bode(const AxisResponse& response, const machine::AxisModel& axis, bool wide) {
  const auto speed = ShownUnits(axis.coordinate).speed;
  const char* per = axis.motor.driven_by_volts() ? "V" : "A";
  auto b = bode("Plant, " + response.axis,
                fmt::format("Speed at the input of the controller, per {} of the {}. Coherence: of the speed.", per,
                            axis.motor.driven_by_volts()                                        ? "motor voltage"
                            : response.spectra.known[static_cast<std::size_t>(Answer::current)] ? "current"
                                                                                                : "set current"),
                fmt::format("magnitude, dB (0 dB = 1 {} per {})", speed.unit, per), wide);
  b.magnitude.series = {magnitude_series("plant", response.plant)};
  for (double& y : b.magnitude.series.front().y) y += decibel(speed.factor);
  b.phase.series = {phase_series("plant", response.plant)};
  b.phase.levels.clear();
  b.coherence.series = {{"coherence", response.plant.frequency, response.plant_coherence, false}};
  return b;
}

// Charts of the same kind of all axes side by side.
void add_charts(std::vector<sim::Chart>& charts, std::vector<Bode> bodes) {
  for (auto part : {&Bode::magnitude, &Bode::phase, &Bode::coherence})
    for (auto& each : bodes) charts.push_back(std::move(each.*part));
}

void add_figures(std::vector<sim::Figure>& figures, const LoopName& name, const AxisResponse& response,
                 const LoopResponse& loop) {
  const auto add = [&](const char* figure, const char* unit, const char* text, double value) {
    figures.push_back({fmt::format("{}_loop_{}_{}", name.name, figure, response.axis),
                       unit,
                       fmt::format("{}, {}: {}", name.title, response.axis, text),
                       value,
                       {},
                       {},
                       response.axis});
  };
  if (loop.phase) {
    add("crossover", "Hz", "crossover frequency", loop.phase->frequency);
    add("phase_margin", "deg", "phase margin", loop.phase->degrees);
  }
  if (loop.gain) {
    add("phase_crossover", "Hz", "phase crossover frequency", loop.gain->frequency);
    add("gain_margin", "dB", "gain margin", decibel(loop.gain->factor));
    add("gain_margin_factor", "", "gain margin as a factor", loop.gain->factor);
  }
  if (loop.bandwidth) add("bandwidth", "Hz", "bandwidth of the closed loop, -3 dB", *loop.bandwidth);
  if (loop.limit) add("unstable_from", "", "factor of its gain from which the axis is unstable", loop.limit->factor);
  if (loop.decays)
    add("decays_up_to", "", "factor of its gain up to which an oscillation falls to a tenth in 1/3 s",
        loop.decays->factor);
}

std::string margin_sentence(const LoopName& name, const AxisResponse& response, const LoopResponse& loop) {
  auto text = fmt::format("{}, {}: ", name.title, response.axis);
  text += loop.phase ? fmt::format("crossover at {:.4g} Hz with a phase margin of {:.0f} deg", loop.phase->frequency,
                                   loop.phase->degrees)
                     : std::string("no crossover");
  text += loop.gain
              ? fmt::format(", gain margin {:.1f} dB at {:.4g} Hz", decibel(loop.gain->factor), loop.gain->frequency)
              : std::string(", no gain margin within the measured band");
  if (loop.limit)
    text +=
        fmt::format("; with all loops closed the axis remains stable up to {:.3g} times this gain", loop.limit->factor);
  return text + ".";
}

std::string condition_sentence(const AxisResponse& response, const machine::AxisModel& axis) {
  const auto feed = ShownUnits(axis.coordinate).feed;
  const auto& s = response.spectra;
  std::size_t blocks = SIZE_MAX;
  for (const auto& point : s.points) blocks = std::min(blocks, point.blocks);
  auto text = fmt::format("{}: {} frequencies from {:.3g} to {:.4g} Hz, each from at least {} {}; slowest {:.3g} {}",
                          response.axis, s.points.size(), s.points.front().frequency, s.points.back().frequency, blocks,
                          s.periodic ? "blocks of whole periods" : "windows", feed(s.slowest), feed.unit);
  if (s.slowest <= 0.0)
    text +=
        ": the speed crosses zero while the test signal acts, so that friction is strongly nonlinear; record with a "
        "higher speed";
  if (response.samples_at_limit > 0)
    text +=
        fmt::format("; {} samples are at the current limit, where the loop is open: record with a smaller test signal",
                    response.samples_at_limit);
  if (response.set_current_computed)
    text += "; the log has no i_set: it is computed with the controllers of the machine file";
  return text + ".";
}

}  // namespace

sim::ExperimentResult response_result(const std::vector<AxisResponse>& responses, const machine::Machine& machine,
                                      const std::vector<std::string>& loops, const ResponseText& text) {
  sim::ExperimentResult result;
  result.experiment = "frequency-response";
  result.title = "Frequency response";
  result.signals = text.signals;
  result.question =
      text.simulated
          ? "How large is the bandwidth of each loop, and how far is each gain from the one at which the axis goes "
            "unstable? Margins are evaluated at frequencies with a coherence of at least 0.9."
          : "The margins of a measured machine have no expected values. They are evaluated at frequencies with a "
            "coherence of at least 0.9.";
  result.findings.push_back(text.condition);
  const auto axis_of = [&](const AxisResponse& response) -> const machine::AxisModel& {
    return *std::find_if(machine.axes.begin(), machine.axes.end(),
                         [&](const auto& axis) { return axis.name == response.axis; });
  };
  for (const auto& response : responses) result.findings.push_back(condition_sentence(response, axis_of(response)));
  const bool wide = responses.size() != 2;
  for (const auto& name : loop_names) {
    if (!loops.empty() && std::find(loops.begin(), loops.end(), name.name) == loops.end()) continue;
    std::vector<Bode> bodes;
    for (const auto& response : responses) {
      const auto* loop = name.of(response);
      if (loop == nullptr) continue;
      bodes.push_back(loop_bode(name, response, *loop, wide));
      add_figures(result.figures, name, response, *loop);
      result.findings.push_back(margin_sentence(name, response, *loop));
    }
    add_charts(result.charts, std::move(bodes));
  }
  if (loops.empty()) {
    std::vector<Bode> bodes;
    for (const auto& response : responses) bodes.push_back(plant_bode(response, axis_of(response), wide));
    add_charts(result.charts, std::move(bodes));
  }
  return result;
}

}  // namespace stiction::host
