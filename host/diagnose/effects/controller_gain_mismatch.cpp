// Gains and integral times of the drive, and the delay in its loop: what the command residual is scanned for.
#include <algorithm>
#include <array>

#include "host/diagnose/command_residual.hpp"

namespace stiction::host {
namespace {

constexpr const char* gains = "controller_gain_mismatch";
constexpr double relative_step = 0.01;
constexpr double longest_delay = 0.3e-3;  // s; longer ones no current loop of this kind survives

using A = machine::AxisModel;
using Value = std::optional<double>;

double loop_delay_of(const machine::AxisModel& axis) {
  for (const auto& effect : axis.effects)
    if (const auto delay = effect.values.find("loop_delay"); effect.name == "time_skew" && delay != effect.values.end())
      return delay->second.front();
  return 0.0;
}
void set_loop_delay(machine::AxisModel& axis, double delay) {
  const auto known =
      std::find_if(axis.effects.begin(), axis.effects.end(), [](const auto& e) { return e.name == "time_skew"; });
  auto& effect = known == axis.effects.end() ? axis.effects.emplace_back(machine::Effect{"time_skew", {}}) : *known;
  effect.values["loop_delay"] = {std::clamp(delay, 0.0, longest_delay)};
}
template <Value (*value)(const A&)>
double part(const A& axis, const machine::Timing&) {
  return relative_step * *value(axis);
}

Value position_gain(const A& a) { return a.position_controller.gain; }
Value velocity_gain(const A& a) { return a.velocity_controller.gain; }
Value velocity_time(const A& a) { return a.velocity_controller.integral_time; }
Value current_gain(const A& a) { return a.current_controller ? Value(a.current_controller->gain) : Value(); }
Value current_time(const A& a) { return a.current_controller ? a.current_controller->integral_time : Value(); }
// Behind a force source's voltage there is nothing that a delay could show in.
Value delay(const A& a) { return a.current_controller ? Value(loop_delay_of(a)) : Value(); }

constexpr std::array table{
    CommandParameter{gains, "position_gain", "_per_s", "_per_s", position_gain,
                     [](A& a, double v) { a.position_controller.gain = v; }, part<position_gain>},
    CommandParameter{gains, "velocity_gain", "_A_s_per_m", "_V_s_per_m", velocity_gain,
                     [](A& a, double v) { a.velocity_controller.gain = v; }, part<velocity_gain>},
    CommandParameter{gains, "velocity_integral_time", "_s", "_s", velocity_time,
                     [](A& a, double v) { a.velocity_controller.integral_time = v; }, part<velocity_time>},
    CommandParameter{gains, "current_gain", "_V_per_A", "_V_per_A", current_gain,
                     [](A& a, double v) { a.current_controller->gain = v; }, part<current_gain>},
    CommandParameter{gains, "current_integral_time", "_s", "_s", current_time,
                     [](A& a, double v) { a.current_controller->integral_time = v; }, part<current_time>},
    CommandParameter{"time_skew", "loop_delay", "_s", "_s", delay, set_loop_delay,
                     [](const A&, const machine::Timing& timing) { return timing.fast_period; }},
};

}  // namespace

std::span<const CommandParameter> command_parameters() { return table; }

}  // namespace stiction::host
