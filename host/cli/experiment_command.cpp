// `stiction simulate EXPERIMENT` for the experiments of the table: their options, their results.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>

#include "host/cli/choices.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/experiment_result_output.hpp"
#include "host/cli/machine_options.hpp"
#include "host/cli/output.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/report_origin.hpp"
#include "host/log/csv_log.hpp"
#include "host/output/experiment_output.hpp"
#include "host/simulate/experiments.hpp"

namespace stiction::host {
namespace {

struct ExperimentOptions {
  MachineOptions machine;
  std::string friction;
  std::string log;
  std::string feed;
  std::string equations;
  std::string jerk;
  std::string out;
  bool json = false;
};

// "run.csv" and "24 m/min" make "run-24_m_per_min.csv".
std::filesystem::path log_place(const std::filesystem::path& file, std::string run) {
  if (run.empty()) return file;
  for (std::size_t at; (at = run.find('/')) != std::string::npos;) run.replace(at, 1, "_per_");
  std::ranges::replace(run, ' ', '_');
  return file.parent_path() / (file.stem().string() + "-" + run + file.extension().string());
}

// The logs of an experiment, moved to their places when all of them are there.
class ExperimentLogs {
 public:
  ExperimentLogs(const Experiment& experiment, const ExperimentOptions& options, ExperimentInput& input) {
    if (options.log.empty()) return;
    if (input.friction.size() != 1)
      throw UsageError(
          fmt::format("--log: found {} friction models; expected one, chosen with --friction", input.friction.size()));
    input.keep_log = [&experiment, &options, &input, this](const std::string& run, Log log) {
      log.comments = {{"log", fmt::format("stiction simulate {}", experiment.name)},
                      {"machine", input.machine.name},
                      {"friction", input.friction.front()},
                      {"current", "amplitude (peak) amperes"}};
      if (!run.empty()) log.comments.emplace_back("run", run);
      if (input.jerk) log.comments.emplace_back("jerk", fmt::format("{:g} m/s^3", *input.jerk));
      places_.push_back(log_place(options.log, run));
      files_.push_back(std::make_unique<PendingFile>(places_.back()));
      files_.back()->write(csv_log_text(log));
    };
  }
  void commit() {
    for (auto& file : files_) file->commit();
  }
  const std::vector<std::filesystem::path>& places() const { return places_; }

 private:
  std::vector<std::filesystem::path> places_;
  std::vector<std::unique_ptr<PendingFile>> files_;
};

void run(const Experiment& experiment, const ExperimentOptions& options, const Invocation& invocation) {
  auto input = experiment_input(experiment, options.machine.load(options.machine.machine, experiment.name),
                                {options.friction, options.feed, options.equations, options.jerk});
  ExperimentLogs logs(experiment, options, input);
  const auto result =
      during("simulating " + std::string(experiment.name), [&] { return run_experiment(experiment, input); });
  logs.commit();
  const auto json = experiment_json(result, input.machine);
  write_experiment_folder(options.out, invocation, input.machine, result, report_origin(options.machine.machine), json);
  if (options.json) {
    fmt::print("{}\n", json.dump(2));
    return;
  }
  std::vector<std::string> places;
  for (const auto& place : logs.places()) places.push_back(place.string());
  print_experiment(result, input.machine, places, options.out);
}

}  // namespace

void add_experiments(CLI::App& simulate, const Invocation& invocation) {
  for (const auto& experiment : experiments()) {
    auto* command = simulate.add_subcommand(experiment.name, experiment.text);
    auto o = std::make_shared<ExperimentOptions>();
    o->machine.add_to(*command, "shipped machine by name, or a machine file");
    if (experiment.compensation) o->machine.add_compensation_to(*command);
    const auto& needs = needs_of(experiment.name);
    if (needs.one_axis) o->machine.add_axis_to(*command);
    if (!needs.feed_drive)
      command
          ->add_option("--friction", o->friction,
                       "friction model, or a list of models [all that the experiment supports]")
          ->type_name("MODEL");
    if (experiment.feeds != nullptr) {
      o->feed = experiment.feeds;
      command->add_option("--feed", o->feed, "feed, or a list of feeds; the charts over time show the first")
          ->type_name("\"NUMBER UNIT\"")
          ->capture_default_str();
    }
    if (!experiment.equations.empty())
      command
          ->add_option(
              "--equations", o->equations,
              fmt::format("version of the equations, or a list: {} [all]", fmt::join(experiment.equations, ", ")))
          ->type_name("FORM");
    if (experiment.jerk)
      command
          ->add_option("--jerk", o->jerk,
                       "limit of the jerk of the set-points [none: the acceleration steps where an arc begins or ends]")
          ->type_name("\"NUMBER UNIT\"");
    if (experiment.keeps_logs)
      add_output_file(*command, "--log", o->log, "write the run as a log (CSV); one file per run if there are several");
    add_out(*command, o->out, "write report.html and result.json into this folder");
    command->add_flag("--json", o->json, "print the result as JSON on standard output");
    command->callback([o, &experiment, &invocation] { run(experiment, *o, invocation); });
  }
}

}  // namespace stiction::host
