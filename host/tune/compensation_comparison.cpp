#include "host/tune/compensation_comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "firmware/machine/configuration/compensation_configuration.hpp"
#include "host/simulate/circle.hpp"
#include "host/simulate/quadrant_run.hpp"

namespace stiction::host {
namespace {

constexpr double turn = 2.0 * std::numbers::pi;
constexpr std::size_t most_points = 3000;  // of a drawn lap: 0.12 degrees apart

struct KindWords {
  CompensationKind kind;
  const char *name, *words;
};
constexpr std::array<KindWords, 4> kinds{{
    {CompensationKind::off, "off", "off"},
    {CompensationKind::pulse, "pulse", "(a) speed pulse"},
    {CompensationKind::friction, "friction", "(b) friction by distance and speed"},
    {CompensationKind::learning, "learning", "(c) the same, with learning"},
}};
const KindWords& row_of(CompensationKind kind) {
  return *std::find_if(kinds.begin(), kinds.end(), [&](const KindWords& row) { return row.kind == kind; });
}

bool has(const machine::AxisModel& axis, CompensationKind kind) {
  const auto& compensation = axis.friction_compensation;
  if (!compensation) return false;
  switch (kind) {
    case CompensationKind::off:
      return true;
    case CompensationKind::pulse:
      return compensation->pulse.has_value();
    case CompensationKind::friction:
      return compensation->friction.has_value();
    case CompensationKind::learning:
      return compensation->friction && compensation->learning;
  }
  return false;
}

bool compares(const machine::Machine& machine, CompensationKind kind) {
  return std::any_of(machine.axes.begin(), machine.axes.end(),
                     [&](const machine::AxisModel& axis) { return has(axis, kind); });
}

bool can_drive(const machine::Machine& machine, sim::CircleSettings circle, double feed) {
  circle.feed = feed;
  try {
    for (const auto& axis : machine.axes) check_circle(axis, circle);
    return true;
  } catch (const InfeasibleMotion&) {
    return false;
  }
}

// Samples of an axis' last lap.
struct Lap {
  std::vector<double> angle, error;
};

Lap thinned(const Lap& lap) {
  const std::size_t stride = lap.angle.size() / most_points + 1;
  Lap kept;
  for (std::size_t i = 0; i < lap.angle.size(); i += stride) {
    kept.angle.push_back(lap.angle[i]);
    kept.error.push_back(lap.error[i]);
  }
  return kept;
}

ComparedCircle drive(const machine::Machine& machine, CompensationKind kind, const sim::CircleSettings& circle,
                     int laps, bool drawn) {
  ComparedCircle result{kind, circle.feed, {}, {}, false, {}, {}};
  const sim::CirclePath path(circle);
  const double begin = sim::CirclePath::lap_begin + turn * (laps - 2);
  for (std::size_t k = 0; k < machine.axes.size(); ++k) {
    auto own = machine;
    if (own.axes[k].friction_compensation)
      own.axes[k].friction_compensation->use = has(machine.axes[k], kind) ? kind : CompensationKind::off;
    Lap lap;
    TraceSink<FixedSignals> sink;
    if (drawn)
      sink = [&](std::int64_t now_ns, std::span<const AxisSignals<FixedSignals>> signals) {
        const double t = static_cast<double>(now_ns) * 1e-9 - machine::set_point_delay(own);
        const double turned = t > 0.0 ? path.at(t).turned : 0.0;
        if (turned < begin) return;
        lap.angle.push_back(turned);
        lap.error.push_back(machine::to_si(signals[0].e));
      };
    const auto run = run_quadrants(own, k, circle, laps, sink);
    result.peak_error.push_back(run.peak_error.back());
    result.peak_current.push_back(run.peak_current);
    result.dropped = result.dropped || run.dropped;
    auto kept = thinned(lap);
    result.angle = std::move(kept.angle);
    result.error.push_back(std::move(kept.error));
  }
  return result;
}

}  // namespace

const char* name_of(CompensationKind kind) { return row_of(kind).name; }
const char* words_of(CompensationKind kind) { return row_of(kind).words; }

std::size_t compared_circles(const machine::Machine& machine, const ComparisonSettings& settings) {
  std::size_t count = 0;
  for (const auto& row : kinds)
    for (const double feed : settings.feeds)
      count += compares(machine, row.kind) && can_drive(machine, settings.circle, feed);
  return count;
}

std::vector<ComparedCircle> compare_compensations(const machine::Machine& machine, const ComparisonSettings& settings) {
  std::vector<ComparedCircle> circles;
  for (const auto& row : kinds) {
    if (!compares(machine, row.kind)) continue;
    for (const double feed : settings.feeds) {
      if (!can_drive(machine, settings.circle, feed)) continue;
      auto circle = settings.circle;
      circle.feed = feed;
      const bool drawn = std::abs(feed - settings.circle.feed) <= 1e-9 * feed;
      const int laps = row.kind == CompensationKind::learning ? settings.learning_laps + 1 : 2;
      circles.push_back(drive(machine, row.kind, circle, laps, drawn));
      if (settings.progress) settings.progress();
    }
  }
  return circles;
}

}  // namespace stiction::host
