#include "host/report/experiment_finding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "host/report/circle_finding.hpp"
#include "host/report/experiment_table.hpp"
#include "host/report/typeset.hpp"

namespace stiction::host {
namespace {

using sim::ExperimentResult;
using sim::Figure;

// What a sentence is made from: the result, and the friction model that it speaks of.
struct Spoken {
  const ExperimentResult& result;
  const machine::Machine& machine;
  std::string friction;  // empty where the figures are of none

  const Figure* find(const std::string& name) const {
    const auto& figures = result.figures;
    const auto found = std::find_if(figures.begin(), figures.end(), [&](const Figure& f) { return f.name == name; });
    return found == figures.end() ? nullptr : &*found;
  }
  // Of the model, whose name the figure's ends with.
  const Figure* of_model(const std::string& name) const {
    return find(friction.empty() ? name : name + "_" + friction);
  }
  std::vector<const Figure*> starting(std::string_view name) const {
    std::vector<const Figure*> found;
    for (const auto& figure : result.figures)
      if (figure.name.starts_with(name)) found.push_back(&figure);
    return found;
  }
  std::string with() const { return friction.empty() ? "" : fmt::format(" ({})", friction_label(friction)); }
};

std::string friction_of(const ExperimentResult& result, const machine::Machine& machine) {
  std::string first;
  for (const auto& figure : result.figures) {
    if (figure.friction.empty()) continue;
    if (first.empty()) first = figure.friction;
    for (const auto& axis : machine.axes)
      if (axis.friction.use == figure.friction) return figure.friction;
  }
  return first;
}

std::string shown(const Figure* figure, int digits = 3) {
  return fmt::format("{:.{}g} {}", figure->value, digits, figure->unit);
}

const Figure* least(const std::vector<const Figure*>& figures) {
  const auto less = [](const Figure* a, const Figure* b) { return a->value < b->value; };
  return figures.empty() ? nullptr : *std::min_element(figures.begin(), figures.end(), less);
}
const Figure* greatest(const std::vector<const Figure*>& figures) {
  const auto less = [](const Figure* a, const Figure* b) { return a->value < b->value; };
  return figures.empty() ? nullptr : *std::max_element(figures.begin(), figures.end(), less);
}

// ---- one sentence an experiment, without its full stop; empty where the figures that it needs are missing ----

std::string impact(const Spoken& s) {
  const auto *peak = s.of_model("peak_deviation"), *back = s.of_model("return_time");
  if (!peak || !back) return "";
  const bool rotary = peak->unit == "urad";
  return fmt::format("The step of {} moves the axis by {}, and it is back after {}{}", rotary ? "torque" : "force",
                     shown(peak), shown(back), s.with());
}

std::string constant_velocity(const Spoken& s) {
  const auto deviations = s.starting("mean_deviation_");
  if (deviations.empty()) {
    const auto currents = s.starting("current_" + s.friction);
    if (currents.size() < 2) return "";
    return fmt::format("The motor current at constant speed lies between {} and {}{}", shown(least(currents)),
                       shown(greatest(currents)), s.with());
  }
  const auto best = least(deviations);
  auto text =
      fmt::format("The simulated currents at constant speed deviate from the measured ones by {} on average ({})",
                  shown(best, 2), friction_label(best->friction));
  if (deviations.size() > 1)
    text += fmt::format(", with the other friction models by up to {}", shown(greatest(deviations), 2));
  return text;
}

std::string l_shape(const Spoken& s) {
  const auto *standing = s.of_model("standing_current"), *same = s.of_model("same_direction_error"),
             *opposite = s.of_model("opposite_direction_error");
  if (!standing || !same || !opposite) return "";
  return fmt::format(
      "At standstill {} remain, and the restart costs {} in the same direction and {} in the opposite one{}",
      shown(standing), shown(same, 2), shown(opposite, 2), s.with());
}

std::string break_away(const Spoken& s) {
  const auto forces = s.starting("break_away_at_");
  if (forces.size() < 2) return "";
  return fmt::format("Sliding begins at {} to {}, the later the slower the force rises", shown(least(forces)),
                     shown(greatest(forces)));
}

std::string friction_lag(const Spoken& s) {
  const auto widest = greatest(s.starting("width_at_"));
  return widest ? fmt::format("The friction lags behind the speed by a loop of up to {}", shown(widest)) : "";
}

std::string stick_slip(const Spoken& s) {
  const auto *jump = s.of_model("jump"), *period = s.of_model("period");
  if (!jump || !period) return "";
  return fmt::format("The mass sticks and slips: it jumps by {} every {}{}", shown(jump), shown(period), s.with());
}

std::string feed_cutting(const Spoken& s) {
  const auto largest = greatest(s.starting("jump_corrected"));
  if (!largest) return "";
  return fmt::format("The feed drive sticks and slips while cutting, by jumps of up to {}", shown(largest));
}

// The text of a replay's figure ends with the label of its case.
std::string label_of(const Figure& figure) {
  const auto comma = figure.text.rfind(", ");
  return comma == std::string::npos ? "" : friction_label(figure.text.substr(comma + 2));
}

std::string replay(const Spoken& s) {
  const auto positions = s.starting("position_difference_rms");
  if (positions.empty()) return "";
  std::vector<const Figure*> efforts;
  for (const auto& figure : s.result.figures)
    if (figure.unit == "%" && figure.name.find("_difference_") != std::string::npos) efforts.push_back(&figure);
  const auto name = [](const Figure* f) { return f->name.substr(0, f->name.find('_')); };
  const auto *first = positions.front(), *last = positions.back();
  if (label_of(*first) == label_of(*last)) {
    const auto worst = greatest(positions);
    auto text = fmt::format("The simulated position deviates from the record by {} rms", shown(worst));
    if (!efforts.empty())
      text += fmt::format(", the {} by {} of the measured one", name(greatest(efforts)), shown(greatest(efforts), 2));
    return text;
  }
  const char* change = last->value < first->value ? "falls" : last->value > first->value ? "grows" : "stays";
  auto text = fmt::format("The deviation of the simulated position from the record {} from {} rms ({}) to {} rms ({})",
                          change, shown(first), label_of(*first), shown(last), label_of(*last));
  if (efforts.size() > 1)
    text += fmt::format(", that of the {} changes from {} to {} of the measured one", name(efforts.front()),
                        shown(efforts.front(), 2), shown(efforts.back(), 2));
  return text;
}

// The circle whose error without compensation is the largest, and what the best kind leaves of it.
std::string tune_friction(const Spoken& s) {
  const Figure *off = nullptr, *best = nullptr;
  for (const auto& axis : s.machine.axes) {
    const auto head = "peak_error_" + axis.name + "_";
    for (const auto* without : s.starting(head + "off_")) {
      if (off && without->value <= off->value) continue;
      const auto tail = without->name.substr(head.size() + 3);
      const Figure* least_here = nullptr;
      for (const auto* each : s.starting(head))
        if (each != without && each->name.ends_with(tail) && (!least_here || each->value < least_here->value))
          least_here = each;
      if (least_here) off = without, best = least_here;
    }
  }
  if (!off) return "";
  const auto where = off->text.substr(0, off->text.rfind(", "));  // "largest error, X at 48 m/min"
  const auto kind = best->text.substr(best->text.rfind(", ") + 2);
  if (best->value >= off->value) return fmt::format("No kind of compensation lowers the {} of {}", where, shown(off));
  return fmt::format("{:.3g} → {:.2g} {} at reversals: the {} {}", off->value, best->value, off->unit, where, kind);
}

std::string frequency_response(const Spoken& s) {
  std::vector<const Figure*> phases, gains;
  for (const auto& figure : s.result.figures) {
    if (figure.unit == "deg" && figure.text.ends_with("phase margin")) phases.push_back(&figure);
    if (figure.unit == "dB" && figure.text.ends_with("gain margin")) gains.push_back(&figure);
  }
  const auto *phase = least(phases), *gain = least(gains);
  const auto whose = [](const Figure* f) {
    auto loop = f->text.substr(0, f->text.find(": "));
    loop.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(loop.front())));
    return loop;
  };
  if (!phase || !gain) return "";
  return fmt::format("The smallest phase margin is {:.0f}° ({}), the smallest gain margin {:.1f} dB ({})", phase->value,
                     whose(phase), gain->value, whose(gain));
}

