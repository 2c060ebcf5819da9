#include "tests/blind/truth/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/configuration/conversion.hpp"
#include "stiction/drive/ticker.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::blind {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int steps_per_tick = 4;

double sign_of(double v) { return v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0; }

// Three windings with a star point, trapezoidal rule.
class Motor {
 public:
  Motor(const machine::MotorParameters& m, const Mechanics& hidden, double h)
      : resistance_(0.5 * h * m.phase_resistance / (m.phase_inductance - m.mutual_inductance)),
        gain_(h / (m.phase_inductance - m.mutual_inductance)),
        emf_(m.emf_constant),
        force_(m.phase_force_constant * hidden.force_ratio),
        most_(hidden.saturation_current * 1.5 * force_),
        wave_(2.0 * pi / m.pole_pair_pitch) {}

  double advance(const std::array<double, 3>& u, double x, double v) {
    const double star = (u[0] + u[1] + u[2]) / 3.0;
    const double s = std::sin(wave_ * x), c = std::cos(wave_ * x), root = 0.5 * std::numbers::sqrt3;
    const std::array<double, 3> sines{s, -0.5 * s + root * c, -0.5 * s - root * c};
    double force = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double sine = sines[k];
      const double before = current[k];
      current[k] = (before * (1.0 - resistance_) + gain_ * (u[k] - star - emf_ * v * sine)) / (1.0 + resistance_);
      force += 0.5 * (before + current[k]) * sine;
    }
    return most_ > 0.0 ? most_ * std::tanh(force_ * force / most_) : force_ * force;
  }
  std::array<double, 3> current{};  // A

 private:
  double resistance_, gain_, emf_, force_, most_, wave_;
};

// Friction and what is hidden in it, as a force that opposes the motion, and forces of the surroundings.
class Carriage {
 public:
  // `turn`: phase (rad) by which this log differs from the first in what has no fixed phase.
  Carriage(const Mechanics& m, double x, double turn) : m_(m), contact_(m.contact), x_(x), turn_(turn), furthest_(x) {
    if (m.mode_frequency <= 0.0) return;
    const double w = 2.0 * pi * m.mode_frequency;
    load_ = m.mode_load * m.mass;
    spring_ = w * w * load_ * (1.0 - m.mode_load);
    damper_ = 2.0 * m.mode_damping * spring_ / w;
  }

  // One step of h s under the motor's force and that of noise; `other`: the other axis' acceleration.
  void advance(double motor, double disturbance, double other, double h, double t) {
    const double angle = 2.0 * pi * x_ / m_.constant_ripple_pitch;
    motor *= 1.0 + m_.constant_cosine * std::cos(angle) + m_.constant_sine * std::sin(angle);
    const double resisting = friction(t);
    double force = motor, mass = m_.mass;
    if (load_ > 0.0) {
      // The motor on its spring: half of the way, the forces, the other half.
      lead_ += 0.5 * h * lead_rate_;
      force = spring_ * lead_ + damper_ * lead_rate_;
      mass = load_;
    }
    const double push = force + disturbance + m_.other_mass * other + surroundings(t) - resisting;
    const double next = (v_ + h / mass * push) / (1.0 + h / mass * m_.viscous);
    if (load_ > 0.0) {
      lead_rate_ += h / (m_.mass - load_) * (motor - force) - (next - v_);
      lead_ += 0.5 * h * lead_rate_;
    }
    if (m_.friction_lag > 0.0) late_ += h / (m_.friction_lag + h) * (next - late_);
    moved_ = 0.5 * h * (v_ + next);
    v_ = next;
    x_ += moved_;
    watch_reversals(t);
  }
  double x() const { return x_; }
  double motor_x() const { return x_ + lead_; }
  double motor_v() const { return v_ + lead_rate_; }

