#include "host/tune/pulse_tuning.hpp"

#include <nlopt.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "host/simulate/quadrant_run.hpp"

namespace stiction::host {
namespace {

struct Problem {
  machine::Machine machine;
  std::size_t axis;
  sim::CircleSettings circle;
  int evaluations = 0;
  double best = std::numeric_limits<double>::infinity();
  machine::PulseCompensationParameters pulse;

  // Amplitude in mm/s, delay and duration in ms.
  double error(const double* x) {
    machine::PulseCompensationParameters candidate;
    candidate.amplitude = x[0] * 1e-3;
    candidate.final_amplitude = candidate.amplitude;
    candidate.rise_until = 1e-3;  // below every acceleration that matters
    candidate.flat_until = machine.axes[axis].max_acceleration;
    candidate.fall_until = 2.0 * candidate.flat_until;
    candidate.delay = x[1] * 1e-3;
    candidate.duration = x[2] * 1e-3;
    machine.axes[axis].friction_compensation = {CompensationKind::pulse, candidate, {}, {}, {}};
    const double peak = run_quadrants(machine, axis, circle, 2).peak_error.back();
    ++evaluations;
    if (peak < best) {
      best = peak;
      pulse = candidate;
    }
    return peak * 1e6;
  }
};

double evaluate(unsigned, const double* x, double*, void* problem) { return static_cast<Problem*>(problem)->error(x); }

}  // namespace

PulseTuning tune_pulse(const machine::Machine& machine, std::size_t axis, const sim::CircleSettings& circle,
                       int evaluations) {
  Problem problem{machine, axis, circle, 0, std::numeric_limits<double>::infinity(), {}};
  PulseTuning tuning;
  problem.machine.axes[axis].friction_compensation.reset();
  tuning.error_off = run_quadrants(problem.machine, axis, circle, 2).peak_error.back();

  // From two starts, as the error has more than one valley: a short strong pulse and a long weak one.
  const std::array<double, 3> low{0.0, 0.0, 0.2}, high{5.0, 60.0, 120.0}, step{0.3, 2.0, 4.0};
  for (const std::array<double, 3>& start : {std::array{0.5, 2.0, 10.0}, std::array{0.3, 8.0, 30.0}}) {
    const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> optimiser(nlopt_create(NLOPT_LN_NELDERMEAD, 3),
                                                                      nlopt_destroy);
    nlopt_set_lower_bounds(optimiser.get(), low.data());
    nlopt_set_upper_bounds(optimiser.get(), high.data());
    nlopt_set_initial_step(optimiser.get(), step.data());
    nlopt_set_min_objective(optimiser.get(), evaluate, &problem);
    nlopt_set_maxeval(optimiser.get(), (evaluations + 1) / 2);
    std::array<double, 3> x = start;
    double value = 0.0;
    nlopt_optimize(optimiser.get(), x.data(), &value);
  }
  tuning.pulse = problem.pulse;
  tuning.error = problem.best;
  tuning.evaluations = problem.evaluations;
  return tuning;
}

}  // namespace stiction::host
