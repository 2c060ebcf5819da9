// An ideal drive by the source's equations, compared with the closed forms.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "host/simulate/feed_cutting.hpp"
#include "sim/plant/feed/feed_per_revolution.hpp"

namespace stiction::host {
namespace {

constexpr auto ideal = sim::FeedSource::constant_speed;
constexpr sim::FeedEquations printed_damping{false, true}, printed_stick{true, false};
constexpr double slow = 0.018;  // beta of the relations

// v sqrt(c m) / dF = beta.
double feed_of(double beta, const machine::FeedDrive& drive) {
  return beta * drive.friction.step() / std::sqrt(drive.carriage.stiffness * drive.carriage.mass);
}

double double_step(const machine::FeedDrive& drive) { return 2.0 * drive.friction.step() / drive.carriage.stiffness; }

machine::FeedDrive damped(machine::FeedDrive drive, double zeta) {
  drive.carriage.damping_ratio = zeta;
  return drive;
}

void add_small_feed_relations(sim::ExperimentResult& result, const machine::FeedDrive& drive) {
  const auto add = [&](std::string name, std::string text, double value) {
    result.figures.push_back({std::move(name), "", std::move(text), value, {}});
  };
  for (const double zeta : {0.0, 0.05, 0.1, 0.2}) {
    const auto each = damped(drive, zeta);
    const auto cycle = sim::jumping_at(each, ideal, {}, feed_of(slow, each)).cycle;
    const double simulated = cycle.travel / double_step(each), predicted = sim::small_feed_jump_ratio(slow, zeta);
    add(fmt::format("jump_ratio_at_zeta_{:g}", zeta),
        fmt::format("ideal drive, beta 0.018: jump over 2 dF/c at zeta {:g}", zeta), simulated);
    add(fmt::format("jump_over_formula_at_zeta_{:g}", zeta),
        fmt::format("ideal drive, beta 0.018: jump over its formula at zeta {:g}", zeta), simulated / predicted);
    if (zeta == 0.0)
      add("slip_time_ratio", "ideal drive, beta 0.018: slip time over pi/omega",
          cycle.slip_time * each.carriage.natural_frequency() / std::numbers::pi);
    if (zeta == 0.05)
      add("period_ratio", "ideal drive: period over jump / feed", cycle.period * feed_of(slow, each) / cycle.travel);
  }
}

void add_first_slip(sim::ExperimentResult& result, const machine::FeedDrive& drive) {
  const double feed = feed_of(slow, drive);
  const auto first_slip = [&](const machine::FeedDrive& each) {
    sim::StickSlipFeed run(each, ideal, {}, feed);
    run.advance_to_standstill(10.0 * each.friction.at_rest(1e9) / (each.carriage.stiffness * feed));
    return run.jumps().front().start;
  };
  const double expected = (drive.friction.normal_load * drive.friction.static_long + drive.cutting.constant_force) /
                          (drive.carriage.stiffness * feed);
  const auto add = [&](const char* name, const char* text, double value) {
    result.figures.push_back({name, "", text, value, {}});
  };
  add("first_slip_ratio", "ideal drive: time of the first slip over (F_s + P)/(c v)", first_slip(drive) / expected);
  add("first_slip_ratio_undamped", "the same without damping", first_slip(damped(drive, 0.0)) / expected);
  auto loaded = drive;
  loaded.cutting.constant_force += 1000.0;
  add("jump_with_more_cutting_ratio", "ideal drive: jump with 1000 N more of constant cutting force over jump without",
      sim::jumping_at(loaded, ideal, {}, feed).cycle.travel / sim::jumping_at(drive, ideal, {}, feed).cycle.travel);
}

// n = 1000/min, S = 0.06 mm a revolution.
void add_feed_over_turns(sim::ExperimentResult& result, const machine::FeedDrive& drive) {
  constexpr double revolution = 0.06, feed = 0.06e-3 / revolution;  // s, m/s
  constexpr std::size_t count = 8;
  const auto cycle = sim::jumping_at(drive, ideal, {}, feed).cycle;
  result.figures.push_back(
      {"jump_at_60_mm_per_min_ideal_drive", "um", "ideal drive, 60 mm/min: jump", cycle.travel * 1e6, {}});
  result.figures.push_back({"period_at_60_mm_per_min_ideal_drive",
                            "revolutions",
                            "ideal drive, 60 mm/min, 1000 rpm: period",
                            cycle.period / revolution,
                            {}});
  // Counted from where the spring carries sliding friction and cutting force.
  const double origin =
      (drive.friction.in_motion(0.0) + drive.cutting.constant_force) / (drive.carriage.stiffness * feed);
  sim::StickSlipFeed run(drive, ideal, {}, feed);
  const auto feeds = sim::feed_per_revolution(run, origin, revolution, count);
  for (std::size_t i = 0; i < count; ++i)
    result.figures.push_back({fmt::format("feed_of_revolution_{}", i + 1),
                              "mm",
                              fmt::format("ideal drive, 60 mm/min, 1000 rpm: feed of revolution {}", i + 1),
                              feeds[i] * 1e3,
                              {}});
}

// The PI drive with the damping term as printed, and corrected.
void add_printed_damping(sim::ExperimentResult& result, const machine::FeedDrive& drive) {
  const auto pi = [&](double mm_per_minute, sim::FeedEquations equations) {
    return sim::jumping_at(drive, sim::FeedSource::pi_drive, equations, mm_per_minute * mm_per_min);
  };
  const auto add = [&](const char* name, const char* unit, const char* text, double value) {
    result.figures.push_back({name, unit, std::string("PI drive, ") + text, value, {}});
  };
  const auto at_60 = pi(60.0, printed_damping), at_1500 = pi(1500.0, printed_damping), corrected = pi(60.0, {});
  add("jump_at_60_mm_per_min_printed_damping", "um", "printed damping, 60 mm/min: jump", at_60.cycle.travel * 1e6);
  add("period_at_60_mm_per_min_printed_damping", "s", "printed damping, 60 mm/min: period", at_60.cycle.period);
  add("jump_ratio_at_60_mm_per_min_printed_damping", "", "printed damping, 60 mm/min: jump over 2 dF/c",
      at_60.cycle.travel / double_step(drive));
  add("jump_ratio_at_1500_mm_per_min_printed_damping", "", "printed damping, 1500 mm/min: jump over 2 dF/c",
      at_1500.cycle.travel / double_step(drive));
  add("jumps_at_3000_mm_per_min_printed_damping", "", "printed damping, 3000 mm/min: 1 if the jumps continue",
      pi(3000.0, printed_damping).lasts ? 1.0 : 0.0);
  add("jump_at_60_mm_per_min_corrected", "um", "corrected equations, 60 mm/min: jump", corrected.cycle.travel * 1e6);
  result.findings.push_back(
      fmt::format("The printed damping term is a constant force: with it the PI drive jumps by {:.1f} um at 60 mm/min "
                  "and by {:.2f} times 2 dF/c at 1500 mm/min; with a term in the relative speed it jumps by {:.1f} um "
                  "and {}.",
                  at_60.cycle.travel * 1e6, at_1500.cycle.travel / double_step(drive), corrected.cycle.travel * 1e6,
                  pi(1500.0, {}).lasts ? "still jumps at 1500 mm/min" : "no longer jumps at 1500 mm/min"));
}

}  // namespace

machine::FeedDrive without_dwell(machine::FeedDrive drive) {
  drive.friction.static_short = drive.friction.static_long;
  return drive;
}

void add_feed_relations(sim::ExperimentResult& result, const machine::FeedDrive& machine) {
  // The relations are those of a step of friction and a constant cutting force.
  auto drive = without_dwell(machine);
  drive.friction.stribeck_velocity = drive.friction.viscous = drive.cutting.coefficient = 0.0;
  add_small_feed_relations(result, drive);
  add_first_slip(result, drive);
  add_feed_over_turns(result, drive);
}

void add_printed_equations(sim::ExperimentResult& result, const machine::FeedDrive& machine) {
  auto drive = without_dwell(machine);
  drive.friction.stribeck_velocity = drive.friction.viscous = drive.cutting.coefficient = 0.0;
  const double feed = feed_of(slow, drive);
  const double undamped = sim::jumping_at(damped(drive, 0.0), ideal, {}, feed).cycle.travel;
  result.figures.push_back({"jump_with_printed_damping_ratio",
                            "",
                            "ideal drive: jump with the printed damping term over jump without any",
                            sim::jumping_at(drive, ideal, printed_damping, feed).cycle.travel / undamped,
                            {}});
  result.figures.push_back({"jump_with_corrected_damping_ratio",
                            "",
                            "ideal drive: jump with the corrected damping term over jump without any",
                            sim::jumping_at(drive, ideal, {}, feed).cycle.travel / undamped,
                            {}});
  const auto break_away = [&](sim::FeedEquations equations, std::size_t jump) {
    sim::StickSlipFeed run(drive, ideal, equations, feed);
    while (run.jumps().size() <= jump) run.advance_to_standstill(run.time() + 0.01);
    return run.jumps()[jump].break_away_force - drive.cutting.constant_force;
  };
  struct Row {
    const char *name, *text;
    sim::FeedEquations equations;
    std::size_t jump;
  };
  for (const auto& [name, text, equations, jump] :
       {Row{"first_break_away_printed", "friction overcome at the first break-away, stick condition as printed",
            printed_stick, 0},
        Row{"second_break_away_printed", "friction overcome at the second break-away, stick condition as printed",
            printed_stick, 1},
        Row{"second_break_away_corrected",
            "friction overcome at the second break-away, stick condition corrected",
            {},
            1}})
    result.figures.push_back({name, "N", text, break_away(equations, jump), {}});
  add_printed_damping(result, drive);
}

}  // namespace stiction::host
