#include "host/diagnose/judge/encoder_difference.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/diagnose/record/moved_values.hpp"
#include "host/identify/identification.hpp"

namespace stiction::host {
namespace {

constexpr double above_mode = 3.0;  // of the load's frequency on its shaft: there a twist is an eighth
// Of the greatest force: where it is less than this share the side of a play is not known.
constexpr double no_side = 0.02;

bool on_both_sides(const machine::AxisModel& axis) {
  return axis.elastic() && axis.second_encoder && axis.second_encoder->on != axis.encoder.on;
}

std::vector<double> sides_of(const std::vector<double>& values) {
  double greatest = 1e-300;
  for (const double value : values) greatest = std::max(greatest, std::abs(value));
  auto side = values;
  for (double& value : side) value = std::clamp(value / (no_side * greatest), -1.0, 1.0);
  return side;
}

// The motor by itself, as an axis.
machine::AxisModel motor_alone(machine::AxisModel axis) {
  axis.mass = axis.motor_mass;
  axis.effects.clear();
  if (axis.motor_friction) axis.friction = *axis.motor_friction;
  return axis;
}

std::vector<double> force_through_shaft(const machine::AxisModel& axis, const Motion& motor) {
  auto force = motor.force;
  const auto alone = motor_alone(axis);
  std::vector<double> friction(force.size(), 0.0);
  if (axis.motor_friction) friction = friction_along(alone, motor);
  for (std::size_t i = 0; i < force.size(); ++i) force[i] -= axis.motor_mass * motor.a[i] + friction[i];
  const double lag = axis.transmission->damping.value_or(0.0) / *axis.transmission->stiffness;  // s
  if (lag == 0.0) return force;
  const auto rate = rate_over(force, motor.period);
  for (std::size_t i = 0; i < force.size(); ++i) force[i] -= lag * rate[i];
  return force;
}

// The load by itself.
machine::AxisModel load_alone(machine::AxisModel axis) {
  axis.mass -= axis.motor_mass;
  axis.transmission->stiffness.reset();
  return axis;
}

double mean_square_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return sum / static_cast<double>(values.size());
}

// Whether the load tells the force through the shaft better than the motor does. What the inverse dynamics of the motor
// is off by goes with the force itself, and a slope is off by as much; noise of the load's acceleration is in the slope
// by its square alone.
bool load_is_better(const machine::AxisModel& axis, const std::vector<double>& by_load, const Motion& motor,
                    double period, const SignalSettings& settings) {
  const auto& further = *axis.second_encoder;
  const bool second = further.on == machine::EncoderPlace::load;
  const double increment = second ? further.increment : axis.encoder.increment;
  const double noise = std::hypot(second ? further.noise : axis.encoder.noise, increment / std::sqrt(12.0));
  const double band = settings.band > 0.0 ? settings.band : settings.cutoff;
  // Of white noise of the position, twice differentiated, up to the end of the band.
  const double acceleration = noise * std::pow(2.0 * std::numbers::pi * band, 2) * std::sqrt(0.4 * period * band);
  const double force = mean_square_of(by_load), of_load = (axis.mass - axis.motor_mass) * acceleration;
  return of_load * of_load / force < resolution_of_dynamics * std::sqrt(mean_square_of(motor.force) / force);
}

// The rows of the shaft's own band: above its load's frequency a twist falls off with the square, and noise of
// accelerations grows with it.
SignalSettings around_mode(SignalSettings settings, const machine::AxisModel& axis) {
  const double mode =
      std::sqrt(*axis.transmission->stiffness / (axis.mass - axis.motor_mass)) / (2.0 * std::numbers::pi);
  const double band = settings.band > 0.0 ? settings.band : settings.cutoff;
  settings.band = std::min(band, above_mode * mode);
  settings.cutoff = std::min(settings.cutoff, 2.0 * settings.band);
  return settings;
}

}  // namespace

