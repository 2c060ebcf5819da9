// Prints what the programme makes of the first axis of a machine file: NAME VALUE lines in SI units of the linear axis,
// with all digits.
#include <cstdio>

#include "sim/machine_file.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: print_axis FILE\n");
    return 2;
  }
  const auto axis = stiction::sim::read_machine(argv[1]).axes.at(0);
  const auto print = [](const char* name, double value) { std::printf("%s %.17g\n", name, value); };
  print("mass_kg", axis.mass);
  print("load_mass_kg", axis.load_mass);
  print("force_constant_N_per_A", axis.motor.force_constant);
  print("phase_force_constant_N_per_A", axis.motor.phase_force_constant);
  print("emf_constant_V_s_per_m", axis.motor.emf_constant);
  print("phase_resistance_Ohm", axis.motor.phase_resistance);
  print("phase_inductance_H", axis.motor.phase_inductance - axis.motor.mutual_inductance);
  print("pole_pair_pitch_m", axis.motor.pole_pair_pitch);
  print("current_limit_A", axis.inverter.current_limit);
  print("voltage_limit_V", axis.inverter.voltage_limit);
  print("increment_m", axis.encoder.increment);
  print("coulomb_N", axis.friction.models.at("coulomb_viscous").at("coulomb").at(0));
  print("viscous_N_s_per_m", axis.friction.models.at("coulomb_viscous").at("viscous").at(0));
}
