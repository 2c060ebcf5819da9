// What surrounds an axis' motor and power stage: the capacitor of the DC link, which a rectifier charges and a braking
// motor lifts, and the temperatures that the losses make of winding and stage, each a body of one time constant.
#pragma once

#include <algorithm>
#include <cmath>

#include "firmware/machine/model/machine.hpp"
#include "sim/plant/inverter.hpp"

namespace stiction::sim {

class DriveSupply {
 public:
  static constexpr double ambient = 20.0;  // degrees Celsius

  // `axis`: with its inverter's and motor's thermal and electrical values; `tick`: of the drive, s.
  DriveSupply(const machine::AxisModel& axis, double tick)
      : tick_(tick),
        resistance_(axis.motor.phase_resistance / axis.motor.count),
        rectified_(axis.inverter.dc_link.value_or(axis.inverter.voltage_limit)),
        capacitance_(axis.inverter.dc_link_capacitance),
        loss_voltage_(axis.inverter.loss_voltage),
        motor_{axis.motor.thermal_resistance, std::exp(-tick / axis.motor.thermal_time_constant)},
        stage_{axis.inverter.thermal_resistance, std::exp(-tick / axis.inverter.thermal_time_constant)},
        dc_link_(rectified_) {}

  // A tick under these voltages (V) of the phases with these currents (A).
  void step(const PhaseValues& voltage, const PhaseValues& current) {
    double power = 0.0, squares = 0.0, amperes = 0.0;
    for (std::size_t k = 0; k < current.size(); ++k) {
      power += voltage[k] * current[k];
      squares += current[k] * current[k];
      amperes += std::abs(current[k]);
    }
    if (capacitance_ > 0.0) {
      const double energy = 0.5 * capacitance_ * dc_link_ * dc_link_ - power * tick_;
      dc_link_ = std::max(rectified_, std::sqrt(2.0 * std::max(energy, 0.0) / capacitance_));
    }
    motor_.step(resistance_ * squares);
    stage_.step(loss_voltage_ * amperes);
  }

  double dc_link() const { return dc_link_; }                         // V
  double motor_temperature() const { return ambient + motor_.rise; }  // degrees Celsius, of the winding
  double stage_temperature() const { return ambient + stage_.rise; }  // degrees Celsius

 private:
  struct Body {
    double resistance;  // K/W
    double decay;       // in a tick
    double rise = 0.0;  // K
    void step(double loss) { rise = decay * rise + (1.0 - decay) * resistance * loss; }
  };

  double tick_;
  double resistance_;    // Ohm
  double rectified_;     // V
  double capacitance_;   // F
  double loss_voltage_;  // V
  Body motor_, stage_;
  double dc_link_;
};

}  // namespace stiction::sim