 private:
  // All but the viscous part, which is taken at the end of the step.
  double friction(double t) {
    const double contact = contact_.move(moved_), speed = std::abs(v_);
    const double slip = contact / contact_.coulomb();  // -1 to 1: how much of it is broken away
    const double ratio = v_ / m_.stribeck_velocity;
    return contact + m_.rise * sign_of(v_) * (1.0 - std::exp(-speed / m_.rise_velocity)) +
           m_.break_away * slip * std::exp(-ratio * ratio) + m_.more_in_plus * std::abs(slip) +
           m_.more_viscous_in_plus * speed + (m_.drift * (1.0 - std::exp(-t / m_.drift_time)) + profile()) * slip +
           (m_.friction_lag > 0.0 ? m_.viscous * (late_ - v_) : 0.0);
  }
  double profile() const {
    const auto& at = m_.profile_position;
    const auto& of = m_.profile_force;
    if (at.empty()) return 0.0;
    for (std::size_t k = 0; k < at.size(); ++k)
      if (x_ < at[k]) return k == 0 ? of[0] : of[k] + (of[k - 1] - of[k]) * (at[k] - x_) / (at[k] - at[k - 1]);
    return of.back();
  }
  double surroundings(double t) const {
    double force = m_.constant_force - m_.spring * (x_ - m_.spring_neutral);
    for (std::size_t k = 0; k < m_.ripple_cosine.size(); ++k) {
      const double angle = 2.0 * pi * static_cast<double>(k + 1) * x_ / m_.ripple_pitch;
      force += m_.ripple_cosine[k] * std::cos(angle) + m_.ripple_sine[k] * std::sin(angle);
    }
    const double off = (x_ - m_.bump_position) / m_.bump_width;
    if (m_.bump != 0.0) force += m_.bump * std::exp(-0.5 * off * off);
    const double wave = 2.0 * pi * m_.tone_frequency * t + turn_;
    if (m_.tone_cosine != 0.0 || m_.tone_sine != 0.0)
      force += m_.tone_cosine * std::cos(wave) + m_.tone_sine * std::sin(wave);
    if (m_.speed_ripple != 0.0)
      force += m_.speed_ripple * std::abs(v_) * std::sin(2.0 * pi * x_ / m_.speed_ripple_pitch);
    if (m_.kick != 0.0) force += m_.kick * direction_ * std::exp(-(t - reversed_at_) / m_.kick_time);
    return force;
  }
  // A reversal is where the carriage has come back by more than it hunts at standstill: kicks by chance would be noise.
  void watch_reversals(double t) {
    constexpr double way_back = 3e-6;  // m
    if (direction_ * (x_ - furthest_) < -way_back) {
      direction_ = -direction_;
      reversed_at_ = t;
    }
    if (direction_ * (x_ - furthest_) > 0.0) furthest_ = x_;
  }

  Mechanics m_;
  Contact contact_;
  double x_, v_ = 0.0, moved_ = 0.0, late_ = 0.0, turn_;
  double load_ = 0.0, spring_ = 0.0, damper_ = 0.0;  // kg, N/m, N s/m; of the elastic mode
  double lead_ = 0.0, lead_rate_ = 0.0;              // of the motor before the load
  double direction_ = 1.0, furthest_ = 0.0, reversed_at_ = -1e3;
};

// Rider on an elastic mount behind the lost motion, and what the encoder reads of it: with an error periodic in its
// signal.
class Encoder {
 public:
  Encoder(const machine::EncoderParameters& e, const Mechanics& m, double x)
      : half_(0.5 * m.backlash),
        dragged_(x),
        increment_(e.increment),
        cosine_(m.reading_cosine),
        sine_(m.reading_sine),
        signal_(2.0 * pi / m.reading_period) {
    if (!e.mount) return;
    w_ = 2.0 * pi * e.mount->natural_frequency;
    damping_ = 2.0 * e.mount->damping_ratio * w_;
  }
  void advance(double x, double h) {
    const double before = dragged_;
    dragged_ = std::clamp(dragged_, x - half_, x + half_);
    const double v = (dragged_ - before) / h;
    rate_ -= v - v_ + h * (damping_ * rate_ + w_ * w_ * deflection_);
    v_ = v;
    if (w_ > 0.0) deflection_ += h * rate_;
  }
  double read(double noise) const {
    const double head = dragged_ + deflection_, phase = signal_ * head;
    const double error = cosine_ == 0.0 && sine_ == 0.0 ? 0.0 : cosine_ * std::cos(phase) + sine_ * std::sin(phase);
    return increment_ * std::round((head + error + noise) / increment_);
  }

 private:
  double half_, dragged_, increment_, cosine_, sine_, signal_, v_ = 0.0;
  double w_ = 0.0, damping_ = 0.0, deflection_ = 0.0, rate_ = 0.0;
};

