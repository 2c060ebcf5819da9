#include "host/simulate/experiments.hpp"

namespace stiction::host {

std::span<const Experiment> experiments() {
  static const std::vector<Experiment> table{
      {"constant-velocity",
       "motor current at constant speeds: the friction characteristic",
       {},
       run_constant_velocity,
       true},
      {"impact", "a step of external force in position control: deviation and return", {}, run_impact, true},
      {"l-shape",
       "a path with standstill of one axis: residual current there, and errors at the two restarts",
       {},
       run_l_shape,
       true,
       ExperimentMachine::axes,
       nullptr,
       {},
       true},
      {"presliding",
       "slow force ramps below break-away: displacement that does not return",
       {"lugre"},
       run_presliding,
       true},
      {"friction-lag",
       "sliding with varying speed: lag of the friction behind the speed",
       {"lugre"},
       run_friction_lag,
       false},
      {"break-away",
       "force ramps of different rates: the force at which sliding begins",
       {"lugre"},
       run_break_away,
       true},
      {"stick-slip", "a mass pulled by a spring at constant speed", {"lugre", "classical"}, run_stick_slip, true},
      {"feed-cutting",
       "a feed drive that sticks and slips while cutting: jumps, feed per revolution, critical feed",
       {},
       run_feed_cutting,
       false,
       ExperimentMachine::feed_drive,
       "60 mm/min, 300 mm/min, 600 mm/min, 1500 mm/min, 3000 mm/min",
       {equations_corrected, equations_printed}},
  };
  return table;
}

}  // namespace stiction::host
