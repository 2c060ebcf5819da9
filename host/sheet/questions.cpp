#include "host/sheet/questions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "firmware/machine/file/units.hpp"

namespace stiction::host {
namespace {

bool always(const SheetAnswers&) { return true; }
bool is(const SheetAnswers& answers, std::string_view name, std::string_view what) {
  return answer_to(answers, name) == what;
}
bool linear(const SheetAnswers& a) { return is(a, "kind", "linear"); }
bool with_windings(const SheetAnswers& a) { return !is_force_source(a); }
bool with_screw(const SheetAnswers& a) { return linear(a) && is(a, "transmission", "screw"); }
bool with_belt(const SheetAnswers& a) { return linear(a) && is(a, "transmission", "belt"); }
bool with_shaft(const SheetAnswers& a) { return !linear(a) || !is(a, "transmission", "direct"); }
bool with_gear(const SheetAnswers& a) { return !is(a, "transmission", "direct"); }
bool with_rotor(const SheetAnswers& a) { return with_shaft(a) && (with_gear(a) || with_windings(a)); }
bool with_wound_shaft(const SheetAnswers& a) { return with_shaft(a) && with_windings(a); }
bool on_screw(const SheetAnswers& a) { return with_screw(a) || with_belt(a); }
bool linear_motor(const SheetAnswers& a) { return !with_shaft(a); }
bool wound_linear_motor(const SheetAnswers& a) { return linear_motor(a) && with_windings(a); }
bool estimated_on_guides(const SheetAnswers& a) { return linear(a) && answer_to(a, "coulomb").empty(); }
bool estimated_on_screw(const SheetAnswers& a) { return on_screw(a) && answer_to(a, "coulomb").empty(); }
bool with_scale(const SheetAnswers& a) { return linear(a) && (!with_gear(a) || is(a, "encoder-on", "load")); }
bool counted(const SheetAnswers& a) { return !with_scale(a); }
bool friction_of_rotary(const SheetAnswers& a) { return !linear(a); }

// A source of amperes has no voltage to be limited, one of volts no current.
bool with_supply(const SheetAnswers& a) { return with_windings(a) || driven_by_volts(a); }
bool with_current(const SheetAnswers& a) { return with_windings(a) || !driven_by_volts(a); }

// A fallback of one blank: it may stay open.
constexpr std::string_view open = " ";

const std::vector<SheetQuestion>& questions() {
  static const std::vector<SheetQuestion> all{
      {"name", "name of the machine, shown in reports", "", "", {}, "new machine", always},
      {"axis", "name of the axis", "", "", {}, "X", always},
      {"kind", "kind of the axis", "", "", {"linear", "rotary"}, "linear", always},
      {"motor",
       "motor: by its windings (synchronous), or with its drive as one source of force or torque",
       "",
       "",
       {"synchronous", "force"},
       "synchronous",
       always},
      {"transmission", "between motor and axis", "", "", {"direct", "screw", "belt", "gear"}, "", always, "direct"},
      {"load",
       "mass of the load without motor and transmission (of a rotary axis its inertia)",
       "kg",
       "kg m^2",
       {},
       "",
       always},
      {"travel", "travel from end to end", "m", "rad", {}, "", always},
      {"max-velocity", "largest speed of the axis", "m/s", "rad/s", {}, "", always},
      {"max-acceleration", "largest acceleration of the axis", "m/s^2", "rad/s^2", {}, "", always},
      {"lead", "way of a turn of the screw", "m", "", {}, "", with_screw},
      {"pulley", "way of a turn of the pulley, its teeth times their pitch", "m", "", {}, "", with_belt},
      {"ratio", "motor turns per turn of screw, pulley or axis, as 3 or 355/113", "", "", {}, "1", with_gear},
      {"motor-inertia", "inertia of the motor's rotor, with its brake", "kg m^2", "", {}, "", with_rotor, "0 kg m^2"},
      {"screw-inertia",
       "inertia of the screw with coupling, or of the pulleys",
       "kg m^2",
       "",
       {},
       "0 kg m^2",
       on_screw},
      {"amperes", "how the sheet gives currents", "", "", {"rms", "peak"}, "", always, "peak"},
      {"volts", "how it gives voltages", "", "", {"rms", "peak"}, "", with_windings},
      {"between",
       "between which points it gives voltage, resistance and inductance",
       "",
       "",
       {"line", "phase"},
       "",
       with_windings},
      {"winding-between",
       "between which points it gives resistance and inductance, where others than the voltage's",
       "",
       "",
       {"line", "phase"},
       open,
       with_windings},
      {"torque-constant",
       "torque constant of the motor, per ampere as above (of a source of torque also per volt)",
       "N m/A",
       "",
       {},
       "",
       with_shaft},
      {"force-constant",
       "force constant of the motor, per ampere as above (of a source of force also per volt)",
       "N/A",
       "",
       {},
       "",
       linear_motor},
      {"voltage-constant",
       "voltage constant, as \"49.6 V/1000 rpm\"; without it that of the torque constant",
       "V s/rad",
       "",
       {},
       open,
       with_wound_shaft},
      {"resistance", "resistance of the winding", "Ohm", "", {}, "", with_windings},
      {"inductance", "inductance of the winding", "H", "", {}, "", with_windings},
      {"pole-pairs", "number of pole pairs", "", "", {}, "", with_wound_shaft},
      {"pole-pair-pitch", "pole-pair pitch of the linear motor", "m", "", {}, "", wound_linear_motor},
      {"supply", "voltage of the inverter's DC link", "V", "", {}, "", with_supply, open},
      {"current-limit", "largest current, in amperes as above", "A", "", {}, "", with_current, open},
      {"encoder-on", "what the encoder sits on", "", "", {"motor", "load"}, "motor", with_gear},
      {"increment", "increment of the encoder", "m", "", {}, "", with_scale},
      {"counts", "edges in a turn of the encoder, after quadrature", "", "", {}, "", counted},
      {"coulomb", "Coulomb friction; without it it is estimated", "N", "N m", {}, open, always},
      {"viscous", "viscous friction; without it it is estimated", "N s/m", "N m s/rad", {}, open, always},
      {"guide-coefficient", "friction coefficient of the guides", "1", "", {}, "0.005", estimated_on_guides},
      {"carriages", "number of guide carriages", "", "", {}, "4", estimated_on_guides},
      {"seal-drag", "drag of the seals of a carriage", "N", "", {}, "5 N", estimated_on_guides},
      {"preload", "preload of a carriage", "N", "", {}, "0 N", estimated_on_guides},
      {"attraction", "attraction of a linear motor", "N", "", {}, "0 N", estimated_on_guides},
      {"drag-torque",
       "drag of screw, nut and bearings, or of the belt, at the screw or pulley",
       "N m",
       "",
       {},
       "0 N m",
       estimated_on_screw},
      {"friction-share",
       "Coulomb friction as a share of the motor's largest torque at the axis",
       "1",
       "",
       {},
       "0.02",
       friction_of_rotary},
  };
  return all;
}

// Numbers of sheets that UDUNITS does not read: "V/1000 rpm".
std::string spelled(std::string text) {
  for (const std::string_view thousand : {"1000 rpm", "1000rpm", "1000 1/min", "1000 min^-1", "kmin^-1"})
    if (const auto at = text.find(thousand); at != std::string::npos) text.replace(at, thousand.size(), "krpm");
  if (const auto at = text.find("krpm"); at != std::string::npos) {
    // In rad/s: UDUNITS has no prefix on rpm.
    text.replace(at, 4, "(rad/s)");
    const auto blank = text.find(' ');
    if (blank == std::string::npos) return text;
    try {
      const double number = std::stod(text.substr(0, blank));
      return fmt::format("{:.17g}{}", number / (1000.0 * 2.0 * 3.14159265358979323846 / 60.0), text.substr(blank));
    } catch (const std::exception&) {
      return text;
    }
  }
  return text;
}

// A positive number without sign and exponent; else 0.
double plain_number(std::string_view text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, std::chars_format::fixed);
  return error == std::errc{} && end == text.data() + text.size() && number > 0.0 ? number : 0.0;
}

bool whole(std::string_view name) { return name == "pole-pairs" || name == "counts" || name == "carriages"; }

std::string_view fallback_of(const SheetQuestion& question, const SheetAnswers& answers) {
  return question.of_source.empty() || !is_force_source(answers) ? question.fallback : question.of_source;
}

// Of the constant of a motor's force or torque.
bool is_constant(std::string_view name) { return name == "torque-constant" || name == "force-constant"; }

bool has_unit(const std::string& text, std::string_view unit) {
  try {
    machine::parse_quantity(spelled(text), unit);
    return true;
  } catch (const machine::UnitError&) {
    return false;
  }
}

}  // namespace

