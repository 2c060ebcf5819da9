#include "host/cli/report_origin.hpp"

#include <algorithm>

#include "host/diagnose/record/record_checks.hpp"
#include "host/log/inspection.hpp"
#include "host/simulate/replay.hpp"
#include "sim/machine_file.hpp"

namespace stiction::host {
namespace {

// None where channels without an axis could be those of several.
std::vector<KnownAxis> known_axes(const machine::Machine& machine, const Log& log) {
  std::vector<KnownAxis> known;
  try {
    for (const auto index : match_axes(machine, log, "")) known.push_back(known_axis(machine.axes[index]));
  } catch (const LogError&) {
    return {};
  }
  return known;
}

template <class List, class Item>
void add_new(List& list, const Item& item) {
  if (std::find(list.begin(), list.end(), item) == list.end()) list.push_back(item);
}

std::string without_full_stop(std::string text) {
  if (text.ends_with('.')) text.pop_back();
  return text;
}

void add(AxisAbility& ability, const AxisInspection& axis) {
  for (const auto& each : axis.determinable) {
    if (each.possible) {
      add_new(ability.possible, each.what);
      std::erase_if(ability.open, [&](const auto& open) { return open.what == each.what; });
      continue;
    }
    const auto known = [&](const auto& open) { return open.what == each.what; };
    if (std::count(ability.possible.begin(), ability.possible.end(), each.what) == 0 &&
        std::none_of(ability.open.begin(), ability.open.end(), known))
      ability.open.push_back({each.what, each.reason, each.remedy});
  }
  for (const auto& question : axis.questions) add_new(ability.suspicions, without_full_stop(question.text));
  for (const auto& suspicion : axis.suspicions) add_new(ability.suspicions, suspicion);
}

}  // namespace

std::vector<AxisAbility> abilities_of(const std::string& machine, const std::vector<Log>& logs) {
  const auto model = sim::read_machine(machine::find_machine(machine));
  std::vector<AxisAbility> abilities;
  for (const auto& log : logs)
    for (const auto& axis : inspect(log, known_axes(model, log)).axes) {
      auto place = std::find_if(abilities.begin(), abilities.end(),
                                [&](const AxisAbility& known) { return known.axis == axis.axis; });
      if (place == abilities.end()) {
        abilities.push_back({axis.axis, {}, {}, {}});
        place = abilities.end() - 1;
      }
      add(*place, axis);
    }
  return abilities;
}

}  // namespace stiction::host