EncoderDifference::EncoderDifference(const std::vector<Log>& logs, const machine::AxisModel& axis,
                                     const SignalSettings& settings) {
  const bool first_on_motor = axis.encoder.on == machine::EncoderPlace::motor;
  std::vector<Motion> motions;
  std::vector<std::vector<double>> ahead;
  for (const auto& log : logs) {
    const auto& channels = channels_of(log, axis);
    const auto first = shown_earlier(channels.x, axis.encoder.delay / log.period);
    const auto second = shown_earlier(channels.x_load, axis.second_encoder->delay / log.period);
    const auto &motor = first_on_motor ? first : second, &load = first_on_motor ? second : first;
    auto of_motor = channels;
    of_motor.x = motor;
    of_motor.v.clear();
    motions.push_back(motion_of(log, of_motor, axis, Amperes::amplitude, settings));
    auto of_load = of_motor;
    of_load.x = load;
    auto by_load = force_along(load_alone(axis), motion_of(log, of_load, axis, Amperes::amplitude, settings));
    const bool better = load_is_better(axis, by_load, motions.back(), log.period, settings);
    runs_.push_back(
        ShaftRun{axis, better ? std::move(by_load) : force_through_shaft(axis, motions.back()), motor, load});
    ahead.emplace_back();
    for (std::size_t i = 0; i < motor.size(); ++i) ahead.back().push_back(load[i] - motor[i]);
  }
  rows_ = LogRows(std::move(motions), settings);
  measured_ = stacked(ahead);
}

Eigen::VectorXd EncoderDifference::stacked(const std::vector<std::vector<double>>& of_each) const {
  return rows_.stacked(
      [&](const Motion& motion) { return of_each[static_cast<std::size_t>(&motion - rows_.motions().data())]; });
}

Eigen::VectorXd EncoderDifference::beyond_file(const machine::AxisModel& axis) const {
  std::vector<std::vector<double>> file;
  for (const auto& run : runs_) {
    const auto side = sides_of(run.force);
    file.emplace_back(run.force.size());
    for (std::size_t i = 0; i < side.size(); ++i)
      file.back()[i] = run.force[i] / *axis.transmission->stiffness + 0.5 * axis.transmission->backlash * side[i];
  }
  return measured_ + stacked(file);
}

Eigen::VectorXd EncoderDifference::force() const {
  std::vector<std::vector<double>> all;
  for (const auto& run : runs_) all.push_back(run.force);
  return stacked(all);
}

Eigen::VectorXd EncoderDifference::load() const {
  return rows_.sampled(
      [&](const Motion& motion) { return runs_[static_cast<std::size_t>(&motion - rows_.motions().data())].load; });
}

std::vector<Eigen::VectorXd> EncoderDifference::columns(const EncoderCause& cause, double shape) const {
  return rows_.stacked_together([&](const Motion& motion) {
    return cause.columns(runs_[static_cast<std::size_t>(&motion - rows_.motions().data())], shape);
  });
}

std::optional<EncoderDifference> EncoderDifference::of(const Record& record, const machine::AxisModel& axis,
                                                       const SignalSettings& settings) {
  const auto has_both = [&](const Log& log) { return !channels_of(log, axis).x_load.empty(); };
  if (!on_both_sides(axis) || !std::ranges::all_of(record.logs, has_both)) return std::nullopt;
  const auto own = around_mode(settings, axis);
  EncoderDifference measured(record.logs, axis, own);
  measured.target_ = measured.beyond_file(axis);
  if (record.simulated.size() == record.logs.size() && std::ranges::all_of(record.simulated, has_both))
    measured.target_ -= EncoderDifference(record.simulated, axis, own).beyond_file(axis);
  const auto& rows = measured.rows_;
  for (std::size_t k = 0; k < rows.logs().size(); ++k) {
    const auto& motion = rows.motions()[k];
    measured.nuisances_.push_back(rows.of_log(k, std::vector<double>(motion.x.size(), 1.0)));
    measured.nuisances_.push_back(rows.of_log(k, motion.t));
  }
  std::vector<std::vector<double>> direction, side, rate, of_motor;
  for (std::size_t k = 0; k < rows.logs().size(); ++k) {
    const auto& motion = rows.motions()[k];
    direction.push_back(sides_of(motion.v));
    side.push_back(sides_of(measured.runs_[k].force));
    rate.push_back(rate_over(measured.runs_[k].force, motion.period));
    of_motor.push_back(rate_over(motion.force, motion.period));
  }
  measured.nuisances_.push_back(rows.velocity);
  for (const auto* each : {&direction, &side, &rate, &of_motor}) measured.nuisances_.push_back(measured.stacked(*each));
  return measured;
}

}  // namespace stiction::host
