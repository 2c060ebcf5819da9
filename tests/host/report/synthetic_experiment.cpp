// Experiments as the simulation might leave them: see synthetic_experiment.hpp.
#include "tests/host/report/synthetic_experiment.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/host/report/synthetic_circle.hpp"

namespace stiction::host {
namespace {

constexpr double sample_ms = 0.0625;
constexpr double step_ms = 10.0;

// What the published test says of a model: um, ms, N.
struct Response {
  const char* friction;
  double peak, back, rest;
};
constexpr std::array responses{Response{"classical", 92.4, 71.1, 113.2}, Response{"linear_ramp", 93.6, 60.9, 0.0},
                               Response{"parabolic", 96.2, 61.3, 0.0}, Response{"lugre", 92.8, 70.8, 112.7}};

// 0 before the step; then up to 1 after 8 ms, and down to 1/93 when `back` has passed.
double pulse(double after_step, double back) {
  if (after_step <= 0.0) return 0.0;
  const double rise = after_step / 8.0, shape = rise * std::exp(1.0 - rise);
  const double tail = std::exp(-(after_step - 8.0) * std::log(93.0) / (back - 8.0));
  return after_step < 8.0 ? shape : std::min(1.0, tail) * (1.0 - 0.12 * std::sin(0.11 * (after_step - 8.0)));
}

sim::Expectation prototype(double value, double tolerance) {
  return {value, tolerance, "prototype (docs/prototype_figures.md, 3)"};
}

void add_response(sim::ExperimentResult& result, const Response& r, std::mt19937& random) {
  std::normal_distribution<double> noise;
  sim::Series deviation{r.friction, {}, {}, false};
  deviation.friction = r.friction;
  auto force = deviation, friction = deviation;
  for (double t = 0.0; t < 200.0; t += sample_ms) {
    const double p = pulse(t - step_ms, r.back), settled = t > step_ms ? 1.0 - std::exp(-(t - step_ms) / 6.0) : 0.0;
    deviation.x.push_back(t);
    deviation.y.push_back(r.peak * p + 0.02 * noise(random));
    force.x.push_back(t);
    force.y.push_back(-1500.0 * settled - 420.0 * p + r.rest * settled + 2.0 * noise(random));
    friction.x.push_back(t);
    friction.y.push_back(t < step_ms ? 0.0 : -(r.rest + (120.0 - r.rest) * std::exp(-(t - step_ms) / 25.0)));
  }
  const std::string name = r.friction, of = ", " + name;
  result.figures.push_back({"peak_deviation_" + name, "um", "peak deviation" + of, r.peak, prototype(93.0, 1.9)});
  result.figures.push_back(
      {"return_time_" + name, "ms", "back within 1 um after" + of, r.back, prototype(r.rest > 0.0 ? 71.0 : 61.0, 1.5)});
  result.figures.push_back({"resting_friction_" + name, "N", "friction left at rest" + of, r.rest,
                            prototype(r.rest > 0.0 ? 113.0 : 0.0, r.rest > 0.0 ? 2.3 : 1.0)});
  result.charts[0].series.push_back(std::move(deviation));
  result.charts[1].series.push_back(std::move(force));
  result.charts[2].series.push_back(std::move(friction));
}

}  // namespace

ExperimentReport synthetic_experiment() {
  ExperimentReport report{"stiction simulate impact --machine mcfv5050ln --friction all --out report",
                          "0.1.0",
                          synthetic_circle({.feeds_m_per_min = {48.0}}).machine,
                          {}};
  auto& result = report.result;
  result.experiment = "impact";
  result.title = "Impact compliance";
  result.signals = "fixed";
  result.question =
      "A step of 1500 N on the X axis in position control: a peak deviation of about 80 um, back in about 70 ms, with "
      "every friction model; afterwards A and C stay wound up a few newtons under the Coulomb friction, B1 and B2 "
      "relax "
      "to zero (Mendricky 2006, 6.2).";
  result.findings = {
      "With the file's velocity gain, 56400 N s/m, the peak is 92.4 um. The source's \"about 80 um\" needs about 65 "
      "000 "
      "N s/m: which gain its figure was made with is unresolved.",
      "lugre: 112.7 N of friction are left at rest, +-0.1 N over the last 50 ms."};
  result.charts = {
      {"Deviation", "time, ms", "deviation at the encoder, um", "External force of 1500 N from 10 ms on.", false, {}},
      {"Motor force", "time, ms", "motor force, N", "At rest motor and friction share the 1500 N.", false, {}},
      {"Friction", "time, ms", "friction force, N", "", false, {}}};
  std::mt19937 random(20240607);
  for (const auto& response : responses) add_response(result, response, random);
  result.figures.push_back({"peak_deviation_at_80000_N_s_per_m", "um",
                            "peak deviation with a velocity gain of 80000 N s/m, lugre", 62.9,
                            sim::Expectation{62.5, 1.3, "prototype: 62 to 63 um"}});
  result.figures.push_back({"settling_speed", "m/min", "largest speed of the axis", 0.8142, {}});
  return report;
}

ExperimentReport synthetic_friction_bench() {
  ExperimentReport report{
      "stiction simulate presliding", "0.1.0", synthetic_circle({.feeds_m_per_min = {48.0}}).machine, {}};
  auto& result = report.result;
  result.experiment = "presliding";
  result.title = "Presliding displacement";
  result.question = "Unloading does not bring the mass back to the origin.";
  sim::Chart loop{"Friction over displacement", "displacement, um", "friction force, N", "Ramps of 54 N/s.", false, {}};
  sim::Chart rates{"Break-away force", "rate, N/s", "break-away force, N", "", true, {}};
  sim::Chart lag{"Frictional lag", "speed, mm/s", "friction force, N", "Speed 2.5 + 2.4 sin(wt) mm/s.", false, {}};
  for (const char* name : {"lugre", "lugre, 5400 N/s"}) {
    const double width = std::string_view(name) == "lugre" ? 4.0 : 6.5;
    sim::Series line{name, {}, {}, false};
    line.friction = "lugre";
    for (int i = 0; i < 9000; ++i) {
      const double phase = 2.0 * std::numbers::pi * i / 9000.0;
      line.x.push_back(14.0 * std::sin(phase) + width * std::cos(phase));
      line.y.push_back(540.0 * std::sin(phase));
    }
    loop.series.push_back(std::move(line));
  }
  sim::Series simulated{"lugre", {}, {}, false}, measured{"measured", {}, {}, true};
  simulated.friction = "lugre";
  measured.role = sim::SeriesRole::measured;
  for (const double rate : {10.0, 30.0, 100.0, 300.0, 1e3, 2e3, 3e3, 5e3, 1e4, 3e4, 1e5}) {
    simulated.x.push_back(rate);
    simulated.y.push_back(400.0 + 180.0 / (1.0 + std::pow(rate / 3000.0, 1.5)));
    measured.x.push_back(rate);
    measured.y.push_back(simulated.y.back() * 1.03);
  }
  rates.series = {simulated, measured};
  for (const double omega : {1.0, 10.0, 25.0, 100.0}) {
    sim::Series line{fmt::format("{:g} rad/s", omega), {}, {}, false};
    for (int i = 0; i < 2000; ++i) {
      const double phase = 2.0 * std::numbers::pi * i / 2000.0;
      line.x.push_back(2.5 + 2.4 * std::sin(phase));
      line.y.push_back(400.0 + 150.0 / (1.0 + line.x.back()) + 8.0 * std::sqrt(omega) * std::cos(phase));
    }
    lag.series.push_back(std::move(line));
    result.figures.push_back({fmt::format("width_at_{:g}_rad_per_s", omega),
                              "N",
                              fmt::format("width of the loop at {:g} rad/s", omega),
                              16.0 * std::sqrt(omega),
                              {}});
  }
  result.charts = {std::move(loop), std::move(rates), std::move(lag)};
  return report;
}

}  // namespace stiction::host
