#include "host/report/diagnosis_finding.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <vector>

#include "host/report/typeset.hpp"

namespace stiction::host {
namespace {

std::string decapitalized(std::string_view title) {
  std::string text(title);
  const bool word = text.size() > 1 && std::islower(static_cast<unsigned char>(text[1]));
  if (word) text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

// "force ripple (X)", "force ripple (X), backlash (X) and 2 more": the first ones explain most.
std::string causes(const Verdict& verdict) {
  constexpr std::size_t named = 3;
  std::vector<std::string> names;
  for (const auto& finding : verdict.findings) {
    if (!finding.names_cause()) continue;
    auto name = fmt::format("{} ({})", decapitalized(finding.effect->title), finding.axis);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
  }
  if (names.size() == 1) return names.front();
  std::string last = names.back();
  if (names.size() > named + 1) last = fmt::format("{} more", names.size() - named);
  names.resize(std::min(names.size() - 1, named));
  return fmt::format("{} and {}", fmt::join(names, ", "), last);
}

// "3.42 → 1.18 N"; of equal texts only one.
std::string change(const std::string& before, const std::string& after, const char* unit) {
  return before == after ? fmt::format("{} {}", before, unit) : fmt::format("{} → {} {}", before, after, unit);
}

// What the extended machine file is worth on data that was not used; empty where nothing falls.
std::string worth(const ResidualFigures& before, const ResidualFigures& after, const Verdict& verdict) {
  const auto &force = verdict.units.force, &deviation = verdict.units.deviation;
  const auto number = [](double value) { return fmt::format("{:.3g}", value); };
  std::vector<std::string> parts;
  if (before.position_error_rms && after.position_error_rms && *after.position_error_rms < *before.position_error_rms)
    parts.push_back(fmt::format("{} rms of position error",
                                change(deviation_text(*before.position_error_rms, deviation),
                                       deviation_text(*after.position_error_rms, deviation), deviation.unit)));
  if (after.force_rms < before.force_rms)
    parts.push_back(fmt::format("{} rms of force",
                                change(number(force(before.force_rms)), number(force(after.force_rms)), force.unit)));
  if (before.command_rms && after.command_rms && *after.command_rms < *before.command_rms)
    parts.push_back(fmt::format("{} rms of controller output",
                                change(fmt::format("{:.2g}", *before.command_rms),
                                       fmt::format("{:.2g}", *after.command_rms), verdict.command_unit.c_str())));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string of_rows(const Verdict& verdict) {
  const auto& score = verdict.reference->unused;
  const auto line = [&](double RowScore::*member) {
    return change(percent(score.published.*member), percent(score.extended.*member), "%");
  };
  return fmt::format(
      "on feeds that were not used, the simulation with it deviates from the measured current by {} and from the "
      "measured error at reversals by {} (published simulation → extended machine file)",
      line(&RowScore::current), line(&RowScore::error));
}

std::string nothing_found(const Verdict& verdict) {
  const auto& rest = verdict.baseline;
  const auto &force = verdict.units.force, &deviation = verdict.units.deviation;
  auto size = rest.force_rms > 0.0 ? fmt::format("{:.3g} {} rms", force(rest.force_rms), force.unit) : std::string();
  if (rest.position_error_rms)
    size += fmt::format("{}{} {} rms of position error", size.empty() ? "" : ", ",
                        deviation_text(*rest.position_error_rms, deviation), deviation.unit);
  const auto of = size.empty() ? "" : fmt::format(" of {}", size);
  const auto why = verdict.agreement ? verdict.agreement->reason : std::string();
  if (verdict.unexplained.signature)
    return fmt::format("Simulation and machine do not agree: no known cause explains the residual{}; its pattern: {}.",
                       of, *verdict.unexplained.signature);
  if (!verdict.agreement)
    return fmt::format(
        "No cause was found for the residual{}; without a known noise of the data, that is no agreement.", of);
  switch (verdict.agreement->status) {
    case Status::agrees:
      return fmt::format("The simulation agrees with the data within their noise: {}.", why);
    case Status::does_not_agree:
      return fmt::format("Simulation and machine do not agree, and no known cause explains the difference: {}.", why);
    case Status::cannot_tell:
      break;
  }
  return fmt::format("These records cannot tell whether simulation and machine agree: {}.", why);
}

// What the extended machine file still leaves, after the figures of its gain; empty where that cannot be said.
std::string rest_of(const Verdict& verdict) {
  if (!verdict.agreement || !verdict.noise_floor) return "";
  if (verdict.agreement->status == Status::agrees) return "; the remaining residual is noise";
  if (verdict.agreement->status == Status::cannot_tell) return "; these records cannot tell whether more is missing";
  const auto& force = verdict.units.force;
  return fmt::format("; noise accounts for {:.2g} {} of the remaining force", force(verdict.noise_floor->force()),
                     force.unit);
}

}  // namespace

std::string percent(double share) { return fmt::format("{:.{}f}", 100.0 * share, std::abs(share) < 0.1 ? 1 : 0); }
std::string deviation_text(double linear, const ShownQuantity& shown) { return fmt::format("{:.2g}", shown(linear)); }

namespace {

std::string sentence_on_causes(const Verdict& verdict) {
  if (named_causes(verdict.findings) == 0) {
    const auto gain = verdict.findings.empty() ? "" : worth(verdict.baseline, verdict.extended, verdict);
    if (gain.empty()) return typeset(nothing_found(verdict));
    return typeset(fmt::format("{} The extended machine file holds it as a table without a name: {} on held-out data.",
                               nothing_found(verdict), gain));
  }
  const auto missing = fmt::format(
      "The machine file{} lacks or misstates {}",
      verdict.identified.empty() ? "" : ", with mass and friction identified from these logs,", causes(verdict));
  if (verdict.reference) return typeset(fmt::format("{}; {}.", missing, of_rows(verdict)));
  const auto gain = worth(verdict.baseline, verdict.extended, verdict);
  if (gain.empty())
    return typeset(fmt::format("{}, but on held-out data the residual force does not fall ({:.3g} {} rms).", missing,
                               verdict.units.force(verdict.extended.force_rms), verdict.units.force.unit));
  return typeset(fmt::format("{}; with it, the simulation's deviation on held-out data falls: {}{}.", missing, gain,
                             rest_of(verdict)));
}

// What is not the same in the held-out records; empty where nothing is.
std::string sentence_on_state(const Verdict& verdict) {
  std::string changed;
  for (const auto& each : verdict.changed)
    changed += fmt::format("{} {} {:.4g} {} instead of {:.4g} {}", changed.empty() ? "" : ",", each.key, each.held_out,
                           each.unit, each.training, each.unit);
  return changed.empty() ? ""
                         : fmt::format(" The held-out records are of a different state of the machine:{}.", changed);
}

}  // namespace

std::string diagnosis_sentence(const Verdict& verdict) {
  return sentence_on_causes(verdict) + typeset(sentence_on_state(verdict));
}

}  // namespace stiction::host
