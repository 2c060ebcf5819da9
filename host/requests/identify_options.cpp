#include "host/requests/identify_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>

#include "firmware/machine/file/units.hpp"
#include "host/identify/law_choice.hpp"
#include "host/requests/names.hpp"
#include "host/requests/usage_error.hpp"

namespace stiction::host {

const machine::AxisModel& axis_to_identify(const std::string& name, const machine::Machine& machine,
                                           const std::vector<Log>& logs) {
  const auto names = axis_names(machine);
  if (!name.empty()) {
    require_known("--axis", name, "an axis of " + machine.id, names);
    const auto found = std::find(names.begin(), names.end(), name);
    return machine.axes[static_cast<std::size_t>(found - names.begin())];
  }
  std::vector<const machine::AxisModel*> common;
  for (const auto& axis : machine.axes)
    if (std::all_of(logs.begin(), logs.end(), [&](const Log& log) {
          return std::any_of(log.axes.begin(), log.axes.end(),
                             [&](const auto& c) { return c.axis.empty() || c.axis == axis.name; });
        }))
      common.push_back(&axis);
  if (common.size() == 1) return *common.front();
  throw UsageError(fmt::format("--axis: found none, but the logs have channels of {} axes of {}; expected one of {}",
                               common.size(), machine.id, fmt::join(names, ", ")));
}

Amperes amperes_of(const std::string& text) {
  if (text.empty()) return Amperes::amplitude;  // by the format of a log
  if (const auto amperes = parse_amperes(text)) return *amperes;
  throw UsageError(
      fmt::format("--amperes: found '{}'; expected peak or rms{}", text, nearest_words(text, {"peak", "rms"})));
}

std::string model_to_identify(const std::string& wanted, const machine::AxisModel& axis) {
  const std::string recipe(sim::CoulombViscous<>::name), contact(sim::LuGre<>::name);
  const auto own = contact_law(axis);
  if (wanted.empty()) return usual_law(axis);
  const std::set<std::string> laws{recipe, contact, own};
  if (!laws.contains(wanted))
    throw UsageError(fmt::format("--friction: found '{}'; expected {}{}", wanted, fmt::join(laws, " or "),
                                 nearest_words(wanted, {laws.begin(), laws.end()})));
  return wanted;
}

Held held_values(const std::vector<std::string>& fixes, const machine::AxisModel& axis) {
  struct Key {
    std::string name;
    const char* linear;
    bool positive;
    machine::OwnQuantity own{};
    std::string_view unit{};
  };
  const bool rotary = axis.coordinate.rotary();
  const char* constant = rotary ? axis.gravity ? "gravity" : "constant_torque" : "constant_force";
  std::array<Key, 4> keys{{{rotary ? "inertia" : "mass", "kg", true},
                           {"viscous", "N s/m", true},
                           {constant, "N", false},
                           {"coulomb", "N", true}}};
  for (auto& key : keys) {
    key.own = axis.coordinate.own(key.linear);
    key.unit = key.own.unit;
  }
  Held held{};
  for (const auto& fix : fixes) {
    const auto sign = fix.find('=');
    const auto key = fix.substr(0, sign);
    const auto found = std::find_if(keys.begin(), keys.end(), [&](const auto& k) { return k.name == key; });
    if (found == keys.end() || sign == std::string::npos)
      throw UsageError(
          fmt::format("--fix: found '{}'; expected KEY=VALUE with {}, viscous, coulomb or {}, as {}=225{}{}", fix,
                      keys[0].name, keys[2].name, keys[0].name, keys[0].unit,
                      nearest_words(key, {keys[0].name, "viscous", keys[2].name, "coulomb"})));
    try {
      const double value = machine::parse_quantity(fix.substr(sign + 1), found->unit);
      if (found->positive && value < 0.0)
        throw UsageError(fmt::format("--fix: found {}; expected a value of at least 0 {}", fix, found->unit));
      held[static_cast<std::size_t>(found - keys.begin())] = found->own.to_linear(value);
    } catch (const machine::UnitError& error) {
      throw UsageError(
          fmt::format("--fix: found '{}' ({}); expected {}=VALUE in {}", fix, error.what(), key, found->unit));
    }
  }
  return held;
}

}  // namespace stiction::host
