#include "host/diagnose/next_measurement/cam_rehearsal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "host/cam/axis_load.hpp"
#include "host/cam/duty.hpp"
#include "host/identify/identification.hpp"
#include "host/log/repeating_motion.hpp"
#include "host/log/set_points.hpp"
#include "host/simulate/cam_set_points.hpp"

namespace stiction::host {
namespace {

constexpr double one_degree = std::numbers::pi / 180.0, turn_per_minute = 2.0 * std::numbers::pi / 60.0;
// Of the axis: what it lacks in its file needs some, too.
constexpr double cam_speed_share = 0.9, cam_acceleration_share = 0.7, cam_effort_share = 0.7;
constexpr double least_duration = 6.0;  // s, of the measured cycles
constexpr int fewest_cycles = 5;
// Of what a record tells of lengths: as round as it was planned, where its samples do not contradict that.
constexpr double neat_within = 1e-4;

double neat_length(double value, double unit) {
  const double round = std::round(value / unit) * unit;
  return std::abs(round - value) <= neat_within * std::abs(value) ? round : value;
}

double own_unit(const machine::AxisModel& axis) {
  return axis.coordinate.rotary() ? axis.coordinate.radius : 1.0;  // m
}

// Where the slave is slowest: in its rest, if it has one.
double resting_place(const SetPoints& points) {
  const auto& v = points.velocity();
  const auto slowest =
      std::min_element(v.begin(), v.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  return points.position()[static_cast<std::size_t>(slowest - v.begin())];
}

std::optional<sim::cam::CamRange> cam_range_of(const Log& log, const machine::AxisModel& axis, double& master_speed) {
  const auto& channels = channels_of(log, axis);
  if (channels.master.empty() || channels.x_set.empty()) return std::nullopt;
  const SetPoints points(log, channels);
  const auto repeats = repeating_motion(log, channels, points);
  if (!repeats) return std::nullopt;
  const double unit = own_unit(axis), neat = axis.coordinate.rotary() ? 1e-3 * one_degree : 1e-6;
  sim::cam::CamRange range;
  range.cycle = neat_length(unwound(channels.master).cycle, one_degree);
  range.slave = axis.coordinate.rotary() ? sim::cam::Coordinate::rotary : sim::cam::Coordinate::linear;
  const auto [low, high] = std::minmax_element(points.position().begin(), points.position().end());
  // A way back that is short of the way out by less than the drive's increments is none.
  range.returns = std::abs(repeats->rise) <= neat_within * (*high - *low);
  range.stroke = neat_length((range.returns ? *high - *low : repeats->rise) / unit, neat);
  range.start = neat_length((range.returns ? *low : resting_place(points)) / unit, neat);
  if (!(std::abs(range.stroke) > 0.0) || !(range.cycle > 0.0)) return std::nullopt;
  if (!range.returns) range.modulo = std::abs(range.stroke);
  // Of an endless axis a record may be turns away from where the drive starts to count.
  if (axis.modulo) range.start -= *axis.modulo / unit * std::floor(range.start * unit / *axis.modulo);
  master_speed = range.cycle / repeats->period;
  return range;
}

// The share of an axis that a cam may use.
AxisLoad permitted_load(const machine::AxisModel& axis) {
  auto load = load_of(axis);
  load.max_speed *= cam_speed_share;
  load.max_acceleration *= cam_acceleration_share;
  load.largest_effort *= cam_effort_share;
  return load;
}

// rad/s, of a speed in turns a minute of three digits, which is shown as it is simulated; none where no speed keeps the
// limits of `load`.
std::optional<ProposedCam> proposed_cam(const sim::cam::SeparatingCam& each, const RecordedCam& recorded,
                                        const AxisLoad& load) {
  ProposedCam cam;
  cam.cam = sim::cam::separating_cam(each, recorded.range);
  const double highest = duty_of(sim::cam::compose(cam.cam), load, 1.0).highest_speed();
  if (!(highest > 0.0) || !std::isfinite(highest)) return std::nullopt;
  cam.turns = std::strtod(fmt::format("{:.3g}", each.speed_share * highest / turn_per_minute).c_str(), nullptr);
  cam.rise = sim::cam::rise_of(each, recorded.range);
  cam.law = each.law;
  cam.speed = fmt::format("{} rpm", cam.turns);
  cam.master_speed = cam.turns * turn_per_minute;
  cam.recorded_speed = recorded.master_speed;
  cam.cycles =
      std::max(fewest_cycles, static_cast<int>(std::ceil(least_duration * cam.master_speed / recorded.range.cycle)));
  return cam;
}

// Of linear channels, from the beginning of a cycle on.
Log set_points_of(const ProposedCam& cam, const sim::cam::Motion& motion, const machine::AxisModel& axis,
                  double period) {
  Log log;
  log.source = "the next measurement";
  log.period = period;
  auto& channels = log.axes.emplace_back();
  channels.axis = axis.name;
  const double unit = own_unit(axis), cycle = motion.cam.cycle(), w = cam.master_speed;
  const double rise = motion.cam.position_of(motion.cam.segments.size()) - motion.cam.start;
  const auto count = static_cast<std::size_t>(cam.cycles * cycle / (w * period));
  for (std::size_t k = 0; k < count; ++k) {
    const double t = static_cast<double>(k) * period, turned = w * t, gone = std::floor(turned / cycle);
    const double place = std::clamp(turned - gone * cycle, 0.0, cycle);
    log.t.push_back(t);
    channels.x_set.push_back(unit * (motion.curve(place) + gone * rise));
    channels.v_set.push_back(unit * motion.curve.derivative(place, 1) * w);
    channels.a_set.push_back(unit * motion.curve.derivative(place, 2) * w * w);
    channels.master.push_back(place);
  }
  channels.master_speed.assign(count, w);
  channels.x = channels.x_set;
  return log;
}

// m, by which the slave of this log goes on from cycle to cycle.
double on_by(const Log& log) {
  const auto& axis = log.axes.front();
  std::size_t cycle = 1;
  while (cycle < axis.master.size() && axis.master[cycle] >= axis.master[cycle - 1]) ++cycle;
  return axis.x_set[std::min(cycle, axis.x_set.size() - 1)] - axis.x_set.front();
}

// Whether the drive makes it of its integers, as `simulate cam` does.
bool drive_takes(const machine::Machine& setup, const sim::cam::Motion& motion, double master_speed) {
  try {
    const CamSetPoints made(setup.timing, setup.axes.front(), motion, master_speed);
    return true;
  } catch (const machine::ConfigurationError&) {
  } catch (const sim::cam::CamError&) {
  }
  return false;
}

}  // namespace

std::optional<RecordedCam> recorded_cam(const std::vector<Log>& logs, const machine::AxisModel& axis) {
  std::optional<RecordedCam> recorded;
  for (const auto& log : logs) {
    double speed = 0.0;
    const auto range = cam_range_of(log, axis, speed);
    if (!range) continue;
    if (!recorded) recorded = RecordedCam{*range, speed};
    recorded->master_speed = std::max(recorded->master_speed, speed);
  }
  if (recorded && !recorded->range.returns && !axis.modulo) return std::nullopt;
  return recorded;
}

std::vector<Rehearsal> rehearse_cams(const machine::Machine& machine, std::size_t axis, const RecordedCam& recorded,
                                     const LogRows& rows, const SearchContext& context,
                                     const SignalSettings& settings) {
  std::vector<Rehearsal> all;
  if (machine.axes.at(axis).unknown_controller()) return all;
  const auto setup = rehearsal_machine(machine, axis);
  const auto& own = setup.axes.front();
  const auto load = permitted_load(own);
  const double period = rehearsal_period(rows);
  for (const auto& each : sim::cam::separating_cams()) {
    auto cam = proposed_cam(each, recorded, load);
    if (!cam) continue;
    const auto motion = sim::cam::compose(cam->cam);
    if (!drive_takes(setup, motion, cam->master_speed)) continue;
    const auto wanted = set_points_of(*cam, motion, own, period);
    auto one = rehearsed(setup, wanted, context, settings);
    if (!one) continue;
    one->log.axes.front().master = wanted.axes.front().master;
    one->log.axes.front().master_speed = wanted.axes.front().master_speed;
    one->name = fmt::format("{}, rise of {:.4g} deg, {}", cam->law, cam->rise / one_degree, cam->speed);
    one->words = each.words;
    one->cam = std::move(cam);
    all.push_back(std::move(*one));
  }
  return all;
}

std::string cam_words(const ProposedCam& proposed, const Log& log, const ShownUnits& units) {
  const auto& axis = log.axes.front();
  const auto largest = [](const std::vector<double>& values) {
    double most = 0.0;
    for (const double value : values) most = std::max(most, std::abs(value));
    return most;
  };
  const auto [low, high] = std::minmax_element(axis.x_set.begin(), axis.x_set.end());
  const bool returns = !proposed.cam.modulo;
  auto words = fmt::format("The axis rests at {:.3f} {} at the beginning of a cycle, ",
                           units.position(axis.x_set.front()), units.position.unit);
  if (returns)
    words += fmt::format("remains between {:.3f} and {:.3f} {}", units.position(*low), units.position(*high),
                         units.position.unit);
  else
    words += fmt::format("goes on by {:.3f} {} in each", units.position(on_by(log)), units.position.unit);
  words += fmt::format(" and reaches {:.3g} {} and {:.3g} {}.", units.speed(largest(axis.v_set)), units.speed.unit,
                       units.acceleration(largest(axis.a_set)), units.acceleration.unit);
  if (proposed.master_speed > proposed.recorded_speed * (1.0 + 1e-3))
    words += fmt::format(
        " In these records the master turned at {:.3g} rpm at most: make sure that it, and what else it drives, may "
        "turn "
        "faster.",
        proposed.recorded_speed / turn_per_minute);
  return words;
}

}  // namespace stiction::host
