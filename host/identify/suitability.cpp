#include "host/identify/suitability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware/machine/model/motor_force.hpp"
#include "host/identify/fit_support.hpp"
#include "host/log/resolution.hpp"

namespace stiction::host {
namespace {

constexpr double shortest = 2.0;  // s, of all logs: 20 blocks of the shortest length

struct Run {
  std::size_t begin = 0, length = 0;
};
// Of samples in a row at which a condition holds, `least` and more.
template <class Holds>
std::vector<Run> runs_where(std::size_t samples, std::size_t least, Holds&& holds) {
  std::vector<Run> runs;
  for (std::size_t k = 0; k < samples; ++k) {
    const std::size_t begin = k;
    while (k < samples && holds(k)) ++k;
    if (k - begin >= least) runs.push_back({begin, k - begin});
  }
  return runs;
}

struct Signal {
  const std::vector<double>* values;
  const char* name;
  const char* unit;
  double limit;  // of the machine, in the signal's unit
};

Signal driving_signal(const AxisLog& channels, const machine::AxisModel& axis) {
  const bool source = axis.motor.driven_by_volts();
  const double current = axis.inverter.current_limit * axis.motor.count;
  const double none = std::numeric_limits<double>::infinity();
  if (!channels.i.empty() && !source) return {&channels.i, "current", "A", current};
  if (!channels.u.empty() && source) return {&channels.u, "voltage", "V", axis.inverter.voltage_limit};
  return {&channels.force, "force", "N", source ? none : machine::largest_force(axis)};
}

// The speeds at which the axis was kept, sorted: rows of steady sliding, a bin each factor of 1.5, at least 0.1 s in a
// bin and 2 % of all: passing through a speed is not keeping it.
std::vector<double> speeds_of(const LogRows& rows, double highest) {
  constexpr double factor = 1.5, kept = 0.1, share = 0.02;
  const auto sliding = fitting::steady_sliding(rows);
  std::vector<double> time_in, sum_in;
  for (std::size_t log = 0; log < rows.logs().size(); ++log) {
    const std::size_t end = rows.end(log);
    for (std::size_t i = rows.logs()[log]; i < end; ++i) {
      const double v = std::abs(rows.velocity[static_cast<Eigen::Index>(i)]);
      if (sliding[static_cast<Eigen::Index>(i)] == 0.0 || v == 0.0) continue;
      // The filter of the rows may overshoot the highest speed of the samples.
      const double below = std::max(0.0, std::log(highest / v) / std::log(factor));
      const auto bin = static_cast<std::size_t>(std::lround(below));
      if (bin >= time_in.size()) {
        time_in.resize(bin + 1, 0.0);
        sum_in.resize(bin + 1, 0.0);
      }
      time_in[bin] += rows.period(log);
      sum_in[bin] += rows.period(log) * v;
    }
  }
  double total = 0.0;
  for (const double time : time_in) total += time;
  std::vector<double> speeds;
  for (std::size_t bin = time_in.size(); bin-- > 0;)
    if (time_in[bin] >= std::max(kept, share * total)) speeds.push_back(sum_in[bin] / time_in[bin]);
  return speeds;
}

// Whether a flat top is a smooth one, rounded: a parabola of which the top hides no more than two increments keeps the
// next increment for sqrt(3/2) - 1 of the top's time, on both sides together; a limited signal has left it by then.
bool rounded(const std::vector<double>& values, const Run& top, double increment) {
  constexpr double of_parabola = 0.225;
  constexpr std::size_t odd_samples = 2;  // one at each side
  const double next = std::abs(values[top.begin]) - 1.5 * increment;
  std::size_t begin = top.begin, end = top.begin + top.length;
  while (begin > 0 && std::abs(values[begin - 1]) >= next) --begin;
  while (end < values.size() && std::abs(values[end]) >= next) ++end;
  return static_cast<double>(end - begin - top.length + odd_samples) >= of_parabola * static_cast<double>(top.length);
}

// Where the machine's limit is reached.
std::vector<Run> at_limit(const Signal& signal) {
  const auto& values = *signal.values;
  return runs_where(values.size(), 3, [&](std::size_t k) { return std::abs(values[k]) >= 0.999 * signal.limit; });
}

// Flat tops: the largest value, to the digit, many times in a row, in a signal that otherwise changes.
std::vector<Run> flat_tops(const std::vector<double>& values) {
  double largest = 0.0;
  std::size_t repeats = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    largest = std::max(largest, std::abs(values[k]));
    repeats += k > 0 && values[k] == values[k - 1];
  }
  if (2 * repeats >= values.size()) return {};
  auto tops = runs_where(values.size(), 10, [&](std::size_t k) { return std::abs(values[k]) == largest; });
  if (tops.empty()) return tops;
  const double increment = increment_of(values);
  std::erase_if(tops, [&](const Run& top) { return rounded(values, top, increment); });
  return tops;
}

}  // namespace

