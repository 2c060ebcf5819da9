#include "host/diagnose/record/encoder_error_response.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <utility>

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
constexpr std::size_t samples_together = 128;  // of columns
constexpr std::size_t longest_difference = 2;  // ticks, of a speed
constexpr double least_of_answer = 1e-3;       // of its largest value
constexpr std::size_t samples_of_answer = 8;   // to either side; the edge above is as sharp as they make it

double folded_share(double frequency, double log_period) {
  const double up = (2.0 * frequency * log_period - folds_from) / (folds_to - folds_from);
  return up <= 0.0 ? 0.0 : up >= 1.0 ? 1.0 : 0.5 * (1.0 - std::cos(std::numbers::pi * up));
}

// Cosine and sine of 2 pi place / period, to 1e-9 and several at once: by half the angle, within a quarter turn.
struct Waves {
  Eigen::ArrayXd cosine, sine;
};
Waves waves_at(const Eigen::Ref<const Eigen::ArrayXd>& place, double period) {
  constexpr double to_integer = 6755399441055744.0;  // 1.5 2^52, at which a double has no fraction
  Eigen::ArrayXd angle = place / period;
  angle = std::numbers::pi * (angle - ((angle + to_integer) - to_integer));
  const Eigen::ArrayXd x = angle.square();
  const Eigen::ArrayXd sine =
      angle * (1 - x / 6 * (1 - x / 20 * (1 - x / 42 * (1 - x / 72 * (1 - x / 110 * (1 - x / 156 * (1 - x / 210)))))));
  const Eigen::ArrayXd cosine =
      1 - x / 2 * (1 - x / 12 * (1 - x / 30 * (1 - x / 56 * (1 - x / 90 * (1 - x / 132 * (1 - x / 182))))));
  return {1 - 2 * sine.square(), 2 * sine * cosine};
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

SeenEncoderError::SeenEncoderError(const Motion& motion, const machine::AxisModel& axis, const machine::Timing& timing,
                                   int difference_points, double cutoff)
    : drive_(axis, timing),
      read_(motion.read.empty() ? motion.x : motion.read),
      ticks_in_sample_(
          timing.fast_period > 0.0
              ? std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(motion.period / timing.fast_period)))
              : 1),
      period_(motion.period),
      tick_(motion.period / static_cast<double>(ticks_in_sample_)),
      answers_(ticks_in_sample_ > 1 && read_.size() > 1 && axis.velocity_controller.gain != 0.0),
      velocity_(axis.encoder.velocity),
      mass_(axis.mass),
      viscous_(viscous_of(axis)),
      difference_points_(difference_points),
      cutoff_(std::min(cutoff, 0.2 / motion.period)) {
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
  answer_.resize(static_cast<Eigen::Index>(2 * reach_ + 1));
  for (std::size_t k = 0; k <= 2 * reach_; ++k) answer_[static_cast<Eigen::Index>(k)] = at(points + reach_ - k);
}

std::size_t SeenEncoderError::ticks() const { return read_.empty() ? 0 : (read_.size() - 1) * ticks_in_sample_ + 1; }

bool SeenEncoderError::answered(std::size_t sample) const {
  const std::size_t tick = sample * ticks_in_sample_;
  return tick >= reach_ + longest_difference && tick + reach_ < ticks();
}

// Cubics between samples, by central differences.
SeenEncoderError::Way SeenEncoderError::way(std::size_t first, std::size_t count) const {
  Way way{Eigen::VectorXd(static_cast<Eigen::Index>(count)), Eigen::VectorXd(static_cast<Eigen::Index>(count))};
  const std::size_t n = read_.size();
  if (n < 2) {
    way.place.setConstant(n == 0 ? 0.0 : read_[0]);
    way.speed.setZero();
    return way;
  }
  const auto slope = [&](std::size_t i) {
    return i == 0 ? read_[1] - read_[0] : i + 1 == n ? read_[i] - read_[i - 1] : 0.5 * (read_[i + 1] - read_[i - 1]);
  };
  for (std::size_t k = 0; k < count;) {
    const std::size_t i = std::min((first + k) / ticks_in_sample_, n - 2);
    const double from = read_[i], step = read_[i + 1] - from, begin = slope(i), end = slope(i + 1);
    const double square = 3.0 * step - 2.0 * begin - end, cube = begin + end - 2.0 * step;
    for (std::size_t part = first + k - i * ticks_in_sample_; part <= ticks_in_sample_ && k < count; ++part, ++k) {
      if (part == ticks_in_sample_ && i + 2 < n) break;
      const double s = static_cast<double>(part) / static_cast<double>(ticks_in_sample_);
      way.place[static_cast<Eigen::Index>(k)] = from + s * (begin + s * (square + s * cube));
      way.speed[static_cast<Eigen::Index>(k)] = (begin + s * (2.0 * square + 3.0 * s * cube)) / period_;
    }
  }
  return way;
}

