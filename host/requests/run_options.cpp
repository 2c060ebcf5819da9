#include "host/requests/run_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "firmware/machine/file/units.hpp"
#include "host/requests/names.hpp"
#include "host/requests/usage_error.hpp"
#include "host/simulate/friction_choice.hpp"
#include "host/simulate/machine_needs.hpp"
#include "sim/plant/friction/coulomb_viscous.hpp"
#include "sim/plant/friction/friction.hpp"

namespace stiction::host {
namespace {

// "8,5 m/min": one number, and no list of them, which have units.
void refuse_decimal_comma(const std::string& text, const std::string& option) {
  const auto digit = [&](std::size_t k) { return k < text.size() && text[k] >= '0' && text[k] <= '9'; };
  for (std::size_t k = 1; k + 1 < text.size(); ++k)
    if (text[k] == ',' && digit(k - 1) && digit(k + 1))
      throw UsageError(
          fmt::format("{}: found '{}' (a comma between digits); expected numbers with a decimal point, as in \"8.5 "
                      "m/min\", each with its unit in a list, as in \"8 m/min, 16 m/min\"",
                      option, text));
}

}  // namespace

std::vector<std::string> split_list(const std::string& text) {
  constexpr const char* blanks = " \t\n\r\v\f";
  std::vector<std::string> parts;
  for (std::size_t from = 0; from == 0 || from < text.size();) {
    const auto end = std::min(text.find(',', from), text.size());
    const auto part = text.substr(from, end - from);
    const auto first = part.find_first_not_of(blanks);
    parts.push_back(first == std::string::npos ? "" : part.substr(first, part.find_last_not_of(blanks) - first + 1));
    from = end + 1;
  }
  return parts;
}

std::vector<std::string> friction_models(const std::string& text, const machine::Machine& machine) {
  std::vector<std::string> everywhere, all{"all"};
  for (const auto& law : sim::friction_tables()) {
    const std::string name(law.name);
    all.push_back(name);
    if (std::all_of(machine.axes.begin(), machine.axes.end(),
                    [&](const auto& axis) { return axis.friction.models.contains(name); }))
      everywhere.push_back(name);
  }
  if (text == "all") return everywhere;
  if (text.empty()) return {friction_in_use(machine)};
  const auto names = split_list(text);
  for (const auto& name : names) {
    if (std::find(everywhere.begin(), everywhere.end(), name) != everywhere.end()) continue;
    const bool law = std::find(all.begin(), all.end(), name) != all.end();
    throw UsageError(fmt::format("--friction: found '{}'{}; expected 'all' or models that every axis of {} has: {}{}",
                                 name, law ? ", of which an axis has no parameters" : "", machine.id,
                                 fmt::join(everywhere, ", "), law ? "" : nearest_words(name, all)));
  }
  return names;
}

std::vector<double> feeds(const std::string& text, const std::string& option) {
  refuse_decimal_comma(text, option);
  std::vector<double> result;
  for (const auto& part : split_list(text)) {
    try {
      result.push_back(machine::parse_quantity(part, "m/s"));
    } catch (const machine::UnitError& error) {
      throw UsageError(
          fmt::format("{}: found '{}' ({}); expected a speed such as \"16 m/min\", or a list \"8 m/min, "
                      "16 m/min\"",
                      option, part, error.what()));
    }
  }
  return result;
}

std::vector<sim::Direction> directions(const std::string& text) {
  if (text == "ccw") return {sim::Direction::counter_clockwise};
  if (text == "cw") return {sim::Direction::clockwise};
  if (text == "both") return {sim::Direction::counter_clockwise, sim::Direction::clockwise};
  throw UsageError(fmt::format("--direction: found '{}'; expected cw, ccw or both{}", text,
                               nearest_words(text, {"cw", "ccw", "both"})));
}

namespace {

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

double radius_of(const std::string& text) {
  try {
    return machine::parse_quantity(text, "m");
  } catch (const machine::UnitError& error) {
    throw UsageError(fmt::format("--radius: found '{}' ({}); expected a length such as \"90 mm\"", text, error.what()));
  }
}

}  // namespace

ExperimentInput experiment_input(const Experiment& experiment, machine::Machine machine, const ExperimentTexts& texts) {
  ExperimentInput input{std::move(machine), {}};
  if (!needs_of(experiment.name).feed_drive) input.friction = models_for(experiment, texts.friction, input.machine);
  if (experiment.feeds != nullptr) input.feeds = feeds(texts.feed.empty() ? experiment.feeds : texts.feed);
  for (const double feed : input.feeds)
    if (!(feed > 0.0)) throw UsageError(fmt::format("--feed: found '{}'; expected feeds above zero", texts.feed));
  input.equations = equations_for(experiment, texts.equations);
  if (!texts.jerk.empty()) input.jerk = jerk_of(texts.jerk);
  return input;
}

CirclePlan circle_plan(machine::Machine machine, const CircleTexts& texts) {
  CirclePlan plan;
  plan.machine = std::move(machine);
  require_known("--signals", texts.signals, "one of", {"fixed", "double"});
  plan.signals = texts.signals == "double" ? SignalKind::double_precision : SignalKind::fixed_point;
  plan.friction = friction_models(texts.friction, plan.machine);
  plan.directions = directions(texts.direction);
  if (plan.machine.axes.size() == 1 && plan.directions.size() > 1)
    throw UsageError(fmt::format("--direction: found '{}'; expected none, as the sine of one axis has no direction",
                                 texts.direction));
  plan.radius = texts.radius.empty() ? usual_radius(plan.machine) : radius_of(texts.radius);
  plan.feeds = texts.feed.empty() ? std::vector{usual_feed(plan.machine, plan.radius)} : feeds(texts.feed);
  return plan;
}

}  // namespace stiction::host
