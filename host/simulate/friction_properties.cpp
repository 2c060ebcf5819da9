// What a dynamic friction model must show (Mendricky 2006, 4.4.3, Tab 4.3): presliding, frictional lag, break-away
// force that falls with the rate of the force, stick-slip.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/simulate/bench_recorder.hpp"
#include "host/simulate/experiments.hpp"
#include "sim/plant/friction/lugre.hpp"
#include "sim/plant/friction/parameters.hpp"

namespace stiction::host {
namespace {

machine::AxisModel axis_with(const ExperimentInput& input, const std::string& friction) {
  auto axis = input.machine.axes.front();
  axis.friction.use = friction;
  return axis;
}

sim::LuGreParameters lugre_of(const machine::AxisModel& axis) {
  return sim::parameters_of<sim::LuGre<>>(axis.friction);
}

double static_friction(const sim::LuGreParameters& friction) { return friction.coulomb * friction.static_ratio; }

// Keeps every `stride`-th point.
class Thinned {
 public:
  Thinned(sim::Series& series, int stride) : series_(series), stride_(stride) {}
  void add(double x, double y) {
    if (count_++ % stride_ != 0) return;
    series_.x.push_back(x);
    series_.y.push_back(y);
  }

 private:
  sim::Series& series_;
  int stride_;
  int count_ = 0;
};

// Force over time from corners (s, N), linear between them.
double polyline(const std::vector<std::pair<double, double>>& corners, double t) {
  for (std::size_t i = 1; i < corners.size(); ++i)
    if (t <= corners[i].first) {
      const auto& [t0, f0] = corners[i - 1];
      const auto& [t1, f1] = corners[i];
      return f0 + (f1 - f0) * (t - t0) / (t1 - t0);
    }
  return corners.back().second;
}

constexpr double ramp_share = 0.9;         // of the static friction: the top of a ramp
constexpr double slow = 0.1, fast = 10.0;  // 1/s, ramps of that many tops in a second

struct PreslidingLoop {
  double at_first_top, at_second_top, after_unloading;  // m
};

// 0 to +`top_force` (N), held, to the same in the other direction, held, and back, held, at `rate` (N/s).
PreslidingLoop presliding_loop(const machine::AxisModel& axis, double top_force, double rate, double hold,
                               sim::Series& series, BenchRecorder* recorder = nullptr) {
  const double ramp = top_force / rate;
  const double top = ramp + hold, bottom = top + 2.0 * ramp, up = bottom + hold, end = up + 2.0 * ramp + hold;
  const std::vector<std::pair<double, double>> corners{{0.0, 0.0},           {ramp, top_force}, {top, top_force},
                                                       {bottom, -top_force}, {up, -top_force},  {end - hold, top_force},
                                                       {end, top_force}};
  FrictionBench bench(axis);
  PreslidingLoop loop{};
  Thinned line(series, std::max(1, static_cast<int>(end / FrictionBench::step / 4000.0)));
  while (bench.time() < end) {
    const double force = polyline(corners, bench.time());
    bench.advance(force);
    if (recorder != nullptr) recorder->add(bench, force);
    line.add(bench.position() * 1e6, bench.friction_force());
    if (bench.time() <= top) loop.at_first_top = bench.position();
    if (bench.time() <= top + ramp) loop.after_unloading = bench.position();
    if (std::abs(bench.position()) > 0.01) break;  // it slides
  }
  loop.at_second_top = bench.position();
  return loop;
}

}  // namespace

sim::ExperimentResult run_presliding(const ExperimentInput& input) {
  const double force = ramp_share * static_friction(lugre_of(input.machine.axes.front()));
  sim::ExperimentResult result{
      "presliding",
      "Presliding displacement",
      "",
      fmt::format("A force below break-away (ramps to +-{:g} N, 90 % of the static friction) moves the mass by "
                  "micrometres, and unloading does not bring it back to the origin (Mendricky 2006, 4.4.3.1).",
                  force),
      {},
      {},
      {}};
  sim::Chart chart{"Friction over displacement",
                   "displacement, um",
                   "friction force, N",
                   fmt::format("Ramps of {:g} N/s.", slow * force),
                   false,
                   {}};
  for (const auto& name : input.friction) {
    sim::Series line{name, {}, {}, false};
    line.friction = name;
    BenchRecorder recorder;
    const auto loop =
        presliding_loop(axis_with(input, name), force, slow * force, 2.0, line, input.keep_log ? &recorder : nullptr);
    if (input.keep_log) input.keep_log("", recorder.take());
    chart.series.push_back(std::move(line));
    const auto add = [&](const std::string& figure, const std::string& text, double metres) {
      result.figures.push_back(
          sim::of_model({figure + "_" + name, "um", fmt::format("{}, {}", text, name), metres * 1e6, {}}, name));
    };
    add(fmt::format("displacement_at_{:g}_N", force), fmt::format("displacement at {:g} N", force), loop.at_first_top);
    add("displacement_after_unloading", "displacement left at 0 N", loop.after_unloading);
    add("loop_gap", fmt::format("between the two visits of +{:g} N", force), loop.at_second_top - loop.at_first_top);
    result.findings.push_back(fmt::format("{}: {:.1f} um at {:g} N, {:.1f} um left after unloading.", name,
                                          loop.at_first_top * 1e6, force, loop.after_unloading * 1e6));
    if (name != sim::LuGre<>::name) continue;
    sim::Series quick{fmt::format("{}, {:g} N/s", name, fast * force), {}, {}, false};
    quick.friction = name;
    const auto broken = presliding_loop(axis_with(input, name), force, fast * force, 2.0, quick);
    chart.series.push_back(std::move(quick));
    const bool breaks_away = std::abs(broken.at_second_top) > 1e-3;
    chart.caption += fmt::format(" At {:g} N/s the mass {} while {:g} N is held{}.", fast * force,
                                 breaks_away ? "breaks away" : "does not break away", force,
                                 breaks_away ? ", and leaves the range of the chart" : "");
    const double shown = 1.5e6 * std::abs(loop.at_first_top);
    chart.x_range = {-0.5 * shown, shown};
    result.figures.push_back({fmt::format("breaks_away_at_{:g}_N_per_s", fast * force),
                              "",
                              fmt::format("1: the mass breaks away while {:g} N is held", force),
                              breaks_away ? 1.0 : 0.0,
                              {}});
  }
  result.charts.push_back(std::move(chart));
  return result;
}

sim::ExperimentResult run_friction_lag(const ExperimentInput& input) {
  sim::ExperimentResult result{"friction-lag",
                               "Frictional lag",
                               "",
                               "While sliding at varying speed the friction is lower for falling than for rising "
                               "speed; the loop widens with the "
                               "frequency (Mendricky 2006, 4.4.3.2).",
                               {},
                               {},
                               {}};
  const auto axis = axis_with(input, "lugre");
  const auto parameters = lugre_of(axis);
  // About the Stribeck velocity, where friction falls with the speed.
  const double middle = 2.5 * parameters.stribeck_velocity, swing = 2.4 * parameters.stribeck_velocity;
  sim::Chart chart{"Friction over speed",
                   "speed, mm/s",
                   "friction force, N",
                   fmt::format("Speed: {:g} + {:g} sin(wt) mm/s.", middle * 1e3, swing * 1e3),
                   false,
                   {}};
  double slow_width = 0.0;
  for (const double omega : {1.0, 10.0, 25.0, 100.0}) {
    // A whole number of steps a period, begun at the lowest speed: step i of the rise has the speed of step count - i
    // of the fall.
    const double period = 2.0 * std::numbers::pi / omega;
    const auto count = static_cast<std::size_t>(std::ceil(period / FrictionBench::step));
    const double step = period / static_cast<double>(count);
    sim::LuGre<> friction(parameters, {axis.mass, step});
    sim::Series series{fmt::format("{:g} rad/s", omega), {}, {}, false};
    Thinned line(series, std::max(1, static_cast<int>(count / 2000)));
    std::vector<double> force(count + 1);
    const int periods = std::max(2, static_cast<int>(std::ceil(1.0 / period))) + 1;  // the last one has settled
    for (int p = 0; p < periods; ++p)
      for (std::size_t i = 0; i <= count; ++i) {
        const double phase = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
        const double v = middle - swing * std::cos(phase);
        force[i] = friction.move_contact(v) + parameters.viscous * v;
        if (p + 1 == periods) line.add(v * 1e3, force[i]);
      }
    double widest = 0.0;
    for (std::size_t i = 0; i <= count / 2; ++i) widest = std::max(widest, force[i] - force[count - i]);
    if (omega == 1.0) slow_width = widest;
    result.figures.push_back({fmt::format("width_at_{:g}_rad_per_s", omega),
                              "N",
                              fmt::format("width of the loop at {:g} rad/s", omega),
                              widest,
                              {}});
    chart.series.push_back(std::move(series));
  }
  result.findings.push_back(
      fmt::format("The loop is {:.1f} N wide at 1 rad/s and {:.1f} N at 25 rad/s; beyond, the contact no longer "
                  "follows and it narrows.",
                  slow_width, result.figures[2].value));
  result.charts.push_back(std::move(chart));
  return result;
}

sim::ExperimentResult run_break_away(const ExperimentInput& input) {
  sim::ExperimentResult result{
      "break-away",
      "Break-away force",
      "",
      "The force at which the mass begins to slide falls with the rate of the force, from the static friction towards "
      "Coulomb friction (Mendricky 2006, 4.4.3.3).",
      {},
      {},
      {}};
  sim::Chart chart{"Break-away force over the rate of the force", "rate, N/s", "break-away force, N", "", true, {}};
  sim::Series series{"lugre", {}, {}, false};
  series.friction = series.name;
  const auto axis = axis_with(input, "lugre");
  // The friction force at its greatest within presliding: from there on the mass is faster than its contact. Tab 4.2
  // lets presliding reach 50 um. At slow rates the friction still grows a little beyond, as the bristles' approach to
  // their limit takes several of their deflections of 15 um.
  constexpr double presliding_range = 50e-6, sliding = 1e-3;  // m
  const auto break_away = [&](double rate, double range, BenchRecorder* recorder = nullptr) {
    FrictionBench bench(axis);
    double greatest = 0.0;
    while (bench.position() < range) {
      const double force = rate * bench.time();
      bench.advance(force);
      if (recorder != nullptr) recorder->add(bench, force);
      greatest = std::max(greatest, bench.friction_force());
    }
    return greatest;
  };
  for (const double rate : {10.0, 30.0, 100.0, 300.0, 1e3, 2e3, 3e3, 5e3, 1e4, 3e4, 1e5}) {
    BenchRecorder recorder(rate < 1e3 ? 50 : 1);
    series.x.push_back(rate);
    series.y.push_back(break_away(rate, presliding_range, input.keep_log ? &recorder : nullptr));
    if (input.keep_log) input.keep_log(fmt::format("{:g} N/s", rate), recorder.take());
  }
  for (const double rate : {10.0, 1e3, 3e3, 1e4})
    result.figures.push_back({fmt::format("break_away_at_{:g}_N_per_s", rate),
                              "N",
                              fmt::format("break-away force at {:g} N/s", rate),
                              break_away(rate, presliding_range),
                              {}});
  result.findings.push_back(fmt::format("From {:.0f} N at 10 N/s to {:.0f} N at 1e4 N/s.", result.figures.front().value,
                                        result.figures.back().value));
  const double beyond = break_away(10.0, sliding);
  result.figures.push_back(
      {"greatest_friction_at_10_N_per_s", "N", "largest friction at 10 N/s at any displacement", beyond, {}});
  result.findings.push_back(
      fmt::format("Break-away is counted within 50 um of presliding; at 10 N/s the friction reaches "
                  "{:.0f} N a little later.",
                  beyond));
  chart.series.push_back(std::move(series));
  result.charts.push_back(std::move(chart));
  return result;
}

sim::ExperimentResult run_stick_slip(const ExperimentInput& input) {
  sim::ExperimentResult result{
      "stick-slip",
      "Stick-slip",
      "",
      fmt::format("A mass of {:g} kg on a spring of 5000 N/m whose end is pulled at 0.1 m/s sticks until about its "
                  "static friction, slips, and repeats (Mendricky 2006, 4.4.3.4).",
                  input.machine.axes.front().mass),
      {},
      {},
      {}};
  constexpr double stiffness = 5000.0, pull = 0.1, duration = 10.0;  // N/m, m/s, s
  constexpr double slipping = 1e-3;                                  // m/s, the Stribeck velocity
  sim::Chart position{"Position", "time, s", "position, m", "", false, {}};
  sim::Chart force{"Friction force", "time, s", "friction force, N", "", false, {}};
  sim::Series spring_end{"spring end", {0.0, duration}, {0.0, pull * duration}, false};
  for (const auto& name : input.friction) {
    FrictionBench bench(axis_with(input, name));
    sim::Series x{name, {}, {}, false}, f{name, {}, {}, false};
    x.friction = f.friction = name;
    Thinned x_line(x, 200), f_line(f, 200);
    std::vector<double> starts, stops, start_positions, stop_positions;
    double first_force = 0.0;
    bool slips = false;
    BenchRecorder recorder;
    while (bench.time() < duration) {
      const double spring = stiffness * (pull * bench.time() - bench.position());
      bench.advance(spring);
      if (input.keep_log) recorder.add(bench, spring);
      x_line.add(bench.time(), bench.position());
      f_line.add(bench.time(), bench.friction_force());
      const bool moving = std::abs(bench.velocity()) > slipping;
      if (moving && !slips) {
        starts.push_back(bench.time());
        start_positions.push_back(bench.position());
        if (starts.size() == 1) first_force = spring;
      }
      if (!moving && slips) {
        stops.push_back(bench.time());
        stop_positions.push_back(bench.position());
      }
      slips = moving;
    }
    if (input.keep_log) input.keep_log("", recorder.take());
    position.series.push_back(std::move(x));
    force.series.push_back(std::move(f));
    if (starts.size() < 3 || stops.size() < 2) {
      result.findings.push_back(name + ": no repeated stick-slip.");
      continue;
    }
    const auto add = [&](const char* figure, const char* unit, const char* text, double value) {
      result.figures.push_back(
          sim::of_model({figure + ("_" + name), unit, fmt::format("{}, {}", text, name), value, {}}, name));
    };
    add("first_slip_time", "s", "first slip", starts[0]);
    add("first_slip_force", "N", "spring force at the first slip", first_force);
    add("first_stop_time", "s", "first stop", stops[0]);
    add("period", "s", "period", starts[2] - starts[1]);
    add("jump", "m", "jump", stop_positions[1] - start_positions[1]);
    result.findings.push_back(fmt::format("{}: first slip after {:.3f} s at {:.0f} N, then every {:.3f} s by {:.4f} m.",
                                          name, starts[0], first_force, starts[2] - starts[1],
                                          stop_positions[1] - start_positions[1]));
  }
  position.series.push_back(std::move(spring_end));
  result.charts = {std::move(position), std::move(force)};
  return result;
}

}  // namespace stiction::host
