#include "tests/blind/truth/command.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/blind/truth/axis.hpp"

namespace stiction::blind {
namespace {

constexpr double lowest = 1.0, highest = 100.0;  // Hz

// Central differences of sixth order.
std::vector<double> rate_of(const std::vector<double>& x, double period) {
  constexpr std::array<double, 4> weights{0.0, 0.75, -0.15, 1.0 / 60.0};
  std::vector<double> rate(x.size());
  for (std::size_t k = 3; k + 3 < x.size(); ++k)
    for (std::size_t j = 1; j < 4; ++j) rate[k] += weights[j] * (x[k + j] - x[k - j]) / period;
  return rate;
}

}  // namespace

std::vector<double> command_residual(const host::Log& log, const sim::Axis& file) {
  const auto& axis = log.axes.front();
  const double h = log.period;
  const auto v = rate_of(axis.x, h), v_set = rate_of(axis.x_set, h), a_set = rate_of(v_set, h);
  const double integral_time = *file.velocity_controller.integral_time;
  std::vector<double> residual(v.size());
  double integral = 0.0;
  for (std::size_t k = 0; k < residual.size(); ++k) {
    const double error = file.position_controller.gain * (axis.x_set[k] - axis.x[k]) + v_set[k] - v[k];
    integral += error * h / integral_time;
    const double command = file.velocity_controller.gain * (error + integral) +
                           file.feedforward.current * file.mass / file.motor.force_constant * a_set[k];
    residual[k] = axis.i[k] - command;
  }
  auto slow = residual;
  zero_phase(slow, lowest, h);
  for (std::size_t k = 0; k < residual.size(); ++k) residual[k] -= slow[k];
  zero_phase(residual, highest, h);
  const auto cut = static_cast<std::ptrdiff_t>(std::min<double>(0.3 / h, static_cast<double>(residual.size()) / 4.0));
  return {residual.begin() + cut, residual.end() - cut};
}

}  // namespace stiction::blind
