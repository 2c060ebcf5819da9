#include "host/cli/sweep_output.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stiction::host {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no number for these.
Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string shown(const Json& value, const Json& unit) {
  const auto text = value.is_null() ? std::string("-") : fmt::format("{:.6g}", value.get<double>());
  const auto name = unit.get<std::string>();
  return name.empty() ? text : text + " " + name;
}

Json effects_json(const FigureEffects& effects) {
  Json json{{"name", effects.figure.name},
            {"unit", effects.figure.unit},
            {"rows", effects.rows},
            {"mean", number_or_null(effects.mean)},
            {"deviation", number_or_null(effects.deviation)},
            {"least", number_or_null(effects.least)},
            {"most", number_or_null(effects.most)},
            {"main_effects", Json::array()},
            {"interactions", Json::array()}};
  for (const auto& each : effects.main) json["main_effects"].push_back({{"key", each.key}, {"share", each.share}});
  for (const auto& each : effects.interactions)
    json["interactions"].push_back({{"keys", {each.first, each.second}}, {"share", each.share}});
  return json;
}

Json robust_json(const RobustChoice& robust) {
  const auto choice_json = [&](const DesignChoice& choice) {
    auto values = Json::object();
    for (std::size_t k = 0; k < robust.keys.size(); ++k) values[robust.keys[k]] = choice.values[k];
    return Json{{"values", std::move(values)}, {"worst", number_or_null(choice.worst)}, {"row", choice.row}};
  };
  auto choices = Json::array();
  for (const auto& choice : robust.choices) choices.push_back(choice_json(choice));
  return {{"nominal", choice_json(robust.choices.front())},
          {"best", choice_json(robust.choices[robust.best])},
          {"choices", std::move(choices)}};
}

std::string choice_text(const Json& choice, const Json& unit) {
  std::string text;
  for (const auto& [key, value] : choice["values"].items())
    text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", key, value.get<std::string>());
  return fmt::format("{} ({}; row {})", shown(choice["worst"], unit), text, choice["row"].get<std::uint64_t>());
}

std::string share_list(const Json& effects) {
  std::string text;
  for (const auto& each : effects)
    text += fmt::format("{}{} {:.1f} %", text.empty() ? "" : ", ", each["key"].get<std::string>(),
                        each["share"].get<double>() * 100.0);
  return text.empty() ? "no key varies" : text;
}

std::string quoted_word(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace

Json sweep_json(const SweepSpec& spec, const SweepPlan& plan, const SweepSummary& summary) {
  Json json{{"schema", "stiction.sweep/1"},
            {"name", spec.name},
            {"command", spec.command},
            {"rows", plan.rows},
            {"failed", summary.failed},
            {"failures", Json::array()},
            {"columns", Json::array()},
            {"figures", Json::array()},
            {"pareto", nullptr},
            {"worst", nullptr},
            {"robust", nullptr}};
  for (const auto& [message, number] : summary.failures)
    json["failures"].push_back({{"message", message}, {"rows", number}});
  for (const auto& key : spec.keys) json["columns"].push_back(key.column());
  for (const auto& figure : plan.figures) json["columns"].push_back(figure.column());
  for (const auto& effects : summary.effects) json["figures"].push_back(effects_json(effects));
  if (!spec.pareto.empty()) {
    auto points = Json::array();
    for (const auto& point : summary.pareto)
      points.push_back({{"row", point.row}, {"first", point.first}, {"second", point.second}});
    json["pareto"] = {{"figures", spec.pareto}, {"points", std::move(points)}};
  }
  if (std::isfinite(summary.worst_value))
    json["worst"] = {{"figure", summary.worst.name},
                     {"unit", summary.worst.unit},
                     {"value", summary.worst_value},
                     {"row", summary.worst_row},
                     {"command", summary.worst_command}};
  for (const auto& robust : summary.robust) {
    json["robust"] = robust_json(robust);
    json["robust"]["figure"] = spec.robust;
    json["robust"]["unit"] = summary.worst.unit;
    for (const auto& figure : plan.figures)
      if (figure.name == spec.robust) json["robust"]["unit"] = figure.unit;
  }
  return json;
}

std::string sweep_text(const std::string& text) {
  const auto json = Json::parse(text);
  auto out = fmt::format("{}: {} runs of `stiction {}`, {} of them failed\n", json["name"].get<std::string>(),
                         json["rows"].get<std::uint64_t>(), json["command"].get<std::string>(),
                         json["failed"].get<std::uint64_t>());
  for (const auto& each : json["failures"])
    out += fmt::format("  {} failed: {}\n", each["rows"].get<std::uint64_t>(), each["message"].get<std::string>());
  for (const auto& figure : json["figures"]) {
    const auto& unit = figure["unit"];
    out += fmt::format("\n{}: mean {}, from {} to {}\n  main effects, share of the variance: {}\n",
                       figure["name"].get<std::string>(), shown(figure["mean"], unit), shown(figure["least"], unit),
                       shown(figure["most"], unit), share_list(figure["main_effects"]));
  }
  if (!json["pareto"].is_null())
    out += fmt::format("\nPareto front of {} and {}: {} rows\n", json["pareto"]["figures"][0].get<std::string>(),
                       json["pareto"]["figures"][1].get<std::string>(), json["pareto"]["points"].size());
  if (!json["robust"].is_null()) {
    const auto& robust = json["robust"];
    out += fmt::format("\nworst {} of the first choice: {}\nworst {} of the robust choice: {}\n",
                       robust["figure"].get<std::string>(), choice_text(robust["nominal"], robust["unit"]),
                       robust["figure"].get<std::string>(), choice_text(robust["best"], robust["unit"]));
  }
  if (!json["worst"].is_null()) {
    const auto& worst = json["worst"];
    out += fmt::format("\nworst {}: {}, row {}\n  {}\n", worst["figure"].get<std::string>(),
                       shown(worst["value"], worst["unit"]), worst["row"].get<std::uint64_t>(),
                       worst["command"].get<std::string>());
  }
  return out;
}

std::string slurm_script(const SlurmJob& job) {
  return fmt::format(
      "#!/bin/bash\n"
      "# The tasks share the sweep in the folder of --out, which all nodes must see. A task that ends early, or that "
      "is\n"
      "# submitted again, does no harm: what is done stays done.\n"
      "#SBATCH --job-name=stiction-sweep\n"
      "#SBATCH --array=0-{}\n"
      "#SBATCH --cpus-per-task={}\n"
      "#SBATCH --output=stiction-sweep-%A_%a.log\n"
      "exec stiction sweep {} --out {} --threads {}{}\n",
      job.tasks - 1, job.threads, quoted_word(job.spec), quoted_word(job.out), job.threads, job.yes ? " --yes" : "");
}

}  // namespace stiction::host
