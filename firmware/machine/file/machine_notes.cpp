#include "firmware/machine/file/machine_notes.hpp"

#include <fmt/format.h>

#include <cmath>

#include "firmware/machine/model/motor_force.hpp"

namespace stiction::machine {
namespace {

constexpr double equal = 1e-6;     // of numbers that a file gives with a few digits
constexpr double rounding = 0.01;  // what data sheets round away

std::string beyond_rounding(double ratio) {
  if (std::abs(ratio - 1.0) <= rounding) return "";
  return "; so much is no rounding: check whether one of them is in rms amperes, or of a line in place of a winding";
}

// The drive's force constant beside that of the windings, each as the file's motor has it.
void note_force_constant(const AxisModel& axis, std::vector<std::string>& notes) {
  const double windings = acting_force_constant(axis.motor), ratio = windings / axis.motor.force_constant;
  if (std::abs(ratio - 1.0) <= equal) return;
  const auto own = axis.motor_coordinate.own("force_constant", "N/A");
  notes.push_back(fmt::format(
      "Axis {}: {} is {:.5g} {}, and the windings make {:.5g} {}, 3/2 of {:.5g} ({:+.2f} %). The drive reckons with "
      "the "
      "first; the simulated motor has the second, and logs are read with it{}.",
      axis.name, own.key, own.from_linear(axis.motor.force_constant), own.unit, own.from_linear(windings), own.unit,
      own.from_linear(axis.motor.phase_force_constant), 100.0 * (ratio - 1.0), beyond_rounding(ratio)));
}

// A winding's voltage per speed and force per ampere are one constant, by the energy that it converts.
void note_emf_constant(const AxisModel& axis, std::vector<std::string>& notes) {
  const double ratio = axis.motor.emf_constant / axis.motor.phase_force_constant;
  if (std::abs(ratio - 1.0) <= rounding) return;
  const auto emf = axis.motor_coordinate.own("emf_constant", "V s/m"),
             force = axis.motor_coordinate.own("phase_force_constant", "N/A");
  notes.push_back(fmt::format(
      "Axis {}: {} is {:.5g} {} and {} {:.5g} {} ({:+.2f} %). Of one winding they are the same number{}.", axis.name,
      emf.key, emf.from_linear(axis.motor.emf_constant), emf.unit, force.key,
      force.from_linear(axis.motor.phase_force_constant), force.unit, 100.0 * (ratio - 1.0), beyond_rounding(ratio)));
}

}  // namespace

std::vector<std::string> machine_notes(const Machine& machine) {
  std::vector<std::string> notes;
  for (const AxisModel& axis : machine.axes) {
    if (axis.modulo && axis.encoder.increment != 0.0 && !axis.modulo_counts)
      notes.push_back(fmt::format(
          "Axis {} is endless, and the increment of its encoder is no exact part of a turn, as none in radians is: its "
          "phase is not counted.",
          axis.name));
    if (!axis.beyond_formats.empty())
      notes.push_back(fmt::format("Axis {} does not run in the firmware. {}.", axis.name, axis.beyond_formats));
    if (axis.motor.model != MotorModel::synchronous) continue;
    note_force_constant(axis, notes);
    note_emf_constant(axis, notes);
  }
  return notes;
}

}  // namespace stiction::machine
