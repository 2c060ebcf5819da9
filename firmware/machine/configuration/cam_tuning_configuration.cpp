#include "firmware/machine/configuration/cam_tuning_configuration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace stiction::machine {
namespace {

using Complex = std::complex<double>;

// Until what the drive's own lag leaves of the rise has died, as at the desk.
constexpr double settling = 6.0;  // time constants
// Over so much the master may be faster or slower: the pulses' length is off by as much.
constexpr double speed_tolerance = 0.01;

// A coefficient of t^`n` in units of the position.
double units_of(const CamTable::Segment& segment, int n) {
  return std::ldexp(static_cast<double>(segment.c[n - 1]),
                    CamTable::extra_bits - segment.shift - segment.finer_bits(n));
}

// The way within a segment at most, in units of the position.
double way_in(const CamTable::Segment& segment) {
  double most = 0.0;
  for (int n = 1; n < 6; ++n) most += std::abs(units_of(segment, n));
  return most;
}

// A rest ends with the integers with which the motion behind it begins, which rounding has moved from its own: its way
// is not nothing, but nothing beside that of what moves.
double largest_way_at_rest(const CamTable& table) {
  double largest = 0.0;
  for (std::uint32_t k = 0; k < table.header().count; ++k) largest = std::max(largest, way_in(table.segment(k)));
  return std::ldexp(largest, -20);
}

std::uint64_t end_of(const CamTable& table, std::uint32_t k) {
  return k + 1 < table.header().count ? table.segment(k + 1).start : std::uint64_t{1} << 32;
}

// The integral of u'(t) e^(p (end - t)) over `duration` before `end` (s), where u' dt = slope(x) dx with x from 0 to 1.
template <class Slope>
Complex integral(Complex pole, double duration, double end, Slope slope) {
  const int steps = 2 * static_cast<int>(std::ceil(std::abs(pole) * duration / 0.05) + 4.0);
  Complex sum = 0.0;
  for (int k = 0; k <= steps; ++k) {
    const double x = static_cast<double>(k) / steps, weight = k == 0 || k == steps ? 1.0 : k % 2 == 1 ? 4.0 : 2.0;
    sum += weight * slope(x) * std::exp(pole * (end + duration * (1.0 - x)));
  }
  return sum / (3.0 * steps);
}

double pulse_slope(double x) { return 30.0 * x * x * (1.0 - x) * (1.0 - x); }

std::uint32_t phases(double cycles) { return static_cast<std::uint32_t>(std::llround(std::ldexp(cycles, 32))); }

}  // namespace

Complex LoadMode::pole() const {
  const double w = 2.0 * std::numbers::pi * frequency;
  return {-damping * w, w * std::sqrt(1.0 - damping * damping)};
}

double LoadMode::period() const { return 2.0 * std::numbers::pi / pole().imag(); }

TablePoint table_point(const CamTable& table, std::uint64_t phase, bool before) {
  const std::uint32_t k = table.find(static_cast<std::uint32_t>(before ? phase - 1 : phase));
  const auto segment = table.segment(k);
  const double over = std::ldexp(static_cast<double>(segment.reciprocal), -segment.down);  // t in a cycle
  const double t = std::ldexp(static_cast<double>(phase - segment.start), -32) * over;
  const double unit = std::ldexp(1.0, -table.header().position_bits);
  std::array<double, 6> c{static_cast<double>(segment.c0) * unit};
  for (std::size_t n = 1; n < 6; ++n) c[n] = units_of(segment, static_cast<int>(n)) * unit;
  TablePoint point;
  for (std::size_t n = 6; n-- > 0;) {
    point.bend = point.bend * t + 2.0 * point.slope;
    point.slope = point.slope * t + point.position;
    point.position = point.position * t + c[n];
  }
  point.slope *= over;
  point.bend *= over * over;
  return point;
}

