#include "host/report/identification_finding.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "host/identify/own_identification.hpp"
#include "host/log/own_units.hpp"
#include "sim/plant/friction/friction.hpp"

namespace stiction::host {
namespace {

// "94.1 ± 0.4 N": two digits of the half interval at most.
std::string with_interval(const IdentifiedParameter& parameter, const char* unit) {
  const double half = 0.5 * (parameter.ci95.high - parameter.ci95.low);
  const int digits = half > 0.0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(half))), 0, 6) : 3;
  return fmt::format("{:.{}f} ± {:.{}f} {}", parameter.value, digits, half, digits, unit);
}

// " (machine file: 90)", in the unit of the parameter; empty where the file has no such value.
std::string in_file(std::string_view name, const machine::AxisModel* file) {
  if (file == nullptr) return "";
  const bool has_law = file->friction.models.contains(file->friction.use);
  double value = 0.0;
  const auto own = [&](double linear, const char* unit) { return file->coordinate.own(unit).from_linear(linear); };
  if (name == "mass_kg") value = own(file->mass, "kg");
  if (name == "coulomb_N" && has_law) value = own(sim::coulomb_of(file->friction), "N");
  if (name == "viscous_N_s_per_m" && has_law) value = own(sim::viscous_of(file->friction), "N s/m");
  return value > 0.0 ? fmt::format(" (machine file: {:.4g})", value) : "";
}

struct SpokenParameter {
  const char *name, *words, *unit;
};
constexpr std::array<SpokenParameter, 4> spoken_parameters{
    {{"coulomb_N", "Coulomb friction of", "N"},
     {"coulomb_positive_N", "Coulomb friction and constant force (+x) of", "N"},
     {"viscous_N_s_per_m", "viscous friction of", "N s/m"},
     {"mass_kg", "moving mass of", "kg"}}};
constexpr SpokenParameter inertia{"mass_kg", "moving inertia of", "kg"};
constexpr SpokenParameter gravity{"gravity_moment_N", "moment of gravity of", "N"};

}  // namespace

std::string identification_sentence(const Identification& result, const machine::AxisModel* file) {
  const auto total = result.parameters.size() + result.not_determined.size();
  if (result.parameters.empty())
    return fmt::format("None of the {} parameters of axis {} is determined by these records.", total, result.axis);
  const machine::Coordinate kind{result.rotary ? machine::AxisKind::rotary : machine::AxisKind::linear, 1.0};
  std::vector<SpokenParameter> spoken(spoken_parameters.begin(), spoken_parameters.end());
  if (result.rotary) {
    spoken.back() = inertia;
    spoken.push_back(gravity);
  }
  std::vector<std::string> parts;
  for (const auto& each : spoken)
    if (const auto* parameter = result.find(result.rotary ? own_name(each.name) : each.name))
      if (parts.empty() || each.name != std::string_view("coulomb_positive_N"))
        parts.push_back(fmt::format("a {} {}{}", each.words,
                                    with_interval(*parameter, std::string(kind.own(each.unit).unit).c_str()),
                                    in_file(each.name, file)));
  std::string text = fmt::format("{} of {} parameters are determined", result.parameters.size(), total);
  if (!parts.empty()) {
    const auto last = parts.back();
    parts.pop_back();
    text = fmt::format("Axis {} has {}{}{}", result.axis, fmt::join(parts, ", "), parts.empty() ? "" : " and ", last);
    if (!result.not_determined.empty())
      text += fmt::format(" ({} of {} parameters are determined)", result.parameters.size(), total);
  }
  if (result.force_rms > 0.0)
    text += fmt::format("; the fit leaves {:.3g} of {:.3g} {} rms, {:.2g} % of the {}", result.residual_rms,
                        result.force_rms, force_unit(result.rotary), 100.0 * result.residual_rms / result.force_rms,
                        result.rotary ? "torque" : "force");
  return text + ".";
}

}  // namespace stiction::host
