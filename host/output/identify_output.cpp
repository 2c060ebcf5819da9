#include "host/output/identify_output.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "host/identify/own_identification.hpp"
#include "host/log/own_units.hpp"
#include "host/output/questions_json.hpp"

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

// The trials of the band: what each cut-off would have given.
json band_json(const Band& band) {
  constexpr std::array<const char*, 4> names{"mass_kg", "viscous_N_s_per_m", "constant_force_N", "coulomb_N"};
  json trials = json::array();
  for (const auto& p : band.trials) {
    json trial{{"cutoff_Hz", p.cutoff},
               {"blocks", p.blocks},
               {"attenuation", p.attenuation},
               {"speed_noise_m_per_s", p.speed_noise},
               {"acceleration_noise_m_per_s2", p.acceleration_noise}};
    for (std::size_t c = 0; c < names.size(); ++c) trial[names[c]] = {{"value", p.value[c]}, {"error", p.error[c]}};
    trials.push_back(trial);
  }
  return {{"cutoff_Hz", band.best().cutoff},
          {"position_noise_m", band.position_noise},
          {"instruments", band.instruments ? "set position" : "none"},
          {"trials", trials}};
}

std::string band_text(const Band& band, bool rotary) {
  const auto& own = band.best();
  return fmt::format(
      "band: up to {:g} Hz, of {} tried; the encoder's noise is {:.3g} {} rms, in the band {:.3g} {} and {:.3g} {}, "
      "which would take {:.2g} % off the {} in plain least squares\n",
      own.cutoff, band.trials.size(), band.position_noise * 1e6, rotary ? "urad" : "um", own.speed_noise * 1e3,
      rotary ? "mrad/s" : "mm/s", own.acceleration_noise, rotary ? "rad/s^2" : "m/s^2", 100.0 * own.attenuation,
      rotary ? "inertia" : "mass");
}

std::string initial_text(const InitialValues& initial, bool rotary) {
  std::string text;
  const auto add = [&](const char* name, const std::optional<double>& value, const char* unit) {
    if (value) text += fmt::format("{}{} {:.4g} {}", text.empty() ? "" : ", ", name, *value, unit);
  };
  add("Coulomb", initial.coulomb, force_unit(rotary));
  add("viscous", initial.viscous, rotary ? "N m s/rad" : "N s/m");
  add(rotary ? "inertia" : "mass", initial.mass, rotary ? "kg m^2" : "kg");
  return text;
}

// The same tree with the names that go with the units of a rotary axis.
json with_own_names(const json& tree) {
  if (tree.is_array()) {
    json out = json::array();
    for (const auto& each : tree) out.push_back(with_own_names(each));
    return out;
  }
  if (!tree.is_object()) return tree;
  json out = json::object();
  for (const auto& [name, value] : tree.items()) out[own_name(name)] = with_own_names(value);
  return out;
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
           {"questions", questions_json(result.questions)},
           {"method", result.method},
           {"parameters", parameters},
           {"not_determined", open},
           {"force_rms_N", result.force_rms},
           {"residual_rms_N", result.residual_rms},
           {"initial_values",
            {{"coulomb_N", optional_json(result.initial.coulomb)},
             {"viscous_N_s_per_m", optional_json(result.initial.viscous)},
             {"mass_kg", optional_json(result.initial.mass)}}}};
  if (result.band) out["band"] = band_json(*result.band);
  if (result.band) {
    out["cutoff_scan"] = json::array();
    for (const auto& p : result.band->trials)
      out["cutoff_scan"].push_back({{"cutoff_Hz", p.cutoff}, {"mass_kg", p.value.front()}});
  }
  if (result.held_out) out["held_out_force_ratio"] = result.held_out->fit / result.held_out->plain;
  if (result.held_out)
    out["held_out_force"] = {{"fit_rms_N", result.held_out->fit},
                             {"plain_least_squares_rms_N", result.held_out->plain},
                             {"ratio", result.held_out->fit / result.held_out->plain}};
  if (!result.notes.empty()) out["notes"] = result.notes;
  if (result.curve) out["sliding_curve"] = curve_json(*result.curve);
  if (!result.elements.empty()) {
    json stiffness = json::array(), level = json::array();
    for (const auto& element : result.elements) {
      stiffness.push_back(element.stiffness);
      level.push_back(element.level);
    }
    out["maxwell_slip"] = {{"stiffness_N_per_m", stiffness}, {"level_N", level}};
  }
  return result.rotary ? with_own_names(out) : out;
}

std::string identification_text(const Identification& result) {
  std::string text;
  for (const auto& question : result.questions) text += fmt::format("QUESTION  {}\n", question.text);
  text += fmt::format("axis {}, {} samples of {}\n{}\n\n{:<30} {:>12}   {:>12} {:>12}\n", result.axis, result.samples,
                      fmt::join(result.sources, ", "), result.method, "parameter", "value", "95 % from", "to");
  for (const auto& p : result.parameters)
    text += fmt::format("{:<30} {:>12.6g}   {:>12.6g} {:>12.6g}\n", p.name, p.value, p.ci95.low, p.ci95.high);
  const char* force = force_unit(result.rotary);
  text += fmt::format("\nThe {} is {:.4g} {} rms; the residual of the fit is {:.4g} {} rms.\n",
                      result.rotary ? "torque" : "force", result.force_rms, force, result.residual_rms, force);
  if (result.held_out)
    text += fmt::format(
        "On data that were held out it leaves {:.4g} {} rms, {:.3f} times the rest of a plain least squares of mass, "
        "viscous "
        "friction, Coulomb friction and offset in the same rows.\n",
        result.held_out->fit, force, result.held_out->fit / result.held_out->plain);
  if (result.band) text += band_text(*result.band, result.rotary);
  for (const auto& note : result.notes) text += note + "\n";
  if (const auto read = initial_text(result.initial, result.rotary); !read.empty())
    text += fmt::format("direct estimates from the record, independent of the fit: {}\n", read);
  if (result.curve) {
    text += fmt::format("sliding curve: {} (held-out error", result.curve->curve);
    for (const auto& e : result.curve->errors) text += fmt::format(" {} {:.4g} {},", e.curve, e.held_out, force);
    text.back() = ')';
    text += "\n";
  }
  if (!result.not_determined.empty()) text += "\nnot determined:\n";
  for (const auto& n : result.not_determined) text += fmt::format("  {}: {}; record {}\n", n.name, n.why, n.record);
  return text;
}

}  // namespace stiction::host
