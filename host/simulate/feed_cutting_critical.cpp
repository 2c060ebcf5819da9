// The feed above which the drive no longer jumps: formula, bisection, and what the loop gains do to it.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "host/simulate/feed_cutting.hpp"

namespace stiction::host {
namespace {

constexpr auto ideal = sim::FeedSource::constant_speed;
constexpr auto pi_drive = sim::FeedSource::pi_drive;
constexpr double width = 1e-3;  // of the bisection, relative

double in_mm_per_min(double feed) { return feed / mm_per_min; }

machine::FeedDrive with(machine::FeedDrive drive, double step, double stiffness, double mass, double zeta) {
  drive.friction.static_long = drive.friction.static_short = drive.friction.sliding + step / drive.friction.normal_load;
  drive.carriage = {mass, stiffness, zeta};
  return drive;
}

double critical_beta_by_bisection(const machine::FeedDrive& drive) {
  return sim::critical_feed_by_bisection(drive, ideal, 1e-6) *
         std::sqrt(drive.carriage.stiffness * drive.carriage.mass) / drive.friction.step();
}

void add_collapse(sim::ExperimentResult& result, const machine::FeedDrive& drive) {
  // Factors on the values of the drive.
  struct Set {
    double step, stiffness, mass;
  };
  const auto& own = drive.carriage;
  int number = 0;
  for (const auto& factor : {Set{1.0, 1.0, 1.0}, Set{1.0, 3.0, 1.0}, Set{0.25, 3.0, 1.0}, Set{0.05, 1.0, 0.5}}) {
    const double step = factor.step * drive.friction.step(), stiffness = factor.stiffness * own.stiffness,
                 mass = factor.mass * own.mass;
    result.figures.push_back(
        {fmt::format("critical_beta_set_{}", ++number),
         "",
         fmt::format("ideal drive: v_c sqrt(c m)/dF at zeta 0.05, dF {:g} N, c {:g} N/m, m {:g} kg", step, stiffness,
                     mass),
         critical_beta_by_bisection(with(drive, step, stiffness, mass, 0.05)),
         {}});
  }
  const auto at_zeta = [&](double zeta) { return with(drive, drive.friction.step(), own.stiffness, own.mass, zeta); };
  for (const double zeta : {0.1, 0.2})
    result.figures.push_back({fmt::format("critical_beta_at_zeta_{:g}", zeta),
                              "",
                              fmt::format("ideal drive: v_c sqrt(c m)/dF at zeta {:g}", zeta),
                              critical_beta_by_bisection(at_zeta(zeta)),
                              {}});
  for (const double zeta : {0.05, 0.1, 0.2})
    result.figures.push_back(
        {fmt::format("critical_beta_over_formula_at_zeta_{:g}", zeta),
         "",
         fmt::format("ideal drive: critical feed by bisection over the formula at zeta {:g}", zeta),
         critical_beta_by_bisection(at_zeta(zeta)) / sim::critical_beta(zeta),
         {}});
  // A break-away noticed at the end of a step adds the force that the spring has gained by then.
  const double late = 1e-4 * std::sqrt(own.stiffness / own.mass), exact = sim::critical_beta(0.1);
  result.findings.push_back(
      fmt::format("At zeta 0.1 the critical feed of the equations is {:.4f} dF/sqrt(c m), by closed form and by "
                  "bisection alike. A break-away that is noticed 0.1 ms late, at the end of a step, gives {:.4f}; here "
                  "the instant is a root.",
                  exact, exact / (1.0 - exact * late)));
}

sim::Series named(const char* name, bool points = false) { return {name, {}, {}, points}; }

void add_point(sim::Series& series, double x, double feed) {
  if (!std::isfinite(feed)) return;
  series.x.push_back(x);
  series.y.push_back(in_mm_per_min(feed));
}

// Formula as a line, bisection as points, over a parameter; `change` sets it.
template <class Change>
sim::Chart over_parameter(const machine::FeedDrive& drive, sim::Chart chart, double low, double high, Change&& change) {
  constexpr int points = 7, fine = 10;
  sim::Series formula = named("formula"), ideal_points = named("ideal drive, bisection", true),
              pi_points = named("PI drive, bisection", true);
  for (int i = 0; i <= (points - 1) * fine; ++i) {
    const double value = low * std::pow(high / low, static_cast<double>(i) / ((points - 1) * fine));
    const auto each = change(drive, value);
    add_point(formula, value, sim::critical_feed_of_ideal_drive(each));
    if (i % fine != 0) continue;
    add_point(ideal_points, value, sim::critical_feed_by_bisection(each, ideal, width));
    add_point(pi_points, value, sim::critical_feed_by_bisection(each, pi_drive, width));
  }
  chart.series = {std::move(formula), std::move(ideal_points), std::move(pi_points)};
  return chart;
}

void add_over_gain(sim::ExperimentResult& result, const machine::FeedDrive& drive) {
  sim::Chart chart{"Critical feed over loop gain",
                   "gain over that of the machine file",
                   "critical feed, mm/min",
                   "One gain at a time. Formula: a drive that moves at constant speed, regardless of the force. A "
                   "curve ends where the loop is unstable.",
                   true,
                   {}};
  struct Loop {
    const char *series, *name, *text;
    double& (*gain)(machine::FeedDrive&);
  };
  const std::array<Loop, 2> loops{{{"speed loop gain", "speed_gain", "speed-loop gain",
                                    [](machine::FeedDrive& d) -> double& { return d.speed_controller.gain; }},
                                   {"current loop gain", "current_gain", "current-loop gain",
                                    [](machine::FeedDrive& d) -> double& { return d.current_controller.gain; }}}};
  sim::Series formula = named("formula");
  constexpr std::array factors{0.125, 0.25, 0.5, 1.0, 1.414, 2.0, 2.828, 4.0};
  for (const double factor : {factors.front(), factors.back()})
    add_point(formula, factor, sim::critical_feed_of_ideal_drive(drive));
  chart.series.push_back(std::move(formula));
  std::string told;
  for (const auto& [name, key, text, gain] : loops) {
    sim::Series series = named(name);
    for (const double factor : factors) {
      auto each = drive;
      gain(each) *= factor;
      if (!sim::loops_are_stable(each)) continue;
      const double feed = sim::critical_feed_by_bisection(each, pi_drive, width);
      add_point(series, factor, feed);
      if ((factor != 0.5 && factor != 2.0) || !std::isfinite(feed)) continue;
      result.figures.push_back({fmt::format("critical_feed_{}_times_{:g}", key, factor),
                                "mm/min",
                                fmt::format("PI drive: critical feed, {} times {:g}", text, factor),
                                in_mm_per_min(feed),
                                {}});
      told += fmt::format("{}{:.0f} mm/min with {:g} times the {}", told.empty() ? "" : ", ", in_mm_per_min(feed),
                          factor, text);
    }
    chart.series.push_back(std::move(series));
  }
  result.findings.push_back(fmt::format(
      "Loop gains move the critical feed of the PI drive: {}; formula for a drive of infinite stiffness {:.0f} mm/min.",
      told, in_mm_per_min(sim::critical_feed_of_ideal_drive(drive))));
  result.charts.push_back(std::move(chart));
}

}  // namespace

void add_critical_feed(sim::ExperimentResult& result, const machine::FeedDrive& machine) {
  // As the relations: a step of friction, constant cutting force.
  auto drive = without_dwell(machine);
  drive.friction.stribeck_velocity = drive.friction.viscous = drive.cutting.coefficient = 0.0;
  add_collapse(result, drive);
  const char* caption =
      "Static friction after a long standstill. Formula: the speed after break-away, an oscillation about the feed, "
      "just reaches zero.";
  result.charts.push_back(over_parameter(
      drive, {"Critical feed over drive stiffness", "stiffness, N/m", "critical feed, mm/min", caption, true, {}}, 3e6,
      3e8, [](machine::FeedDrive each, double stiffness) {
        each.carriage.stiffness = stiffness;
        return each;
      }));
  result.charts.push_back(over_parameter(
      drive, {"Critical feed over friction step", "friction step, N", "critical feed, mm/min", caption, true, {}},
      100.0, 4000.0, [](const machine::FeedDrive& each, double step) {
        return with(each, step, each.carriage.stiffness, each.carriage.mass, each.carriage.damping_ratio);
      }));
  const double by_formula = sim::critical_feed_of_ideal_drive(drive);
  const double of_pi = sim::critical_feed_by_bisection(drive, pi_drive, width);
  result.figures.push_back(
      {"critical_feed_formula", "mm/min", "ideal drive: critical feed by formula", in_mm_per_min(by_formula), {}});
  result.figures.push_back(
      {"critical_feed_pi_drive", "mm/min", "PI drive: critical feed by bisection", in_mm_per_min(of_pi), {}});
  add_over_gain(result, drive);
}

}  // namespace stiction::host
