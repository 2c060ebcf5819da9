#include "host/identify/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware/machine/model/motor_force.hpp"
namespace stiction::host {
namespace {

constexpr int position_order = 4;
constexpr int anti_alias_order = 8;
constexpr double anti_alias_ripple = 0.05;  // dB
constexpr double anti_alias_edge = 0.8;     // of half the new rate
constexpr double rows_per_band = 2.5;       // rate of the rows over the band that they hold

// A filter's default padding is right for the rates of the recipe: the position's at 1 kHz, the anti-aliasing one's at
// a ratio of 10. In time it stays the same.
std::size_t scaled_padding(const Lowpass& filter, double scale) {
  return static_cast<std::size_t>(std::lround(static_cast<double>(default_padding(filter)) * std::max(1.0, scale)));
}

// Samples of the log for one row.
std::size_t row_ratio(double period, const SignalSettings& settings) {
  const double ratio = settings.band > 0.0 ? std::floor(1.0 / (rows_per_band * settings.band * period))
                                           : std::round(1.0 / (settings.row_rate * period));
  return static_cast<std::size_t>(std::max(1.0, ratio));
}

std::size_t samples(double duration, double period) { return static_cast<std::size_t>(std::lround(duration / period)); }

}  // namespace

SignalSettings published_recipe() {
  SignalSettings s;
  s.difference_points = 3;
  s.skip_start = 0.049;
  s.skip_end = 0.0;
  return s;
}

std::vector<double> force_of(const Log& log, const AxisLog& channels, const machine::AxisModel& axis, Amperes amperes) {
  const bool source = axis.motor.driven_by_volts();
  const double per_unit = machine::acting_force_constant(axis.motor);
  std::vector<double> force;
  if (!channels.force.empty()) {
    force = channels.force;
  } else if (!channels.i.empty() && !source) {
    const double amplitude = amperes == Amperes::rms ? std::numbers::sqrt2 : 1.0;
    force = channels.i;
    for (double& f : force) f *= amplitude * per_unit;
  } else if (!channels.u.empty() && source) {
    force = channels.u;
    for (double& f : force) f *= per_unit;
  } else {
    throw LogError(
        fmt::format("{}: found neither the motor's force nor {}; expected a column F[N]{}", log.source,
                    source ? "its voltage, as the machine file describes the motor as a force source" : "its current",
                    source ? " or u[V]" : " or i[A]"));
  }
  for (std::size_t k = 0; k < channels.external_force.size(); ++k) force[k] += channels.external_force[k];
  return force;
}

std::vector<double> shape_of_constant(const machine::AxisModel& axis, const std::vector<double>& x) {
  if (!axis.gravity || !axis.coordinate.rotary()) return {};
  std::vector<double> shape(x.size());
  std::transform(x.begin(), x.end(), shape.begin(),
                 [&](double at) { return std::sin((at - axis.gravity->zero) / axis.coordinate.radius); });
  return shape;
}

Motion motion_of(const Log& log, const AxisLog& channels, const machine::AxisModel& axis, Amperes amperes,
                 const SignalSettings& settings) {
  Motion motion{log.source, log.period, log.t, {}, {}, {}, {}, channels.i, channels.x_set};
  motion.force = force_of(log, channels, axis, amperes);
  motion.force_is_current = channels.force.empty() && channels.external_force.empty();
  if (log.t.size() < 20) return motion;
  const double cutoff = std::min(settings.cutoff, settings.highest / log.period);
  const auto lowpass = butterworth(position_order, 2.0 * cutoff * log.period);
  motion.x = filter_both_ways(lowpass, channels.x, scaled_padding(lowpass, 1e-3 / log.period));
  motion.read = channels.x;
  motion.constant = shape_of_constant(axis, motion.x);
  motion.v = central_difference(motion.x, log.period, settings.difference_points);
  motion.a = central_difference(motion.v, log.period, settings.difference_points);
  if (log.axes.size() != 2) return motion;
  const auto& other = &log.axes.front() == &channels ? log.axes.back() : log.axes.front();
  const auto x = filter_both_ways(lowpass, other.x, scaled_padding(lowpass, 1e-3 / log.period));
  motion.other_a = central_difference(central_difference(x, log.period, settings.difference_points), log.period,
                                      settings.difference_points);
  return motion;
}

RowFilter::RowFilter(const Motion& motion, const SignalSettings& settings)
    : samples_(motion.t.size()),
      begin_(samples(settings.skip_start, motion.period)),
      end_(samples_),
      ratio_(row_ratio(motion.period, settings)),
      period_(static_cast<double>(ratio_) * motion.period) {
  const std::size_t skipped_end = samples(settings.skip_end, motion.period);
  end_ = end_ > begin_ + skipped_end ? end_ - skipped_end : begin_;
  rows_ = (end_ - begin_ + ratio_ - 1) / ratio_;
  const double edge = settings.band > 0.0 ? 2.0 * settings.band * motion.period
                                          : std::min(anti_alias_edge / static_cast<double>(ratio_), settings.highest);
  lowpass_ = chebyshev(anti_alias_order, anti_alias_ripple, edge);
  // Of even order it stands at the ripple's lower end at standstill; a force keeps its size in its rows.
  const double at_standstill = std::pow(10.0, anti_alias_ripple / 20.0);
  auto& first = lowpass_.sections.front();
  for (double* b : {&first.b0, &first.b1, &first.b2}) *b *= at_standstill;
  padding_ = scaled_padding(lowpass_, 0.1 * anti_alias_edge / edge);
}

std::span<const double> RowFilter::kept(std::span<const double> column) const {
  return column.subspan(begin_, end_ - begin_);
}

std::vector<double> RowFilter::operator()(std::span<const double> column) const {
  return every(filter_both_ways(lowpass_, kept(column), padding_), ratio_);
}

std::vector<std::vector<double>> RowFilter::operator()(const std::vector<std::vector<double>>& columns) const {
  std::vector<std::span<const double>> all;
  for (const auto& column : columns) all.push_back(kept(column));
  std::vector<std::vector<double>> rows;
  for (const auto& column : filter_both_ways(lowpass_, all, padding_)) rows.push_back(every(column, ratio_));
  return rows;
}

std::vector<double> RowFilter::transposed(std::span<const double> rows) const {
  std::vector<double> all(end_ - begin_, 0.0);
  for (std::size_t k = 0; k < rows.size(); ++k) all[k * ratio_] = rows[k];
  all = filter_both_ways(lowpass_, all, padding_);
  all.insert(all.begin(), begin_, 0.0);
  all.resize(samples_, 0.0);
  return all;
}

std::vector<double> RowFilter::sampled(std::span<const double> column) const { return every(kept(column), ratio_); }

}  // namespace stiction::host
