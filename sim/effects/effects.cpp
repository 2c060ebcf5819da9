#include "sim/effects/effects.hpp"

#include <algorithm>

#include "sim/effects/effect_table.hpp"
#include "sim/effects/given_force.hpp"

namespace stiction::sim {
namespace {

const std::vector<EffectDescriptor>& descriptors() {
  static const std::vector<EffectDescriptor> made = [] {
    std::vector<EffectDescriptor> all;
    for (const EffectFolder& folder : effect_folders()) all.emplace_back(folder.describe()).folder = folder.folder;
    std::sort(all.begin(), all.end(),
              [](const EffectDescriptor& one, const EffectDescriptor& other) { return one.order < other.order; });
    return all;
  }();
  return made;
}

void check_effects(const machine::AxisModel& axis) {
  std::vector<std::string_view> seen;
  for (const machine::Effect& effect : axis.effects) {
    if (given_force(effect)) continue;
    check_effect(effect);
    const EffectId id = *find_effect(effect.name);
    if (id->law.check_axis != nullptr) id->law.check_axis(effect.values, axis);
    if (!id->several && std::find(seen.begin(), seen.end(), effect.name) != seen.end())
      throw EffectError(effect.name, "it twice on one axis", "it once");
    seen.push_back(effect.name);
  }
}

}  // namespace

std::span<const EffectId> all_effects() {
  static const std::vector<EffectId> ids(descriptors().begin(), descriptors().end());
  return ids;
}

std::optional<EffectId> find_effect(std::string_view name) {
  const auto all = all_effects();
  const auto found = std::find_if(all.begin(), all.end(), [&](EffectId id) { return id->name == name; });
  return found == all.end() ? std::nullopt : std::optional(*found);
}

std::vector<machine::ValueTable> effect_tables() {
  std::vector<machine::ValueTable> tables;
  for (const EffectId id : all_effects()) tables.push_back(*id);
  return tables;
}

std::vector<Confusion> confusions_of(EffectId effect) {
  std::vector<Confusion> found;
  for (const EffectId other : all_effects()) {
    for (const EffectAlias& alias : effect->aliases)
      if (alias.other == other->name)
        found.push_back({other, alias.separate_by, alias.separable != Separable::by_motion});
    for (const EffectAlias& alias : other->aliases)
      if (alias.other == effect->name)
        found.push_back({other, alias.separate_by, alias.separable == Separable::not_by_motion});
  }
  return found;
}

void check_effect(const machine::Effect& effect) {
  const auto id = find_effect(effect.name);
  if (!id) throw EffectError(effect.name, "no such effect", "a known one");
  (*id)->law.check(effect.values);
}

std::string_view key_unit(const machine::ValueKey& key, const machine::AxisModel& axis) {
  return axis.motor.driven_by_volts() && !key.unit_of_force_motor.empty() ? key.unit_of_force_motor : key.unit;
}

std::string unit_suffix(std::string_view unit) {
  if (unit == "1") return {};
  std::string suffix = unit.starts_with("1/") ? "" : "_";
  for (const char c : unit.substr(unit.starts_with("1/") ? 1 : 0)) {
    if (c == '/')
      suffix += "_per_";
    else if (c == ' ')
      suffix += '_';
    else if (c != '^')
      suffix += c;
  }
  return suffix;
}

machine::AxisModel plant_axis(const machine::AxisModel& axis) {
  machine::AxisModel plant = axis;
  check_effects(axis);
  for (const EffectId id : all_effects())
    if (id->law.change != nullptr)
      for (const machine::Effect& effect : axis.effects)
        if (effect.name == id->name) id->law.change(effect.values, plant);
  return plant;
}

machine::AxisModel drive_axis(const machine::AxisModel& axis) {
  machine::AxisModel drive = axis;
  for (const EffectId id : all_effects())
    if (id->law.change_drive != nullptr)
      for (const machine::Effect& effect : axis.effects)
        if (effect.name == id->name) id->law.change_drive(effect.values, drive);
  return drive;
}

}  // namespace stiction::sim
