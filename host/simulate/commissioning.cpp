#include "host/simulate/commissioning.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "firmware/machine/configuration/double_signals.hpp"
#include "firmware/machine/model/motor_force.hpp"
#include "host/log/own_units.hpp"
#include "host/simulate/replay.hpp"
#include "host/simulate/starts.hpp"
#include "sim/experiment/commissioning_path.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

constexpr double period = 1e-3;         // s, of the log
constexpr double current_noise = 0.03;  // A rms

// Sizes of a rotary axis in those of the linear one that the records were planned for: its travel, its highest planned
// speed, its motor.
constexpr double planned_travel = 0.5;         // m
constexpr double planned_speed = 24.0 / 60.0;  // m/s
constexpr double planned_force = 6594.0;       // N
constexpr double planned_current = 70.0;       // A, or V of a force source
struct Scale {
  double length = 1.0, speed = 1.0, force = 1.0, effort = 1.0;
};

constexpr double speed_share = 0.9;                                       // of what the axis can do at most
constexpr double stroke_share = 0.9;                                      // of the travel
constexpr double smallest_reversal = 5e-6;                                // m, of the planned ones
constexpr double largest_reversal = 400e-6, largest_reversal_rate = 1.5;  // m, Hz
constexpr double least_counts = 20.0;  // of the encoder that the smallest reversal of a rotary axis has

// N, of a motor that has limits; without them what its axis needs for the largest acceleration.
double force_of(const machine::AxisModel& axis) {
  const bool limited = std::min(axis.inverter.current_limit, axis.inverter.voltage_limit) < machine::unlimited;
  return limited ? machine::largest_force(axis) : axis.mass * axis.max_acceleration;
}

Scale scale_of(const machine::AxisModel& axis) {
  if (!axis.coordinate.rotary()) return {};
  const double force = force_of(axis);
  return {axis.travel / planned_travel, speed_share * axis.max_velocity / planned_speed, force / planned_force,
          force / machine::acting_force_constant(axis.motor) / planned_current};
}

std::vector<double> times(double factor, std::vector<double> values) {
  for (double& v : values) v *= factor;
  return values;
}

std::vector<double> per_second(std::vector<double> metres_per_minute, const Scale& scale) {
  for (double& v : metres_per_minute) v /= 60.0;
  return scale.speed == 1.0 ? metres_per_minute : times(scale.speed, std::move(metres_per_minute));
}

// The speeds (m/s), all of them slower by one factor where the axis cannot do the highest.
sim::Trajectory speeds_on(const machine::AxisModel& axis, std::vector<double> speeds, double cruise, double shortest) {
  const auto start = start_on(axis);
  const double highest = *std::max_element(speeds.begin(), speeds.end());
  const double allowed =
      std::min(highest, sim::speed_within(stroke_share * axis.travel, speed_share * axis.max_velocity, cruise, start));
  if (allowed < highest)
    for (double& v : speeds) v *= allowed / highest;
  return sim::constant_speeds(speeds, cruise, shortest, start);
}

// The circle at `feed` (m/s), smaller and slower where the axis needs it.
sim::Trajectory circle_on(const machine::AxisModel& axis, double feed, double turns) {
  sim::CircleSettings settings;
  const auto start = start_on(axis);
  const auto scale = scale_of(axis);
  settings.radius *= scale.length;
  feed *= scale.speed;
  settings.acceleration = start.acceleration;
  settings.jerk = start.jerk;
  settings.radius = std::min(settings.radius, 0.5 * stroke_share * axis.travel);
  settings.feed = std::min(
      {feed, speed_share * axis.max_velocity, std::sqrt(acceleration_share * axis.max_acceleration * settings.radius)});
  return sim::circle(settings, turns);
}

// Factor of the planned small reversals: an encoder of a rotary axis has to see the smallest one, as far as the axis
// can do the largest.
double reversal_scale(const machine::AxisModel& axis) {
  const auto scale = scale_of(axis);
  if (!axis.coordinate.rotary()) return scale.length;
  const double turn = 2.0 * std::numbers::pi * largest_reversal_rate;
  const double can = std::min({stroke_share * axis.travel / (2.0 * largest_reversal),
                               speed_share * axis.max_velocity / (turn * largest_reversal),
                               acceleration_share * axis.max_acceleration / (turn * turn * largest_reversal)});
  return std::max(scale.length, std::min(can, least_counts * axis.encoder.increment / smallest_reversal));
}

struct Planned {
  const char* name;
  bool held_out;
  sim::Trajectory trajectory;
};

