#include "host/cam/duty.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/cam/quadrature.hpp"

namespace stiction::host {
namespace {

using sim::cam::Extremes;
using sim::cam::Motion;
using sim::cam::Peak;
using sim::cam::Piece;

// Samples of a piece between which the motor's torque has no two peaks.
constexpr int samples_of_piece = 128;

Peak larger(const Extremes& extremes) {
  return std::fabs(extremes.lowest.value) > std::fabs(extremes.highest.value) ? extremes.lowest : extremes.highest;
}

double effort_at(const Piece& piece, const AxisLoad& load, double w, double x) {
  return load.effort(piece.derivative(x, 0), piece.derivative(x, 1) * w, piece.derivative(x, 2) * w * w);
}

// The largest magnitude of `function` around the sample `x`, by thirds of the interval around it.
template <class Function>
Peak refined(const Function& function, double low, double high) {
  for (int k = 0; k < 80; ++k) {
    const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
    (std::fabs(function(a)) < std::fabs(function(b)) ? low : high) =
        std::fabs(function(a)) < std::fabs(function(b)) ? a : b;
  }
  const double x = 0.5 * (low + high);
  return {function(x), x};
}

// The largest magnitude of a function of piece and place over the whole motion.
template <class Function>
Peak largest(const Motion& motion, const Function& function) {
  Peak best;
  const auto include = [&](const Peak& peak) {
    if (std::fabs(peak.value) > std::fabs(best.value)) best = peak;
  };
  for (const Piece& piece : motion.curve.pieces()) {
    const auto at = [&](double x) { return function(piece, x); };
    const double step = piece.length() / samples_of_piece;
    int top = 0;
    for (int k = 1; k <= samples_of_piece; ++k)
      if (std::fabs(at(piece.begin + step * k)) > std::fabs(at(piece.begin + step * top))) top = k;
    include({at(piece.begin + step * top), piece.begin + step * top});
    include(
        refined(at, piece.begin + step * std::max(top - 1, 0), std::min(piece.begin + step * (top + 1), piece.end)));
  }
  return best;
}

// The integral over a cycle of a function of piece and place.
template <class Function>
double over_cycle(const Motion& motion, const Function& function) {
  double sum = 0.0;
  for (const Piece& piece : motion.curve.pieces())
    for (int k = 0; k < 16; ++k)
      sum += sim::cam::integral([&](double x) { return function(piece, x); }, piece.begin + piece.length() * k / 16,
                                piece.begin + piece.length() * (k + 1) / 16);
  return sum;
}

EffortFigures effort_of(const Motion& motion, const AxisLoad& load, double w) {
  EffortFigures figures;
  const auto scaled = [](Peak peak, double factor) { return Peak{peak.value * factor, peak.place}; };
  figures.load = scaled(larger(extremes(motion.curve, 2)), load.load * w * w);
  figures.cam = scaled(larger(torque_extremes(motion.curve)), load.load * w * w);
  const auto effort = [&](const Piece& piece, double x) { return effort_at(piece, load, w, x); };
  const auto power = [&](const Piece& piece, double x) { return effort(piece, x) * piece.derivative(x, 1) * w; };
  figures.motor = largest(motion, effort);
  figures.peak_power = std::fabs(largest(motion, power).value);
  const double cycle = motion.curve.length();
  figures.motor_rms =
      std::sqrt(over_cycle(motion, [&](const Piece& p, double x) { return effort(p, x) * effort(p, x); }) / cycle);
  figures.energy = over_cycle(motion, power) / w;
  figures.cam_power = std::fabs(figures.cam.value) * w;
  return figures;
}

// The highest speed of the master at which the motor's torque keeps its limit.
double highest_for_effort(const Motion& motion, const AxisLoad& load) {
  const auto keeps = [&](double w) {
    const auto peak = largest(motion, [&](const Piece& piece, double x) { return effort_at(piece, load, w, x); });
    return std::fabs(peak.value) <= load.largest_effort;
  };
  if (!keeps(0.0)) return 0.0;
  double low = 0.0, high = 1e-3;
  while (keeps(high)) {
    low = high;
    high *= 2.0;
    if (high > 1e9) return std::numeric_limits<double>::infinity();
  }
  for (int k = 0; k < 50; ++k) {
    const double middle = 0.5 * (low + high);
    (keeps(middle) ? low : high) = middle;
  }
  return low;
}

std::vector<Limit> limits_of(const Motion& motion, const AxisLoad& load, const Duty& duty) {
  constexpr double any = std::numeric_limits<double>::infinity();
  std::vector<Limit> limits;
  const std::string unit = load.unit(), effort = load.effort_unit();
  const auto finite = [](double value) { return std::isfinite(value); };
  if (finite(load.travel)) {
    const auto& range = duty.extremes[0];
    const double found = range.highest.value - range.lowest.value;
    limits.push_back({"travel", unit, found, load.travel, range.highest.place, found <= load.travel ? any : 0.0});
  }
  const Peak speed = larger(duty.extremes[1]), acceleration = larger(duty.extremes[2]);
  const double w = duty.master_speed;
  const auto reach = [&](double allowed, double found, bool squared) {
    if (found == 0.0) return any;
    return w * (squared ? std::sqrt(allowed / found) : allowed / found);
  };
  const double v = std::fabs(speed.value), a = std::fabs(acceleration.value);
  if (finite(load.max_speed))
    limits.push_back({"speed", unit + "/s", v, load.max_speed, speed.place, reach(load.max_speed, v, false)});
  if (finite(load.max_acceleration))
    limits.push_back({"acceleration", unit + "/s^2", a, load.max_acceleration, acceleration.place,
                      reach(load.max_acceleration, a, true)});
  if (finite(load.largest_effort))
    limits.push_back({load.kind == sim::cam::Coordinate::rotary ? "motor torque" : "motor force", effort,
                      std::fabs(duty.effort.motor.value), load.largest_effort, duty.effort.motor.place,
                      highest_for_effort(motion, load)});
  return limits;
}

}  // namespace

bool Duty::broken() const {
  return std::any_of(limits.begin(), limits.end(), [](const Limit& limit) { return limit.broken(); });
}

double Duty::highest_speed() const {
  double highest = std::numeric_limits<double>::infinity();
  for (const Limit& limit : limits) highest = std::min(highest, limit.highest_speed);
  return highest;
}

Duty duty_of(const Motion& motion, double master_speed) {
  Duty duty;
  duty.master_speed = master_speed;
  double factor = 1.0;
  for (int order = 0; order < 4; ++order, factor *= master_speed) {
    auto& found = duty.extremes[static_cast<std::size_t>(order)];
    found = extremes(motion.curve, order);
    found.lowest.value *= factor;
    found.highest.value *= factor;
  }
  return duty;
}

Duty duty_of(const Motion& motion, const AxisLoad& load, double master_speed) {
  Duty duty = duty_of(motion, master_speed);
  duty.effort = effort_of(motion, load, master_speed);
  duty.limits = limits_of(motion, load, duty);
  return duty;
}

}  // namespace stiction::host