std::optional<TunedRise> tuned_rise(const CamTable& table) {
  struct Rest {
    std::uint64_t begin, end;
  };
  std::vector<Rest> found;
  const double at_rest = largest_way_at_rest(table);
  for (std::uint32_t k = 0; k < table.header().count; ++k) {
    const std::uint64_t begin = table.segment(k).start, end = end_of(table, k);
    if (way_in(table.segment(k)) > at_rest) continue;
    if (!found.empty() && found.back().end == begin)
      found.back().end = end;
    else
      found.push_back({begin, end});
  }
  constexpr std::uint64_t cycle = std::uint64_t{1} << 32;
  if (found.empty() || (found.front().begin == 0 && found.front().end == cycle)) return {};
  // A rest over the seam is one, behind the motion that ends in it.
  const std::uint64_t before_first = found.front().begin == 0 ? found.front().end : 0;
  std::size_t longest = found.size();
  std::uint64_t longest_rest = 0;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (found[k].begin == 0) continue;
    const std::uint64_t rest = found[k].end - found[k].begin + (found[k].end == cycle ? before_first : 0);
    if (rest > longest_rest) longest = k, longest_rest = rest;
  }
  if (longest == found.size()) return {};
  const std::uint64_t begin = longest > 0 ? found[longest - 1].end : 0, end = found[longest].begin;
  // What moves at the begin of the cycle without a rest there, or up to its end, moves over the seam.
  if (begin == 0 && found.back().end != cycle) return {};
  TunedRise rise;
  rise.begin = static_cast<std::uint32_t>(begin);
  rise.length = static_cast<std::uint32_t>(end - begin);
  rise.rest = static_cast<std::uint32_t>(longest_rest);
  rise.start = table_point(table, begin).position;
  rise.stroke = table_point(table, end).position - rise.start;
  return rise;
}

Complex drive_residue(const AxisModel* axis, const LoadMode& mode, double& lag) {
  const Complex p = mode.pole();
  lag = 0.0;
  // Y/U = (2 z w s + w^2) / (s^2 + 2 z w s + w^2), whose numerator is -s^2 at the pole.
  const Complex alone = -p / Complex(0.0, 2.0 * p.imag());
  if (axis == nullptr || !axis->elastic() || !axis->cascaded() || axis->velocity_controller.integral_time) return alone;
  // k_D (u - x) + b_D (u' - x') is the cascade, q = k + b s the shaft (docs/residual_vibration.md). The pole says what
  // the shaft is: (J p^2 + b_D p + k_D) (1 + I p^2 / q) = -I p^2.
  const double load = axis->mass - axis->motor_mass, motor = axis->motor_mass;
  const double b_drive = axis->velocity_controller.gain * axis->motor.force_constant;
  const double k_drive = axis->position_controller.gain * b_drive;
  const Complex inertia = load * p * p, rotor = motor * p * p + b_drive * p + k_drive;
  const Complex q = -inertia / (1.0 + inertia / rotor);
  const double b = q.imag() / p.imag(), k = q.real() - b * p.real();
  if (!(k > 0.0)) return alone;
  // D = (I s^2 + q) (J s^2 + b_D s + k_D + q) - q^2, N = q (b_D s + k_D).
  const Complex slope =
      (2.0 * load * p + b) * (rotor + q) + (inertia + q) * (2.0 * motor * p + b_drive + b) - 2.0 * q * b;
  lag = b_drive / k_drive;
  // The drive's own poles: about those of the rotor alone, whose slowest is at most twice as slow as the position loop.
  const double half = 0.5 * b_drive / motor, square = half * half - k_drive / motor;
  lag = square > 0.0 ? 1.0 / (half - std::sqrt(square)) : 1.0 / half;
  return q * (b_drive * p + k_drive) / (slope * p);
}