// The newest values, one a tick; linear between them.
class Memory {
 public:
  double delayed(double value, double ticks) {
    values_.push_front(value);
    if (values_.size() > 64) values_.pop_back();
    const auto k = std::min(static_cast<std::size_t>(ticks), values_.size() - 1);
    const auto next = std::min(k + 1, values_.size() - 1);
    return values_[k] + (values_[next] - values_[k]) * (ticks - static_cast<double>(k));
  }

 private:
  std::deque<double> values_;
};

machine::AxisModel true_drive(machine::AxisModel axis, const Mechanics& m) {
  axis.position_controller.gain *= m.position_gain;
  axis.velocity_controller.gain *= m.velocity_gain;
  if (axis.velocity_controller.integral_time) *axis.velocity_controller.integral_time *= m.velocity_integral_time;
  return axis;
}

// Voltages that act some time after they were commanded; the mean of two in the step of the change.
class Inverter {
 public:
  Inverter(double delay, double tick) : ticks_(delay / tick), sent_(static_cast<std::size_t>(ticks_) + 3) {}

  void command(const std::array<double, 3>& u) {
    sent_.push_front(u);
    sent_.pop_back();
  }
  // During the step from `begin` to `end`, in ticks since the newest command.
  std::array<double, 3> acting(double begin, double end) const {
    const double first = std::floor(begin - ticks_ + 1e-9), change = first + 1.0 + ticks_;
    const double share = std::clamp((change - begin) / (end - begin), 0.0, 1.0);
    const auto& a = sent_[static_cast<std::size_t>(-first)];
    const auto& b = sent_[static_cast<std::size_t>(std::max(-first - 1.0, 0.0))];
    std::array<double, 3> u;
    for (std::size_t k = 0; k < 3; ++k) u[k] = share * a[k] + (1.0 - share) * b[k];
    return u;
  }

 private:
  double ticks_;
  std::deque<std::array<double, 3>> sent_;
};

}  // namespace

// Butterworth of second order, forwards and backwards: no phase, -6 dB at the corner.
void zero_phase(std::vector<double>& values, double corner, double period) {
  const double c = std::tan(pi * corner * period), d = 1.0 + std::numbers::sqrt2 * c + c * c;
  const double b = c * c / d, a1 = 2.0 * (c * c - 1.0) / d, a2 = (1.0 - std::numbers::sqrt2 * c + c * c) / d;
  for (int pass = 0; pass < 2; ++pass) {
    double x1 = values.front(), x2 = x1, y1 = x1, y2 = x1;
    for (double& value : values) {
      const double y = b * (value + 2.0 * x1 + x2) - a1 * y1 - a2 * y2;
      x2 = x1, x1 = value, y2 = y1, y1 = y;
      value = y;
    }
    std::reverse(values.begin(), values.end());
  }
}