double SeenEncoderError::shown_at(double frequency) const {
  return std::abs(frequency - std::round(frequency * period_) / period_);
}

Complex SeenEncoderError::response(double frequency) const {
  const double cycles = shown_at(frequency) * period_;
  // The filter's frequencies are warped as its bilinear transform does it.
  const double edge = std::tan(std::numbers::pi * cycles) / std::tan(std::numbers::pi * cutoff_ * period_);
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
  const std::size_t samples = read_.size();
  const auto seen =
      waves_at(Eigen::Map<const Eigen::ArrayXd>(read_.data(), static_cast<Eigen::Index>(samples)), period);
  auto cosine = inverse_dynamics({seen.cosine.begin(), seen.cosine.end()});
  auto sine = inverse_dynamics({seen.sine.begin(), seen.sine.end()});
  if (answer_.size() == 0) return {cosine, sine};
  std::size_t first = 0, last = samples;
  while (first < samples && !answered(first)) ++first;
  while (last > first && !answered(last - 1)) --last;
  // In stretches whose ticks stay near at hand.
  for (; first < last; first += samples_together)
    add_answer(first, std::min(first + samples_together, last), period, cosine, sine);
  return {cosine, sine};
}

void SeenEncoderError::add_answer(std::size_t first, std::size_t last, double period, std::vector<double>& to_cosine,
                                  std::vector<double>& to_sine) const {
  const std::size_t earlier = reach_ + longest_difference, begin = first * ticks_in_sample_ - earlier;
  const auto count = static_cast<Eigen::Index>((last - 1 - first) * ticks_in_sample_ + earlier + reach_ + 1);
  const Way along = way(begin, static_cast<std::size_t>(count));
  auto [cosine, sine] = waves_at(along.place.array(), period);
  // From here on the waves' speeds.
  if (velocity_ == machine::VelocitySource::ideal) {
    const Eigen::ArrayXd rate = 2.0 * std::numbers::pi / period * along.speed.array();
    std::swap(cosine, sine);
    cosine *= -rate;
    sine *= rate;
  } else {
    const auto back = static_cast<Eigen::Index>(ticks_back());
    for (auto* wave : {&cosine, &sine})
      wave->tail(count - back) =
          ((wave->tail(count - back) - wave->head(count - back)) / (static_cast<double>(back) * tick_)).eval();
  }
  for (std::size_t i = first; i < last; ++i) {
    const auto at = static_cast<Eigen::Index>(i * ticks_in_sample_ - reach_ - begin);
    to_cosine[i] += answer_.dot(cosine.matrix().segment(at, answer_.size()));
    to_sine[i] += answer_.dot(sine.matrix().segment(at, answer_.size()));
  }
}

// Filters in both directions are their own transposes but at the ends; differences are so with the sign changed.
SeenEncoderError::Weights SeenEncoderError::transposed(const std::vector<double>& weight) const {
  const std::size_t samples = read_.size();
  const auto [places, speeds] = way(0, ticks());
  Weights all{places, Eigen::VectorXd::Zero(places.size()), Eigen::VectorXd::Zero(places.size())};
  if (samples < 2) return all;
  const auto lowpass = butterworth(4, 2.0 * cutoff_ * period_);
  const auto once = central_difference(weight, period_, difference_points_);
  auto own = central_difference(once, period_, difference_points_);
  for (std::size_t i = 0; i < own.size(); ++i) own[i] = viscous_ * once[i] - mass_ * own[i];
  own = filter_both_ways(lowpass, own, default_padding(lowpass));
  for (std::size_t i = 0; i < samples; ++i) all.position[static_cast<Eigen::Index>(i * ticks_in_sample_)] = own[i];
  if (answer_.size() == 0) return all;
  Eigen::VectorXd speed = Eigen::VectorXd::Zero(places.size());
  for (std::size_t i = 0; i < samples; ++i)
    if (answered(i))
      speed.segment(static_cast<Eigen::Index>(i * ticks_in_sample_ - reach_), answer_.size()) += weight[i] * answer_;
  if (velocity_ == machine::VelocitySource::ideal) {
    all.slope = speeds.cwiseProduct(speed);
    return all;
  }
  const auto back = static_cast<Eigen::Index>(ticks_back()), others = speed.size() - back;
  const Eigen::VectorXd by = speed.tail(others) / (static_cast<double>(back) * tick_);
  all.position.tail(others) += by;
  all.position.head(others) -= by;
  return all;
}

}  // namespace stiction::host