CamTuningDesign::CamTuningDesign(const Given& given)
    : mode_(given.mode), speed_(given.speed), tick_(given.period), increment_(given.increment) {
  const auto found = tuned_rise(*given.table);
  if (!found)
    throw CamTuningError("found a table without a rest behind a rise; expected one, in which the load may vibrate");
  rise_ = *found;
  const Complex p = mode_.pole();
  const double cycle = 1.0 / speed_, rise_time = std::ldexp(rise_.length, -32) * cycle, half = 0.5 * mode_.period();
  if (1.5 * half > rise_time)
    throw CamTuningError(
        fmt::format("found a rise of {:.2f} periods of the load; expected 0.75 or more, which two "
                    "pulses take",
                    rise_time / (2.0 * half)));
  places_.length = phases(half * speed_);
  places_.second = rise_.end() - places_.length;
  places_.first = places_.second - places_.length / 2;
  if (given.places) places_ = *given.places;
  const Complex factor = 2.0 * drive_residue(given.axis, mode_, lag_) * std::exp(-p * mode_.delay);
  own_ = 0.0;
  for (std::uint32_t k = 0; k < given.table->header().count; ++k) {
    const std::uint64_t begin = given.table->segment(k).start, end = end_of(*given.table, k);
    if (begin < rise_.begin || end > std::uint64_t{rise_.begin} + rise_.length) continue;
    const double share = std::ldexp(static_cast<double>(end - begin), -32);
    const double behind = std::ldexp(static_cast<double>(std::uint64_t{rise_.begin} + rise_.length - end), -32) * cycle;
    own_ += integral(p, share * cycle, behind, [&](double x) {
      const auto at = begin + static_cast<std::uint64_t>(x * static_cast<double>(end - begin));
      return table_point(*given.table, at, at == end).slope * share;
    });
  }
  own_ *= factor;
  const std::uint32_t begins[]{places_.first, places_.second};
  for (int k = 0; k < 2; ++k) {
    const double length = std::ldexp(places_.length, -32) * cycle;
    const double behind = std::ldexp(rise_.end() - places_.length - begins[k], -32) * cycle;
    unit_[k] = factor * integral(p, length, behind, pulse_slope) - own_ / rise_.stroke;
  }
  const double rest = std::ldexp(rise_.rest, -32) * cycle - mode_.delay - settling * lag_;
  if (rest < mode_.period())
    throw CamTuningError(fmt::format(
        "found a rest of {:.1f} ms behind the drive's lag; expected a period of the load or more, {:.1f} ms",
        1e3 * rest, 1e3 * mode_.period()));
}

CamTuning::Config CamTuningDesign::config(Complex factor) const {
  CamTuning::Config config;
  config.rise_begin = rise_.begin;
  config.rise_length = rise_.length;
  const double a_tick = speed_ * tick_;
  config.settling = phases((mode_.delay + settling * lag_) * speed_);
  config.window_end = rise_.rest - phases(4.0 * a_tick);
  config.ticks_a_phase = static_cast<std::uint32_t>(std::min(std::ldexp(1.0 / a_tick, 16), 0x1p32 - 1.0));
  const Complex z = std::exp(mode_.pole() * tick_);
  config.turn_re = static_cast<std::int32_t>(std::llround(std::ldexp(z.real(), CamTuning::phasor_bits)));
  config.turn_im = static_cast<std::int32_t>(std::llround(std::ldexp(z.imag(), CamTuning::phasor_bits)));
  // As far as the stroke, which no load that is to be tuned is off.
  config.shift = static_cast<std::int8_t>(std::clamp(
      static_cast<int>(std::ceil(std::log2(std::abs(rise_.stroke) * 0x1p40 / CamTuning::most_deviation))), 0, 40));
  const double ticks = std::ldexp(config.window_end - config.settling, -32) / a_tick;
  config.every = static_cast<std::int16_t>(std::clamp(std::ceil(ticks / CamTuning::record_size), 1.0, 32767.0));
  config.least_ticks = static_cast<std::int32_t>(std::ceil(mode_.period() / tick_));
  config.speed = std::llround(std::ldexp(a_tick, MotionPoint::velocity_bits));
  config.speed_tolerance = std::llround(speed_tolerance * std::ldexp(a_tick, MotionPoint::velocity_bits));
  const double noise = increment_ * 0x1p40 / std::ldexp(1.0, config.shift);
  config.noise = std::llround(std::min(256.0 * noise * noise, 0x1p60));
  // first u + second v = -factor (re + i im), in its two parts.
  const Complex u = unit_[0], v = unit_[1];
  const double determinant = u.real() * v.imag() - u.imag() * v.real();
  const auto row = [&](Complex w, double sign) {
    // Of -(re + i im) factor against w: its change with re, and with im.
    const Complex with_re = -factor, with_im = -factor * Complex(0.0, 1.0);
    const auto solve = [&](Complex right) {
      return sign * (right.real() * w.imag() - right.imag() * w.real()) / determinant;
    };
    return std::array{solve(with_re), solve(with_im)};
  };
  const auto first = row(v, 1.0), second = row(u, -1.0);
  const double values[]{first[0], first[1], second[0], second[1]};
  for (std::size_t k = 0; k < 4; ++k)
    config.pulses[k] = static_cast<std::int32_t>(
        std::llround(std::clamp(std::ldexp(values[k], CamTuning::pulse_bits), -0x1p30, 0x1p30)));
  return config;
}

}  // namespace stiction::machine
