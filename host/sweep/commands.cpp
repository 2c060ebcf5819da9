#include "host/sweep/commands.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "firmware/machine/file/machine_file.hpp"
#include "firmware/machine/file/nearest_name.hpp"
#include "host/simulate/experiments.hpp"
#include "host/simulate/machine_needs.hpp"

namespace stiction::host {
namespace {

SweepCommand row_of(const Experiment& experiment) {
  SweepCommand command;
  command.name = std::string("simulate ") + experiment.name;
  command.experiment = experiment.name;
  const auto& needs = needs_of(experiment.name);
  if (!needs.feed_drive) {
    command.options.push_back("friction");
    command.required.push_back("friction");
  }
  if (needs.one_axis) command.options.push_back("axis");
  if (experiment.compensation) command.options.push_back("compensation");
  if (experiment.feeds != nullptr) command.options.push_back("feed");
  if (!experiment.equations.empty()) command.options.push_back("equations");
  if (experiment.jerk) command.options.push_back("jerk");
  command.run = sweep_experiment;
  return command;
}

[[noreturn]] void refuse(const SweepSpec& spec, const std::string& key, const std::string& found,
                         const std::string& expected) {
  throw machine::MachineFileError(fmt::format("{}: {}: found {}; expected {}", spec.file, key, found, expected));
}

}  // namespace

std::span<const SweepCommand> sweep_commands() {
  static const auto table = [] {
    std::vector<SweepCommand> all{
        {.name = "simulate circle",
         .experiment = "circle",
         .options = {"friction", "feed", "direction", "radius", "signals", "compensation"},
         .run = sweep_circle},
        {.name = "tune-friction",
         .experiment = "",
         .options = {"axis", "feed", "show"},
         .flags = {"no-pulse"},
         .run = sweep_tuning},
        {.name = "identify", .experiment = "", .options = {"axis"}, .logs = true, .run = sweep_identification},
        {.name = "diagnose", .experiment = "", .options = {"axis", "seed"}, .logs = true, .run = sweep_diagnosis}};
    for (const auto& experiment : experiments()) all.push_back(row_of(experiment));
    return all;
  }();
  return table;
}

const SweepCommand& command_of(const SweepSpec& spec) {
  const auto table = sweep_commands();
  const auto command =
      std::find_if(table.begin(), table.end(), [&](const SweepCommand& each) { return each.name == spec.command; });
  if (command == table.end()) {
    std::vector<std::string_view> names;
    for (const auto& each : table) names.push_back(each.name);
    refuse(spec, "command", fmt::format("\"{}\"", spec.command),
           fmt::format("one of {}{}", fmt::join(names, ", "), machine::did_you_mean(spec.command, names)));
  }
  auto known = command->options;
  known.insert(known.end(), command->flags.begin(), command->flags.end());
  bool logs = false;
  for (const auto& key : spec.keys) {
    logs = logs || key.kind == SweptKey::Kind::log;
    if (key.kind == SweptKey::Kind::option && std::find(known.begin(), known.end(), key.name) == known.end())
      refuse(spec, "option." + key.name, "an option that the sweep cannot give to " + command->name,
             fmt::format("one of {}{}", fmt::join(known, ", "), machine::did_you_mean(key.name, known)));
  }
  for (const auto option : command->required)
    if (std::none_of(spec.keys.begin(), spec.keys.end(),
                     [&](const SweptKey& key) { return key.kind == SweptKey::Kind::option && key.name == option; }))
      refuse(spec, fmt::format("option.{}", option), "no such key", "one value, or a list with one for each run");
  if (logs != command->logs)
    refuse(spec, "log", logs ? "logs" : "no such key",
           logs ? fmt::format("none, as {} reads no logs", command->name) : "a log, or a list with one for each run");
  return *command;
}

}  // namespace stiction::host
