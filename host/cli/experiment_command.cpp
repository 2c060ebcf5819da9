// `stiction simulate EXPERIMENT` for the experiments of the table: their options, their results.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>

#include "firmware/machine/file/units.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/experiment_output.hpp"
#include "host/cli/experiment_result_output.hpp"
#include "host/cli/machine_options.hpp"
#include "host/cli/output.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/report_origin.hpp"
#include "host/log/csv_log.hpp"
#include "host/simulate/experiments.hpp"
#include "sim/plant/friction/coulomb_viscous.hpp"

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

// Without --friction: every model that the experiment makes sense for and that the machine has.
std::vector<std::string> models_for(const Experiment& experiment, const std::string& text,
                                    const machine::Machine& machine) {
  auto names = friction_models(text.empty() ? "all" : text, machine);
  const auto models = needs_of(experiment.name).friction;
  if (models.empty()) {
    // The baseline D cannot stick and is not among the source's models; it runs where it is asked for, or alone.
    if (text.empty() && names.size() > 1) std::erase(names, std::string(sim::CoulombViscous<>::name));
    if (names.empty())
      throw UsageError(fmt::format("{}: found no friction model that all axes have; expected one, such as {}",
                                   machine.id, machine.axes.front().friction.use));
    return names;
  }
  const auto known = [&](const std::string& name) { return std::ranges::find(models, name) != models.end(); };
  if (!text.empty() && text != "all")
    for (const auto& name : names)
      require_known("--friction", name, fmt::format("a friction model that {} supports", experiment.name),
                    {models.begin(), models.end()});
  std::erase_if(names, [&](const std::string& name) { return !known(name); });
  return names;
}

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

// Empty: all that the experiment knows.
std::vector<std::string> equations_for(const Experiment& experiment, const std::string& text) {
  if (text.empty()) return experiment.equations;
  const auto& known = experiment.equations;
  auto names = split_list(text);
  for (const auto& name : names) require_known("--equations", name, "one or several of", known);
  return names;
}

double jerk_of(const std::string& text) {
  constexpr const char* expected = "a jerk above zero, such as \"40 m/s^3\"";
  try {
    const double jerk = machine::parse_quantity(text, "m/s^3");
    if (jerk > 0.0) return jerk;
  } catch (const machine::UnitError& error) {
    throw UsageError(fmt::format("--jerk: found '{}' ({}); expected {}", text, error.what(), expected));
  }
  throw UsageError(fmt::format("--jerk: found '{}'; expected {}", text, expected));
}

ExperimentInput input_of(const Experiment& experiment, const ExperimentOptions& options) {
  ExperimentInput input{options.machine.load(options.machine.machine, experiment.name), {}};
  if (!needs_of(experiment.name).feed_drive) input.friction = models_for(experiment, options.friction, input.machine);
  if (experiment.feeds != nullptr) input.feeds = feeds(options.feed);
  for (const double feed : input.feeds)
    if (!(feed > 0.0)) throw UsageError(fmt::format("--feed: found '{}'; expected feeds above zero", options.feed));
  input.equations = equations_for(experiment, options.equations);
  if (!options.jerk.empty()) input.jerk = jerk_of(options.jerk);
  return input;
}

void run(const Experiment& experiment, const ExperimentOptions& options, const Invocation& invocation) {
  auto input = input_of(experiment, options);
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
