// `stiction machine`: the shipped machines, the check of a machine file, the reference of its keys.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "firmware/machine/file/machine_notes.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/machine_options.hpp"
#include "host/report/machine_sheet.hpp"
#include "sim/machine_file.hpp"

namespace stiction::host {
namespace {

struct MachineCommand {
  std::string check, checked;
  bool reference = false, json = false;
};

nlohmann::ordered_json endless_json(const machine::AxisModel& axis) {
  if (!axis.modulo_counts) return nullptr;
  return {{"encoder_on", axis.encoder.on == machine::EncoderPlace::motor ? "motor" : "load"},
          {"counts_numerator", axis.modulo_counts->numerator},
          {"counts_denominator", axis.modulo_counts->denominator}};
}

nlohmann::ordered_json check_json(const machine::Machine& machine, const std::vector<std::string>& notes) {
  nlohmann::ordered_json axes = nlohmann::ordered_json::array();
  for (const auto& axis : machine.axes) {
    const bool rotary = axis.coordinate.rotary(), fits = axis.beyond_formats.empty();
    axes.push_back({{"axis", axis.name},
                    {"kind", rotary ? "rotary" : "linear"},
                    {"radius_m", rotary && fits ? nlohmann::ordered_json(axis.coordinate.radius) : nullptr},
                    {"beyond_formats", fits ? nullptr : nlohmann::ordered_json(axis.beyond_formats)},
                    {"endless", endless_json(axis)}});
  }
  return {{"schema", "stiction.machine-check/1"},
          {"machine", machine.id},
          {"name", machine.name},
          {"axes", axes},
          {"notes", notes}};
}

// Reads and checks a file, down to the drive's number formats, and prints what was understood, or all of its errors.
void check_machine(const std::string& name, bool json) {
  sim::read_machine(machine::find_machine(name), {.experiment = {}, .set = {}, .all_errors = true});
  const auto machine = MachineOptions{name, {}}.load(name, "", needs_of("machine"));
  const auto notes = machine::machine_notes(machine);
  if (json) {
    fmt::print("{}\n", check_json(machine, notes).dump(2));
    return;
  }
  fmt::print("{}: {}\n", machine.id, machine.name);
  for (const auto& section : machine_sheet(machine)) {
    fmt::print("\n{}\n", section.title);
    for (const auto& row : section.rows) {
      fmt::print("  {:<44} {:<8}", row.label, row.unit);
      for (const auto& value : row.values) fmt::print(" {:>16}", value);
      fmt::print("\n");
    }
  }
  if (!notes.empty()) fmt::print("\nNotes\n");
  for (const auto& note : notes) fmt::print("  {}\n", note);
}

void print_lines(const std::vector<std::string>& lines) {
  for (const auto& line : lines) fmt::print("{}\n", line);
}

void add_list(CLI::App& command) {
  auto* list = command.add_subcommand("list", "print the names of the shipped machines, or of the axes of a machine");
  auto machine = std::make_shared<std::string>();
  list->add_option("--axes", *machine, "print the names of the axes of this machine instead")->type_name("MACHINE");
  list->callback([machine] {
    print_lines(machine->empty() ? machine::shipped_machines()
                                 : axis_names(sim::read_machine(machine::find_machine(*machine))));
  });
}

}  // namespace

void add_machine(CLI::App& program, const Invocation& invocation) {
  auto* command = program.add_subcommand(
      "machine", "list the shipped machines, check a machine file, make a new one, print the reference of its keys");
  auto o = std::make_shared<MachineCommand>();
  command->prefix_command();  // a command that it does not know is told by the callback
  add_list(*command);
  add_machine_new(*command, invocation);
  auto* check = command->add_subcommand("check", "read a machine file and print its errors or its contents");
  check->add_option("MACHINE", o->checked, "shipped machine by name, or a machine file")
      ->required()
      ->type_name("MACHINE");
  check->add_flag("--json", o->json, "print what later steps need of it as JSON on standard output");
  check->callback([o] { check_machine(o->checked, o->json); });
  command->add_subcommand("reference", "print the reference of all keys of a machine file (Markdown)")->callback([] {
    fmt::print("{}", sim::reference_page());
  });
  command->add_option("--check", o->check, "read a machine file and print its errors or its contents")
      ->type_name("MACHINE");
  command->add_flag("--json", o->json, "with --check: print what later steps need of it as JSON on standard output");
  command->add_flag("--reference", o->reference, "print the reference of all keys (Markdown)");
  // Before a subcommand prints anything.
  command->parse_complete_callback([o, command] {
    if (command->count("--json") == 0 || command->got_subcommand("check")) return;
    if (o->check.empty() || o->reference)
      throw UsageError("--json: found it without a machine to check; expected stiction machine --check MACHINE --json");
  });
  command->callback([o, command] {
    if (!command->get_subcommands().empty()) return;
    if (const auto found = command->remaining(); !found.empty()) refuse_unknown_command(*command, "command");
    if (o->reference) fmt::print("{}", sim::reference_page());
    if (!o->check.empty()) check_machine(o->check, o->json);
    if (!o->reference && o->check.empty()) print_lines(machine::shipped_machines());
  });
}

}  // namespace stiction::host
