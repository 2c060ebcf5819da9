// What fixed point costs: the same inputs through P, feedforwards, PI and notch in fixed point and in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/configuration/conversion.hpp"
#include "firmware/machine/configuration/double_signals.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/support/figure.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction {
namespace {

// The axis' own velocity controller, fed with what it takes from the rest of a tick.
template <class S>
class VelocityLoop {
 public:
  VelocityLoop(const machine::Machine& machine, std::size_t axis)
      : axis_(machine::configure_axis<S>(machine.timing, machine.axes[axis])) {
    axis_.start({});
  }

  double step(double e_held, double v_set, double v, double a_set) {
    signals_.e_held = machine::to_signal<typename S::Distance>(e_held).value();
    signals_.v_set_delayed = machine::to_signal<typename S::Velocity>(v_set).value();
    signals_.v = machine::to_signal<typename S::Velocity>(v).value();
    SetPoint<S> set;
    set.acceleration = machine::to_signal<typename S::Acceleration>(a_set).value();
    axis_.control_velocity(set, 0, signals_);
    return machine::to_si(signals_.i_set);
  }

 private:
  Axis<S> axis_;
  AxisSignals<S> signals_;
};

TEST(Precision, FixedPointStaysWithinATenthOfAMilliampereOfDouble) {
  const auto machine = test::cross_table();
  double largest = 0.0;
  for (const std::size_t axis : {0u, 1u}) {
    VelocityLoop<FixedSignals> fixed(machine, axis);
    VelocityLoop<machine::DoubleSignals> real(machine, axis);
    // A circle of 90 mm at 16 m/min with following errors of whole micrometres and a velocity error of friction's size.
    const double speed = 16.0 / 60.0, turn = speed / 0.09, bit = 0x1p-32;
    for (int k = 0; k < 32000; ++k) {
      const double t = 62.5e-6 * k;
      const double e = bit * std::round(1e-6 * std::round(4.0 * std::sin(5.0 * turn * t)) / bit);
      const double v_set = speed * std::sin(turn * t), a_set = speed * turn * std::cos(turn * t);
      const double v = v_set + 83.33 * e - 2e-6 * std::sin(300.0 * t);
      largest = std::max(largest, std::abs(fixed.step(e, v_set, v, a_set) - real.step(e, v_set, v, a_set)));
    }
  }
  // Inputs round to 3.7 nm/s (times 1200 A s/m: 4 uA each), the integral gain to 2^-17 of 7.5.
  test::figure("P, feedforwards, PI, notch: fixed against double", fmt::format("{:.1e} A (bound 1e-4 A)", largest));
  EXPECT_LE(largest, 1e-4);
}

}  // namespace
}  // namespace stiction
