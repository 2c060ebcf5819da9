#include "host/simulate/injection.hpp"

#include <algorithm>

namespace stiction::host {
namespace {

bool acts(const std::vector<double>& signal) {
  return std::any_of(signal.begin(), signal.end(), [](double value) { return value != 0.0; });
}

bool is_force_source(const machine::AxisModel& axis) { return axis.commanded_in_volts(); }

}  // namespace

Injection::Injection(const Log& log, const AxisLog& channels, const machine::AxisModel& axis)
    : signal_(is_force_source(axis) ? &channels.u_inject : &channels.i_inject),
      begin_(log.t.front()),
      period_(log.period) {}

double Injection::at(double t) const {
  if (signal_->empty()) return 0.0;
  const auto& values = *signal_;
  const auto last = values.size() - 1;
  // Stamps and ticks are multiples of different steps: a millionth of a sample is none.
  constexpr double rounding = 1e-6;
  const double place = (t - begin_) / period_;
  if (place < -rounding || place > static_cast<double>(last) + rounding) return 0.0;
  const auto k = std::min(static_cast<std::size_t>(std::max(place + rounding, 0.0)), last);
  const double s = place - static_cast<double>(k);
  if (s < rounding || k == last) return values[k];
  const double p = values[k > 0 ? k - 1 : k], a = values[k], b = values[k + 1], q = values[std::min(k + 2, last)];
  return a + 0.5 * s * (b - p + s * (2.0 * p - 5.0 * a + 4.0 * b - q + s * (3.0 * (a - b) + q - p)));
}

std::string refused_injection(const AxisLog& channels, const machine::AxisModel& axis) {
  const auto prefix = channels.axis.empty() ? "" : channels.axis + ".";
  if (is_force_source(axis))
    return acts(channels.i_inject)
               ? "found " + prefix + "i_inject[A], a test signal on a current, but the motor of axis " + axis.name +
                     " is a force source without a current controller; expected u_inject[V]"
               : "";
  return acts(channels.u_inject)
             ? "found " + prefix + "u_inject[V], a test signal behind the current controller of axis " + axis.name +
                   ", where the simulation has no input; expected i_inject[A], which is added to "
                   "the set current"
             : "";
}

std::string refused_injection(const Log& log, const std::vector<const machine::AxisModel*>& axes) {
  for (std::size_t k = 0; k < log.axes.size(); ++k)
    if (auto why = refused_injection(log.axes[k], *axes[k]); !why.empty()) return why;
  return "";
}

}  // namespace stiction::host
