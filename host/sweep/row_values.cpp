#include "host/sweep/row_values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

#include "firmware/machine/file/machine_file.hpp"
#include "firmware/machine/file/nearest_name.hpp"
#include "firmware/machine/file/units.hpp"
#include "host/simulate/friction_choice.hpp"
#include "host/simulate/loaded_machine.hpp"

namespace stiction::host {
namespace {

[[noreturn]] void refuse_option(std::string_view name, const std::string& found, const std::string& expected) {
  throw machine::MachineFileError(fmt::format("--{}: found '{}'; expected {}", name, found, expected));
}

double quantity_in(std::string_view name, const std::string& text, const std::string& unit) {
  try {
    return machine::parse_quantity(text, unit);
  } catch (const machine::UnitError& error) {
    refuse_option(name, text, fmt::format("a quantity in {} ({})", unit, error.what()));
  }
}

}  // namespace

machine::Machine machine_of(const SweepCommand& command, const SweepRow& row) {
  auto set = row.set;
  if (const auto kind = row.option("compensation"); !kind.empty()) set.push_back(compensation_assignment(kind));
  const auto needs = command.experiment.empty() ? std::string_view(command.name) : std::string_view(command.experiment);
  return load_machine(row.machine, set, command.experiment, needs_of(needs), row.option("axis"));
}

double quantity_option(const SweepRow& row, std::string_view name, const std::string& unit, double fallback) {
  const auto text = row.option(name);
  return text.empty() ? fallback : quantity_in(name, text, unit);
}

std::vector<double> quantity_list_option(const SweepRow& row, std::string_view name, const std::string& unit) {
  std::vector<double> values;
  const auto text = row.option(name);
  for (std::size_t from = 0; from < text.size();) {
    const auto end = std::min(text.find(',', from), text.size());
    const auto begin = text.find_first_not_of(' ', from);
    values.push_back(quantity_in(name, text.substr(begin, end - begin), unit));
    from = end + 1;
  }
  return values;
}

std::string choice_option(const SweepRow& row, std::string_view name, const std::vector<std::string_view>& names) {
  const auto text = row.option(name, std::string(names.front()));
  if (std::find(names.begin(), names.end(), text) == names.end())
    refuse_option(name, text, fmt::format("{}{}", fmt::join(names, " or "), machine::did_you_mean(text, names)));
  return text;
}

std::string friction_option(const SweepRow& row, const machine::Machine& machine) {
  const auto name = row.option("friction");
  if (name.empty()) return friction_in_use(machine);
  for (const auto& axis : machine.axes)
    if (!axis.friction.models.contains(name)) {
      std::vector<std::string_view> known;
      for (const auto& [each, values] : axis.friction.models) known.push_back(each);
      refuse_option("friction", name,
                    fmt::format("one friction model that axis {} has: {}{}", axis.name, fmt::join(known, ", "),
                                machine::did_you_mean(name, known)));
    }
  return name;
}

std::vector<std::size_t> axes_option(const SweepRow& row, const machine::Machine& machine) {
  std::vector<std::size_t> axes(machine.axes.size());
  std::iota(axes.begin(), axes.end(), std::size_t{0});
  const auto name = row.option("axis");
  if (name.empty()) return axes;
  std::vector<std::string_view> known;
  for (const auto& axis : machine.axes) known.push_back(axis.name);
  const auto found = std::find(known.begin(), known.end(), name);
  if (found == known.end())
    refuse_option("axis", name, fmt::format("an axis of {}: {}", machine.id, fmt::join(known, ", ")));
  return {static_cast<std::size_t>(found - known.begin())};
}

}  // namespace stiction::host
