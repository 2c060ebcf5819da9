#include "host/diagnose/record/elastic_mode.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <functional>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "firmware/machine/model/motor_force.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/identify/filter.hpp"

namespace stiction::host {
namespace {

using Complex = std::complex<double>;

double radians(const ElasticMode& mode) { return 2.0 * std::numbers::pi * mode.frequency; }

std::vector<double> inertia(const machine::AxisModel& axis, const Motion& motion) {
  std::vector<double> force(motion.a.size());
  for (std::size_t i = 0; i < force.size(); ++i) force[i] = axis.mass * motion.a[i];
  return force;
}

// `values` at a `period` (s), as a filter with this `response` (of s) leaves them that holds back what is constant or
// grows evenly. What the ends differ by is taken off as a line: the transform's record closes upon itself.
std::vector<double> filtered(const std::vector<double>& values, double period,
                             const std::function<Complex(Complex)>& response) {
  const std::size_t count = values.size();
  if (count < 2) return std::vector<double>(count, 0.0);
  std::size_t points = 1;
  while (points < 2 * count) points *= 2;
  std::vector<double> padded(points, 0.0);
  const double slope = (values.back() - values.front()) / static_cast<double>(count - 1);
  for (std::size_t i = 0; i < count; ++i) padded[i] = values[i] - values.front() - slope * static_cast<double>(i);
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<Complex> spectrum;
  fft.fwd(spectrum, padded);
  for (std::size_t k = 0; k < spectrum.size(); ++k)
    spectrum[k] *=
        response({0.0, 2.0 * std::numbers::pi * static_cast<double>(k) / (static_cast<double>(points) * period)});
  spectrum.back() = spectrum.back().real();
  fft.inv(padded, spectrum, static_cast<Eigen::Index>(points));
  padded.resize(count);
  return padded;
}

// The deviations from the simulated motion, in which carriage and drive are at rest: x of the measured part, z of the
// other one against it. Forces are over the whole mass; the motor's deviation is -C x. Integrated by the semi-implicit
// Euler method, velocities before places.
class ModeInLoop {
 public:
  ModeInLoop(const ElasticMode& mode, const machine::AxisModel& axis, const Motion& motion)
      : mode_(mode), period_(motion.period), viscous_(viscous_of(axis) / axis.mass), contact_(motion.t.size()) {
    const double w = radians(mode), own = mode.mass_ratio, other = 1.0 - own;
    stiffness_ = own * other * w * w;
    damping_ = 2.0 * mode.damping_ratio * own * other * w;
    const auto& velocity = axis.velocity_controller;
    const double gain = velocity.gain * machine::acting_force_constant(axis.motor) / axis.mass;
    const double reset = velocity.integral_time ? 1.0 / *velocity.integral_time : 0.0;
    of_speed_ = gain;
    of_place_ = gain * (axis.position_controller.gain + reset);
    of_sum_ = gain * axis.position_controller.gain * reset;
    // Of the fastest of what it integrates, in a step.
    constexpr double turn = 0.25;
    const auto contact = contact_of(axis);
    const double length = contact ? contact->distance / std::numbers::ln10 : 0.0;
    const double contact_stiffness = contact ? coulomb_of(axis) / length / axis.mass : 0.0;
    const double rate = std::max(
        {w / std::sqrt(std::min(own, other)), std::sqrt(2.0 * contact_stiffness / own), gain / own, 1.0 / period_});
    steps_ = static_cast<int>(std::ceil(period_ * rate / turn));
    contact_seen_ = contact.has_value();
    const auto level = contact_level(axis, motion);
    double highest = 0.0;
    for (const double v : motion.v) highest = std::max(highest, std::abs(v));
    for (std::size_t i = 0; i < contact_.size(); ++i) {
      const double v = motion.v[i];
      if (contact)
        contact_[i] = {contact_stiffness * (1.0 - level[i] * (v > 0.0   ? 1.0
                                                              : v < 0.0 ? -1.0
                                                                        : 0.0)),
                       std::abs(v) / length, false};
      else
        contact_[i].holds = std::abs(v) < rests_below * highest;
    }
  }

