// The current recorded late against the position: F(t - delay) - F(t) with the force that the file expects, over the
// delay. The scanned delay is the place of the slope: at the true one the weight is the delay itself.
#include <algorithm>
#include <array>
#include <cmath>

#include "host/diagnose/classes/effect_regressor.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "sim/effects/effects.hpp"
#include "sim/effects/time_skew/time_skew.hpp"

namespace stiction::host::effects::time_skew {
namespace {

constexpr double longest_loop_delay = 0.3e-3;  // s; longer ones no current loop of this kind survives

// The answer of the loop comes late too: along the measured motion that is a skew which the record does not have.
std::vector<double> grid(const SearchContext& context) {
  if (context.measured_motion) return {};
  return {1e-4, 1e-3, 3e-3, -1e-3, -3e-3};
}

// `values` at a time `delay` (s) earlier; cubic through four samples, the ends held.
std::vector<double> delayed(const std::vector<double>& values, double delay, double period) {
  const auto n = static_cast<std::ptrdiff_t>(values.size());
  const auto at = [&](std::ptrdiff_t i) {
    return values[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, n - 1))];
  };
  std::vector<double> out(values.size());
  const double shift = delay / period;
  const double whole = std::floor(-shift), s = -shift - whole;
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const auto k = i + static_cast<std::ptrdiff_t>(whole);
    const double a = at(k - 1), b = at(k), c = at(k + 1), d = at(k + 2);
    out[static_cast<std::size_t>(i)] = -s * (s - 1.0) * (s - 2.0) / 6.0 * a +
                                       (s + 1.0) * (s - 1.0) * (s - 2.0) / 2.0 * b -
                                       (s + 1.0) * s * (s - 2.0) / 2.0 * c + (s + 1.0) * s * (s - 1.0) / 6.0 * d;
  }
  return out;
}

Columns columns(const SearchContext& context, const Motion& motion, double delay) {
  const auto force = force_along(context.axis, motion);
  auto column = delayed(force, delay, motion.period);
  for (std::size_t i = 0; i < column.size(); ++i) column[i] = (column[i] - force[i]) / delay;
  return {column};
}
// Slopes far from the weight do not describe it.
bool possible(const SearchContext&, double delay, const Eigen::VectorXd& w) {
  return std::abs(delay) < 2e-4 || (w[0] * delay > 0.0 && w[0] / delay > 0.3 && w[0] / delay < 3.0);
}
void describe(const SearchContext& context, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c,
              Finding& finding) {
  add_key(context, finding, "delay", {w[0]}, {std::sqrt(c(0, 0))});
}

// The delay in the loop shows in what the drive commands.
double loop_delay_of(const machine::AxisModel& axis) {
  const auto known = sim::effects_of<sim::TimeSkew>(axis);
  return known.empty() ? 0.0 : known.front().loop_delay;
}
// Behind a force source's voltage there is nothing that a delay could show in.
std::optional<double> loop_delay(const machine::AxisModel& axis) {
  return axis.current_controller ? std::optional(loop_delay_of(axis)) : std::nullopt;
}
void set_loop_delay(machine::AxisModel& axis, double delay) {
  const auto known = std::find_if(axis.effects.begin(), axis.effects.end(),
                                  [](const machine::Effect& effect) { return sim::is_a<sim::TimeSkew>(effect); });
  auto& effect = known == axis.effects.end() ? axis.effects.emplace_back(sim::effect_of<sim::TimeSkew>({})) : *known;
  effect.values["loop_delay"] = {std::clamp(delay, 0.0, longest_loop_delay)};
}
constexpr std::array in_loop{CommandParameter{
    "loop_delay", loop_delay, set_loop_delay,
    [](const machine::AxisModel&, const machine::Timing& timing) { return timing.fast_period; }, true}};

}  // namespace

extern const EffectRegressor regressor{
    .force = {.grid = grid, .columns = columns, .possible = possible, .describe = describe, .at_weight = true},
    .command = in_loop};

}  // namespace stiction::host::effects::time_skew
