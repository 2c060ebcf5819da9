#include <fmt/format.h>

#include <algorithm>

#include "host/cli/cam_output.hpp"
#include "sim/cam/characteristics.hpp"

namespace stiction::host {
namespace {

using json = nlohmann::ordered_json;

// Below the rounding of the integral it is 0.
double shown_residual(const sim::cam::Curve& curve, double r) {
  const double a = sim::cam::residual_amplitude(curve, r);
  return a < 1e-14 ? 0.0 : a;
}

// A law with free coefficients has no figures without them.
bool has_figures(const sim::cam::Law& law) {
  return std::all_of(law.parameters.begin(), law.parameters.end(),
                     [](const auto& parameter) { return parameter.fallback.has_value(); });
}

json aliases_of(const sim::cam::Law& law) {
  json list = json::array();
  for (auto names : {law.english, law.german})
    while (!names.empty()) {
      const auto comma = std::min(names.find(','), names.size());
      list.push_back(std::string(names.substr(0, comma)));
      names.remove_prefix(std::min(comma + 1, names.size()));
    }
  return list;
}

json parameters_of(const sim::cam::Law& law) {
  json list = json::array();
  for (const auto& p : law.parameters) {
    const auto end = [](double value) { return std::isfinite(value) ? json(value) : json(nullptr); };
    list.push_back({{"key", std::string(p.key)},
                    {"unit", std::string(p.unit)},
                    {"lowest", end(p.range.low)},
                    {"highest", end(p.range.high)},
                    {"list", p.list},
                    {"default", p.fallback ? json(*p.fallback) : json(nullptr)},
                    {"text", std::string(p.text)}});
  }
  return list;
}

json figures_of(const sim::cam::Law& law) {
  json figures{{"Cv", nullptr},  {"Ca", nullptr},    {"Cj", nullptr},
               {"C_M", nullptr}, {"jumps", nullptr}, {"residual", nullptr}};
  if (!has_figures(law)) return figures;
  const auto values = sim::cam::default_values(law);
  const auto curve = sim::cam::unit_curve(law, values);
  const auto c = sim::cam::characteristics(law, values, curve);
  json jumps = json::array(), residual = json::array();
  for (const auto& jump : c.jumps) jumps.push_back({{"x", jump.place}, {"order", jump.order}, {"height", jump.height}});
  for (const double r : listed_periods) residual.push_back({{"periods", r}, {"amplitude", shown_residual(curve, r)}});
  return {{"Cv", c.speed},  {"Ca", {c.acceleration, c.deceleration}},
          {"Cj", c.jerk},   {"C_M", c.torque},
          {"jumps", jumps}, {"residual", residual}};
}

std::string figures_text(const sim::cam::Law& law) {
  if (!has_figures(law)) return "needs its coefficients";
  const auto values = sim::cam::default_values(law);
  const auto curve = sim::cam::unit_curve(law, values);
  const auto c = sim::cam::characteristics(law, values, curve);
  auto text = fmt::format("{:6.3f} {:8.3f} {:8.3f} {:8.2f} {:7.3f}  {:1}", c.speed, c.acceleration, c.deceleration,
                          c.jerk, c.torque, c.jerks_without_bound() ? "J" : "");
  for (const double r : {1.0, 2.0, 3.0, 5.0}) text += fmt::format(" {:8.2g}", shown_residual(curve, r));
  return text;
}

}  // namespace

nlohmann::ordered_json laws_json(const std::vector<const sim::cam::Law*>& laws) {
  json list = json::array();
  for (const sim::cam::Law* law : laws) {
    json row{{"number", law->number},
             {"name", std::string(law->name)},
             {"aliases", aliases_of(*law)},
             {"task", task_of(*law)},
             {"kind", std::string(name_of(law->kind))},
             {"parameters", parameters_of(*law)},
             {"formula", std::string(law->formula)},
             {"source", std::string(law->source)}};
    row.update(figures_of(*law));
    list.push_back(std::move(row));
  }
  return {{"schema", "stiction.cam-laws/1"}, {"laws", list}};
}

std::string laws_text(const std::vector<const sim::cam::Law*>& laws) {
  std::string text =
      fmt::format("{:>3} {:<29} {:<4} {:<11} {:>6} {:>8} {:>8} {:>8} {:>7}  {:1} {:>8} {:>8} {:>8} {:>8}\n", "", "law",
                  "task", "kind", "Cv", "Ca+", "Ca-", "Cj", "C_M", "", "A(1)", "A(2)", "A(3)", "A(5)");
  for (const sim::cam::Law* law : laws)
    text += fmt::format("{:>3} {:<29} {:<4} {:<11} {}\n", law->number, law->name, task_of(*law), name_of(law->kind),
                        figures_text(*law));
  return text +
         "\nPeaks of the unit law: speed Cv, acceleration Ca, jerk Cj, torque C_M = max |y' y''|. J: the acceleration\n"
         "jumps, Cj is its finite part. A(r): undamped residual amplitude over the stroke, r natural periods in the "
         "rise.\n";
}

}  // namespace stiction::host
