// `stiction identify`: mass and friction of an axis from measured logs, or from a table of steady states.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>
#include <set>

#include "firmware/machine/file/units.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/identify_output.hpp"
#include "host/cli/identify_reference.hpp"
#include "host/cli/logs.hpp"
#include "host/cli/machine_options.hpp"
#include "host/cli/output.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/report_origin.hpp"
#include "host/identify/identified_machine.hpp"
#include "host/identify/law_choice.hpp"
#include "host/identify/own_identification.hpp"
#include "host/identify/refinement.hpp"
#include "host/log/shown_units.hpp"
#include "host/log/text_file.hpp"
#include "host/report/identification_report.hpp"
#include "sim/machine_file.hpp"

namespace stiction::host {
namespace {

struct IdentifyCommandOptions {
  std::vector<std::string> logs;
  std::string columns;
  std::string reference;
  MachineOptions machine;
  std::string axis;
  std::string friction;
  std::string amperes;
  std::vector<std::string> fix;
  std::string out;
  bool refine = false;
  bool json = false;
};

// The axis named, or the only one that machine and logs have in common.
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

// The values of --fix, in the order of the fit's columns, of a linear axis.
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

struct Run {
  const machine::AxisModel* axis;
  Identification result;
  Origin origin;  // of the report
};

// Puts what the closed loop made of them in place of the parameters, and says what it gained.
void take(Identification& result, const Refinement& refinement, const ShownUnits& own) {
  for (const auto& refined : refinement.parameters)
    for (auto& parameter : result.parameters)
      if (parameter.name == refined.name) parameter = refined;
  result.method += fmt::format(
      " Refined in closed loop ({} simulations): the simulated {} deviates from the logs by {:.4g} {} rms (before: "
      "{:.4g}), the position by {:.3g} {} rms (before: {:.3g}).",
      refinement.simulations, own.force_word, own.force(refinement.force_after), own.force.unit,
      own.force(refinement.force_before), own.deviation(refinement.position_after), own.deviation.unit,
      own.deviation(refinement.position_before));
}

Run identify(const IdentifyCommandOptions& options, const machine::Machine& machine) {
  const auto amperes = amperes_of(options.amperes);
  if (options.logs.size() == 1)
    if (const auto text = read_text_file(options.logs.front()); is_steady_table(text)) {
      if (!options.fix.empty()) throw UsageError("--fix: found a table of steady states; expected logs");
      if (options.refine) throw UsageError("--refine: found a table of steady states; expected logs with set-points");
      const auto& axis = axis_to_identify(options.axis, machine, {});
      if (axis.coordinate.rotary())
        throw UsageError(fmt::format("{}: found a table of steady states and the rotary axis {}; expected logs",
                                     options.logs.front(), axis.name));
      return {&axis,
              identify_table(parse_steady_table(text, options.logs.front()), axis, parse_amperes(options.amperes),
                             FitSettings{}),
              report_origin(options.machine.machine, options.logs)};
    }
  const auto read = read_logs(options.logs, options.columns);
  const auto& axis = axis_to_identify(options.axis, machine, read);
  if (options.refine && !axis.cascaded() && axis.controller->structure == machine::ControlStructure::unknown)
    throw UsageError(fmt::format(
        "--refine: found axis {} with an unknown controller; expected one that can be simulated", axis.name));
  const auto logs = linear_logs(read, axis);
  const auto held = held_values(options.fix, axis);
  const IdentifyOptions settings{model_to_identify(options.friction, axis), amperes, FitSettings{},
                                 options.friction.empty(), held};
  const Progress progress(options.refine ? "identifying and refining" : "identifying");
  Run run{&axis, identify_logs(logs, axis, settings), report_origin(options.machine.machine, logs)};
  if (options.refine)
    take(run.result, refine_in_closed_loop(logs, machine, axis, run.result, settings), ShownUnits(axis.coordinate));
  return run;
}

void run(const IdentifyCommandOptions& options, const Invocation& invocation) {
  const auto machine = options.machine.load(options.machine.machine, "", needs_of("identify"));
  const auto file = machine::find_machine(options.machine.machine);
  const auto [axis, linear, origin] = identify(options, machine);
  const auto result = in_own_units(linear, *axis);
  const auto json = identification_json(result);
  if (!options.out.empty()) {
    PendingFolder folder(options.out, invocation.command);
    folder.write("identified.toml",
                 identified_machine(file, options.machine.set, *axis, linear, invocation.command_line));
    sim::read_machine(folder.path() / "identified.toml");  // what was written must be a machine
    folder.write("report.html",
                 identification_report_html({invocation.command_line, invocation.version, machine, result, origin}));
    folder.write("result.json", json.dump(2) + "\n");
    folder.commit();
  }
  if (options.json) {
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print("{}", identification_text(result));
  if (!options.out.empty()) fmt::print("\nmachine file: {0}/identified.toml\nreport: {0}/report.html\n", options.out);
}

}  // namespace

void add_identify(CLI::App& program, const Invocation& invocation) {
  auto* command = program.add_subcommand("identify", "identify mass and friction from measured logs");
  auto o = std::make_shared<IdentifyCommandOptions>();
  auto* logs =
      command->add_option("logs", o->logs, "logs of one axis, or one table of steady states (columns v[m/min],i[A])")
          ->type_name("LOG");
  add_columns(*command, o->columns);
  command
      ->add_option("--reference", o->reference,
                   "use the measured rows of this experiment in the machine file instead of logs")
      ->excludes(logs)
      ->check(one_of({"circle"}));
  o->machine.add_to(*command,
                    "shipped machine by name, or a machine file with force constant, limits and friction models");
  command->add_option("--axis", o->axis, "axis to identify, if logs and machine have several")->type_name("NAME");
  command
      ->add_option("--friction", o->friction,
                   "coulomb_viscous: sgn(v) of every sample, as published for EMPS; lugre: with presliding; or the "
                   "law in use, if its contact has one length (dahl, elasto_plastic) "
                   "[for a law of the file that sticks rigidly sgn(v) of the moving rows; else the law in use, if its "
                   "contact has one length; else lugre]")
      ->type_name("MODEL");
  command
      ->add_option("--amperes", o->amperes,
                   "convention of the currents [logs: peak; a table needs this option or a comment]")
      ->check(one_of({"peak", "rms"}));
  command
      ->add_option("--fix", o->fix,
                   "hold mass, viscous, coulomb or constant_force (of a rotary axis inertia, gravity or "
                   "constant_torque) at this value instead of estimating it, for example "
                   "mass=225kg; may be given several times")
      ->type_name("KEY=VALUE");
  command->add_flag("--refine", o->refine,
                    "refine mass, friction and stiffness in closed-loop simulation with the set-points of the logs; "
                    "takes seconds, and helps if the position is noisy or coarse");
  add_out(*command, o->out, "write identified.toml, report.html and result.json into this folder");
  command->add_flag("--json", o->json, "print the result as JSON on standard output");
  command->callback([o, &invocation] {
    try {
      if (!o->reference.empty()) return identify_reference({o->machine, o->reference, o->out, o->json}, invocation);
      if (o->logs.empty()) throw UsageError("identify: found neither LOG nor --reference; expected one of them");
      run(*o, invocation);
    } catch (const LogError& error) {
      throw UsageError(error.what());
    }
  });
}

}  // namespace stiction::host
