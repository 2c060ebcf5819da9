#include "tests/host/diagnose/cam_ambiguity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "host/diagnose/diagnose.hpp"
#include "host/simulate/cam_run.hpp"
#include "sim/cam/motion_file.hpp"
#include "sim/machine_file.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::cam_ambiguity {
namespace {

constexpr std::array table{
    Kind{"lag or mass", "friction_lag", "mass_mismatch"},
    Kind{"mass or lag", "mass_mismatch", "friction_lag"},
    Kind{"viscous or place", "viscous_mismatch", "position_dependent_friction"},
};

constexpr double turn_per_minute = 2.0 * std::numbers::pi / 60.0, degree = std::numbers::pi / 180.0;

// As the demonstration has it, with a motor that is known.
machine::Machine slave() {
  return sim::read_machine(
      std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml",
      {{}, {"axis.X.encoder.velocity=estimated", "axis.X.encoder.noise=2 nm", "axis.X.motor.force_constant=94.2 N/A"}});
}

struct Draws {
  std::mt19937_64 engine;

  double between(double low, double high) { return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53; }
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(engine() % n); }
};

machine::Effect hidden_effect(const Kind& kind, const machine::AxisModel& axis, Draws& draws) {
  const std::string name = kind.hidden;
  if (name == "friction_lag") return {name, {{"time", {draws.between(2e-3, 6e-3)}}}};
  const double sign = draws.below(2) == 0 ? 1.0 : -1.0;
  if (name == "mass_mismatch") return {name, {{"mass", {axis.mass * (1.0 - draws.between(10e-3, 30e-3))}}}};
  return {name, {{"viscous", {500.0 * (1.0 + sign * draws.between(0.04, 0.15))}}}};
}

sim::cam::Segment segment(double length, double stroke, const char* law) {
  sim::cam::Segment made;
  made.length = length * degree;
  made.stroke = stroke;
  if (stroke != 0.0) made.law = law;
  return made;
}

// Out and back with a rest at both ends.
sim::cam::Motion first_cam(Draws& draws) {
  constexpr std::array laws{"modified_sine", "sloping_sine", "polynomial_3_4_5", "modified_trapezoid"};
  const char* law = laws[draws.below(laws.size())];
  const double rise = std::round(draws.between(100.0, 160.0)), stroke = 1e-3 * std::round(draws.between(40.0, 90.0));
  sim::cam::Cam cam;
  cam.name = "first";
  cam.slave = sim::cam::Coordinate::linear;
  cam.segments = {segment(180.0 - rise, 0.0, law), segment(rise, stroke, law), segment(180.0 - rise, 0.0, law),
                  segment(rise, -stroke, law)};
  return sim::cam::compose(cam);
}

// A sample a millisecond, from a tick of the position controller on.
host::Log recorded(const machine::Machine& real, const sim::cam::Motion& motion, double master_speed, int cycles,
                   const char* name) {
  host::CamRunSettings settings;
  settings.master_speed = master_speed;
  settings.cycles = cycles;
  auto log = host::run_cam<FixedSignals>(real, motion, settings).log;
  log.source = name;
  const double slow = real.timing.slow_period;
  const auto every = static_cast<std::size_t>(std::llround(slow / log.period));
  std::size_t first = 0;
  while (std::abs(log.t[first] / slow - std::round(log.t[first] / slow)) > 1e-6) ++first;
  const auto thin = [&](std::vector<double>& values) {
    std::size_t kept = 0;
    for (std::size_t k = first; k < values.size(); k += every) values[kept++] = values[k];
    values.resize(kept);
  };
  thin(log.t);
  for (auto& axis : log.axes)
    for (const auto& channel : host::log_channels) thin(axis.*channel.values);
  log.period = slow;
  return log;
}

std::string found_in(const host::Verdict& verdict) {
  std::string all;
  for (const auto& finding : verdict.findings) {
    all += (all.empty() ? "" : ", ") + finding.effect.name();
    for (const auto& other : finding.confused_with)
      all += fmt::format(" or {} ({:.2f})", other.effect.name(), other.probability);
  }
  return all.empty() ? "nothing" : all;
}

bool says(const host::Verdict& verdict, const std::string& one, const std::string& other) {
  return std::ranges::any_of(verdict.findings, [&](const host::Finding& finding) {
    return std::ranges::any_of(finding.confused_with, [&](const auto& with) {
      return (finding.effect.name() == one && with.effect.name() == other) ||
             (finding.effect.name() == other && with.effect.name() == one);
    });
  });
}

bool names(const host::Verdict& verdict, const std::string& effect) {
  return std::ranges::any_of(verdict.findings, [&](const auto& finding) { return finding.effect.name() == effect; });
}

// Of the question between the two, by its place among the verdict's.
std::optional<std::size_t> question_of(const host::NextMeasurement& next, const Kind& kind) {
  for (std::size_t k = 0; k < next.questions.size(); ++k) {
    const auto& q = next.questions[k];
    if (!q.rival) continue;
    const auto one = q.effect.name(), other = q.rival->name();
    if ((one == kind.hidden && other == kind.rival) || (one == kind.rival && other == kind.hidden)) return k;
  }
  return std::nullopt;
}

// As a user gets it: a motion file, and a speed on a command line.
sim::cam::Motion from_file(const sim::cam::Cam& cam) {
  return sim::cam::compose(sim::cam::parse_motion_file("next.toml", sim::cam::motion_text({cam})).front());
}

}  // namespace

std::span<const Kind> kinds() { return table; }

Outcome run(const Kind& kind, std::uint64_t seed) {
  Draws draws{std::mt19937_64(seed)};
  host::DiagnoseInput input;
  input.machine = slave();
  input.closed_loop = false;
  auto real = input.machine;
  real.axes.front().effects = {hidden_effect(kind, input.machine.axes.front(), draws)};
  const auto first = first_cam(draws);
  const double speed = draws.between(15.0, 40.0);
  input.logs = {recorded(real, first, speed * turn_per_minute, 4, "first")};
  input.held_out = {recorded(real, first, 0.8 * speed * turn_per_minute, 2, "held out")};
  const auto before = host::diagnose(input);
  Outcome outcome;
  const auto& effect = real.axes.front().effects.front();
  outcome.text =
      fmt::format("{} {:.4g} hidden, {} over {:.0f} deg and {:.0f} mm at {:.1f} rpm: {}", effect.name,
                  effect.values.begin()->second.front(), first.cam.segments[1].law,
                  first.cam.segments[1].length / degree, 1e3 * first.cam.segments[1].stroke, speed, found_in(before));
  outcome.ambiguous = says(before, kind.hidden, kind.rival);
  if (!outcome.ambiguous || !before.next || !before.next->cam) return outcome;
  const auto question = question_of(*before.next, kind);
  if (!question) return outcome;
  const auto& best = before.next->trajectories.front();
  outcome.proposed = true;
  outcome.expected = best.separations[*question];
  outcome.before = before.next->questions[*question].these_logs;
  const auto& cam = *before.next->cam;
  input.logs.push_back(recorded(real, from_file(cam.cam), cam.master_speed, cam.cycles, "proposed"));
  const auto after = host::diagnose(input);
  outcome.settled = names(after, kind.hidden) && !names(after, kind.rival) && !says(after, kind.hidden, kind.rival);
  outcome.text +=
      fmt::format("; {} proposed, {:.1f} standard errors expected (present logs {:.1f}), share {:.3f}; with it: {}",
                  best.name, outcome.expected, outcome.before, best.shares[*question], found_in(after));
  return outcome;
}

}  // namespace stiction::cam_ambiguity
