#include "sim/plant/effects/effects.hpp"

#include <algorithm>

#include "sim/plant/effects/aliases.hpp"

namespace stiction::sim {
namespace {

template <class Owner>
EffectKey key_of(const machine::Parameter<Owner>& p) {
  const bool list = std::holds_alternative<std::vector<double> Owner::*>(p.member);
  const bool optional = detail::is_optional(p);
  return {p.key,    p.unit, p.unit_of_force_motor, unit_suffix(p.unit), p.range, list, !p.fallback && !optional,
          optional, p.text};
}

std::vector<EffectAlias> aliases_of(std::string_view name) {
  std::vector<EffectAlias> aliases;
  for (const AliasPair& pair : alias_pairs) {
    if (pair.one == name) aliases.push_back({pair.other, pair.separate_by});
    if (pair.other == name) aliases.push_back({pair.one, pair.separate_by});
  }
  return aliases;
}

void check_names(const machine::AxisModel& axis) {
  std::vector<std::string_view> seen;
  for (const machine::Effect& effect : axis.effects) {
    check_effect(effect);
    if (!find_effect_kind(effect.name)->several && std::find(seen.begin(), seen.end(), effect.name) != seen.end())
      throw EffectError(effect.name, "it twice on one axis", "it once");
    seen.push_back(effect.name);
  }
}

}  // namespace

std::span<const EffectKind> effect_kinds() {
  static const std::vector<EffectKind> kinds = [] {
    std::vector<EffectKind> made;
    for_each_effect([&]<class E>() {
      EffectKind kind{E::name, E::text, E::several, {}, aliases_of(E::name)};
      for (const auto& p : E::parameters) kind.keys.push_back(key_of(p));
      made.push_back(std::move(kind));
    });
    return made;
  }();
  return kinds;
}

std::vector<machine::ValueTable> effect_tables() {
  std::vector<machine::ValueTable> tables;
  for_each_effect([&]<class E>() {
    tables.push_back({E::name, E::text, E::several, machine::keys_of(E::parameters)});
  });
  return tables;
}

const EffectKind* find_effect_kind(std::string_view name) {
  const auto kinds = effect_kinds();
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [&](const EffectKind& kind) { return kind.name == name; });
  return found == kinds.end() ? nullptr : &*found;
}

void check_effect(const machine::Effect& effect) {
  bool known = false;
  for_each_effect([&]<class E>() {
    if (E::name != effect.name) return;
    known = true;
    parameters_of<E>(effect);
  });
  if (!known) throw EffectError(effect.name, "no such effect", "a known one");
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
  check_names(axis);
  for_each_effect([&]<class E>() {
    if constexpr (requires(const typename E::Parameters& p) { E::change(p, plant); })
      for (const auto& parameters : effects_of<E>(axis)) E::change(parameters, plant);
  });
  return plant;
}

machine::AxisModel drive_axis(const machine::AxisModel& axis) {
  machine::AxisModel drive = axis;
  for_each_effect([&]<class E>() {
    if constexpr (requires(const typename E::Parameters& p) { E::change_drive(p, drive); })
      for (const auto& parameters : effects_of<E>(axis)) E::change_drive(parameters, drive);
  });
  return drive;
}

double record_delay(const machine::AxisModel& axis) {
  double delay = 0.0;
  for (const auto& skew : effects_of<TimeSkew>(axis)) delay += skew.delay;
  return delay;
}

}  // namespace stiction::sim
