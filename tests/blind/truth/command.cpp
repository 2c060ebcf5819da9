#include "tests/blind/truth/command.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace stiction::blind {
namespace {

constexpr double lowest = 1.0, highest = 100.0;  // Hz

// Central differences of sixth order.
std::vector<double> rate_of(const std::vector<double>& x, double period) {
  constexpr std::array<double, 4> coefficients{0.0, 0.75, -0.15, 1.0 / 60.0};
  std::vector<double> rate(x.size());
  for (std::size_t k = 3; k + 3 < x.size(); ++k)
    for (std::size_t j = 1; j < 4; ++j) rate[k] += coefficients[j] * (x[k + j] - x[k - j]) / period;
  return rate;
}

struct Gains {
  double position, velocity, integral_time;
};

class Controller {
 public:
  Controller(const host::AxisLog& axis, double period)
      : axis_(axis), period_(period), v_(rate_of(axis.x, period)), v_set_(rate_of(axis.x_set, period)) {}

  // But for the feedforward, which is the same in both.
  std::vector<double> command(const Gains& gains) const {
    std::vector<double> values(v_.size());
    double integral = 0.0;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double error = gains.position * (axis_.x_set[k] - axis_.x[k]) + v_set_[k] - v_[k];
      integral += error * period_ / gains.integral_time;
      values[k] = gains.velocity * (error + integral);
    }
    return values;
  }

 private:
  const host::AxisLog& axis_;
  double period_;
  std::vector<double> v_, v_set_;
};

}  // namespace

std::vector<double> command_effect(const host::Log& log, const machine::AxisModel& file, const Mechanics& truth) {
  const auto& axis = log.axes.front();
  const double h = log.period;
  const Gains gains{file.position_controller.gain, file.velocity_controller.gain,
                    *file.velocity_controller.integral_time};
  const Controller controller(axis, h);
  const auto of_file = controller.command(gains);
  const auto of_truth = controller.command({gains.position * truth.position_gain, gains.velocity * truth.velocity_gain,
                                            gains.integral_time * truth.velocity_integral_time});
  std::vector<double> effect(of_file.size());
  for (std::size_t k = 0; k < effect.size(); ++k) effect[k] = of_truth[k] - of_file[k];
  auto slow = effect;
  zero_phase(slow, lowest, h);
  for (std::size_t k = 0; k < effect.size(); ++k) effect[k] -= slow[k];
  zero_phase(effect, highest, h);
  const auto cut = static_cast<std::ptrdiff_t>(std::min<double>(0.3 / h, static_cast<double>(effect.size()) / 4.0));
  return {effect.begin() + cut, effect.end() - cut};
}

}  // namespace stiction::blind
