#include "tests/host/report/synthetic_diagnosis.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include "tests/host/report/synthetic_circle.hpp"

namespace stiction::host {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double pitch = 72.0;  // mm

double ripple(double x) { return 3.1 * std::cos(2.0 * pi * x / pitch) + 0.4 * std::sin(2.0 * pi * x / pitch); }

sim::Series simulated_before() {
  sim::Series series{"before", {}, {}};
  series.role = sim::SeriesRole::before;
  return series;
}
sim::Series simulated_after() {
  sim::Series series{"after", {}, {}};
  series.role = sim::SeriesRole::after;
  return series;
}

sim::Chart over_time() {
  std::mt19937 random(1);
  std::normal_distribution<double> noise;
  sim::Series measured{"measured", {}, {}}, before = simulated_before(), after = simulated_after();
  measured.role = sim::SeriesRole::measured;
  for (double t = 0.0; t < 3.0; t += 1e-3) {
    const double glitch = 6.0 * std::exp(-std::fmod(t, 0.75) / 0.03) * (std::fmod(t, 1.5) < 0.75 ? 1.0 : -1.0);
    const double wave = 0.5 * std::sin(4.0 * pi * t);
    for (auto* each : {&measured, &before, &after}) each->x.push_back(t);
    measured.y.push_back(glitch + wave + 0.05 * noise(random));
    before.y.push_back(0.8 * glitch);
    after.y.push_back(glitch + 0.9 * wave);
  }
  return {.title = "Position error",
          .x_label = "time, s",
          .y_label = "position error, µm",
          .caption = "Held-out log: what was measured, what the machine file gives, what the extended one gives.",
          .series = {measured, before, after}};
}

// The residual against the position, before and after.
sim::Chart over_position() {
  std::mt19937 random(2);
  std::normal_distribution<double> noise;
  sim::Series before = simulated_before(), after = simulated_after();
  before.points = after.points = true;
  for (int k = 0; k < 1500; ++k) {
    const double x = -100.0 + 200.0 * k / 1500.0;
    before.x.push_back(x), after.x.push_back(x);
    before.y.push_back(ripple(x) + 0.7 * noise(random));
    after.y.push_back(0.7 * noise(random));
  }
  return {.title = "Residual force over position",
          .x_label = "position, mm",
          .y_label = "residual force, N",
          .caption = "",
          .series = {before, after}};
}

sim::Chart spectrum() {
  sim::Series before = simulated_before(), after = simulated_after();
  for (double f = 0.5; f < 100.0; f *= 1.05) {
    before.x.push_back(f), after.x.push_back(f);
    after.y.push_back(0.8 / (1.0 + f / 20.0));
    before.y.push_back(after.y.back() + 3.0 * std::exp(-std::pow(std::log(f / 3.7) / 0.2, 2)));
  }
  return {.title = "Spectrum of the residual force",
          .x_label = "frequency, Hz",
          .y_label = "residual force, N/√Hz",
          .caption = "",
          .logarithmic_x = true,
          .series = {before, after}};
}

sim::Chart fitted() {
  sim::Series means{"residual, mean of 2 mm", {}, {}, true}, fit{"fitted ripple", {}, {}};
  for (double x = -100.0; x <= 100.0; x += 2.0) {
    means.x.push_back(x), fit.x.push_back(x);
    fit.y.push_back(ripple(x));
    means.y.push_back(ripple(x) + 0.2 * std::sin(x));
  }
  return {.title = "Residual force along the stroke",
          .x_label = "position, mm",
          .y_label = "force, N",
          .caption = "Equal both ways, and it does not grow with the current.",
          .series = {means, fit}};
}

// One question that a motion answers, one that none does.
NextMeasurement next_measurement() {
  NextMeasurement next;
  next.axis = "X";
  const auto effect = [](const char* name) { return *sim::find_effect(name); };
  next.questions = {{effect("force_ripple"), effect("position_dependent_friction"),
                     "traverse the same stretch in both directions", true, 0.7},
                    {effect("constant_force"), effect("friction_asymmetry"),
                     "the axis turned over, a different payload, or a reading at standstill", false, 0.0}};
  next.trajectories = {{"slow sweep", "the stroke both ways, slowly and at twice the speed", 25.0, {14.2, 0.0}},
                       {"constant speeds", "ten constant speeds", 12.3, {6.1, 0.0}}};
  next.log.emplace();
  next.note = "It begins at rest at 0.000 mm.";
  sim::Series way{"proposed", {}, {}};
  for (double t = 0.0; t < 25.0; t += 0.05) way.x.push_back(t), way.y.push_back(100.0 - std::abs(8.0 * t - 100.0));
  next.charts = {{.title = "Proposed: slow sweep",
                  .x_label = "time of the proposed record, s",
                  .y_label = "set position, mm",
                  .caption = "",
                  .series = {way}}};
  return next;
}

DiagnosisReport frame() {
  return {"stiction diagnose run1.csv run2.csv --machine mcfv5050ln --holdout run3.csv --out diagnosis",
          "0.1.0",
          synthetic_circle().machine,
          {}};
}

}  // namespace

