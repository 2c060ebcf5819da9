#include "host/simulate/commissioning.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "host/simulate/replay.hpp"
#include "sim/experiment/commissioning_path.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

constexpr double period = 1e-3;         // s, of the log
constexpr double current_noise = 0.03;  // A rms

constexpr double speed_share = 0.9;  // of what the axis can do at most
constexpr double acceleration_share = 0.9;
constexpr double stroke_share = 0.9;  // of the travel

std::vector<double> per_second(std::vector<double> metres_per_minute) {
  for (double& v : metres_per_minute) v /= 60.0;
  return metres_per_minute;
}

// The start of a motion as far as the axis can.
sim::Dynamics start_on(const machine::AxisModel& axis) {
  auto start = sim::standard_start;
  const double highest = acceleration_share * axis.max_acceleration;
  if (start.acceleration > highest) start = {highest, start.jerk * highest / start.acceleration};
  return start;
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
  settings.acceleration = start.acceleration;
  settings.jerk = start.jerk;
  settings.radius = std::min(settings.radius, 0.5 * stroke_share * axis.travel);
  settings.feed = std::min(
      {feed, speed_share * axis.max_velocity, std::sqrt(acceleration_share * axis.max_acceleration * settings.radius)});
  return sim::circle(settings, turns);
}

struct Planned {
  const char* name;
  bool held_out;
  sim::Trajectory trajectory;
};

std::vector<Planned> plan(const machine::AxisModel& axis) {
  std::vector<Planned> all;
  all.push_back(
      {"speeds", false, speeds_on(axis, per_second({0.05, 0.2, 0.5, 1.0, 3.2, 8.0, 16.0, 24.0}), 0.3, 0.4e-3)});
  all.push_back({"circle", false, circle_on(axis, 16.0 / 60.0, 2.0)});
  all.push_back({"reversals", false, sim::small_reversals({5e-6, 10e-6, 20e-6, 50e-6, 100e-6, 200e-6}, 2.0)});
  all.push_back({"other-speeds", true, speeds_on(axis, per_second({0.1, 0.35, 1.5, 5.0, 12.0, 20.0}), 0.4, 0.6e-3)});
  all.push_back({"other-circle", true, circle_on(axis, 10.0 / 60.0, 2.0)});
  all.push_back({"other-reversals", true, sim::small_reversals({8e-6, 30e-6, 80e-6, 150e-6, 400e-6}, 1.5)});
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
  Coloured slow(2.5, 3.0, wanted.period), fast(2.0, 40.0, wanted.period);  // N, Hz
  auto& push = wanted.axes.front().external_force;
  push.clear();
  for (std::size_t k = 0; k < wanted.t.size(); ++k) push.push_back(slow.next(normal) + fast.next(normal));
  auto log = replay<FixedSignals>(bench, wanted);
  auto& channels = log.axes.front();
  AxisLog kept;
  kept.axis = channels.axis;
  kept.x_set = std::move(channels.x_set);
  kept.v_set = std::move(channels.v_set);
  kept.a_set = std::move(channels.a_set);
  kept.x = std::move(channels.x);
  kept.i = std::move(channels.i);
  for (double& i : kept.i) i += current_noise * normal();
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
