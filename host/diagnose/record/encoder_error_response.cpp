#include "host/diagnose/record/encoder_error_response.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "firmware/machine/model/motor_force.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/identify/filter.hpp"

namespace stiction::host {
namespace {

using Complex = std::complex<double>;

// PI with the integrator updated before use; `back` is one tick back, z^-1.
Complex pi(double gain, const std::optional<double>& integral_time, double tick, Complex back) {
  return integral_time ? gain * (1.0 + tick / *integral_time / (1.0 - back)) : Complex(gain);
}

// Bilinear transform of s^2 + 2 D1 w s + w^2 over s^2 + 2 D2 w s + w^2, prewarped.
Complex notch_of(const machine::NotchParameters& notch, double tick, Complex back) {
  const double w = std::tan(std::numbers::pi * notch.frequency * tick);
  const Complex s = (1.0 - back) / (1.0 + back) / w;
  return (s * s + 2.0 * notch.numerator_damping * s + 1.0) / (s * s + 2.0 * notch.denominator_damping * s + 1.0);
}

// Of the log's Nyquist frequency: where the drive's answer begins to be folded down, and where it is so in full. In
// between, the rows' band has ended.
constexpr double folds_from = 0.8, folds_to = 1.2;
constexpr double least_of_answer = 1e-3;      // of its largest value
constexpr std::size_t samples_of_answer = 8;  // to either side; the edge above is as sharp as they make it

double folded_share(double frequency, double log_period) {
  const double up = (2.0 * frequency * log_period - folds_from) / (folds_to - folds_from);
  return up <= 0.0 ? 0.0 : up >= 1.0 ? 1.0 : 0.5 * (1.0 - std::cos(std::numbers::pi * up));
}

// exp(2 pi i turns) to 1e-9, in a quarter of the library's time: by half the angle, within a quarter turn.
Complex wave_at(double turns) {
  const double angle = std::numbers::pi * (turns - std::nearbyint(turns)), square = angle * angle;
  const double sine =
      angle *
      (1.0 - square / 6.0 *
                 (1.0 - square / 20.0 *
                            (1.0 - square / 42.0 *
                                       (1.0 - square / 72.0 *
                                                  (1.0 - square / 110.0 *
                                                             (1.0 - square / 156.0 * (1.0 - square / 210.0)))))));
  const double cosine =
      1.0 -
      square / 2.0 *
          (1.0 - square / 12.0 *
                     (1.0 - square / 30.0 *
                                (1.0 - square / 56.0 *
                                           (1.0 - square / 90.0 * (1.0 - square / 132.0 * (1.0 - square / 182.0))))));
  return {1.0 - 2.0 * sine * sine, 2.0 * sine * cosine};
}

// The values of samples and, between two of them, of `parts` - 1 ticks: cubics by central differences.
std::vector<double> between(const std::vector<double>& values, std::size_t parts) {
  const std::size_t n = values.size();
  std::vector<double> all;
  all.reserve(n * parts);
  const auto slope = [&](std::size_t i) {
    return i == 0       ? values[1] - values[0]
           : i + 1 == n ? values[i] - values[i - 1]
                        : 0.5 * (values[i + 1] - values[i - 1]);
  };
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double from = values[i], way = values[i + 1] - from, begin = slope(i), end = slope(i + 1);
    for (std::size_t k = 0; k < parts; ++k) {
      const double s = static_cast<double>(k) / static_cast<double>(parts);
      all.push_back(from + s * (begin + s * (3.0 * way - 2.0 * begin - end + s * (begin + end - 2.0 * way))));
    }
  }
  all.push_back(values.back());
  return all;
}

}  // namespace

EncoderErrorResponse::EncoderErrorResponse(const machine::AxisModel& axis, const machine::Timing& timing)
    : axis_(axis), tick_(timing.fast_period) {}

// Set current to current: PI, dead time, and windings under a voltage held for a tick.
Complex EncoderErrorResponse::current_loop(Complex back) const {
  const auto& motor = axis_.motor;
  if (motor.model == machine::MotorModel::force || !axis_.current_controller) return 1.0;
  const double mutual = motor.model == machine::MotorModel::synchronous ? motor.mutual_inductance : 0.0;
  const double resistance = motor.phase_resistance / motor.count;
  const double inductance = (motor.phase_inductance - mutual) / motor.count;
  const double decay = std::exp(-resistance * tick_ / inductance);
  const Complex windings = (1.0 - decay) / resistance * back / (1.0 - decay * back);
  const Complex open = pi(axis_.current_controller->gain, axis_.current_controller->integral_time, tick_, back) *
                       std::pow(back, std::round(axis_.inverter.dead_time / tick_)) * windings;
  return open / (1.0 + open);
}