  // Of the residual force of a record, over the mass: -C x - x'' less the friction that the record's motion shows. `a`
  // and `f`: acceleration of the simulated motion and load over the mass, m/s^2; empty: none. Empty where it grows
  // without bound.
  std::vector<double> residual(const std::vector<double>& a, const std::vector<double>& f) const {
    std::vector<double> force(contact_.size()), place(contact_.size());
    const auto at = [](const std::vector<double>& values, std::size_t i, double part) {
      return values.empty() ? 0.0 : i + 1 == values.size() ? values[i] : values[i] + part * (values[i + 1] - values[i]);
    };
    const double own = mode_.mass_ratio, other = 1.0 - own, step = period_ / steps_;
    double x = 0.0, v = 0.0, sum = 0.0, z = 0.0, rate = 0.0, friction = 0.0;
    // The motor's lead in what it holds already.
    if (!mode_.motor_measured) z = (own * at(a, 0, 0.0) + at(f, 0, 0.0)) / stiffness_;
    for (std::size_t i = 0; i < force.size(); ++i)
      for (int k = 0; k < steps_; ++k) {
        const double part = static_cast<double>(k) / steps_, needed = at(a, i, part), load = at(f, i, part);
        const double drive = of_speed_ * v + of_place_ * x + of_sum_ * sum;
        const double spring = stiffness_ * z + damping_ * rate;
        const double held = friction + viscous_ * v;
        double change = mode_.motor_measured ? (other * needed - drive + spring - held) / own
                                             : (spring - load - held) / own - needed;
        if (contact_[i].holds) v = change = 0.0;
        const double of_other = mode_.motor_measured ? -spring / other : (needed + load - drive - spring) / other;
        if (k == 0) force[i] = -drive - (contact_seen_ ? held : 0.0), place[i] = x;
        rate += step * (of_other - needed - change);
        v += step * change;
        friction = (friction + step * contact_[i].stiffness * v) / (1.0 + step * contact_[i].forgets);
        z += step * rate, x += step * v, sum += step * x;
        if (!(std::abs(x) < without_bound)) return {};
      }
    const auto acceleration = central_difference(central_difference(place, period_, 7), period_, 7);
    for (std::size_t i = 0; i < force.size(); ++i) force[i] -= acceleration[i];
    return force;
  }

 private:
  static constexpr double rests_below = 1e-3;   // of the highest speed
  static constexpr double without_bound = 1e3;  // m

  // Of friction along the simulated motion: Dahl's law (1968) linearised there, of the file's level and distance; a law
  // without a contact holds what rests.
  struct Contact {
    double stiffness = 0.0;  // 1/s^2, over the mass
    double forgets = 0.0;    // 1/s
    bool holds = false;
  };
  ElasticMode mode_;
  double period_, viscous_;              // s, 1/s
  double stiffness_, damping_;           // 1/s^2, 1/s
  double of_speed_, of_place_, of_sum_;  // C: 1/s, 1/s^2, 1/s^3
  int steps_;                            // in a period
  std::vector<Contact> contact_;
  bool contact_seen_ = false;  // in the friction that a residual is less
};

}  // namespace

std::vector<std::vector<double>> mode_columns(const ElasticMode& mode, const machine::AxisModel& axis,
                                              const Motion& motion, const std::vector<double>& load) {
  const double w = radians(mode);
  const auto response = [&](Complex s) {
    const Complex stiff = w * w + 2.0 * mode.damping_ratio * w * s;
    return mode.motor_measured ? -(1.0 - mode.mass_ratio) * s * s / (s * s + mode.mass_ratio * stiff) : s * s / stiff;
  };
  std::vector<std::vector<double>> columns{filtered(inertia(axis, motion), motion.period, response)};
  if (!mode.motor_measured) columns.push_back(filtered(load, motion.period, response));
  return columns;
}

std::vector<std::vector<double>> mode_columns_in_loop(const ElasticMode& mode, const machine::AxisModel& axis,
                                                      const Motion& motion, const std::vector<double>& load) {
  const ModeInLoop loop(mode, axis, motion);
  const auto column = [&](const std::vector<double>& a, const std::vector<double>& f, double times) {
    auto force = loop.residual(a, f);
    force.resize(motion.t.size(), 0.0);
    for (double& value : force) value *= times;
    return force;
  };
  // Within an increment an axis at rest hunts, in a record at other instants than in its simulation.
  constexpr double hunts_at = 100.0;  // Hz, at most
  const double increment = std::max(axis.encoder.increment, axis.position_controller.increment);
  const double hunting = 2.0 * std::numbers::pi * hunts_at * increment;
  auto acceleration = motion.a;
  for (std::size_t i = 0; i < acceleration.size(); ++i)
    if (std::abs(motion.v[i]) < hunting) acceleration[i] = 0.0;
  std::vector<std::vector<double>> columns{column(acceleration, {}, axis.mass)};
  if (!mode.motor_measured) columns.push_back(column({}, load, mode.mass_ratio));
  return columns;
}

}  // namespace stiction::host
