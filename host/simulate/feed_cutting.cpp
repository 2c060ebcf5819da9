// The stick-slip feed with cutting (Kudoyarov et al.): the feed drive of the machine over time and over the feed. Its
// relations and its critical feed are in feed_cutting_relations.cpp and feed_cutting_critical.cpp.
#include "host/simulate/feed_cutting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "host/simulate/experiments.hpp"

namespace stiction::host {
namespace {

using namespace sim::feed_state;

struct Variant {
  std::string name;
  sim::FeedEquations equations;
};

Variant variant_of(const std::string& name) {
  const bool corrected = name == equations_corrected;
  return {name, {corrected, corrected}};
}

// Until the fifth jump begins, if it comes soon, and at least eight revolutions.
double shown_duration(const machine::FeedDrive& drive, double feed) {
  const double winding = drive.carriage.stiffness * feed;
  const double first =
      (drive.friction.normal_load * drive.friction.static_long + drive.cutting.constant_force) / winding;
  const double cycle =
      2.0 * drive.friction.step() / winding + 2.0 * std::numbers::pi / drive.carriage.natural_frequency();
  const double soon = 3.0 * (first + 5.0 * cycle);
  sim::StickSlipFeed run(drive, sim::FeedSource::pi_drive, {}, feed);
  while (run.jumps().size() < 5 && run.time() < soon) run.advance_to_standstill(run.time() + 0.1 * cycle);
  const double shown = run.jumps().size() < 5 ? first + 5.0 * cycle : run.jumps().back().start + 0.1 * cycle;
  return std::max(shown, 8.0 * drive.cutting.revolution());
}

struct TimeCharts {
  sim::Chart travel{
      "Travel",
      "time, s",
      "travel, mm",
      "The drive winds up its spring; the carriage follows in jumps (corrected, printed: version of the equations).",
      false,
      {}};
  sim::Chart speed{"Sliding speed", "time, s", "speed of the carriage, mm/s", "", false, {}};
  sim::Chart force{"Drive force",
                   "time, s",
                   "force on the carriage, N",
                   "At standstill the threshold: static friction, which grows with the dwell time, plus cutting force. "
                   "In motion: sliding friction plus cutting force.",
                   false,
                   {}};
  sim::Chart tool{"Tool deflection",
                  "time, s",
                  "deflection of the tool, um",
                  "Force proportional to the speed of the carriage to the power of 0.55 in X and 0.75 in Z, unless the "
                  "machine file has other exponents.",
                  false,
                  {}};
  sim::Chart turns{"Feed per revolution", "revolution of the spindle, count", "feed, mm per revolution", "", false, {}};
};

// Adds one variant of the equations; the first one shows drive, threshold and tool too.
sim::StickSlipFeed add_over_time(TimeCharts& charts, const machine::FeedDrive& drive, double feed,
                                 const Variant& variant) {
  const bool first = charts.travel.series.empty();
  const double revolution = drive.cutting.revolution();
  const double revolutions = std::ceil(shown_duration(drive, feed) / revolution);
  const int per_revolution = static_cast<int>(std::ceil(6000.0 / revolutions));
  sim::StickSlipFeed run(drive, sim::FeedSource::pi_drive, variant.equations, feed);
  sim::Series travelled{variant.name, {}, {}}, speeds = travelled, forces = travelled, turns = travelled;
  sim::Series driven{"drive", {}, {}}, thresholds{"threshold", {}, {}}, x{"tool in X", {}, {}}, z{"tool in Z", {}, {}};
  turns.bars = true;
  double before = 0.0;
  const int samples = static_cast<int>(revolutions) * per_revolution;
  for (int i = 0; i <= samples; ++i) {
    const double t = revolution * i / per_revolution;
    run.advance_to(t);
    const auto& s = run.state();
    const auto add = [t](sim::Series& series, double value) {
      series.x.push_back(t);
      series.y.push_back(value);
    };
    add(travelled, s[travel] * 1e3);
    add(speeds, s[speed] * 1e3);
    add(forces, run.system().drive_force(s));
    if (i > 0 && i % per_revolution == 0) {
      turns.x.push_back(i / per_revolution);
      turns.y.push_back((s[travel] - before) * 1e3);
      before = s[travel];
    }
    if (!first) continue;
    add(driven, run.system().drive_travel(s) * 1e3);
    add(thresholds, run.threshold());
    add(x, s[tool_x] * 1e6);
    add(z, s[tool_z] * 1e6);
  }
  charts.travel.series.push_back(std::move(travelled));
  charts.speed.series.push_back(std::move(speeds));
  charts.force.series.push_back(std::move(forces));
  charts.turns.series.push_back(std::move(turns));
  if (first) {
    charts.travel.series.push_back(std::move(driven));
    charts.force.series.push_back(std::move(thresholds));
    charts.tool.series = {std::move(x), std::move(z)};
  }
  return run;
}

double double_step(const machine::FeedDrive& drive) { return 2.0 * drive.friction.step() / drive.carriage.stiffness; }

void add_motion(sim::ExperimentResult& result, const ExperimentInput& input, const machine::FeedDrive& drive) {
  const double feed = input.feeds.front();
  TimeCharts charts;
  const auto title = fmt::format(", {:g} mm/min", feed / mm_per_min);
  for (sim::Chart* chart : {&charts.travel, &charts.speed, &charts.force, &charts.tool, &charts.turns})
    chart->title += title;
  charts.turns.caption = fmt::format("{:g} rpm; revolutions are counted from the start.",
                                     drive.cutting.spindle_speed * 30.0 / std::numbers::pi);
  for (const auto& name : input.equations) {
    const auto run = add_over_time(charts, drive, feed, variant_of(name));
    std::size_t stops = 0;
    double peak = 0.0;
    for (const auto& jump : run.jumps()) {
      stops += std::isfinite(jump.stop) ? 1 : 0;
      peak = std::max(peak, jump.peak_speed);
    }
    const auto& turns = charts.turns.series.back().y;
    const auto still = std::count_if(turns.begin(), turns.end(), [&](double each) { return each < 1e-6; });
    result.findings.push_back(fmt::format(
        "{:g} mm/min, equations {}: {} jumps in {:.3g} s, sliding at up to {:.3g} mm/s; {} of {} revolutions without "
        "feed, {:.4g} mm at most.",
        feed / mm_per_min, name, stops, run.time(), peak * 1e3, still, turns.size(),
        *std::max_element(turns.begin(), turns.end())));
  }
  for (auto* chart : {&charts.travel, &charts.speed, &charts.force, &charts.tool, &charts.turns})
    result.charts.push_back(std::move(*chart));
}

// Jump over 2 dF/c: the machine's drive, the same without growth of static friction, and an ideal drive.
void add_over_feed(sim::ExperimentResult& result, const ExperimentInput& input, const machine::FeedDrive& drive) {
  sim::Chart chart{"Jump over feed", "feed, mm/min", "jump over 2 dF/c", "A curve ends where the jumps end.", true, {}};
  auto constant = without_dwell(drive);
  auto simple = constant;
  simple.cutting.coefficient = 0.0;
  struct Row {
    const char* name;
    const machine::FeedDrive& drive;
    sim::FeedSource source;
    sim::FeedEquations equations;
  };
  for (const auto& [name, each, source, equations] :
       {Row{"PI drive", drive, sim::FeedSource::pi_drive, {}},
        Row{"PI drive, static friction constant", constant, sim::FeedSource::pi_drive, {}},
        Row{"PI drive, damping as printed", constant, sim::FeedSource::pi_drive, {false, true}},
        Row{"ideal drive", simple, sim::FeedSource::constant_speed, {}}}) {
    sim::Series series{name, {}, {}};
    for (int i = 0; i <= 16; ++i) {
      const double feed = 30.0 * std::pow(4000.0 / 30.0, i / 16.0);
      const auto jumping = sim::jumping_at(each, source, equations, feed * mm_per_min);
      if (!jumping.lasts) continue;
      series.x.push_back(feed);
      series.y.push_back(jumping.cycle.travel / double_step(each));
    }
    chart.series.push_back(std::move(series));
  }
  result.charts.push_back(std::move(chart));

  for (const auto& name : input.equations)
    for (const double feed : input.feeds) {
      const auto jumping = sim::jumping_at(drive, sim::FeedSource::pi_drive, variant_of(name).equations, feed);
      const auto key = fmt::format("_{}_at_{:g}_mm_per_min", name, feed / mm_per_min);
      const auto of = fmt::format("{:g} mm/min, {}: ", feed / mm_per_min, name);
      result.figures.push_back({"jumps" + key, "", of + "1 if the jumps continue", jumping.lasts ? 1.0 : 0.0, {}});
      if (!jumping.lasts) continue;
      result.figures.push_back({"jump" + key, "um", of + "jump", jumping.cycle.travel * 1e6, {}});
      result.figures.push_back({"period" + key, "s", of + "period", jumping.cycle.period, {}});
      result.figures.push_back({"standstill" + key, "s", of + "standstill in it", jumping.cycle.dwell, {}});
      result.figures.push_back(
          {"jump_ratio" + key, "", of + "jump over 2 dF/c", jumping.cycle.travel / double_step(drive), {}});
    }
}

// (6) with the feed of the instant is a damper: coefficient times the revolution's time.
void add_cutting(sim::ExperimentResult& result, const ExperimentInput& input, const machine::FeedDrive& drive) {
  const double feed = input.feeds.front();
  const auto jumps = [&](double coefficient) {
    auto each = drive;
    each.cutting.coefficient = coefficient;
    return sim::jumping_at(each, sim::FeedSource::pi_drive, {}, feed).lasts;
  };
  if (!jumps(0.0)) return;
  double low = 0.0, high = 2.0 * std::sqrt(drive.carriage.stiffness * drive.carriage.mass) / drive.cutting.revolution();
  while (jumps(high)) {
    low = high;
    high *= 2.0;
  }
  while (high - low > 1e-3 * high) {
    const double middle = 0.5 * (low + high);
    (jumps(middle) ? low : high) = middle;
  }
  result.figures.push_back(
      {"critical_cutting_coefficient",
       "N/mm",
       fmt::format("cutting coefficient C_v0 from which on {:g} mm/min is free of jumps", feed / mm_per_min),
       0.5 * (low + high) * 1e-3,
       {}});
  result.findings.push_back(fmt::format(
      "A cutting force linear in the instantaneous feed damps like {:.0f} N s/m; from C_v0 = {:.3g} N per mm of feed "
      "per revolution on, it alone ends the jumps at {:g} mm/min. A constant cutting force changes only the first "
      "slip.",
      drive.cutting.coefficient * drive.cutting.revolution(), 0.5 * (low + high) * 1e-3, feed / mm_per_min));
}

}  // namespace

sim::ExperimentResult run_feed_cutting(const ExperimentInput& input) {
  sim::ExperimentResult result{
      "feed-cutting",
      "Stick-slip feed with cutting",
      "",
      "Below a critical feed the carriage of a feed drive does not slide but jumps, by about twice the friction step "
      "over the drive stiffness, and the feed differs from one revolution of the spindle to the next (Kudoyarov, "
      "Perevertailo, Fetsak). The paper prints no parameters; its damping term has no damping effect, and its stick "
      "condition holds for the first stick only.",
      {},
      {},
      {}};
  const auto& drive = *input.machine.feed_drive;
  if (!sim::loops_are_stable(drive))
    throw machine::ConfigurationError(
        "feed_drive: found gains with which the motor's loops are unstable; expected smaller "
        "gains or longer integral times");
  add_motion(result, input, drive);
  add_over_feed(result, input, drive);
  add_cutting(result, input, drive);
  add_printed_equations(result, drive);
  add_feed_relations(result, drive);
  add_critical_feed(result, drive);
  return result;
}

}  // namespace stiction::host