Complex EncoderErrorResponse::speed(double frequency) const {
  const double w = 2.0 * std::numbers::pi * frequency;
  const Complex back = std::polar(1.0, -w * tick_);
  switch (axis_.encoder.velocity) {
    case machine::VelocitySource::ideal:
      return {0.0, w};
    case machine::VelocitySource::mean_difference:
      return (1.0 - back * back) / (2.0 * tick_);
    case machine::VelocitySource::estimated:
      break;
  }
  return (1.0 - back) / tick_;
}

Complex EncoderErrorResponse::of_speed(double frequency) const {
  if (!(tick_ > 0.0) || axis_.velocity_controller.gain == 0.0) return 0.0;
  const double w = 2.0 * std::numbers::pi * frequency;
  const Complex back = std::polar(1.0, -w * tick_);
  if (std::abs(1.0 - back) < 1e-9) return 0.0;
  Complex law = pi(axis_.velocity_controller.gain, axis_.velocity_controller.integral_time, tick_, back) *
                current_loop(back) * machine::acting_force_constant(axis_.motor);
  if (axis_.notch) law *= notch_of(*axis_.notch, tick_, back);
  // x = F / (m s^2) is read with the error.
  return -law / (1.0 - law * speed(frequency) / (axis_.mass * w * w));
}

Complex EncoderErrorResponse::drive(double frequency) const { return speed(frequency) * of_speed(frequency); }

SeenEncoderError::SeenEncoderError(const Motion& motion, const machine::AxisModel& axis, const machine::Timing& timing,
                                   int difference_points, double cutoff)
    : drive_(axis, timing),
      samples_(motion.x.size()),
      ticks_in_sample_(
          timing.fast_period > 0.0
              ? std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(motion.period / timing.fast_period)))
              : 1),
      period_(motion.period),
      tick_(motion.period / static_cast<double>(ticks_in_sample_)),
      answers_(ticks_in_sample_ > 1 && axis.velocity_controller.gain != 0.0),
      velocity_(axis.encoder.velocity),
      mass_(axis.mass),
      viscous_(viscous_of(axis)),
      difference_points_(difference_points),
      cutoff_(std::min(cutoff, 0.2 / motion.period)) {
  if (samples_ < 2) {
    places_ = motion.x;
    speeds_.assign(places_.size(), 0.0);
    return;
  }
  places_ = between(motion.read.empty() ? motion.x : motion.read, ticks_in_sample_);
  speeds_ = central_difference(places_, tick_);
  if (!answers_) return;
  reach_ = samples_of_answer * ticks_in_sample_;
  std::size_t points = 1;
  while (points < 4 * reach_) points *= 2;
  std::vector<Complex> spectrum(points), answer;
  for (std::size_t k = 1; k < points / 2; ++k) {
    const double frequency = static_cast<double>(k) / (static_cast<double>(points) * tick_);
    if (const double share = folded_share(frequency, period_); share > 0.0)
      spectrum[k] = share * drive_.of_speed(frequency);
    spectrum[points - k] = std::conj(spectrum[k]);
  }
  Eigen::FFT<double> fft;
  fft.inv(answer, spectrum);
  const auto at = [&](std::size_t later) { return answer[(points + later) % points].real(); };
  // The last of the answer that is worth its time.
  double largest = 0.0;
  for (std::size_t k = 0; k <= 2 * reach_; ++k) largest = std::max(largest, std::abs(at(points + k - reach_)));
  while (reach_ > 1 && std::max(std::abs(at(reach_)), std::abs(at(points - reach_))) < least_of_answer * largest)
    --reach_;
  for (std::size_t k = 0; k <= 2 * reach_; ++k) answer_.push_back(at(points + k - reach_));
}

double SeenEncoderError::shown_at(double frequency) const {
  return std::abs(frequency - std::round(frequency * period_) / period_);
}

Complex SeenEncoderError::response(double frequency) const {
  const double cycles = shown_at(frequency) * period_, edge = shown_at(frequency) / cutoff_;
  const auto sine = [&](double k) { return std::sin(2.0 * std::numbers::pi * k * cycles); };
  const double slope =
      (difference_points_ == 7 ? (45.0 * sine(1.0) - 9.0 * sine(2.0) + sine(3.0)) / 30.0 : sine(1.0)) / period_;
  const Complex own = Complex(mass_ * slope * slope, -viscous_ * slope) / (1.0 + std::pow(edge, 8.0));
  if (!answers_) return own;
  // The ticks fold as well.
  const double seen = std::abs(frequency - std::round(frequency * tick_) / tick_);
  const double share = folded_share(seen, period_);
  if (share == 0.0) return own;
  const Complex speed = velocity_ == machine::VelocitySource::ideal ? Complex(0.0, 2.0 * std::numbers::pi * frequency)
                                                                    : drive_.speed(seen);
  return own + share * drive_.of_speed(seen) * speed;
}