host::Log record(const machine::Machine& machine, const Mechanics& mechanics, const Trajectory& trajectory,
                 const Trajectory& other, const NoiseLevels& noise, double period, std::uint64_t seed) {
  using S = FixedSignals;
  const auto& axis = machine.axes.front();
  const double tick = machine.timing.fast_period, h = tick / steps_per_tick;
  const auto config = machine::configure_axis<S>(machine.timing, true_drive(axis, mechanics));
  const auto period_ns = machine::fast_period_ns(machine.timing);
  Ticker ticker(period_ns, static_cast<std::uint32_t>(machine::slow_ratio(machine.timing)));
  Axis<S> drive(config);

  const double start = trajectory.at(0.0).position;
  Motor motor(axis.motor, mechanics, h);
  const double turn = 2.0 * pi * 0.6180339887 * static_cast<double>(seed % 100);
  Carriage carriage(mechanics, start, turn);
  Encoder encoder(axis.encoder, mechanics, start);
  GaussMarkov slow(noise.slow_force, noise.slow_force_corner, tick, seed * 8 + 1);
  GaussMarkov fast(noise.fast_force, noise.fast_force_corner, tick, seed * 8 + 2);
  GaussMarkov jitter(noise.encoder, 2000.0, tick, seed * 8 + 3);
  std::array<GaussMarkov, 3> sensors{GaussMarkov(noise.phase_current, 3000.0, tick, seed * 8 + 4),
                                     GaussMarkov(noise.phase_current, 3000.0, tick, seed * 8 + 5),
                                     GaussMarkov(noise.phase_current, 3000.0, tick, seed * 8 + 6)};
  Memory current;
  Inverter inverter(axis.inverter.dead_time, tick);

  host::Log log;
  log.source = trajectory.name() + ".csv";
  log.period = period;
  auto& channels = log.axes.emplace_back();
  channels.axis = axis.name;
  host::AxisLog second;
  second.axis = "Y";
  const auto stride = std::lround(period / tick);
  const auto ticks = std::lround(trajectory.duration() / tick);
  AxisSignals<S> signals;
  for (long k = 0; k < ticks; ++k) {
    const std::int64_t now_ns = k * period_ns;
    const double t = static_cast<double>(k) * tick;
    Feedback<S> feedback;
    feedback.position_valid = machine::convert(encoder.read(jitter.next()), feedback.position);
    feedback.position_time_ns = now_ns;
    for (std::size_t p = 0; p < 3; ++p)
      feedback.fault |= !machine::convert(motor.current[p] + sensors[p].next(), feedback.current[p]);
    if (k == 0) drive.start(feedback);
    const auto set = trajectory.at(t);
    const auto command = drive.tick(sim::to_set_point<S>(set), feedback, now_ns, ticker.slow(), signals);
    if (drive.fault() != Fault::none)
      throw Tripped(fmt::format("blind: fault {} at {:.4f} s of {}", name_of(drive.fault()), t, log.source));
    ticker.advance();

    const double recorded = current.delayed(machine::to_si(signals.i), mechanics.current_delay / tick);
    if (k % stride == 0) {
      log.t.push_back(t);
      channels.x_set.push_back(set.position);
      channels.x.push_back(machine::to_si(signals.x));
      channels.i.push_back(recorded);
      second.x.push_back(1e-9 * std::round(1e9 * other.at(t).position));
    }
    inverter.command(
        {machine::to_si(command.voltage[0]), machine::to_si(command.voltage[1]), machine::to_si(command.voltage[2])});
    const double acceleration = other.at(t + 0.5 * tick).acceleration;
    const double disturbance = slow.next() + fast.next();
    for (int step = 0; step < steps_per_tick; ++step) {
      const auto u = inverter.acting(step / double{steps_per_tick}, (step + 1) / double{steps_per_tick});
      const double force = motor.advance(u, carriage.motor_x(), carriage.motor_v());
      carriage.advance(force, disturbance, acceleration, h, t + step * h);
      encoder.advance(carriage.x(), h);
    }
  }
  log.axes.push_back(std::move(second));
  return log;
}

std::vector<double> residual_force(const host::Log& log, const Mechanics& mechanics, double force_constant,
                                   double band) {
  const auto& axis = log.axes.front();
  const std::size_t n = axis.x.size();
  const double h = log.period;
  // Central differences of sixth order: at 100 Hz and 1 kHz the second is 1e-4 off.
  constexpr std::array<double, 4> first{0.0, 0.75, -0.15, 1.0 / 60.0};
  constexpr std::array<double, 4> second{-49.0 / 18.0, 1.5, -0.15, 1.0 / 90.0};
  Contact contact(mechanics.contact);
  std::vector<double> residual(n, 0.0);
  double contact_force = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    if (k > 0) contact_force = contact.move(axis.x[k] - axis.x[k - 1]);
    if (k < 3 || k + 3 >= n) continue;
    double v = 0.0, a = second[0] * axis.x[k];
    for (std::size_t j = 1; j < 4; ++j) {
      v += first[j] * (axis.x[k + j] - axis.x[k - j]);
      a += second[j] * (axis.x[k + j] + axis.x[k - j]);
    }
    residual[k] = force_constant * axis.i[k] - mechanics.mass * a / (h * h) - mechanics.viscous * v / h - contact_force;
  }
  zero_phase(residual, band, h);
  const auto cut = static_cast<std::ptrdiff_t>(std::min<double>(5.0 / (band * h), static_cast<double>(n) / 4.0));
  return {residual.begin() + cut, residual.end() - cut};
}

}  // namespace stiction::blind
