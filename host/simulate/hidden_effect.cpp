#include "host/simulate/hidden_effect.hpp"

#include <algorithm>
#include <vector>

#include "sim/effects/effects.hpp"

namespace stiction::host {

machine::Effect draw_hidden_effect(const machine::AxisModel& axis, std::uint64_t seed) {
  std::vector<sim::EffectId> demonstrated;
  for (const sim::EffectId effect : sim::all_effects())
    if (effect->hidden.demonstrated) demonstrated.push_back(effect);
  std::sort(demonstrated.begin(), demonstrated.end(), [](sim::EffectId one, sim::EffectId other) {
    return one->hidden.demonstrated < other->hidden.demonstrated;
  });
  sim::Draw draw(seed);
  const sim::EffectId chosen = demonstrated[draw.index(demonstrated.size())];
  return sim::effect_with(chosen, chosen->hidden.values(axis, draw));
}

}  // namespace stiction::host
