#include "host/cam/rank.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/cam/characteristics.hpp"

namespace stiction::host {
namespace {

using sim::cam::Law;

// Of the band; the lobes of a residual spectrum are one period in the rise apart.
constexpr double frequencies_each_period = 12.0;

double largest_residual(const sim::cam::Curve& unit, double lowest, double highest) {
  const int count = std::max(8, static_cast<int>(std::ceil((highest - lowest) * frequencies_each_period)));
  double largest = 0.0;
  for (int k = 0; k <= count; ++k)
    largest = std::max(largest, residual_amplitude(unit, lowest + (highest - lowest) * k / count));
  return largest;
}

RankedLaw ranked(const Law& law, const RankTask& task, const AxisLoad& load) {
  RankedLaw row;
  row.law = &law;
  const auto unit = sim::cam::unit_curve(law);
  const double length = law.kind == sim::cam::LawKind::rise ? task.rise : 2.0 * task.rise;
  sim::cam::Cam cam{.name = "rise", .periodic = false};
  cam.segments = {{.length = length, .stroke = task.stroke, .law = std::string(law.name)}};
  sim::cam::Motion motion{cam, unit.placed({.stretch = length, .gain = task.stroke}), {{0, unit.pieces().size()}}};
  const Duty duty = duty_of(motion, load, task.master_speed);
  row.speed = duty.extremes[1].magnitude();
  row.acceleration = duty.extremes[2].magnitude();
  row.jerk = duty.extremes[3].magnitude();
  row.effort = std::fabs(duty.effort.motor.value);
  row.broken = duty.broken();
  row.jumps = sim::cam::characteristics(law, sim::cam::default_values(law), unit).jerks_without_bound();
  const double time = length / task.master_speed;
  row.residual = std::fabs(task.stroke) * largest_residual(unit, task.lowest * time, task.highest * time);
  return row;
}

bool dominates(const RankedLaw& a, const RankedLaw& b) {
  const double one[] = {a.speed, a.acceleration, a.effort, a.residual},
               two[] = {b.speed, b.acceleration, b.effort, b.residual};
  bool better = false;
  for (int k = 0; k < 4; ++k) {
    if (one[k] > two[k] * (1.0 + 1e-9)) return false;
    better = better || one[k] < two[k] * (1.0 - 1e-9);
  }
  return better;
}

void mark_front(std::vector<RankedLaw>& rows) {
  for (RankedLaw& row : rows)
    row.front = std::none_of(rows.begin(), rows.end(), [&](const RankedLaw& other) { return dominates(other, row); });
}

void recommend(Ranking& ranking, const AxisLoad& load) {
  double least = -1.0;
  const auto fit = [](const RankedLaw& row) { return row.front && !row.jumps && !row.broken; };
  for (const RankedLaw& row : ranking.laws)
    if (fit(row) && (least < 0.0 || row.effort < least)) least = row.effort;
  const bool rotary = load.kind == sim::cam::Coordinate::rotary;
  const std::string_view effort = rotary ? "torque" : "force";
  for (const RankedLaw& row : ranking.laws) {  // in the order of their residuals
    if (!fit(row) || row.effort > least * (1.0 + effort_margin)) continue;
    ranking.recommended = static_cast<std::size_t>(&row - ranking.laws.data());
    ranking.reason = fmt::format(
        "{} leaves the smallest residual oscillation in the band of the laws of the front whose motor {} is at most "
        "{:.0f} % above the smallest one, without a jump of the acceleration.",
        row.law->name, effort, 100.0 * effort_margin);
    return;
  }
  const bool all_broken =
      std::all_of(ranking.laws.begin(), ranking.laws.end(), [](const RankedLaw& row) { return row.broken; });
  ranking.reason = all_broken ? "No law is recommended: each breaks a limit of the axis at this speed."
                              : "No law is recommended: those that keep the limits jump in their acceleration.";
}

void recommend_from_rest_to_rest(Ranking& ranking, RankTask task, const AxisLoad& load) {
  task.task = "R-R";
  const Ranking rests = rank_laws(task, load);
  ranking.reason = "Of the laws from rest to rest: " + rests.reason;
  if (!rests.recommended) return;
  const auto is_it = [&](const RankedLaw& row) { return row.law == rests.laws[*rests.recommended].law; };
  const auto found = std::find_if(ranking.laws.begin(), ranking.laws.end(), is_it);
  ranking.recommended = static_cast<std::size_t>(found - ranking.laws.begin());
}

}  // namespace

FrequencyBand usual_band(const AxisLoad& load, double rise_time) {
  if (load.frequency) return {0.8 * *load.frequency, 1.2 * *load.frequency};
  return {1.0 / rise_time, 5.0 / rise_time};
}

Ranking rank_laws(const RankTask& task, const AxisLoad& load) {
  Ranking ranking;
  for (const Law& law : sim::cam::laws()) {
    const bool complete = std::all_of(law.parameters.begin(), law.parameters.end(),
                                      [](const auto& parameter) { return parameter.fallback.has_value(); });
    if (!complete) continue;
    if (task.task == every_task || (law.kind == sim::cam::LawKind::rise && task_of(law) == task.task))
      ranking.laws.push_back(ranked(law, task, load));
  }
  mark_front(ranking.laws);
  std::stable_sort(ranking.laws.begin(), ranking.laws.end(), [](const RankedLaw& a, const RankedLaw& b) {
    return a.residual != b.residual ? a.residual < b.residual : a.effort < b.effort;
  });
  if (task.task == every_task)
    recommend_from_rest_to_rest(ranking, task, load);
  else
    recommend(ranking, load);
  return ranking;
}

}  // namespace stiction::host
