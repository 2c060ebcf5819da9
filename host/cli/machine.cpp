// `stiction machine`: the shipped machines, the check of a machine file, the reference of its keys.
#include <fmt/format.h>

#include <memory>

#include "firmware/machine/file/machine_notes.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/machine_options.hpp"
#include "host/report/machine_sheet.hpp"
#include "sim/machine_file.hpp"

namespace stiction::host {
namespace {

struct MachineCommand {
  std::string check;
  bool reference = false;
};

// Reads and checks a file, down to the drive's number formats, and prints what was understood.
void check_machine(const std::string& name) {
  const auto machine = MachineOptions{name, {}}.load(name, "", needs_of("machine"));
  fmt::print("{}: {}\n", machine.id, machine.name);
  for (const auto& section : machine_sheet(machine)) {
    fmt::print("\n{}\n", section.title);
    for (const auto& row : section.rows) {
      fmt::print("  {:<44} {:<8}", row.label, row.unit);
      for (const auto& value : row.values) fmt::print(" {:>16}", value);
      fmt::print("\n");
    }
  }
  const auto notes = machine::machine_notes(machine);
  if (!notes.empty()) fmt::print("\nNotes\n");
  for (const auto& note : notes) fmt::print("  {}\n", note);
}

}  // namespace

void add_machine(CLI::App& program, const Invocation&) {
  auto* command = program.add_subcommand(
      "machine", "list the shipped machines, check a machine file, print the reference of its keys");
  auto o = std::make_shared<MachineCommand>();
  command->add_option("--check", o->check, "read a machine file and print its errors or its contents")
      ->type_name("MACHINE");
  command->add_flag("--reference", o->reference, "print the reference of all keys (Markdown)");
  command->callback([o] {
    if (o->reference) fmt::print("{}", sim::reference_page());
    if (!o->check.empty()) check_machine(o->check);
    if (!o->reference && o->check.empty())
      for (const auto& name : machine::shipped_machines()) fmt::print("{}\n", name);
  });
}

}  // namespace stiction::host