std::vector<Planned> plan(const machine::AxisModel& axis) {
  const auto scale = scale_of(axis);
  const auto speeds = [&](std::vector<double> list) { return per_second(std::move(list), scale); };
  const double reversal = reversal_scale(axis);
  const auto amplitudes = [&](std::vector<double> list) { return times(reversal, std::move(list)); };
  std::vector<Planned> all;
  all.push_back({"speeds", false,
                 speeds_on(axis, speeds({0.05, 0.2, 0.5, 1.0, 3.2, 8.0, 16.0, 24.0}), 0.3, scale.length * 0.4e-3)});
  all.push_back({"circle", false, circle_on(axis, 16.0 / 60.0, 2.0)});
  all.push_back({"reversals", false,
                 sim::small_reversals(amplitudes({smallest_reversal, 10e-6, 20e-6, 50e-6, 100e-6, 200e-6}), 2.0)});
  all.push_back(
      {"other-speeds", true, speeds_on(axis, speeds({0.1, 0.35, 1.5, 5.0, 12.0, 20.0}), 0.4, scale.length * 0.6e-3)});
  all.push_back({"other-circle", true, circle_on(axis, 10.0 / 60.0, 2.0)});
  all.push_back({"other-reversals", true, sim::small_reversals(amplitudes({8e-6, 30e-6, 80e-6, 150e-6, 400e-6}), 1.5)});
  return all;
}

// Standard normal numbers by Box and Muller; those of the library differ from one to another.
class Normal {
 public:
  explicit Normal(std::uint64_t seed) : random_(seed) {}
  double operator()() {
    const double radius = std::sqrt(-2.0 * std::log1p(-even()));
    return radius * std::cos(2.0 * std::numbers::pi * even());
  }

 private:
  double even() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  std::mt19937_64 random_;
};

// First-order low-pass of white noise.
class Coloured {
 public:
  Coloured(double rms, double corner, double step)
      : keep_(std::exp(-2.0 * std::numbers::pi * corner * step)), rms_(rms) {}
  double next(Normal& normal) {
    value_ = keep_ * value_ + rms_ * std::sqrt(1.0 - keep_ * keep_) * normal();
    return value_;
  }

 private:
  double keep_, rms_, value_ = 0.0;
};

Log set_points(const Planned& planned, const std::string& axis) {
  Log log;
  log.source = planned.name;
  log.period = period;
  auto& channels = log.axes.emplace_back();
  channels.axis = axis;
  const auto count = static_cast<int>(planned.trajectory.duration / period);
  for (int k = 0; k < count; ++k) {
    const auto point = planned.trajectory.at(k * period);
    log.t.push_back(k * period);
    channels.x_set.push_back(point.position);
    channels.v_set.push_back(point.velocity);
    channels.a_set.push_back(point.acceleration);
    channels.x.push_back(point.position);
  }
  return log;
}

// `bench`: of that axis alone.
Log recorded(const machine::Machine& bench, Log wanted, Normal& normal) {
  const auto& axis = bench.axes.front();
  const auto scale = scale_of(axis);
  Coloured slow(scale.force * 2.5, 3.0, wanted.period), fast(scale.force * 2.0, 40.0, wanted.period);  // N, Hz
  auto& push = wanted.axes.front().external_force;
  push.clear();
  for (std::size_t k = 0; k < wanted.t.size(); ++k) push.push_back(slow.next(normal) + fast.next(normal));
  wanted.axes.front() = in_own_units(std::move(wanted.axes.front()), axis.coordinate);
  auto log = bench.fits_formats() ? replay<FixedSignals>(bench, wanted) : replay<machine::DoubleSignals>(bench, wanted);
  auto& channels = log.axes.front();
  AxisLog kept;
  kept.axis = channels.axis;
  kept.rotary = channels.rotary;
  kept.x_set = std::move(channels.x_set);
  kept.v_set = std::move(channels.v_set);
  kept.a_set = std::move(channels.a_set);
  kept.x = std::move(channels.x);
  kept.phase = std::move(channels.phase);
  kept.turn = channels.turn;
  kept.i = std::move(channels.i);
  for (double& i : kept.i) i += scale.effort * current_noise * normal();
  kept.u = std::move(channels.u);  // of a force source; the drive knows what it commands
  channels = std::move(kept);
  return log;
}

machine::Machine alone(const machine::Machine& machine, std::size_t axis) {
  auto bench = machine;
  bench.axes = {machine.axes.at(axis)};
  return bench;
}

}  // namespace

Log record_set_points(const machine::Machine& machine, std::size_t axis, const Log& set_points, std::uint64_t seed) {
  Normal normal(seed);
  return recorded(alone(machine, axis), set_points, normal);
}

std::vector<CommissioningRecord> record_commissioning(const machine::Machine& machine, std::size_t axis,
                                                      std::uint64_t seed, const std::function<void()>& progress) {
  const auto bench = alone(machine, axis);
  Normal normal(seed);
  std::vector<CommissioningRecord> records;
  for (const auto& planned : plan(bench.axes.front())) {
    records.push_back(
        {planned.name, planned.held_out, recorded(bench, set_points(planned, bench.axes.front().name), normal)});
    if (progress) progress();
  }
  return records;
}

}  // namespace stiction::host
