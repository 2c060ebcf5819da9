// A circle as the simulation might leave it: see synthetic_circle.hpp.
#include "tests/host/report/synthetic_circle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <string>

#include "sim/plant/friction/classical.hpp"
#include "sim/plant/friction/coulomb_viscous.hpp"
#include "sim/plant/friction/linear_ramp.hpp"
#include "sim/plant/friction/lugre.hpp"
#include "sim/plant/friction/parabolic.hpp"
#include "sim/plant/friction/parameters.hpp"

namespace stiction::host {
namespace {

using Row = std::array<double, 5>;
constexpr Row feeds{3.2, 8.0, 16.0, 24.0, 48.0};  // m/min

// Heights of the published table (Mendricky 2006, Tab 6.4): um and A.
struct Heights {
  Row x_error, y_error, x_current, y_current;
};
const Heights measured_rows{
    {2.0, 4.5, 7.0, 9.0, 17.0}, {2.5, 5.0, 8.5, 10.5, 18.0}, {1.7, 2.1, 3.6, 5.7, 19.5}, {4.7, 5.1, 8.3, 13.5, 46.8}};
const std::map<std::string, Heights> published_rows{
    {"classical", {{9, 11, 12, 13, 16}, {10, 13, 14, 15, 18}, {1.5, 2.2, 3.8, 6.2, 19.2}, {3.6, 5.4, 9.3, 14.9, 45.0}}},
    {"linear_ramp", {{1, 3, 8, 11, 15}, {1, 3, 9, 13, 18}, {1.2, 1.8, 3.3, 5.9, 19.1}, {3.0, 4.3, 7.9, 14.2, 44.7}}},
    {"parabolic", {{2, 4, 7, 9, 14}, {3, 5, 8, 11, 18}, {1.2, 1.8, 3.3, 5.7, 19.0}, {3.2, 4.7, 8.2, 13.9, 45.0}}},
    {"lugre", {{2, 4, 7, 10, 16}, {2, 5, 9, 12, 18}, {1.3, 1.8, 3.3, 5.7, 19.4}, {3.2, 4.4, 8.0, 13.8, 45.4}}}};
// How fast a glitch of the model decays, s.
const std::map<std::string, double> decay{
    {"classical", 0.006}, {"linear_ramp", 0.018}, {"parabolic", 0.012}, {"lugre", 0.009}, {"coulomb_viscous", 0.006}};

double at(const Row& row, double feed) {
  const auto above = std::lower_bound(feeds.begin(), feeds.end(), feed - 1e-9);
  if (above == feeds.end()) return row.back();
  return row[static_cast<std::size_t>(above - feeds.begin())];
}

const Heights& heights_of(const std::string& friction) {
  const auto found = published_rows.find(friction);
  return found == published_rows.end() ? published_rows.at("classical") : found->second;
}

// A glitch that starts at a reversal and has its peak of 1 at `tau`.
double glitch(double time, double tau) { return time < 0.0 ? 0.0 : time / tau * std::exp(1.0 - time / tau); }

// Time since the axis last reversed, both axes reversing every half turn.
double since(double travelled, double period) { return travelled - period * std::floor(travelled / period); }

sim::AxisLap make_axis(const std::string& name, std::size_t index, const std::string& friction,
                       const sim::CircleRun& run, std::mt19937& random) {
  const auto& rows = heights_of(friction);
  const double feed = run.feed * 60.0;
  const double error = 0.97 * 1e-6 * at(index ? rows.y_error : rows.x_error, feed);
  const double current = 0.98 * at(index ? rows.y_current : rows.x_current, feed);
  const double rate = run.feed / run.radius;
  const double half_turn = std::numbers::pi / rate;
  std::normal_distribution<double> noise(0.0, 0.04e-6);
  sim::AxisLap lap;
  lap.axis = name;
  for (const double angle : run.angle) {
    const double phase = index ? angle - std::numbers::pi / 2.0 : angle;
    const double travelled = (run.direction == sim::Direction::clockwise ? -phase : phase) / rate;
    const double time = since(travelled, half_turn);
    const bool outward = std::sin(phase) > 0.0;  // speed -sin(phase) for counter-clockwise
    const double sign = (outward ? 1.0 : -1.0) * (run.direction == sim::Direction::clockwise ? -1.0 : 1.0);
    const double slow = 0.05e-6 * std::cos(phase) * feed / 16.0;
    lap.error.push_back(-sign * error * glitch(time, decay.at(friction)) + slow + noise(random));
    const double friction_part = std::min(1.0, 0.25 * current / 1.2);
    lap.current.push_back((current - friction_part) * -std::cos(phase) -
                          sign * friction_part * (1.0 - 2.0 * std::exp(-time / 0.008)) + 1e5 * noise(random));
  }
  const auto peak = [](const std::vector<double>& channel) {
    double largest = 0.0;
    for (const double value : channel) largest = std::max(largest, std::abs(value));
    return largest;
  };
  lap.peak_error = peak(lap.error);
  lap.peak_error_quantised = 1e-6 * std::round(lap.peak_error * 1e6);
  lap.peak_current = peak(lap.current);
  return lap;
}

sim::CircleRun make_run(const std::string& friction, double feed, sim::Direction direction, std::mt19937& random) {
  sim::CircleRun run;
  run.friction = friction;
  run.feed = feed / 60.0;
  run.radius = 0.09;
  run.direction = direction;
  run.sample_period = 62.5e-6;
  const auto samples = static_cast<std::size_t>(2.0 * std::numbers::pi * run.radius / run.feed / run.sample_period);
  const double step = (direction == sim::Direction::clockwise ? -1.0 : 1.0) * run.feed / run.radius * run.sample_period;
  for (std::size_t i = 0; i < samples; ++i)
    run.angle.push_back(
        std::remainder(0.25 * std::numbers::pi + step * static_cast<double>(i), 2.0 * std::numbers::pi));
  run.axes = {make_axis("X", 0, friction, run, random), make_axis("Y", 1, friction, run, random)};
  for (std::size_t i = 0; i < samples; ++i)
    run.radial_deviation.push_back(-run.axes[0].error[i] * std::cos(run.angle[i]) -
                                   run.axes[1].error[i] * std::sin(run.angle[i]));
  const auto [low, high] = std::minmax_element(run.radial_deviation.begin(), run.radial_deviation.end());
  run.errors = {*high - *low, *high, *low, {0.1e-6, -0.05e-6}};
  return run;
}

machine::AxisModel make_machine_axis(const std::string& name) {
  const bool y = name == "Y";
  machine::AxisModel axis;
  axis.name = name;
  axis.mass = y ? 520 : 225;
  axis.travel = y ? 0.4 : 0.5;
  axis.max_velocity = 80.0 / 60.0;
  axis.max_acceleration = 20.0;
  axis.motor = {machine::MotorModel::synchronous, false, 1.8, 18e-3, 1.8e-3, 62.8, 62.8, 94.0, 0.072, y ? 2 : 1};
  axis.inverter = {125e-6, 600.0, 70.0};
  axis.encoder.increment = 1e-9;
  axis.encoder.mount = machine::EncoderMountParameters{0.5, 2000.0, 0.05};
  axis.position_controller = {83.3333, 1e-6};
  axis.velocity_controller = {y ? 1200.0 : 600.0, y ? 4.4e-3 : 5e-3};
  axis.current_controller = machine::CurrentControllerParameters{y ? 17.0 : 35.0, 2e-3};
  axis.notch = machine::NotchParameters{2000.0, 0.05, 0.7};
  axis.feedforward = {1.0, 1.0};
  const double coulomb = y ? 220 : 90, viscous = y ? 1250 : 500;
  auto& friction = axis.friction;
  friction.use = "lugre";
  sim::set_parameters<sim::CoulombViscous<>>(friction, {coulomb, viscous});
  sim::set_parameters<sim::Classical<>>(friction, {coulomb, 1.0, viscous});
  sim::set_parameters<sim::LinearRamp<>>(friction, {coulomb, y ? 29000.0 : 12000.0, viscous});
  sim::set_parameters<sim::Parabolic<>>(friction, {y ? 800.0 : 300.0, 3.0});
  sim::set_parameters<sim::LuGre<>>(friction, {coulomb, 1.0, viscous, 1e-3, y ? 2e6 : 8e5, 0.1});
  return axis;
}

void add_references(machine::Machine& machine, const Heights& rows, std::optional<std::string> friction) {
  for (std::size_t i = 0; i < feeds.size(); ++i) {
    const double feed = feeds[i] / 60.0;
    machine.circle_references.push_back({"X", !friction, friction, feed, rows.x_error[i] * 1e-6, rows.x_current[i]});
    machine.circle_references.push_back({"Y", !friction, friction, feed, rows.y_error[i] * 1e-6, rows.y_current[i]});
  }
}

}  // namespace

CircleReport synthetic_circle(const SyntheticCircle& options) {
  CircleReport report;
  report.title = "Circle: MCFV 5050 LN cross table";
  report.command = "stiction simulate circle --machine mcfv5050ln --friction all --out report";
  report.version = "0.1.0";
  report.machine.name = "MCFV 5050 LN cross table";
  report.machine.id = "mcfv5050ln";
  report.machine.axes = {make_machine_axis("X"), make_machine_axis("Y")};
  if (options.measured) add_references(report.machine, measured_rows, std::nullopt);
  if (options.published)
    for (const auto& [friction, rows] : published_rows) add_references(report.machine, rows, friction);
  report.result.signals = "fixed";
  std::mt19937 random(20240607);
  for (const char* friction : {"coulomb_viscous", "classical", "linear_ramp", "parabolic", "lugre"})
    for (const double feed : options.feeds_m_per_min)
      for (const auto direction : options.directions) {
        auto run = make_run(friction, feed, direction, random);
        if (options.directions.size() > 1) run.both_directions = {run.errors.circular_error * 1.1, -0.2e-6};
        report.result.runs.push_back(std::move(run));
      }
  return report;
}

}  // namespace stiction::host