std::vector<double> SeenEncoderError::inverse_dynamics(const std::vector<double>& error) const {
  const auto lowpass = butterworth(4, 2.0 * cutoff_ * period_);
  const auto seen = filter_both_ways(lowpass, error, default_padding(lowpass));
  const auto speed = central_difference(seen, period_, difference_points_);
  auto force = central_difference(speed, period_, difference_points_);
  for (std::size_t i = 0; i < force.size(); ++i) force[i] = -mass_ * force[i] - viscous_ * speed[i];
  return force;
}

std::vector<std::vector<double>> SeenEncoderError::columns(double period) const {
  std::vector<Complex> wave(places_.size());
  for (std::size_t i = 0; i < wave.size(); ++i) wave[i] = wave_at(places_[i] / period);
  std::vector<double> cosine(samples_), sine(samples_);
  for (std::size_t i = 0; i < samples_; ++i) {
    cosine[i] = wave[i * ticks_in_sample_].real();
    sine[i] = wave[i * ticks_in_sample_].imag();
  }
  cosine = inverse_dynamics(cosine);
  sine = inverse_dynamics(sine);
  if (answer_.empty()) return {cosine, sine};
  // From here on the waves' speeds, the last first, as each needs the ones before it.
  if (velocity_ == machine::VelocitySource::ideal) {
    const double order = 2.0 * std::numbers::pi / period;
    for (std::size_t i = 0; i < wave.size(); ++i)
      wave[i] = order * speeds_[i] * Complex(-wave[i].imag(), wave[i].real());
  } else {
    const std::size_t back = ticks_back();
    for (std::size_t i = wave.size(); i-- > back;)
      wave[i] = (wave[i] - wave[i - back]) / (static_cast<double>(back) * tick_);
  }
  for (std::size_t i = 0; i < samples_; ++i) {
    const std::size_t tick = i * ticks_in_sample_;
    if (tick < reach_ + 2 || tick + reach_ >= wave.size()) continue;
    double of_cosine = 0.0, of_sine = 0.0;
    for (std::size_t k = 0; k <= 2 * reach_; ++k) {
      const Complex& speed = wave[tick + reach_ - k];
      of_cosine += answer_[k] * speed.real();
      of_sine += answer_[k] * speed.imag();
    }
    cosine[i] += of_cosine;
    sine[i] += of_sine;
  }
  return {cosine, sine};
}

// Filters in both directions are their own transposes but at the ends; differences are so with the sign changed.
SeenEncoderError::Weights SeenEncoderError::transposed(const std::vector<double>& weight) const {
  Weights all{std::vector<double>(places_.size(), 0.0), std::vector<double>(places_.size(), 0.0)};
  if (samples_ < 2) return all;
  const auto lowpass = butterworth(4, 2.0 * cutoff_ * period_);
  const auto once = central_difference(weight, period_, difference_points_);
  auto own = central_difference(once, period_, difference_points_);
  for (std::size_t i = 0; i < own.size(); ++i) own[i] = viscous_ * once[i] - mass_ * own[i];
  own = filter_both_ways(lowpass, own, default_padding(lowpass));
  for (std::size_t i = 0; i < samples_; ++i) all.position[i * ticks_in_sample_] = own[i];
  if (answer_.empty()) return all;
  std::vector<double> speed(places_.size(), 0.0);
  for (std::size_t i = 0; i < samples_; ++i) {
    const std::size_t tick = i * ticks_in_sample_;
    if (tick < reach_ + 2 || tick + reach_ >= speed.size()) continue;
    for (std::size_t k = 0; k <= 2 * reach_; ++k) speed[tick + reach_ - k] += weight[i] * answer_[k];
  }
  if (velocity_ == machine::VelocitySource::ideal) {
    for (std::size_t i = 0; i < speed.size(); ++i) all.slope[i] = speeds_[i] * speed[i];
    return all;
  }
  const std::size_t back = ticks_back();
  for (std::size_t i = back; i < speed.size(); ++i) {
    const double by = speed[i] / (static_cast<double>(back) * tick_);
    all.position[i] += by;
    all.position[i - back] -= by;
  }
  return all;
}

}  // namespace stiction::host
