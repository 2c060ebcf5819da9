// `stiction compare`: the machine file's published and measured rows, or a measured log, beside the simulation.
#include <fmt/format.h>

#include <memory>
#include <set>

#include "host/cli/choices.hpp"
#include "host/cli/circle_command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/compare_output.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/log_input.hpp"
#include "host/cli/machine_options.hpp"
#include "host/cli/output.hpp"
#include "host/cli/replay_command.hpp"
#include "host/output/circle_output.hpp"
#include "host/report/circle_table.hpp"
#include "host/report/machine_sheet.hpp"

namespace stiction::host {
namespace {

struct CompareOptions {
  MachineOptions machine;
  std::string reference;
  std::string log;      // instead of a reference
  std::string columns;  // of the log, without header
  std::string axis;     // of the log
  std::string friction;
  std::string signals = "fixed";
  std::string out;
  bool json = false;
};

// What the references speak of: their feeds, and the models of the published simulations.
CirclePlan plan_of(const CompareOptions& options, const std::string& machine_name) {
  CirclePlan plan;
  plan.machine = options.machine.load(machine_name, "circle", needs_of("compare --reference circle"));
  plan.signals = options.signals == "double" ? SignalKind::double_precision : SignalKind::fixed_point;
  plan.directions = directions("ccw");
  std::set<double> feed_set;
  std::set<std::string> published;
  for (const auto& row : plan.machine.circle_references) {
    feed_set.insert(row.feed);
    if (row.friction) published.insert(*row.friction);
  }
  plan.feeds.assign(feed_set.begin(), feed_set.end());
  if (!options.friction.empty()) {
    plan.friction = friction_models(options.friction, plan.machine);
  } else {
    for (const auto& name : friction_models("all", plan.machine))
      if (published.contains(name)) plan.friction.push_back(name);
    if (plan.friction.empty()) plan.friction = friction_models("", plan.machine);
  }
  return plan;
}

std::string cell(const std::optional<double>& fraction) {
  return fraction ? fmt::format("{:.1f}", *fraction * 100.0) : "-";
}

std::string compare_text(const CirclePlan& plan, const sim::CircleResult& result,
                         const std::vector<CircleTableRow>& table) {
  std::string text = circle_text(result, plan.machine);
  text +=
      "\nmean |measured - simulated| / measured over the feeds, %\n"
      "axis friction           error    of the published    current    of the published\n"
      "                                      simulation                      simulation\n";
  for (const auto& mean : mean_deviations(table))
    text += fmt::format("{:<4} {:<16} {:>7} {:>19} {:>10} {:>19}\n", mean.axis, mean.friction, cell(mean.error),
                        cell(mean.error_published), cell(mean.current), cell(mean.current_published));
  const auto a = agreement_of(table, plan.machine);
  if (a.cells > 0)
    text += fmt::format(
        "\n"
        "compared with the published simulation: {} of {} quantised peak errors are equal, {} differ by at most one "
        "increment;\n"
        "currents differ by {:.2f} % on average; velocity feedback: {}\n",
        a.equal, a.cells, a.within_increment, a.current_deviation * 100.0,
        velocity_source_name(plan.machine.axes.front().encoder.velocity));
  return text;
}

void compare(const CompareOptions& options, const Invocation& invocation) {
  if (options.reference.empty() == options.log.empty())
    throw UsageError(fmt::format("compare: found {}; expected either --reference circle or a measured log",
                                 options.log.empty() ? "neither --reference nor LOG" : "--reference and LOG"));
  if (!options.log.empty()) {
    run_replay({options.machine, options.log, options.friction, options.axis, options.signals, "", options.out,
                options.json, options.columns},
               invocation,
               [&](const Log& log, const std::vector<ReplayCase>& cases, const sim::ExperimentResult& result) {
                 return compare_log_json(log, cases, options.axis, result.signals);
               });
    return;
  }
  if (!options.axis.empty()) throw UsageError("--axis: found it together with --reference; expected it with LOG only");
  require_known("--reference", options.reference, "rows of the machine file", {"circle"});
  std::vector<CirclePlan> plans;
  const auto names = split_list(options.machine.machine);
  for (const auto& name : names) {
    plans.push_back(plan_of(options, name));
    for (const auto& other : plans)
      if (&other != &plans.back() && other.machine.id == plans.back().machine.id)
        throw UsageError(fmt::format("--machine: found {} twice; expected different names", other.machine.id));
  }
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  std::string text, signals;
  for (std::size_t k = 0; k < plans.size(); ++k) {
    const auto& plan = plans[k];
    // Several machines: a folder each.
    const std::string out =
        options.out.empty() || plans.size() == 1 ? options.out : options.out + "/" + plan.machine.id;
    const auto result = run_plan(plan, {"", out, invocation.command});
    const auto table = circle_table(result, plan.machine);
    auto json = compared_circle_json(result, plan.machine, table);
    signals = result.signals;
    if (!out.empty())
      write_circle_folder(out, plan, result, compare_reference_json(signals, nlohmann::ordered_json::array({json})),
                          invocation, names[k]);
    text += compare_text(plan, result, table);
    if (!out.empty()) text += fmt::format("\nreport: {}/report.html\n", out);
    all.push_back(std::move(json));
  }
  if (options.json)
    fmt::print("{}\n", compare_reference_json(signals, all).dump(2));
  else
    fmt::print("{}", text);
}

}  // namespace

void add_compare(CLI::App& program, const Invocation& invocation) {
  auto* command = program.add_subcommand(
      "compare", "compare the simulation with published and measured rows, or with a measured log");
  auto o = std::make_shared<CompareOptions>();
  command->add_option("--reference", o->reference, "rows of the machine file to compare with")
      ->check(one_of({"circle"}));
  command->add_option("LOG", o->log, "a measured log; the simulation follows its set-points")->type_name("LOG");
  add_columns(*command, o->columns);
  command->add_option("--axis", o->axis, "axis of the machine, for a log without axis names")->type_name("AXIS");
  o->machine.add_to(*command, "shipped machine by name, or a machine file; or a list of them");
  command
      ->add_option("--friction", o->friction,
                   "model, list of models, or all [those of the published simulations, or of the machine file]")
      ->type_name("MODEL");
  command
      ->add_option("--signals", o->signals,
                   "fixed: the firmware in fixed point; double: the same laws in double precision")
      ->check(one_of({"fixed", "double"}))
      ->capture_default_str();
  add_out(*command, o->out, "write report.html and result.json into this folder", true);
  command->add_flag("--json", o->json, "print the result as JSON on standard output");
  command->callback([o, &invocation] { compare(*o, invocation); });
}

}  // namespace stiction::host