constexpr std::array<std::pair<std::string_view, std::string (*)(const Spoken&)>, 10> sentences{{
    {"impact", impact},
    {"constant-velocity", constant_velocity},
    {"l-shape", l_shape},
    {"break-away", break_away},
    {"friction-lag", friction_lag},
    {"stick-slip", stick_slip},
    {"feed-cutting", feed_cutting},
    {"replay", replay},
    {"tune-friction", tune_friction},
    {"frequency-response", frequency_response},
}};

// A finding may go on after the sentence that says what was found.
std::string first_sentence(const std::string& text) {
  for (auto at = text.find(". "); at != std::string::npos; at = text.find(". ", at + 1))
    if (at + 2 < text.size() && std::isupper(static_cast<unsigned char>(text[at + 2]))) return text.substr(0, at + 1);
  return text;
}

std::string without_full_stop(std::string text) {
  if (text.ends_with('.')) text.pop_back();
  return text;
}

}  // namespace

std::string experiment_sentence(const ExperimentResult& result, const machine::Machine& machine) {
  const Spoken spoken{result, machine, friction_of(result, machine)};
  std::string text;
  for (const auto& [experiment, sentence] : sentences)
    if (experiment == result.experiment) text = sentence(spoken);
  if (text.empty() && !result.findings.empty()) text = without_full_stop(first_sentence(result.findings.front()));
  const bool expects = std::any_of(result.figures.begin(), result.figures.end(),
                                   [](const Figure& figure) { return figure.expected.has_value(); });
  if (text.empty()) return typeset(result.figures.empty() ? "The run has no figures." : verdict(result));
  if (expects) text += "; " + without_full_stop(verdict(result));
  return typeset(text + ".");
}

}  // namespace stiction::host