std::string sources_of(const std::vector<Motion>& motions) {
  std::string all;
  for (const auto& motion : motions) all += (all.empty() ? "" : ", ") + motion.source;
  return all;
}

void require_samples(const Log& log) {
  const double duration = static_cast<double>(log.t.size()) * log.period;
  if (log.t.size() >= 50 && duration > 0.2) return;
  throw LogError(
      fmt::format("{}: found a log of {} samples, {:.3g} s; expected more than 0.2 s and 50 samples. Record "
                  "several reversals at several speeds, {:g} s or more together",
                  log.source, log.t.size(), duration, shortest));
}

void refuse_saturation(const Log& log, const AxisLog& channels, const machine::AxisModel& axis) {
  const auto signal = driving_signal(channels, axis);
  const auto& values = *signal.values;
  const auto refuse = [&](const std::vector<Run>& runs, const std::string& why) {
    if (runs.empty()) return;
    const auto run = std::ranges::max(runs, {}, &Run::length);
    throw LogError(
        fmt::format("{}: found the {} at {:.4g} {} for {:.3g} ms at t = {:.4g} s, {}; expected a {} that is never "
                    "limited, because the log then lacks the force that the motion requires. Record the same motion "
                    "with lower acceleration or speed, or a wider measuring range",
                    log.source, signal.name, std::abs(values[run.begin]), signal.unit,
                    1e3 * static_cast<double>(run.length) * log.period, log.t[run.begin], why, signal.name));
  };
  refuse(at_limit(signal), fmt::format("the limit of {:.4g} {} in the machine file", signal.limit, signal.unit));
  refuse(flat_tops(values), "the same to the last digit");
}

std::vector<bool> saturated(const AxisLog& channels, const machine::AxisModel& axis) {
  const auto signal = driving_signal(channels, axis);
  std::vector<bool> marked(channels.x.size(), false);
  for (const auto& runs : {at_limit(signal), flat_tops(*signal.values)})
    for (const auto& run : runs) std::fill_n(marked.begin() + static_cast<std::ptrdiff_t>(run.begin), run.length, true);
  return marked;
}

const char* name_of_effort(const AxisLog& channels, const machine::AxisModel& axis) {
  return driving_signal(channels, axis).name;
}

void require_motion(const Excitation& e, const std::string& sources) {
  if (e.duration < shortest)
    throw LogError(
        fmt::format("{}: found {:.3g} s; expected at least {:g} s of motion. Record several reversals at "
                    "several speeds",
                    sources, e.duration, shortest));
  if (e.highest_speed == 0.0) throw LogError(fmt::format("{}: found an axis at rest; expected motion", sources));
}

Excitation excitation_of(const LogRows& rows) {
  Excitation e;
  for (const auto& motion : rows.motions())
    for (const double v : motion.v) e.highest_speed = std::max(e.highest_speed, std::abs(v));
  if (rows.rows() > 0) e.highest_acceleration = rows.acceleration.cwiseAbs().maxCoeff();
  for (const auto& motion : rows.motions()) {
    e.duration += static_cast<double>(motion.t.size()) * motion.period;
    // From one side to the other of a hundredth of this log's own highest speed.
    double highest = 0.0, side = 0.0;
    for (const double v : motion.v) highest = std::max(highest, std::abs(v));
    for (const double v : motion.v) {
      if (std::abs(v) <= 0.01 * highest) continue;
      const double now = v > 0.0 ? 1.0 : -1.0;
      if (side * now < 0.0) ++e.reversals;
      side = now;
    }
  }
  if (e.highest_speed > 0.0) e.speeds = speeds_of(rows, e.highest_speed);
  return e;
}

void require_excitation(const Excitation& e, const std::string& sources) {
  require_motion(e, sources);
  if (e.reversals == 0)
    throw LogError(
        fmt::format("{}: found no reversal; expected motion in both directions, without which Coulomb friction cannot "
                    "be separated from a constant force. Record each speed there and back",
                    sources));
  if (e.speeds.size() < 2)
    throw LogError(
        fmt::format("{}: found {}; expected at least two, a factor 1.5 apart and each for 0.1 s, without which viscous "
                    "friction cannot be separated from Coulomb friction. Record constant speeds from a few mm/s up to "
                    "the highest, each both ways",
                    sources,
                    e.speeds.empty() ? std::string("no speed kept for 0.1 s")
                                     : fmt::format("one speed only, {:.3g} mm/s", e.speeds.front() * 1e3)));
}

void refuse_swapped_sign(const LogRows& rows) {
  double power = 0.0, either_way = 0.0;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    power += rows.force[i] * rows.velocity[i];
    either_way += std::abs(rows.force[i] * rows.velocity[i]);
  }
  if (power >= -0.1 * either_way) return;
  throw LogError(
      fmt::format("{}: found a force that pushes where friction must brake: the motor absorbs {:.3g} J from the "
                  "motion; expected force and position positive in the same direction. The sign of one of them is "
                  "swapped: reverse the current or the position in the record",
                  sources_of(rows.motions()), -power * rows.period(0)));
}

}  // namespace stiction::host
