#include "host/cli/frequency_response_command.hpp"

#include <fmt/format.h>

#include <memory>

#include "firmware/machine/file/machine_file.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/experiment_result_output.hpp"
#include "host/cli/log_input.hpp"
#include "host/cli/machine_options.hpp"
#include "host/cli/output.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/report_origin.hpp"
#include "host/cli/response_test_output.hpp"
#include "host/log/csv_log.hpp"
#include "host/output/experiment_output.hpp"
#include "host/requests/response_request.hpp"

namespace stiction::host {
namespace {

struct Options {
  MachineOptions machine;
  std::string friction, axis, loop, speed, amplitude, lowest = "2 Hz", signal = "multisine";
  int periods = 2, passes = 8;
  std::string from, columns, log, out;
  bool json = false;
};

void run(const Options& options, const Invocation& invocation) {
  if (is_response_test_file(options.from)) {
    if (!options.out.empty() || !options.axis.empty() || !options.loop.empty())
      throw UsageError(fmt::format(
          "--from: found {}, the response test of a control, together with --out, --axis or --loop; expected "
          "it alone or with --json, as it is a response of its own",
          options.from));
    print_response_test(options.from, options.json);
    return;
  }
  if (options.machine.machine.empty())
    throw UsageError(
        "--machine: found none; expected a shipped machine by name, or a machine file (only the response test of a "
        "control, --from FILE.XML, needs none)");
  ResponseHooks hooks{[](const auto& file, const auto& columns) { return read_log_shown(file, columns); }};
  if (!options.log.empty())
    hooks.simulated = [&](const Log& log) {
      PendingFile file(options.log);
      file.write(csv_log_text(log));
      file.commit();
    };
  auto machine_read = options.machine.load(options.machine.machine, "frequency-response");
  auto origin = report_origin(options.machine.machine);
  const auto [machine, result, period] = during("measuring the loops", [&] {
    return response_request(
        {options.axis, options.loop, options.from, options.columns, options.friction, options.signal, options.speed,
         options.amplitude, options.lowest, options.periods, options.passes},
        std::move(machine_read), machine::find_machine(options.machine.machine), hooks);
  });
  if (!options.from.empty()) origin.sources = {options.from}, origin.sample_periods = {period};
  const auto json = experiment_json(result, machine);
  write_experiment_folder(options.out, invocation, machine, result, origin, json);
  if (options.json) {
    fmt::print("{}\n", json.dump(2));
    return;
  }
  print_experiment(result, machine, written(options.log), options.out);
}

}  // namespace

void add_frequency_response(CLI::App& simulate, const Invocation& invocation) {
  auto* command = simulate.add_subcommand("frequency-response",
                                          "measure current, velocity and position loop and the plant with a test "
                                          "signal on the set current: Bode plots and margins");
  auto o = std::make_shared<Options>();
  o->machine.add_to(*command, "shipped machine by name, or a machine file; required but for a response test");
  command->get_option("--machine")->required(false);
  command->add_option("--axis", o->axis, "axis, or a list of axes [all]")->type_name("AXIS");
  command
      ->add_option("--loop", o->loop,
                   "loop to measure: current, velocity, position, or a list of them [all, with the plant]")
      ->type_name("LOOP");
  auto* from =
      command
          ->add_option(
              "--from", o->from,
              "evaluate this log instead, which must have i_inject[A] or u_inject[V], or the response test (XML) of "
              "a SINUMERIK")
          ->type_name("LOG");
  add_columns(*command, o->columns)->needs(from);
  const auto simulated_only = [&](CLI::Option* option) { return option->excludes(from); };
  simulated_only(command->add_option("--friction", o->friction, "friction model [as in the machine file]"))
      ->type_name("MODEL");
  simulated_only(command->add_option("--signal", o->signal, "multisine: all frequencies at once; stepped-sine"))
      ->check(one_of({"multisine", "stepped-sine"}))
      ->capture_default_str();
  simulated_only(
      command->add_option("--speed", o->speed,
                          "speed of the axis, which moves back and forth during the test [2 m/min; of a rotary axis a "
                          "third of its highest speed, or what its travel allows]"))
      ->type_name("\"NUMBER UNIT\"");
  simulated_only(
      command->add_option("--amplitude", o->amplitude, "peak value of the test signal [10 % of the current limit]"))
      ->type_name("\"NUMBER UNIT\"");
  simulated_only(
      command->add_option("--lowest", o->lowest, "lowest frequency, and spacing of the lines of a multisine"))
      ->type_name("\"NUMBER UNIT\"")
      ->capture_default_str();
  simulated_only(
      command->add_option("--periods", o->periods, "number of evaluated periods, at least 2, after one for settling"))
      ->capture_default_str();
  simulated_only(
      command->add_option("--passes", o->passes, "number of passes of a multisine, each with different phases"))
      ->capture_default_str();
  simulated_only(add_output_file(*command, "--log", o->log, "write the signals that a drive would record (CSV)"));
  add_out(*command, o->out, "write report.html and result.json into this folder");
  command->add_flag("--json", o->json, "print the result as JSON on standard output");
  command->callback([o, &invocation] { run(*o, invocation); });
}

}  // namespace stiction::host
