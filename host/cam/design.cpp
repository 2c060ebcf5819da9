#include "host/cam/design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace stiction::host {
namespace {

constexpr double degree = 180.0 / std::numbers::pi;
constexpr std::size_t drawn_points = 1440, drawn_harmonics = 60, transformed_points = 8192;

struct Shown {
  double x_scale;  // of the master
  std::string x_label;
  double y_scale;  // of the slave
  std::string y_unit;
};

Shown shown_of(const sim::cam::Cam& cam) {
  const bool angle = cam.master == sim::cam::Coordinate::rotary, turn = cam.slave == sim::cam::Coordinate::rotary;
  return {angle ? degree : 1e3, angle ? "master, °" : "master, mm", turn ? degree : 1e3, turn ? "°" : "mm"};
}

// Of y' y''.
std::string product_unit(const sim::cam::Cam& cam) {
  const bool angle = cam.master == sim::cam::Coordinate::rotary, turn = cam.slave == sim::cam::Coordinate::rotary;
  return angle ? turn ? "1" : "m²/rad³" : turn ? "rad²/m³" : "1/m";
}

// Both sides of each joint are drawn, so that a jump is one.
template <class Function>
sim::Series series_of(const sim::cam::Motion& motion, const std::string& name, double x_scale, const Function& y) {
  sim::Series series{.name = name, .x = {}, .y = {}};
  for (const auto& piece : motion.curve.pieces()) {
    const auto share = static_cast<double>(drawn_points) * piece.length() / motion.curve.length();
    const int count = std::max(8, static_cast<int>(share));
    for (int k = 0; k <= count; ++k) {
      const double x = k == count ? piece.end : piece.begin + piece.length() * k / count;
      series.x.push_back(x * x_scale);
      series.y.push_back(y(piece, x));
    }
  }
  return series;
}

sim::Chart chart_of(std::string title, const std::string& x, std::string y, std::string caption,
                    std::vector<sim::Series> series) {
  sim::Chart chart;
  chart.title = std::move(title);
  chart.x_label = x;
  chart.y_label = std::move(y);
  chart.caption = std::move(caption);
  chart.series = std::move(series);
  return chart;
}

void add_motion_charts(const CamDesign& d, sim::ExperimentResult& result) {
  const auto shown = shown_of(d.motion.cam);
  const double w = d.duty.master_speed;
  const char* const titles[] = {"Position", "Speed", "Acceleration", "Jerk"};
  const char* const names[] = {"position", "speed", "acceleration", "jerk"};
  const char* const rates[] = {"", "/s", "/s²", "/s³"};
  double factor = shown.y_scale;
  for (int order = 0; order < 4; ++order, factor *= w)
    result.charts.push_back(
        chart_of(titles[order], shown.x_label, fmt::format("{}, {}{}", names[order], shown.y_unit, rates[order]), "",
                 {series_of(d.motion, "slave", shown.x_scale,
                            [&](const auto& piece, double x) { return piece.derivative(x, order) * factor; })}));
  result.charts.push_back(chart_of(
      "Product of speed and acceleration", shown.x_label, "product, " + product_unit(d.motion.cam),
      "Torque at the shaft of a classic cam follows it.",
      {series_of(d.motion, "slave", shown.x_scale,
                 [&](const auto& piece, double x) { return piece.derivative(x, 1) * piece.derivative(x, 2); })}));
}

void add_effort_chart(const CamDesign& d, sim::ExperimentResult& result) {
  const auto shown = shown_of(d.motion.cam);
  const double w = d.duty.master_speed, load = d.load.load;
  auto chart = chart_of(
      d.load.kind == sim::cam::Coordinate::rotary ? "Torque" : "Force", shown.x_label,
      std::string(d.load.kind == sim::cam::Coordinate::rotary ? "torque, " : "force, ") + d.load.effort_unit(),
      "Motor: with rotor, friction and weight. M_D: the load alone at the output. M_H: at the shaft of a classic cam.",
      {series_of(d.motion, "motor", shown.x_scale,
                 [&](const auto& piece, double x) {
                   return d.load.effort(piece.derivative(x, 0), piece.derivative(x, 1) * w,
                                        piece.derivative(x, 2) * w * w);
                 }),
       series_of(d.motion, "M_D", shown.x_scale,
                 [&](const auto& piece, double x) { return load * piece.derivative(x, 2) * w * w; }),
       series_of(d.motion, "M_H", shown.x_scale, [&](const auto& piece, double x) {
         return load * piece.derivative(x, 1) * piece.derivative(x, 2) * w * w;
       })});
  if (std::isfinite(d.load.largest_effort)) chart.levels = {d.load.largest_effort, -d.load.largest_effort};
  result.charts.push_back(std::move(chart));
}

void add_spectrum_chart(const CamDesign& d, sim::ExperimentResult& result) {
  const auto shown = shown_of(d.motion.cam);
  const double w = d.duty.master_speed, cycles = w / d.motion.cam.cycle();
  sim::Series series{.name = "harmonics", .x = {}, .y = {}, .bars = true};
  const auto amplitudes = acceleration_harmonics(d.motion, drawn_harmonics);
  for (std::size_t k = 0; k < amplitudes.size(); ++k) {
    series.x.push_back(static_cast<double>(k + 1) * cycles);
    series.y.push_back(amplitudes[k] * w * w * shown.y_scale);
  }
  result.charts.push_back(chart_of("Spectrum of the acceleration", "frequency, Hz",
                                   "acceleration, " + shown.y_unit + "/s²", "Amplitudes of the harmonics of a cycle.",
                                   {series}));
}

// Of the segments that move, each at its own duration; the largest counts.
double residual_at(const CamDesign& d, double frequency) {
  double largest = 0.0;
  const auto& motion = d.motion;
  for (std::size_t k = 0; k < motion.segments.size(); ++k) {
    const auto& segment = motion.cam.segments[k];
    if (segment.stroke == 0.0 || segment.law == "linear") continue;
    const auto& pieces = motion.curve.pieces();
    const sim::cam::Curve part({pieces.begin() + static_cast<std::ptrdiff_t>(motion.segments[k].first_piece),
                                pieces.begin() + static_cast<std::ptrdiff_t>(motion.segments[k].end_piece)});
    const double periods = frequency * part.length() / d.duty.master_speed;
    largest = std::max(largest, residual_amplitude(part, periods));
  }
  return largest;
}

void add_residual_chart(const CamDesign& d, sim::ExperimentResult& result) {
  const auto shown = shown_of(d.motion.cam);
  double shortest = d.motion.cam.cycle();
  for (const auto& segment : d.motion.cam.segments)
    if (segment.stroke != 0.0) shortest = std::min(shortest, segment.length);
  const double slowest = d.duty.master_speed / shortest;
  const double highest = std::max(8.0 * slowest, d.load.frequency ? 1.5 * *d.load.frequency : 0.0);
  sim::Series series{.name = "largest of all segments", .x = {}, .y = {}};
  for (int k = 1; k <= 240; ++k) {
    const double f = highest * k / 240;
    series.x.push_back(f);
    series.y.push_back(residual_at(d, f) * shown.y_scale);
  }
  auto chart = chart_of("Residual oscillation", "natural frequency, Hz", "amplitude, " + shown.y_unit,
                        "Amplitude behind a segment of an undamped load of that frequency.", {series});
  if (d.load.frequency)
    chart.distances.push_back({*d.load.frequency, 0.0, residual_at(d, *d.load.frequency) * shown.y_scale,
                               fmt::format("{:.3g} Hz of {}", *d.load.frequency, d.load.axis)});
  result.charts.push_back(std::move(chart));
}

void add_figures(const CamDesign& d, sim::ExperimentResult& result) {
  const auto shown = shown_of(d.motion.cam);
  const auto& e = d.duty.effort;
  const std::string effort = d.load.effort_unit();
  const auto add = [&](const char* name, const std::string& unit, const char* text, double value) {
    result.figures.push_back({.name = name, .unit = unit, .text = text, .value = value, .expected = {}});
  };
  add("peak_speed", shown.y_unit + "/s", "peak speed", d.duty.extremes[1].magnitude() * shown.y_scale);
  add("peak_acceleration", shown.y_unit + "/s²", "peak acceleration", d.duty.extremes[2].magnitude() * shown.y_scale);
  add("output", effort, "load alone at the output, M_D", std::fabs(e.load.value));
  add("classic_cam", d.motion.cam.master == sim::cam::Coordinate::rotary ? "N m" : "N",
      "classic cam at the shaft of the master, M_H", std::fabs(e.cam.value));
  add("motor", effort, "motor of the electronic cam", std::fabs(e.motor.value));
  add("motor_rms", effort, "motor, rms over a cycle", e.motor_rms);
  add("motor_power", "W", "motor, peak power", e.peak_power);
  add("classic_cam_power", "W", "classic cam, peak power", e.cam_power);
  if (std::isfinite(d.load.largest_effort))
    add("motor_reserve", "%", "reserve of the motor", 100.0 * (1.0 - std::fabs(e.motor.value) / d.load.largest_effort));
  add("energy", "J", "energy of a cycle", e.energy);
  if (d.load.frequency)
    add("residual", shown.y_unit, "residual oscillation at the own frequency, undamped",
        residual_at(d, *d.load.frequency) * shown.y_scale);
}

void add_findings(const CamDesign& d, sim::ExperimentResult& result) {
  for (const auto& limit : d.duty.limits)
    if (limit.broken())
      result.findings.push_back(fmt::format("The {} is {:.4g} {}; the axis allows {:.4g}.", limit.name, limit.found,
                                            limit.unit, limit.allowed));
  if (result.findings.empty()) result.findings.emplace_back("Every limit of the axis is kept.");
  int counted[4] = {};
  for (const auto& found : d.jumps) ++counted[found.jump.order];
  for (int order = 0; order < 3; ++order)
    if (counted[order] > 0)
      result.findings.push_back(fmt::format("The {} jumps at {} place{} of the master.",
                                            sim::cam::derivative_name(order), counted[order],
                                            counted[order] == 1 ? "" : "s"));
  if (counted[0] + counted[1] + counted[2] == 0)
    result.findings.emplace_back("Position, speed and acceleration are continuous, over the seam too.");
}

}  // namespace

std::vector<double> acceleration_harmonics(const sim::cam::Motion& motion, std::size_t count) {
  std::vector<double> samples(transformed_points);
  const double begin = motion.curve.begin(), cycle = motion.curve.length();
  for (std::size_t k = 0; k < samples.size(); ++k)
    samples[k] = motion.curve.derivative(begin + cycle * static_cast<double>(k) / transformed_points, 2);
  std::vector<std::complex<double>> lines;
  Eigen::FFT<double> fft;
  fft.fwd(lines, samples);
  std::vector<double> amplitudes;
  for (std::size_t k = 1; k <= count; ++k) amplitudes.push_back(2.0 * std::abs(lines[k]) / transformed_points);
  return amplitudes;
}

sim::ExperimentResult design_result(const CamDesign& design) {
  sim::ExperimentResult result;
  result.experiment = "cam-design";
  result.title = "Cam " + design.motion.cam.name;
  result.question = "Can the axis follow this motion at this speed of the master, and what does it ask of the motor?";
  add_figures(design, result);
  add_findings(design, result);
  add_motion_charts(design, result);
  add_effort_chart(design, result);
  add_spectrum_chart(design, result);
  add_residual_chart(design, result);
  return result;
}

}  // namespace stiction::host
