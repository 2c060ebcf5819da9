// `stiction simulate commissioning`: records of a simulated machine to identify and diagnose from, on request with an
// effect hidden in it that its file does not have.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "host/cli/choices.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/machine_options.hpp"
#include "host/cli/output.hpp"
#include "host/cli/progress.hpp"
#include "host/log/csv_log.hpp"
#include "host/simulate/commissioning.hpp"
#include "host/simulate/hidden_effect.hpp"
#include "sim/machine_file.hpp"

namespace stiction::host {
namespace {

struct CommissioningOptions {
  MachineOptions machine;
  std::string axis;
  std::uint64_t seed = 1;
  std::optional<std::uint64_t> hide;
  std::string out;
  bool json = false;
};

std::size_t axis_of(const CommissioningOptions& options, const machine::Machine& machine) {
  if (options.axis.empty()) return 0;
  const auto names = axis_names(machine);
  require_known("--axis", options.axis, "an axis of " + machine.id, names);
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), options.axis) - names.begin());
}

void run(const CommissioningOptions& options, const Invocation& invocation) {
  const auto file = options.machine.load(options.machine.machine, "commissioning");
  const std::size_t axis = axis_of(options, file);
  auto machine = file;
  PendingFolder folder(options.out, invocation.command);
  if (options.hide) {
    const auto effect = draw_hidden_effect(file.axes[axis], *options.hide);
    machine.axes[axis].effects.push_back(effect);
    folder.write("hidden.toml", sim::effect_table(file.axes[axis].name, effect, file.axes[axis].motor.driven_by_volts(),
                                                  file.axes[axis].coordinate));
  }
  std::vector<CommissioningRecord> records;
  {
    Progress progress("records", commissioning_records);
    records = record_commissioning(machine, axis, options.seed, [&] { progress.add(); });
  }
  nlohmann::ordered_json training = nlohmann::ordered_json::array(), held_out = nlohmann::ordered_json::array();
  for (auto& record : records) {
    record.log.comments = {
        {"made by", invocation.command_line}, {"machine", file.name}, {"current", "amplitude (peak) amperes"}};
    const std::string name = record.name + ".csv";
    folder.write(name, csv_log_text(record.log));
    (record.held_out ? held_out : training).push_back(name);
  }
  const std::vector<std::string> comment{"the records were made by: " + invocation.command_line};
  folder.write("machine.toml",
               sim::extended_machine(machine::find_machine(options.machine.machine), options.machine.set, {}, comment));
  const nlohmann::ordered_json json{{"schema", "stiction.commissioning/1"},
                                    {"machine", "machine.toml"},
                                    {"axis", file.axes[axis].name},
                                    {"logs", training},
                                    {"holdout", held_out},
                                    {"hidden", options.hide ? nlohmann::ordered_json("hidden.toml") : nullptr}};
  folder.write("result.json", json.dump(2) + "\n");
  folder.commit();
  if (options.json) {
    fmt::print("{}\n", json.dump(2));
    return;
  }
  for (const auto& record : records)
    fmt::print("{}/{}.csv: {:.1f} s{}\n", options.out, record.name, record.log.t.back(),
               record.held_out ? " (held-out data)" : "");
  fmt::print("{0}/machine.toml: nominal machine file{1}\n", options.out,
             options.hide ? fmt::format("\n{}/hidden.toml: the effect that was hidden; do not give it to the diagnosis",
                                        options.out)
                          : "");
}

}  // namespace

void add_commissioning(CLI::App& simulate, const Invocation& invocation) {
  auto* command = simulate.add_subcommand(
      "commissioning",
      "make records of one axis for identification and diagnosis: constant speeds, circle, small reversals");
  auto o = std::make_shared<CommissioningOptions>();
  o->machine.add_to(*command, "shipped machine by name, or a machine file");
  command->add_option("--axis", o->axis, "the axis that moves [the machine's first]")->type_name("NAME");
  command
      ->add_option("--hide", o->hide, "add an effect that is drawn with this seed to the machine, but not to its file")
      ->check(whole_number())
      ->type_name("SEED");
  command->add_option("--seed", o->seed, "seed of the noise")
      ->check(whole_number())
      ->type_name("N")
      ->capture_default_str();
  add_out(*command, o->out, "write the logs, the machine file and the hidden effect into this folder")->required();
  command->add_flag("--json", o->json, "print the list of written files as JSON on standard output");
  command->callback([o, &invocation] { run(*o, invocation); });
}

}  // namespace stiction::host
