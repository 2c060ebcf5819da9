#include "host/diagnose/next_measurement/trajectory_rehearsal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/model/motor_force.hpp"
#include "host/diagnose/record/effect_response.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/simulate/control_run.hpp"
#include "host/simulate/replay.hpp"

namespace stiction::host {
namespace {

constexpr double usual_period = 1e-3;  // s, of a proposed log
constexpr double least_of_travel = 0.25;
constexpr double speed_share = 0.9, acceleration_share = 0.7, force_share = 0.5;
constexpr double beyond_the_records = 1.5;  // times their acceleration
constexpr double rise = 0.05;               // s, from rest to the highest acceleration

struct Covered {
  double low, high;
};
Covered covered_by(const LogRows& rows) {
  const auto place = [](const Motion& m) -> const std::vector<double>& { return m.x_set.empty() ? m.x : m.x_set; };
  Covered covered{place(rows.motions().front()).front(), place(rows.motions().front()).front()};
  for (const auto& motion : rows.motions()) {
    const auto [low, high] = std::minmax_element(place(motion).begin(), place(motion).end());
    covered = {std::min(covered.low, *low), std::max(covered.high, *high)};
  }
  return covered;
}

Log set_points(const sim::SeparatingTrajectory& kind, const sim::MotionRange& range, const std::string& axis,
               double period) {
  const auto trajectory = kind.make(range);
  Log log;
  log.source = kind.name;
  log.period = period;
  auto& channels = log.axes.emplace_back();
  channels.axis = axis;
  const auto count = static_cast<std::size_t>(trajectory.duration / period);
  for (std::size_t k = 0; k < count; ++k) {
    log.t.push_back(static_cast<double>(k) * period);
    const auto point = trajectory.at(log.t.back());
    channels.x_set.push_back(point.position);
    channels.v_set.push_back(point.velocity);
    channels.a_set.push_back(point.acceleration);
  }
  channels.x = channels.x_set;
  return log;
}

SearchContext scene_with(SearchContext context, const LogRows& rows) {
  const auto& motion = rows.motions().front();
  for (const double v : motion.v) context.highest_speed = std::max(context.highest_speed, std::abs(v));
  for (const double f : force_along(context.axis, motion))
    context.highest_force = std::max(context.highest_force, std::abs(f));
  context.reversals = enough_reversals;
  context.force_is_current = true;
  context.other_axis = false;
  return context;
}

}  // namespace

sim::MotionRange motion_range(const machine::AxisModel& axis, const LogRows& rows) {
  auto [low, high] = covered_by(rows);
  if (const double least = least_of_travel * axis.travel; high - low < least) {
    const double middle = 0.5 * (low + high);
    low = middle - 0.5 * least;
    high = middle + 0.5 * least;
  }
  const double speed = speed_share * axis.max_velocity;
  const double friction = coulomb_of(axis) + viscous_of(axis) * speed;
  const double by_force = (force_share * machine::largest_force(axis) - friction) / axis.mass;
  const double highest = std::min(acceleration_share * axis.max_acceleration, by_force);
  const double acceleration = std::min(beyond_the_records * rows.acceleration.cwiseAbs().maxCoeff(), highest);
  return {low, high, speed, acceleration, acceleration / rise, highest};
}

std::string extent_words(const Log& proposed, const LogRows& rows, const ShownUnits& units) {
  const auto& place = units.position;
  const auto& axis = proposed.axes.front();
  const auto [low, high] = std::minmax_element(axis.x_set.begin(), axis.x_set.end());
  const auto largest = [](const std::vector<double>& values) {
    return std::abs(
        *std::max_element(values.begin(), values.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
  };
  auto words = fmt::format(
      "It begins at rest at {:.3f} {}, remains between {:.3f} and {:.3f} {} and reaches {:.3g} {} and {:.3g} {}.",
      place(axis.x_set.front()), place.unit, place(*low), place(*high), place.unit, units.speed(largest(axis.v_set)),
      units.speed.unit, units.acceleration(largest(axis.a_set)), units.acceleration.unit);
  const auto covered = covered_by(rows);
  const double slack = 1e-3 * (covered.high - covered.low);
  if (*low < covered.low - slack || *high > covered.high + slack)
    words +=
        fmt::format(" These records cover only {:.3f} to {:.3f} {}: make sure that the range is free of obstacles.",
                    place(covered.low), place(covered.high), place.unit);
  return words;
}

machine::Machine rehearsal_machine(const machine::Machine& machine, std::size_t axis) {
  auto setup = machine;
  setup.axes = {machine.axes.at(axis)};
  setup.axes.front().encoder.noise = 0.0;
  return setup;
}

double rehearsal_period(const LogRows& rows) {
  const double row_period = rows.period(0);
  return row_period / std::max(1.0, std::round(row_period / usual_period));
}

std::optional<Rehearsal> rehearsed(const machine::Machine& setup, const Log& set_points, const SearchContext& context,
                                   const SignalSettings& settings) {
  try {
    auto log = replay_linear_as_held(setup, set_points);
    log.axes.front().i_set.clear();
    LogRows moved({motion_of(log, log.axes.front(), setup.axes.front(), Amperes::amplitude, settings)}, settings);
    log.axes.front().force.clear();
    log.axes.front().v.clear();
    auto known = scene_with(context, moved);
    known.response = EffectResponse(setup, 0, {log}, settings, FrictionAlong::own_motion);
    return Rehearsal{"", "", std::nullopt, std::move(log), std::move(moved), std::move(known)};
  } catch (const FaultTripped&) {  // not for this machine
  } catch (const machine::ConfigurationError&) {
  } catch (const LogError&) {
  }
  return std::nullopt;
}

std::vector<Rehearsal> rehearse(const machine::Machine& machine, std::size_t axis, const sim::MotionRange& range,
                                const LogRows& rows, const SearchContext& context, const SignalSettings& settings) {
  std::vector<Rehearsal> all;
  if (machine.axes.at(axis).unknown_controller()) return all;
  if (!(range.high > range.low) || !(range.speed > 0.0) || !(range.acceleration > 0.0)) return all;
  const auto setup = rehearsal_machine(machine, axis);
  const double period = rehearsal_period(rows);
  for (const auto& kind : sim::separating_trajectories()) {
    auto one = rehearsed(setup, set_points(kind, range, setup.axes.front().name, period), context, settings);
    if (!one) continue;
    one->name = kind.name;
    one->words = kind.words;
    all.push_back(std::move(*one));
  }
  return all;
}

}  // namespace stiction::host
