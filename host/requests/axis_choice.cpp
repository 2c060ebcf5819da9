#include "host/requests/axis_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "host/requests/names.hpp"
#include "host/requests/usage_error.hpp"

namespace stiction::host {

std::vector<std::size_t> axes_to_diagnose(const std::string& name, const machine::Machine& machine,
                                          const std::vector<Log>& logs) {
  const auto names = axis_names(machine);
  if (!name.empty()) {
    require_known("--axis", name, "an axis of " + machine.id, names);
    const auto found = std::find(names.begin(), names.end(), name);
    return {static_cast<std::size_t>(found - names.begin())};
  }
  const auto has = [](const Log& log, const std::string& axis) {
    return std::any_of(log.axes.begin(), log.axes.end(), [&](const AxisLog& c) { return c.axis == axis; });
  };
  for (const auto& log : logs)
    if (has(log, "") && names.size() > 1)
      throw UsageError(
          fmt::format("--axis: found none, but {} has channels without an axis, and {} has {} axes; "
                      "expected one of {}",
                      log.source, machine.id, names.size(), fmt::join(names, ", ")));
  std::vector<std::size_t> shared;
  for (std::size_t k = 0; k < names.size(); ++k)
    if (std::all_of(logs.begin(), logs.end(), [&](const Log& log) { return has(log, "") || has(log, names[k]); }))
      shared.push_back(k);
  if (shared.empty())
    throw UsageError(fmt::format("{}: found no axis that all logs and {} share; expected channels of {}",
                                 logs.front().source, machine.id, fmt::join(names, ", ")));
  return shared;
}

std::vector<std::size_t> axes_to_tune(const std::string& name, const machine::Machine& machine,
                                      const std::vector<Log>& logs) {
  std::vector<std::size_t> chosen;
  const auto names = axis_names(machine);
  if (!name.empty()) require_known("--axis", name, "an axis of " + machine.id, names);
  for (std::size_t k = 0; k < machine.axes.size(); ++k) {
    const auto& axis = machine.axes[k].name;
    const auto in = [&](const Log& log) {
      return std::any_of(log.axes.begin(), log.axes.end(),
                         [&](const auto& c) { return c.axis == axis || (c.axis.empty() && machine.axes.size() == 1); });
    };
    if (name.empty() ? std::all_of(logs.begin(), logs.end(), in) : axis == name) chosen.push_back(k);
  }
  if (!chosen.empty()) return chosen;
  throw UsageError(fmt::format("--axis: found {}; expected an axis of {} that every log has channels of: {}",
                               name.empty() ? "none" : "'" + name + "'", machine.id, fmt::join(names, ", ")));
}

}  // namespace stiction::host
