#include "firmware/machine/file/radius_exclusion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "firmware/machine/model/own_words.hpp"

namespace stiction::machine {
namespace {

// From the axis on, as the file of this axis spells it.
std::string spelled(const std::string& key, const AxisModel& axis) {
  const auto dot = key.rfind('.');
  if (dot == std::string::npos) return std::string(axis.coordinate.own(key, "").key);
  const auto& coordinate = key.starts_with("motor.") ? axis.motor_coordinate : axis.coordinate;
  return join_key(key.substr(0, dot), coordinate.own(key.substr(dot + 1), "").key);
}

// Whether it is a limit of the inverter, or a default that is made of one.
bool follows_from_limits(const std::string& key, const toml::table& table) {
  return key.starts_with("inverter.") || (key == "supervision.over_current" && table.at_path(key).node() == nullptr);
}

// "max_velocity, "10 rad/s" (line 10)"; with what is computed from it.
std::string described(const Document& document, const toml::table& table, const AxisModel& axis,
                      const RadiusBound& bound) {
  if (bound.key == "supervision.over_speed" && table.at_path(bound.key).node() == nullptr)
    return described(document, table, axis, {"max_velocity", "over-speed limit", bound.radius});
  const std::string key = spelled(bound.key, axis);
  const toml::node* node = key.starts_with("timing.") ? document.root().at_path(key).node() : table.at_path(key).node();
  std::string text = key;
  if (node == nullptr) text += " (not in the file)";
  if (node != nullptr && !node->is_table()) text += fmt::format(", {}", describe_node(*node));
  if (node != nullptr) text += fmt::format(" (line {})", node->source().begin.line);
  if (!bound.what.empty()) text += fmt::format(" with its {}", in_own_words(bound.what, axis.coordinate));
  return text;
}

}  // namespace

std::string describe_exclusion(const Document& document, const toml::table& table, const std::string& path,
                               const AxisModel& axis, const RadiusChoice& choice) {
  std::vector<std::string> found;
  const bool limited = table.get("inverter") != nullptr;
  if (!limited)
    found.push_back(
        fmt::format("no table [{}], so that neither current nor voltage has a limit, which no radius serves",
                    join_key(path, "inverter")));
  for (const auto& bound : choice.never)
    if (limited || !follows_from_limits(bound.key, table))
      found.push_back(described(document, table, axis, bound) + ", which no radius serves");
  if (choice.at_most && choice.at_least)
    found.push_back(
        fmt::format("{}, which needs a radian of at most {:g} m, together with {}, which needs one of at "
                    "least {:g} m",
                    described(document, table, axis, *choice.at_most), *choice.at_most->radius,
                    described(document, table, axis, *choice.at_least), *choice.at_least->radius));
  return fmt::format(
      "{}: found {}; expected values that the firmware's number formats hold on one radius, or a run in double "
      "precision (simulate replay --signals double)",
      path, fmt::join(found, "; "));
}

}  // namespace stiction::machine
