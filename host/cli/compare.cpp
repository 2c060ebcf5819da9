// `stiction compare`: the machine file's published and measured rows, or a measured log, beside the simulation.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "host/cli/choices.hpp"
#include "host/cli/circle_command.hpp"
#include "host/cli/circle_output.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/machine_options.hpp"
#include "host/cli/output.hpp"
#include "host/cli/replay_command.hpp"
#include "host/report/circle_table.hpp"
#include "host/report/machine_sheet.hpp"

namespace stiction::host {
namespace {

struct CompareOptions {
  MachineOptions machine;
  std::string reference;
  std::string log;   // instead of a reference
  std::string axis;  // of the log
  std::string friction;
  std::string signals = "fixed";
  std::string out;
  bool json = false;
};

// How a simulation agrees with the rows of its machine file.
struct Agreement {
  int published_cells = 0;
  int equal = 0;                   // quantised error equal to the published one
  int within_increment = 0;        // or one increment beside it
  double current_deviation = 0.0;  // mean |ours / published - 1|
};

Agreement agreement_of(const std::vector<CircleTableRow>& table, const machine::Machine& machine) {
  Agreement a;
  for (const auto& row : table) {
    if (!row.error_quantised.published || !row.current.published) continue;
    const auto axis = std::find_if(machine.axes.begin(), machine.axes.end(),
                                   [&](const auto& candidate) { return candidate.name == row.axis; });
    const double increment = axis->position_controller.increment;
    const double off = std::abs(row.error_quantised.simulated - *row.error_quantised.published);
    ++a.published_cells;
    a.equal += off < 0.5 * increment;
    a.within_increment += off < 1.5 * increment;
    a.current_deviation += std::abs(row.current.simulated / *row.current.published - 1.0);
  }
  if (a.published_cells > 0) a.current_deviation /= a.published_cells;
  return a;
}

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

nlohmann::ordered_json percent(const std::optional<double>& fraction) {
  return fraction ? nlohmann::ordered_json(*fraction * 100.0) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json compare_json(const CirclePlan& plan, const sim::CircleResult& result,
                                    const std::vector<CircleTableRow>& table) {
  auto json = circle_json(result, plan.machine);
  const auto a = agreement_of(table, plan.machine);
  json["published_agreement"] = {{"cells", a.published_cells},
                                 {"equal", a.equal},
                                 {"within_one_increment", a.within_increment},
                                 {"mean_current_deviation_percent", a.current_deviation * 100.0}};
  json["mean_deviation_from_measured_percent"] = nlohmann::ordered_json::array();
  for (const auto& mean : mean_deviations(table))
    json["mean_deviation_from_measured_percent"].push_back({{"axis", mean.axis},
                                                            {"friction", mean.friction},
                                                            {"error", percent(mean.error)},
                                                            {"error_quantised", percent(mean.error_quantised)},
                                                            {"error_published", percent(mean.error_published)},
                                                            {"current", percent(mean.current)},
                                                            {"current_published", percent(mean.current_published)}});
  return json;
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
  if (a.published_cells > 0)
    text += fmt::format(
        "\n"
        "compared with the published simulation: {} of {} quantised peak errors are equal, {} differ by at most one "
        "increment;\n"
        "currents differ by {:.2f} % on average; velocity feedback: {}\n",
        a.equal, a.published_cells, a.within_increment, a.current_deviation * 100.0,
        velocity_source_name(plan.machine.axes.front().encoder.velocity));
  return text;
}

void compare(const CompareOptions& options, const Invocation& invocation) {
  if (options.reference.empty() == options.log.empty())
    throw UsageError(fmt::format("compare: found {}; expected either --reference circle or a measured log",
                                 options.log.empty() ? "neither --reference nor LOG" : "--reference and LOG"));
  if (!options.log.empty()) {
    run_replay(
        {options.machine, options.log, options.friction, options.axis, options.signals, "", options.out, options.json},
        invocation);
    return;
  }
  if (!options.axis.empty()) throw UsageError("--axis: found it together with --reference; expected it with LOG only");
  require_known("--reference", options.reference, "rows of the machine file", {"circle"});
  const auto machines = split_list(options.machine.machine);
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  std::string text;
  for (const auto& name : machines) {
    const auto plan = plan_of(options, name);
    // Several machines: a folder each.
    const std::string out =
        options.out.empty() || machines.size() == 1 ? options.out : options.out + "/" + plan.machine.id;
    const auto result = run_plan(plan, {"", out, invocation.command});
    const auto table = circle_table(result, plan.machine);
    auto json = compare_json(plan, result, table);
    if (!out.empty()) write_circle_folder(out, plan, result, json, invocation);
    text += compare_text(plan, result, table);
    if (!out.empty()) text += fmt::format("\nreport: {}/report.html\n", out);
    all.push_back(std::move(json));
  }
  if (options.json)
    fmt::print("{}\n",
               (machines.size() == 1 ? all.front()
                                     : nlohmann::ordered_json{{"schema", "stiction.comparison/1"}, {"machines", all}})
                   .dump(2));
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
