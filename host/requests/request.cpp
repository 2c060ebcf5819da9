#include "host/requests/request.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "firmware/machine/file/machine_file.hpp"
#include "host/diagnose/diagnose.hpp"
#include "host/diagnose/verdict/verdict_json.hpp"
#include "host/identify/own_identification.hpp"
#include "host/log/channel_name.hpp"
#include "host/log/read_log.hpp"
#include "host/log/stretches.hpp"
#include "host/output/circle_output.hpp"
#include "host/output/experiment_output.hpp"
#include "host/output/identify_output.hpp"
#include "host/requests/axis_choice.hpp"
#include "host/requests/given_force.hpp"
#include "host/requests/identify_request.hpp"
#include "host/requests/names.hpp"
#include "host/requests/request_texts.hpp"
#include "host/requests/run_answers.hpp"
#include "host/requests/run_options.hpp"
#include "host/requests/tuning_options.hpp"
#include "host/requests/usage_error.hpp"
#include "host/simulate/friction_choice.hpp"
#include "host/simulate/machine_needs.hpp"
#include "host/tune/tuning_result.hpp"

namespace stiction::host {
namespace {

RequestAnswer circle(const Request& request, const RequestProgress& progress) {
  const RequestTexts texts(request);
  const auto plan = circle_plan(machine_of(request, "circle", needs_of("circle")),
                                {texts.text("friction"), texts.text("feed"), texts.text("direction", "ccw"),
                                 texts.text("radius"), texts.text("signals", "fixed")});
  RequestAnswer answer{circle_json(run_circles(plan,
                                               [&] {
                                                 if (progress) progress("circle");
                                               }),
                                   plan.machine)};
  if (!request.keep_logs) return answer;
  for (const auto& each : cases_of(plan)) {
    const bool clockwise = each.settings.direction == sim::Direction::clockwise;
    const auto run = fmt::format("{} {:g} m/min {}", friction_in_use(each.machine), each.settings.feed * 60.0,
                                 clockwise ? "cw" : "ccw");
    answer.logs.push_back({run, run_logged(each)});
    if (progress) progress("log of " + run);
  }
  return answer;
}

const Experiment& experiment_of(const std::string& command) {
  const auto table = experiments();
  return *std::ranges::find_if(table,
                               [&](const Experiment& each) { return command == std::string("simulate ") + each.name; });
}

RequestAnswer experiment(const Request& request, const RequestProgress& progress) {
  const auto& which = experiment_of(request.command);
  const RequestTexts texts(request);
  auto input =
      experiment_input(which, machine_of(request, which.name, needs_of(which.name)),
                       {texts.text("friction"), texts.text("feed"), texts.text("equations"), texts.text("jerk")});
  if (request.keep_logs && !which.keeps_logs)
    throw UsageError(fmt::format("{}: found that logs are wanted; expected none, as it keeps none", request.command));
  RequestAnswer answer;
  if (request.keep_logs)
    input.keep_log = [&](const std::string& run, Log log) {
      answer.logs.push_back({run, std::move(log)});
      if (progress) progress("log " + run);
    };
  answer.document = experiment_json(run_experiment(which, input), input.machine);
  return answer;
}

RequestAnswer identification(const Request& request, const RequestProgress& progress) {
  const RequestTexts texts(request);
  const auto machine = machine_of(request, "", needs_of("identify"));
  const auto [axis, linear, logs] =
      identify_request({request.logs, texts.text("columns"), texts.text("axis"), texts.text("friction"),
                        texts.text("amperes"), texts.all("fix"), texts.flag("refine")},
                       machine,
                       {[](const auto& files, const auto& columns) { return logs_of(files, columns); },
                        [&] {
                          if (progress) progress("identifying");
                        }});
  return {identification_json(in_own_units(linear, *axis))};
}

RequestAnswer diagnosis(const Request& request, const RequestProgress& progress) {
  const RequestTexts texts(request);
  DiagnoseInput input;
  input.seed = texts.number("seed", 1, 0, std::numeric_limits<std::uint64_t>::max());
  input.machine = machine_of(request, "", needs_of("diagnose"));
  input.logs = logs_of(request.logs, texts.text("columns"));
  input.held_out = logs_of(texts.all("holdout"), texts.text("columns"));
  auto all = input.logs;
  all.insert(all.end(), input.held_out.begin(), input.held_out.end());
  std::vector<Verdict> verdicts;
  for (const auto axis : axes_to_diagnose(texts.text("axis"), input.machine, all)) {
    input.axis = axis;
    if (progress)
      input.progress = [&, name = input.machine.axes[axis].name](std::string_view part) {
        progress(fmt::format("{}: {}", name, part));
      };
    verdicts.push_back(diagnose(input));
  }
  return {verdict_json(verdicts)};
}

RequestAnswer tuning(const Request& request, const RequestProgress& progress) {
  const RequestTexts texts(request);
  const auto machine = machine_of(request, "", needs_of(""));
  const auto logs = logs_of(request.logs, texts.text("columns"));
  auto settings = tuning_settings({texts.text("axis"), texts.text("feed"), texts.text("show"), texts.flag("no-pulse")},
                                  machine, logs);
  if (progress) {
    settings.tuned = [&](const std::string& axis) { progress("tuned " + axis); };
    settings.begin_comparison = [&](std::size_t circles) { progress(fmt::format("{} circles follow", circles)); };
  }
  const auto all = tune_machine(machine, logs, settings);
  return {experiment_json(tuning_result(all), all.machine)};
}

struct Command {
  std::string name;
  std::vector<std::string> options;
  RequestAnswer (*run)(const Request& request, const RequestProgress& progress);
  enum class Logs { none, may, must } logs = Logs::none;
};

Command row_of(const Experiment& each) {
  Command command{std::string("simulate ") + each.name, {}, experiment};
  const auto& needs = needs_of(each.name);
  if (each.compensation) command.options.emplace_back("compensation");
  if (needs.one_axis) command.options.emplace_back("axis");
  if (!needs.feed_drive) command.options.emplace_back("friction");
  if (each.feeds != nullptr) command.options.emplace_back("feed");
  if (!each.equations.empty()) command.options.emplace_back("equations");
  if (each.jerk) command.options.emplace_back("jerk");
  return command;
}

const std::vector<Command>& commands() {
  static const auto all = [] {
    using Logs = Command::Logs;
    std::vector<Command> table{
        {"simulate circle", {"compensation", "friction", "feed", "direction", "radius", "signals"}, circle},
        {"simulate cam", {"axis", "cam", "name", "speed", "cycles", "master", "model", "verification"}, answer_cam},
        {"simulate replay", {"axis", "columns", "friction", "signals"}, answer_replay, Logs::must},
        {"simulate frequency-response",
         {"axis", "loop", "columns", "friction", "signal", "speed", "amplitude", "lowest", "periods", "passes"},
         answer_response,
         Logs::may},
        {"identify", {"axis", "columns", "friction", "amperes", "fix", "refine"}, identification, Logs::must},
        {"diagnose", {"axis", "columns", "holdout", "seed"}, diagnosis, Logs::must},
        {"tune-friction", {"axis", "columns", "feed", "show", "no-pulse"}, tuning, Logs::may}};
    for (const auto& each : experiments()) table.push_back(row_of(each));
    return table;
  }();
  return all;
}

const Command& command_of(const std::string& name) {
  require_known("command", name, "one of", request_commands());
  return *std::ranges::find(commands(), name, &Command::name);
}

// An experiment without an axis in closed loop would run, and never ask for the forces.
RequestAnswer answer_with_forces(const Command& command, Request request, const RequestProgress& progress) {
  for (auto& force : request.forces) force.watch = std::make_shared<WatchedForce>(force.axis, force.force);
  auto answer = command.run(request, progress);
  for (const auto& force : request.forces)
    if (!force.watch->asked())
      throw UsageError(
          fmt::format("{}: found an effect on axis {}, which no run has asked for; expected an experiment "
                      "with that axis in closed loop",
                      command.name, force.axis));
  return answer;
}

}  // namespace

std::vector<std::string> request_commands() {
  std::vector<std::string> names;
  for (const auto& each : commands()) names.push_back(each.name);
  return names;
}

std::vector<std::string> request_options(const std::string& command) { return command_of(command).options; }

RequestAnswer answer(const Request& request, const RequestProgress& progress) {
  const auto& command = command_of(request.command);
  for (const auto& [name, value] : request.options) {
    require_known(command.name, name, "an option among", command.options);
    if (value.empty())
      throw UsageError(fmt::format("--{}: found an empty value; expected one, or not the option", name));
  }
  if (command.logs == Command::Logs::none && !request.logs.empty())
    throw UsageError(fmt::format("{}: found {} logs; expected none", command.name, request.logs.size()));
  if (command.logs == Command::Logs::must && request.logs.empty())
    throw UsageError(fmt::format("{}: found no log; expected at least one", command.name));
  const bool simulates = command.name.starts_with("simulate ");
  if (!simulates && request.keep_logs)
    throw UsageError(fmt::format("{}: found that logs are wanted; expected it of simulations alone", command.name));
  if (request.forces.empty()) return command.run(request, progress);
  if (!simulates) throw UsageError(fmt::format("{}: found effects; expected them of simulations alone", command.name));
  return answer_with_forces(command, request, progress);
}

std::vector<LogColumn> columns_of(const Log& log) {
  std::vector<LogColumn> columns{{"t", "s", &log.t}};
  for (const auto& axis : log.axes)
    for (const auto& channel : log_channels) {
      const auto& values = axis.*channel.values;
      if (values.empty()) continue;
      columns.push_back(
          {(axis.axis.empty() ? "" : axis.axis + ".") + name_on(axis, channel), unit_on(axis, channel), &values});
    }
  return columns;
}

std::vector<Log> logs_of(const std::vector<std::string>& files, const std::string& columns) {
  std::vector<Log> logs;
  for (const auto& file : files)
    for (auto& stretch : stretches_of(read_log(file, {columns, {}}))) logs.push_back(std::move(stretch));
  return logs;
}

}  // namespace stiction::host
