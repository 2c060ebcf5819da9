// By which the drive has its set-points late: it commands for the place of the master of a while ago.
#include <algorithm>
#include <array>

#include "host/diagnose/classes/effect_regressor.hpp"
#include "sim/effects/effects.hpp"
#include "sim/effects/master_delay/master_delay.hpp"

namespace stiction::host::effects::master_delay {
namespace {

constexpr double longest = 0.05;  // s; a slave that is later follows something else

std::optional<double> delay(const machine::AxisModel& axis) { return sim::master_delay(axis); }
void set_delay(machine::AxisModel& axis, double delay) {
  const auto known = std::find_if(axis.effects.begin(), axis.effects.end(),
                                  [](const machine::Effect& effect) { return sim::is_a<sim::MasterDelay>(effect); });
  auto& effect = known == axis.effects.end() ? axis.effects.emplace_back(sim::effect_of<sim::MasterDelay>({})) : *known;
  effect.values["delay"] = {std::clamp(delay, 0.0, longest)};
}
constexpr std::array behind_master{CommandParameter{
    "delay", delay, set_delay,
    [](const machine::AxisModel&, const machine::Timing& timing) { return timing.fast_period; }, true, true}};

}  // namespace

// The force that moves the axis is that of its own motion, however late.
extern const EffectRegressor regressor{.command = behind_master};

}  // namespace stiction::host::effects::master_delay
