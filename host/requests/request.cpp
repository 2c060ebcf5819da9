#include "host/requests/request.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

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
#include "host/requests/identify_request.hpp"
#include "host/requests/names.hpp"
#include "host/requests/run_options.hpp"
#include "host/requests/tuning_options.hpp"
#include "host/requests/usage_error.hpp"
#include "host/simulate/friction_choice.hpp"
#include "host/simulate/loaded_machine.hpp"
#include "host/simulate/machine_needs.hpp"
#include "host/tune/tuning_result.hpp"

namespace stiction::host {
namespace {

// What a request says, option by option.
class Texts {
 public:
  explicit Texts(const Request& request) : request_(request) {}
  std::string text(std::string_view name, std::string usual = {}) const {
    for (const auto& [key, value] : request_.options)
      if (key == name) return value;
    return usual;
  }
  std::vector<std::string> all(std::string_view name) const {
    std::vector<std::string> values;
    for (const auto& [key, value] : request_.options)
      if (key == name) values.push_back(value);
    return values;
  }
  bool flag(std::string_view name) const {
    const auto found = text(name, "false");
    if (found != "true" && found != "false")
      throw UsageError(fmt::format("--{}: found '{}'; expected true or false", name, found));
    return found == "true";
  }

 private:
  const Request& request_;
};

machine::Machine machine_of(const Request& request, const std::string& experiment, const MachineNeeds& needs) {
  const Texts texts(request);
  auto set = request.set;
  if (const auto kind = texts.text("compensation"); !kind.empty()) set.push_back(compensation_assignment(kind));
  return load_machine(request.machine, set, experiment, needs, needs.one_axis ? texts.text("axis") : "");
}

Answer circle(const Request& request, const RequestProgress& progress) {
  const Texts texts(request);
  const auto plan = circle_plan(machine_of(request, "circle", needs_of("circle")),
                                {texts.text("friction"), texts.text("feed"), texts.text("direction", "ccw"),
                                 texts.text("radius"), texts.text("signals", "fixed")});
  Answer answer{circle_json(run_circles(plan,
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

Answer experiment(const Request& request, const RequestProgress& progress) {
  const auto& which = experiment_of(request.command);
  const Texts texts(request);
  auto input =
      experiment_input(which, machine_of(request, which.name, needs_of(which.name)),
                       {texts.text("friction"), texts.text("feed"), texts.text("equations"), texts.text("jerk")});
  if (request.keep_logs && !which.keeps_logs)
    throw UsageError(fmt::format("{}: found that logs are wanted; expected none, as it keeps none", request.command));
  Answer answer;
  if (request.keep_logs)
    input.keep_log = [&](const std::string& run, Log log) {
      answer.logs.push_back({run, std::move(log)});
      if (progress) progress("log " + run);
    };
  answer.document = experiment_json(run_experiment(which, input), input.machine);
  return answer;
}

Answer identification(const Request& request, const RequestProgress& progress) {
  const Texts texts(request);
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

std::uint64_t whole_number_of(const std::string& option, const std::string& text) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && end == text.data() + text.size()) return number;
  throw UsageError(fmt::format("--{}: found '{}'; expected a whole number from 0 to {}", option, text,
                               std::numeric_limits<std::uint64_t>::max()));
}

Answer diagnosis(const Request& request, const RequestProgress& progress) {
  const Texts texts(request);
  DiagnoseInput input;
  input.seed = whole_number_of("seed", texts.text("seed", "1"));
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

Answer tuning(const Request& request, const RequestProgress& progress) {
  const Texts texts(request);
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
  Answer (*run)(const Request& request, const RequestProgress& progress);
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

}  // namespace

std::vector<std::string> request_commands() {
  std::vector<std::string> names;
  for (const auto& each : commands()) names.push_back(each.name);
  return names;
}

std::vector<std::string> request_options(const std::string& command) { return command_of(command).options; }

Answer answer(const Request& request, const RequestProgress& progress) {
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
  if (command.run != circle && command.run != experiment && request.keep_logs)
    throw UsageError(fmt::format("{}: found that logs are wanted; expected it of simulations alone", command.name));
  return command.run(request, progress);
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
