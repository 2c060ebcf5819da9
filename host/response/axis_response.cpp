#include "host/response/axis_response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/configuration/conversion.hpp"
#include "firmware/machine/configuration/double_signals.hpp"
#include "firmware/machine/model/motor_force.hpp"
#include "sim/effects/effects.hpp"

namespace stiction::host {
namespace {

using Complex = std::complex<double>;

// ln 10 in a third of a second: what the stability limits of docs/prototype_figures.md, 2, call "no longer decays".
constexpr double slow_decay = 3.0 * std::numbers::ln10;  // 1/s

constexpr auto index(Answer answer) { return static_cast<std::size_t>(answer); }

// The drive's own laws at one frequency, from the very coefficients it runs with.
class Controllers {
 public:
  Controllers(const machine::Timing& timing, const machine::AxisModel& axis)
      : config_(machine::configure_axis<machine::DoubleSignals>(timing, sim::drive_axis(axis))),
        period_(timing.fast_period),
        slow_ratio_(machine::slow_ratio(timing)) {}

  void at(double frequency) {
    s_ = Complex(0.0, 2.0 * std::numbers::pi * frequency);
    back_ = std::exp(-s_ * period_);
  }

  // From the following error to the speed that is wanted: gain, sample and hold.
  Complex position() const {
    Complex sum = 0.0, delay = 1.0;
    for (int k = 0; k < slow_ratio_; ++k, delay *= back_) sum += delay;
    return config_.position_gain.value * sum / static_cast<double>(slow_ratio_);
  }
  // From the speed error to the set current: PI and notch.
  Complex velocity() const {
    const auto& pi = config_.velocity;
    const Complex law = pi.proportional.value + pi.integral.value / (1.0 - back_);
    const auto& n = config_.notch;
    if (!n.enabled) return law;
    return law * (n.b0.value + (n.b1.value + n.b2.value * back_) * back_) /
           (1.0 + (n.a1.value + n.a2.value * back_) * back_);
  }
  // From the position to the speed as the controller sees it.
  Complex speed() const {
    switch (config_.velocity_feedback) {
      case VelocityFeedback::difference:
        return (1.0 - back_) / period_;
      case VelocityFeedback::mean_difference:
        return (1.0 - back_ * back_) / (2.0 * period_);
      case VelocityFeedback::given:
        break;
    }
    return s_;
  }

 private:
  AxisConfig<machine::DoubleSignals> config_;
  double period_;
  int slow_ratio_;
  Complex s_, back_;
};

void check(const Log& log, const AxisLog& measured, const machine::AxisModel& axis) {
  if (!measured.i_inject.empty() || measured.u_inject.empty() || !axis.current_controller) return;
  throw ResponseError(
      fmt::format("{}: found u_inject and no i_inject; expected i_inject[A], a test signal on the set current, as the "
                  "machine's axis {} has a current controller",
                  place_of(log, measured), axis.name));
}

// Only the points that are answer rather than noise.
Curve coherent(const Curve& curve, const std::vector<double>& coherence) {
  Curve result;
  for (std::size_t k = 0; k < curve.value.size(); ++k)
    if (coherence[k] >= least_coherence) result.add(curve.frequency[k], curve.value[k]);
  return result;
}

void find_margins(LoopResponse& loop) {
  const auto open = coherent(loop.open, loop.coherence), broken = coherent(loop.broken, loop.coherence);
  loop.phase = phase_margin(open);
  loop.gain = gain_margin(open);
  loop.limit = gain_margin(broken);
  loop.decays = gain_margin(with_decay(broken, slow_decay));
  loop.bandwidth = bandwidth(coherent(loop.closed, loop.coherence));
}

std::size_t samples_at_limit(const AxisLog& measured, const machine::AxisModel& axis) {
  const bool force = axis.motor.driven_by_volts();
  const double limit = 0.999 * (force ? axis.inverter.voltage_limit : axis.inverter.current_limit * axis.motor.count);
  const auto& set = force ? measured.u : measured.i_set.empty() ? measured.i : measured.i_set;
  return static_cast<std::size_t>(
      std::count_if(set.begin(), set.end(), [limit](double value) { return std::abs(value) >= limit; }));
}

void add(LoopResponse& loop, double frequency, Complex open, Complex broken, double coherence) {
  loop.open.add(frequency, open);
  loop.closed.add(frequency, open / (1.0 + open));
  loop.broken.add(frequency, broken);
  loop.coherence.push_back(coherence);
}

}  // namespace

AxisResponse axis_response(const Log& log, const AxisLog& measured, const machine::Timing& timing,
                           const machine::AxisModel& axis) {
  check(log, measured, axis);
  AxisResponse result;
  result.axis = axis.name;
  result.samples_at_limit = samples_at_limit(measured, axis);
  result.spectra = measure_spectra(log, measured, machine::acting_force_constant(axis.motor));
  const auto known = [&](Answer answer) { return result.spectra.known[index(answer)]; };
  const bool has_current_loop = axis.current_controller.has_value();
  const bool has_current = known(Answer::current);
  // Without a current controller the current is what the velocity controller commands.
  const bool current_is_set = !has_current_loop && has_current;
  result.set_current_computed = !known(Answer::controller) && !current_is_set;
  if (has_current_loop && has_current) result.current.emplace();
  Controllers controllers(timing, axis);
  for (const auto& point : result.spectra.points) {
    controllers.at(point.frequency);
    const Complex x = point.gain[index(Answer::position)];
    const bool speed_known = known(Answer::velocity);
    const Complex v = speed_known ? point.gain[index(Answer::velocity)] : controllers.speed() * x;
    const Complex speed_error = -(controllers.position() * x + v);
    const Complex output = known(Answer::controller) ? point.gain[index(Answer::controller)]
                           : current_is_set          ? point.gain[index(Answer::current)] - 1.0
                                                     : controllers.velocity() * speed_error;
    const Complex set = 1.0 + output;
    const Complex i = has_current ? point.gain[index(Answer::current)] : set;
    const Complex open_velocity = output / speed_error * v / set;
    const double x_coherence = point.coherence[index(Answer::position)];
    const double v_coherence = speed_known ? point.coherence[index(Answer::velocity)] : x_coherence;
    const double output_coherence =
        known(Answer::controller) ? point.coherence[index(Answer::controller)] : v_coherence;
    add(result.velocity, point.frequency, open_velocity, -output / set, output_coherence);
    const Complex open_position = controllers.position() * x / v * open_velocity / (1.0 + open_velocity);
    add(result.position, point.frequency, open_position, open_position, x_coherence);
    if (result.current) {
      const auto error_or_current = known(Answer::current_error) ? Answer::current_error : Answer::current;
      add(*result.current, point.frequency, i / (set - i), (i - output) / (set - i),
          point.coherence[index(error_or_current)]);
    }
    result.plant.add(point.frequency, v / i);
    result.plant_coherence.push_back(v_coherence);
  }
  for (auto* loop : {result.current ? &*result.current : nullptr, &result.velocity, &result.position})
    if (loop != nullptr) find_margins(*loop);
  return result;
}

}  // namespace stiction::host
