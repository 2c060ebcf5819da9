#include "sim/cam/laws.hpp"

#include <algorithm>

#include "sim/cam/modification.hpp"

namespace stiction::sim::cam {
namespace {

// "Modified Sine" and "modified-sine" are "modified_sine".
std::string plain_name(std::string_view name) {
  std::string plain;
  for (const char c : name) {
    if (c == ' ' || c == '-' || c == '_') continue;
    plain += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return plain;
}

bool is_among(std::string_view aliases, const std::string& plain) {
  while (!aliases.empty()) {
    const auto comma = std::min(aliases.find(','), aliases.size());
    if (plain_name(aliases.substr(0, comma)) == plain) return true;
    aliases.remove_prefix(std::min(comma + 1, aliases.size()));
  }
  return false;
}

bool has_slope(const LawValues& values, std::string_view key) {
  const auto found = values.find(key);
  return found != values.end() && found->second.front() != 0.0;
}

}  // namespace

std::string task_of(const Law& law) { return {static_cast<char>(law.start), '-', static_cast<char>(law.end)}; }

std::string_view name_of(LawKind kind) {
  return kind == LawKind::rise ? "rise" : kind == LawKind::rise_return ? "rise-return" : "periodic";
}

const std::vector<Law>& laws() {
  static const std::vector<Law> table = [] {
    std::vector<Law> all = detail::rest_laws();
    for (const auto& part : {detail::one_sided_laws(), detail::return_laws()})
      all.insert(all.end(), part.begin(), part.end());
    std::stable_sort(all.begin(), all.end(), [](const Law& a, const Law& b) { return a.number < b.number; });
    return all;
  }();
  return table;
}

const Law* find_law(std::string_view name) {
  const auto plain = plain_name(name);
  for (const Law& law : laws())
    if (plain_name(law.name) == plain || is_among(law.english, plain) || is_among(law.german, plain)) return &law;
  return nullptr;
}

LawValues default_values(const Law& law) {
  LawValues values;
  for (const auto& key : law.parameters)
    if (key.fallback) values[std::string(key.key)] = {*key.fallback};
  return values;
}

Curve unit_curve(const Law& law, const LawValues& values) {
  machine::ValueTable table{law.name, law.formula, false, law.parameters};
  LawValues all = default_values(law);
  for (const auto& [key, given] : values) all[key] = given;
  machine::check_values(table, all);
  const Curve curve = law.make(all);
  if (law.ends != EndValues::slopes) return curve;
  return modified(curve, {value(all, "c"), value(all, "lambda"), value(all, "start_slope"), value(all, "end_slope")});
}

End start_of(const Law& law, const LawValues& values) {
  return law.ends == EndValues::slopes && has_slope(values, "start_slope") ? End::constant_speed : law.start;
}

End end_of(const Law& law, const LawValues& values) {
  return law.ends == EndValues::slopes && has_slope(values, "end_slope") ? End::constant_speed : law.end;
}

std::vector<machine::ValueKey> detail::modifications(double c, double lambda, double start_slope, double end_slope) {
  return {law_parameter("c", {0.001, 1.0}, c, "share of the interval that accelerates and brakes; the rest is a line"),
          law_parameter("lambda", {0.001, 0.999}, lambda, "share of accelerating in accelerating and braking"),
          law_parameter("start_slope", law_range(), start_slope, "speed of the unit law at the start, y1_a"),
          law_parameter("end_slope", law_range(), end_slope, "speed of the unit law at the end, y1_b")};
}

}  // namespace stiction::sim::cam