bool is_force_source(const SheetAnswers& answers) { return is(answers, "motor", "force"); }

bool driven_by_volts(const SheetAnswers& answers) {
  return is_force_source(answers) && (has_unit(answer_to(answers, "torque-constant"), "N m/V") ||
                                      has_unit(answer_to(answers, "force-constant"), "N/V"));
}

bool may_stay_open(const SheetQuestion& question, const SheetAnswers& answers) {
  return !fallback_of(question, answers).empty();
}

double ratio_in(std::string_view text) {
  const auto slash = text.find('/');
  if (slash == std::string_view::npos) return plain_number(text);
  const double below = plain_number(text.substr(slash + 1));
  return below > 0.0 ? plain_number(text.substr(0, slash)) / below : 0.0;
}

std::span<const SheetQuestion> sheet_questions() { return questions(); }

std::string answer_to(const SheetAnswers& answers, std::string_view name) {
  if (const auto found = answers.find(name); found != answers.end()) return found->second;
  const auto& all = questions();
  const auto question = std::find_if(all.begin(), all.end(), [&](const auto& q) { return q.name == name; });
  if (question == all.end()) return {};
  const auto fallback = fallback_of(*question, answers);
  return fallback == open ? std::string() : std::string(fallback);
}

std::string_view unit_of(const SheetQuestion& question, const SheetAnswers& answers) {
  return !linear(answers) && !question.rotary_unit.empty() ? question.rotary_unit : question.unit;
}

