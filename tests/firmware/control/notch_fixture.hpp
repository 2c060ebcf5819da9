// A notch as the machine file's frequency and dampings give it to the drive, in either signal policy.
#pragma once

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/configuration/conversion.hpp"
#include "firmware/machine/configuration/double_signals.hpp"
#include "stiction/control/notch.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::test {

template <class S>
typename Notch<S>::Config notch_config(const machine::NotchParameters& notch) {
  machine::AxisModel axis;
  axis.name = "x";
  axis.mass = 1.0;
  axis.max_velocity = 1.0;
  axis.motor.model = machine::MotorModel::force;
  axis.motor.force_constant = 1.0;
  axis.inverter.voltage_limit = 10.0;
  axis.position_controller.gain = 1.0;
  axis.velocity_controller.gain = 1.0;
  axis.notch = notch;
  return machine::configure_axis<S>({}, axis).notch;
}

// The filter itself, ampere in and out.
template <class S>
class NotchFilter {
 public:
  explicit NotchFilter(const machine::NotchParameters& notch) : config_(notch_config<S>(notch)) {}

  double step(double x) {
    return machine::to_si(
        stiction::Notch<S>::step(config_, state_, machine::to_signal<typename S::Current>(x).value(), saturations));
  }

  SaturationCounter saturations;

 private:
  typename stiction::Notch<S>::Config config_;
  typename stiction::Notch<S>::State state_{};
};

}  // namespace stiction::test
