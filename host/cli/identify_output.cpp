#include "host/cli/identify_output.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace stiction::host {
namespace {

using json = nlohmann::ordered_json;

json optional_json(const std::optional<double>& value) { return value ? json(*value) : json(nullptr); }

json curve_json(const SlidingCurve& curve) {
  json parameters = json::object(), errors = json::object();
  for (const auto& p : curve.parameters) {
    const auto ci = p.interval();
    parameters[p.name] = {{"value", p.value}, {"ci95", {ci.low, ci.high}}};
  }
  for (const auto& e : curve.errors) errors[e.curve] = e.held_out;
  return {{"curve", curve.curve}, {"parameters", parameters}, {"held_out_rms_N", errors}};
}

std::string initial_text(const InitialValues& initial) {
  std::string text;
  const auto add = [&](const char* name, const std::optional<double>& value, const char* unit) {
    if (value) text += fmt::format("{}{} {:.4g} {}", text.empty() ? "" : ", ", name, *value, unit);
  };
  add("Coulomb", initial.coulomb, "N");
  add("viscous", initial.viscous, "N s/m");
  add("mass", initial.mass, "kg");
  return text;
}

}  // namespace

json identification_json(const Identification& result) {
  json parameters = json::object();
  for (const auto& p : result.parameters)
    parameters[p.name] = {{"value", p.value}, {"ci95", {p.ci95.low, p.ci95.high}}, {"how", p.how}};
  json open = json::array();
  for (const auto& n : result.not_determined) open.push_back(fmt::format("{}: {}; record {}", n.name, n.why, n.record));
  json out{{"schema", "stiction.identification/1"},
           {"axis", result.axis},
           {"logs", result.sources},
           {"samples", result.samples},
           {"method", result.method},
           {"parameters", parameters},
           {"not_determined", open},
           {"force_rms_N", result.force_rms},
           {"residual_rms_N", result.residual_rms},
           {"initial_values",
            {{"coulomb_N", optional_json(result.initial.coulomb)},
             {"viscous_N_s_per_m", optional_json(result.initial.viscous)},
             {"mass_kg", optional_json(result.initial.mass)}}}};
  if (result.curve) out["sliding_curve"] = curve_json(*result.curve);
  if (!result.elements.empty()) {
    json stiffness = json::array(), level = json::array();
    for (const auto& element : result.elements) {
      stiffness.push_back(element.stiffness);
      level.push_back(element.level);
    }
    out["maxwell_slip"] = {{"stiffness_N_per_m", stiffness}, {"level_N", level}};
  }
  return out;
}

std::string identification_text(const Identification& result) {
  std::string text =
      fmt::format("axis {}, {} samples of {}\n{}\n\n{:<30} {:>12}   {:>12} {:>12}\n", result.axis, result.samples,
                  fmt::join(result.sources, ", "), result.method, "parameter", "value", "95 % from", "to");
  for (const auto& p : result.parameters)
    text += fmt::format("{:<30} {:>12.6g}   {:>12.6g} {:>12.6g}\n", p.name, p.value, p.ci95.low, p.ci95.high);
  text += fmt::format("\nThe force is {:.4g} N rms; the residual of the fit is {:.4g} N rms.\n", result.force_rms,
                      result.residual_rms);
  if (const auto read = initial_text(result.initial); !read.empty())
    text += fmt::format("direct estimates from the record, independent of the fit: {}\n", read);
  if (result.curve) {
    text += fmt::format("sliding curve: {} (held-out error", result.curve->curve);
    for (const auto& e : result.curve->errors) text += fmt::format(" {} {:.4g} N,", e.curve, e.held_out);
    text.back() = ')';
    text += "\n";
  }
  if (!result.not_determined.empty()) text += "\nnot determined:\n";
  for (const auto& n : result.not_determined) text += fmt::format("  {}: {}; record {}\n", n.name, n.why, n.record);
  return text;
}

}  // namespace stiction::host