std::string objection_to(const SheetQuestion& question, const std::string& answer, const SheetAnswers& answers) {
  const auto found = [&](const std::string& expected) {
    return fmt::format("found \"{}\"; expected {}", answer, expected);
  };
  if (!question.choices.empty())
    return std::find(question.choices.begin(), question.choices.end(), answer) != question.choices.end()
               ? ""
               : found(fmt::format("{} ({})", fmt::join(question.choices, " or "), question.text));
  if (question.name == "ratio") {
    return ratio_in(answer) > 0.0
               ? ""
               : found("a number such as 3, or a fraction such as 355/113 (" + std::string(question.text) + ")");
  }
  if (whole(question.name)) {
    const bool digits = !answer.empty() && answer.find_first_not_of("0123456789") == std::string::npos;
    return digits && answer != "0" ? "" : found("a whole number (" + std::string(question.text) + ")");
  }
  auto unit = unit_of(question, answers);
  if (is_constant(question.name) && is_force_source(answers))
    for (const std::string_view per_volt : {"N m/V", "N/V"})
      if (per_volt.substr(0, per_volt.size() - 1) == unit.substr(0, unit.size() - 1) && has_unit(answer, per_volt))
        unit = per_volt;
  if (unit.empty()) return answer.empty() ? found("a text (" + std::string(question.text) + ")") : "";
  try {
    const double value = machine::parse_quantity(spelled(answer), unit);
    const bool may_be_zero = may_stay_open(question, answers);
    if (value > 0.0 || (may_be_zero && value == 0.0)) return "";
    return found(fmt::format("more than 0 {} ({})", unit, question.text));
  } catch (const machine::UnitError& error) {
    return fmt::format("found \"{}\" ({}); expected a value in {} ({})", answer, error.what(), unit, question.text);
  }
}

double sheet_quantity(const SheetAnswers& answers, std::string_view name, std::string_view unit) {
  return machine::parse_quantity(spelled(answer_to(answers, name)), unit);
}

}  // namespace stiction::host
