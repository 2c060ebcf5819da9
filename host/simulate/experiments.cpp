#include "host/simulate/experiments.hpp"

#include "host/simulate/expected_figures.hpp"
#include "host/simulate/machine_needs.hpp"

namespace stiction::host {

std::span<const Experiment> experiments() {
  static const std::vector<Experiment> table{
      {.name = "constant-velocity",
       .text = "motor current at constant speeds: the friction characteristic",
       .run = run_constant_velocity,
       .keeps_logs = true},
      {.name = "impact",
       .text = "a step of external force in position control: deviation and return",
       .run = run_impact,
       .keeps_logs = true},
      {.name = "l-shape",
       .text = "a path with standstill of one axis: residual current there, and errors at the two restarts",
       .run = run_l_shape,
       .keeps_logs = true,
       .jerk = true,
       .compensation = true},
      {.name = "presliding",
       .text = "slow force ramps below break-away: displacement that does not return",
       .run = run_presliding,
       .keeps_logs = true},
      {.name = "friction-lag",
       .text = "sliding with varying speed: lag of the friction behind the speed",
       .run = run_friction_lag},
      {.name = "break-away",
       .text = "force ramps of different rates: the force at which sliding begins",
       .run = run_break_away,
       .keeps_logs = true},
      {.name = "stick-slip",
       .text = "a mass pulled by a spring at constant speed",
       .run = run_stick_slip,
       .keeps_logs = true},
      {.name = "feed-cutting",
       .text = "a feed drive that sticks and slips while cutting: jumps, feed per revolution, critical feed",
       .run = run_feed_cutting,
       .feeds = "60 mm/min, 300 mm/min, 600 mm/min, 1500 mm/min, 3000 mm/min",
       .equations = {equations_corrected, equations_printed}},
  };
  return table;
}

sim::ExperimentResult run_experiment(const Experiment& experiment, const ExperimentInput& input) {
  auto result = experiment.run(input);
  if (needs_of(experiment.name).one_axis)
    for (auto& figure : result.figures) figure.axis = input.machine.axes.front().name;
  std::map<std::string, double> options;
  if (input.jerk) options["jerk"] = *input.jerk;
  add_expected_figures(result, input.machine, options);
  return result;
}

}  // namespace stiction::host
