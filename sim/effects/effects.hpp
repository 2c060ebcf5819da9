// The vocabulary of effects: every descriptor of the folders that the programme links (effect_table.hpp), and what
// an axis has of them.
#pragma once

#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "sim/effects/effect_descriptor.hpp"
#include "sim/effects/effect_values.hpp"

namespace stiction::sim {

// In the order of the vocabulary.
std::span<const EffectId> all_effects();

// None for a name that is none.
std::optional<EffectId> find_effect(std::string_view name);

// As the reader of machine files wants them, in the order of the vocabulary.
std::vector<machine::ValueTable> effect_tables();

// Another effect that this one may be confused with.
struct Confusion {
  EffectId other;
  std::string_view separate_by;  // the experiment that tells the two apart
  bool always = false;           // no motion of this axis alone does
};

// Of both folders, in the order of the vocabulary. An alias whose name no folder has is left out.
std::vector<Confusion> confusions_of(EffectId effect);

// Of this kind, as values by key.
inline machine::Effect effect_with(EffectId id, machine::KeyedValues values) { return {id.name(), std::move(values)}; }

// Throws EffectError for an unknown name and for values that the effect refuses.
void check_effect(const machine::Effect& effect);

// The descriptor of the class E. Throws std::logic_error where the programme has no such folder.
template <class E>
EffectId id_of() {
  static const EffectId id = [] {
    if (const auto found = find_effect(E::name)) return *found;
    throw std::logic_error("no folder of the effect " + std::string(E::name));
  }();
  return id;
}

// Whether an axis' row is of kind E.
template <class E>
bool is_a(const machine::Effect& effect) {
  return effect.name == E::name;
}
template <class E>
bool is_a(EffectId effect) {
  return effect == id_of<E>();
}

// All effects of kind E that an axis has. Throws EffectError.
template <class E>
std::vector<typename E::Parameters> effects_of(const machine::AxisModel& axis) {
  std::vector<typename E::Parameters> found;
  for (const machine::Effect& effect : axis.effects)
    if (is_a<E>(effect)) found.push_back(parameters_of<E>(effect.values));
  return found;
}

// The unit of a key's values on this axis.
std::string_view key_unit(const machine::ValueKey& key, const machine::AxisModel& axis);

// "N s/m" as the suffix of a name in verdict.json: "_N_s_per_m"; empty for "1".
std::string unit_suffix(std::string_view unit);

// The axis as its plant is: with the changes of its effects made. The drive's configuration comes from `axis` itself.
// Throws EffectError for an unknown effect, for one too many, for values that the effect refuses and for those that do
// not go with the friction model in use.
machine::AxisModel plant_axis(const machine::AxisModel& axis);

// The axis as its drive is configured: with the changes of those effects that are the drive's. Throws EffectError.
machine::AxisModel drive_axis(const machine::AxisModel& axis);

}  // namespace stiction::sim