DiagnosisReport synthetic_diagnosis() {
  auto report = frame();
  auto& v = report.verdict;
  v.machine = "mcfv5050ln.toml";
  v.logs = {"logs/run1.csv", "logs/run2.csv"};
  v.holdout = {"logs/run3.csv"};
  v.baseline = {3.42, 0.61e-6, {}};
  v.extended = {1.18, 0.22e-6, {}};
  const auto effect = [](const char* name) { return *sim::find_effect(name); };
  Finding cogging(effect("force_ripple"));
  cogging.axis = "X";
  cogging.values = {{"pitch", {0.072}}, {"cosine", {3.1}}, {"sine", {0.4}}};
  cogging.parameters = {{"pitch", "m", false, {0.07201}, {1e-5}},
                        {"cosine", "N", true, {3.1, 0.21}, {0.08, 0.07}},
                        {"sine", "N", true, {0.4, -0.02}, {0.08, 0.07}}};
  cogging.explains = 0.63;
  cogging.holdout = {0.41, 0.44, {}, {}, {0.38, 0.45}};
  cogging.p_value = 1e-9;
  cogging.probability = 0.93;
  cogging.without_each_log = NamedIn{2, 3};
  cogging.confused_with = {{effect("position_dependent_friction"), "traverse the same stretch in both directions"}};
  cogging.evidence = "The residual repeats every 72.0 mm with 3.1 N, in both directions and at all six speeds.";
  cogging.part_error = 0.31e-6;
  cogging.charts = {fitted(), spectrum()};
  Finding constant(effect("constant_force"));
  constant.axis = "X";
  constant.values = {{"force", {-1.4}}};
  constant.parameters = {{"force", "N", false, {-1.4}, {}}};
  constant.explains = 0.08;
  constant.holdout = {0.95, {}, {}, {}, {0.93, 0.98}};
  constant.p_value = 1e-14;
  constant.confused_with = {
      {effect("friction_asymmetry"), "the axis turned over, a different payload, or a reading at standstill"}};
  constant.evidence = "The residual's mean is -1.4 N in every block.";
  v.findings = {cogging, constant};
  v.rejected = {{effect("backlash"), "no gain on held-out data (-0.2 %)"}, {effect("stribeck"), "p 0.21 over blocks"}};
  v.unexplained = {0.04, "grows with acceleration"};
  v.notes = {"Record small reversals of 5 to 200 um: presliding cannot be judged without them."};
  v.before_after = {over_time(), over_position(), spectrum()};
  v.next = next_measurement();
  return report;
}

DiagnosisReport synthetic_cam_proposal() {
  auto report = synthetic_diagnosis();
  auto& next = *report.verdict.next;
  next.trajectories = {
      {"modified_sine, rise of 72 deg, 39 rpm", "nearly constant speed over most of the rise", 7.7, {14.2, 0.0}}};
  ProposedCam cam;
  cam.turns = 39.0;
  cam.speed = "39 rpm";
  cam.cycles = 5;
  cam.spectrum = "At 39 rpm one order of the master is 0.65 Hz.";
  next.cam = cam;
  sim::Series lines{"acceleration of the lift", {}, {}};
  for (double order = 1.0; order < 30.0; order += 1.0) lines.x.push_back(order), lines.y.push_back(100.0 / order);
  next.charts.push_back({.title = "Spectrum of the proposed lift and of both candidates",
                         .x_label = "order of the master, 0.65 Hz each",
                         .y_label = "amplitude, % of the largest line",
                         .caption = "The separating part is what neither candidate imitates.",
                         .series = {lines}});
  return report;
}

DiagnosisReport synthetic_agreement() {
  auto report = frame();
  auto& v = report.verdict;
  v.machine = "mcfv5050ln.toml";
  v.logs = {"run1.csv"};
  v.holdout_is_a_part = true;
  v.baseline = v.extended = {1.2, 0.3e-6, {}};
  v.noise_floor = NoiseFloor{.encoder = 0.9, .effort = 0.6, .position = 0.2e-6, .increment = 1e-6};
  v.agreement = agreement_of({1.2, 0.3e-6, 1.08, 0.2e-6, 50.0}, "", {});
  return report;
}

}  // namespace stiction::host
