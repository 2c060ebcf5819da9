#include "firmware/machine/configuration/compensation_configuration.hpp"

#include <algorithm>

#include "firmware/machine/configuration/conversion.hpp"
#include "firmware/machine/configuration/double_signals.hpp"
#include "stiction/design/compensation_configuration.hpp"
#include "stiction/design/compensation_design.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::machine {
namespace {

design::QuadrantLearningParameters parameters_of(const QuadrantLearningParameters& learning) {
  design::QuadrantLearningParameters p;
  p.gain = learning.gain;
  p.forgetting = learning.forgetting;
  p.smoothing = learning.smoothing;
  p.limit = learning.limit;
  p.dead_zone = learning.dead_zone;
  p.filter = learning.filter;
  if (learning.lead) p.lead = *learning.lead;
  return p;
}

// Shows the lists of `axis`.
CompensationDesign compensation_of(const Machine& machine, const AxisModel& axis) {
  CompensationDesign d;
  d.set_point_delay = machine.timing.set_point_delay;
  if (!axis.friction_compensation) return d;
  const auto& compensation = *axis.friction_compensation;
  d.kind = compensation.use;
  if (const auto& p = compensation.pulse)
    d.pulse = {p->amplitude, p->final_amplitude, p->rise_until, p->flat_until, p->fall_until, p->delay, p->duration};
  if (const auto& f = compensation.friction)
    d.friction = {f->look_ahead, f->distance, f->level, f->contact_damping, f->speed, f->forward, f->backward};
  if (const auto& learning = compensation.learning) d.learning = parameters_of(*learning);
  d.learning.identity = d.learning.learned_identity = learning_identity(machine.name, axis.name);
  if (const auto& learned = compensation.learned) {
    d.learning.learned_identity = learning_identity(learned->machine, learned->axis);
    d.learning.learned_backward = learned->backward;
    d.learning.learned_forward = learned->forward;
  }
  return d;
}

}  // namespace

std::uint32_t learning_identity(std::string_view machine, std::string_view axis) {
  std::uint32_t hash = 2166136261u;  // FNV-1a
  const auto add = [&](unsigned char c) { hash = (hash ^ c) * 16777619u; };
  for (const char c : machine) add(static_cast<unsigned char>(c));
  add(0);
  for (const char c : axis) add(static_cast<unsigned char>(c));
  return hash | 1u;
}

double learning_lead(const AxisModel& axis) {
  return design::learning_lead(design_of({}, axis), parameters_of(*axis.friction_compensation->learning));
}

bool has_compensation(const Machine& machine) {
  return std::any_of(machine.axes.begin(), machine.axes.end(), [](const AxisModel& axis) {
    return axis.friction_compensation && axis.friction_compensation->use != CompensationKind::off;
  });
}

double set_point_delay(const Machine& machine) {
  return has_compensation(machine) ? machine.timing.set_point_delay : 0.0;
}

std::vector<double> sliding_node_speeds() {
  constexpr auto speeds = design::sliding_node_speeds();
  return {speeds.begin(), speeds.end()};
}

double sliding_value(const std::vector<double>& speeds, const std::vector<double>& values, double speed) {
  return design::sliding_value(speeds, values, speed);
}

template <class S>
FrictionCompensationConfig<S> configure_compensation(const Machine& machine, const AxisModel& axis) {
  design::Problems problems;
  const auto config =
      design::configure_compensation<S>(design_of(machine.timing, axis), compensation_of(machine, axis), problems);
  refuse(problems, axis.name);
  return config;
}

template <class S>
std::vector<FrictionCompensationConfig<S>> configure_compensations(const Machine& machine) {
  std::vector<FrictionCompensationConfig<S>> configs;
  if (!has_compensation(machine)) return configs;
  for (const auto& axis : machine.axes) configs.push_back(configure_compensation<S>(machine, axis));
  return configs;
}

template FrictionCompensationConfig<FixedSignals> configure_compensation<FixedSignals>(const Machine&,
                                                                                       const AxisModel&);
template FrictionCompensationConfig<DoubleSignals> configure_compensation<DoubleSignals>(const Machine&,
                                                                                         const AxisModel&);
template std::vector<FrictionCompensationConfig<FixedSignals>> configure_compensations<FixedSignals>(const Machine&);
template std::vector<FrictionCompensationConfig<DoubleSignals>> configure_compensations<DoubleSignals>(const Machine&);

}  // namespace stiction::machine
