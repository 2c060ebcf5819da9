#include "host/diagnose/reference_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "sim/plant/effects/effects.hpp"

namespace stiction::host {
namespace {

double feed_of(double metres_per_second) { return metres_per_second * 60.0; }  // m/min

// Why rows of two numbers say nothing of an effect.
struct Silence {
  std::string_view effect, why;
};
constexpr std::string_view both_directions =
    "not identifiable: a row has only the largest value of both directions; record one lap with separate directions";
constexpr std::string_view no_position =
    "not identifiable: a row has no position; record position and current over one stroke at constant speed";
constexpr std::string_view no_time = "not identifiable: a row has no time; record set-points, position and current";
constexpr std::array silences{
    Silence{"friction_asymmetry", both_directions},
    Silence{"constant_force", both_directions},
    Silence{"position_spring", no_position},
    Silence{"force_ripple", no_position},
    Silence{"force_constant_ripple", no_position},
    Silence{"position_dependent_friction", no_position},
    Silence{"encoder_subdivision_error", no_position},
    Silence{"time_skew", no_time},
    Silence{"friction_lag", no_time},
    Silence{"thermal_drift", no_time},
    Silence{"periodic_disturbance", no_time},
    Silence{"structural_resonance", no_time},
    Silence{"cross_axis_coupling", no_time},
    Silence{"backlash",
            "not identifiable from two numbers per row: at a reversal it increases the largest error like a softer "
            "contact; load the axis at standstill"},
    Silence{"force_constant_mismatch",
            "not identifiable from two numbers per row: it scales mass and friction together; accelerate a known added "
            "mass"},
    Silence{"force_saturation",
            "not identifiable from two numbers per row: only the fastest circle has a high current; accelerate at "
            "several levels"},
    Silence{"controller_gain_mismatch",
            "not identifiable from two numbers per row: it changes the error like the contact; measure a frequency "
            "response"},
};

std::string percent_off(double simulated, double measured) {
  const double off = 100.0 * (simulated / measured - 1.0);
  return fmt::format("{:.1f} % too {}", std::abs(off), off < 0.0 ? "low" : "high");
}

// The fastest circle's current is mostly acceleration: what the mass may be off, with the friction extended.
std::string why_not_mass(const machine::Machine& machine, const Verdict& verdict) {
  std::string text = "not needed: ";
  for (std::size_t k = 0; k < machine.axes.size(); ++k) {
    const auto& axis = machine.axes[k];
    const DiagnosedRow* fastest = nullptr;
    for (const auto& row : verdict.reference->rows)
      if (row.axis == axis.name && (fastest == nullptr || row.feed > fastest->feed)) fastest = &row;
    if (k > 0) text += "; ";
    text += fmt::format("{} at {:g} m/min, current {}", axis.name, feed_of(fastest->feed),
                        percent_off(fastest->extended.current, fastest->measured.current));
  }
  return text + " with the extended friction, and most of that current accelerates the mass";
}

bool named(const Verdict& verdict, std::string_view effect) {
  return std::any_of(verdict.findings.begin(), verdict.findings.end(),
                     [&](const Finding& f) { return f.effect.name == effect; });
}

std::string contact_evidence(const AxisExtension& axis, double feed, const machine::CircleReference& row) {
  return fmt::format(
      "With the extended sliding friction and the contact of the file, the error at {:g} m/min is {:.2f} um, measured "
      "{:.1f} um. The contact has the shape of the presliding rows (loaded against the previous motion) with "
      "displacements scaled by {:.2g}; one error determines this scale only.",
      feed_of(feed), axis.error_with_file_contact * 1e6, row.error * 1e6, axis.displacement);
}

}  // namespace

const char* name_of(SlidingPart part) {
  return part == SlidingPart::coulomb   ? "coulomb_mismatch"
         : part == SlidingPart::viscous ? "viscous_mismatch"
                                        : "viscous_nonlinear";
}

std::string evidence_words(const ReferenceExtension& extension, const AxisExtension& axis, const std::string& effect,
                           const machine::CircleReference& row) {
  if (effect == "presliding_hysteresis") return contact_evidence(axis, extension.training_feed, row);
  const auto& fit = extension.sliding;
  if (!axis.own_rows)
    return fmt::format(
        "Two numbers per row cannot separate the parts of the friction of this axis. Its law is that of {}, scaled by "
        "{:.2f} from one number, {:.1f} A at {:g} m/min, and the parts are evaluated together. The interval contains "
        "that of this scale (with a drift of friction of 3 % from day to day) and that of the law of {}.",
        axis.law_from, axis.force, row.current, feed_of(extension.training_feed), axis.law_from);
  const auto test = std::find_if(fit.tests.begin(), fit.tests.end(),
                                 [&](const SlidingPartTest& each) { return effect == name_of(each.part); });
  return fmt::format(
      "The friction of the file deviates by {:.1f} N rms from the rows of steady friction, the extended one by {:.1f} "
      "N rms. Without this cause, and with the others fitted again, {:.0f} % of the squared deviation of the file "
      "returns (p = {:.1g}).",
      fit.deviation_before, fit.deviation_after, 100.0 * test->explains, test->p_value);
}

std::vector<ConfusedWith> confusion_words(const ReferenceExtension& extension, const AxisExtension& axis,
                                          const std::string& effect) {
  if (effect == "presliding_hysteresis")
    return {{"backlash", "load at standstill: presliding has an elastic slope, play has none; a second encoder"}};
  std::vector<ConfusedWith> list;
  const auto record = fmt::format("constant speeds of {} itself, from 0.02 m/min up, both ways", axis.axis);
  if (!axis.own_rows)
    for (const auto& test : extension.sliding.tests)
      if (test.named && effect != name_of(test.part)) list.push_back({name_of(test.part), record});
  return list;
}

std::vector<Rejected> rejection_words(const machine::Machine& machine, const Verdict& verdict) {
  std::vector<Rejected> list;
  for (const auto& kind : sim::effect_kinds()) {
    if (named(verdict, kind.name)) continue;
    const auto silence =
        std::find_if(silences.begin(), silences.end(), [&](const Silence& each) { return each.effect == kind.name; });
    std::string why =
        silence != silences.end() ? std::string(silence->why) : "not identifiable from two numbers per row";
    if (kind.name == "mass_mismatch") why = why_not_mass(machine, verdict);
    if (kind.name == "stribeck")
      why =
          "not found: the rows of steady friction rise from the lowest speed on; they have no information about lower "
          "speeds";
    list.push_back({std::string(kind.name), why});
  }
  return list;
}

Unexplained left_words(const std::vector<DiagnosedRow>& rows) {
  double before = 0.0, after = 0.0;
  for (const auto& row : rows)
    if (!row.training) {
      before += std::pow(row.machine_file.current / row.measured.current - 1.0, 2);
      after += std::pow(row.extended.current / row.measured.current - 1.0, 2);
    }
  Unexplained left{std::min(1.0, after / before), {}};
  const DiagnosedRow* worst = nullptr;
  const auto off = [](const DiagnosedRow& row) { return std::abs(row.extended.current / row.measured.current - 1.0); };
  for (const auto& row : rows)
    if (!row.training && (worst == nullptr || off(row) > off(*worst))) worst = &row;
  if (worst != nullptr && off(*worst) > 0.05)
    left.signature =
        fmt::format("{} at {:g} m/min, where the current remains {} ({:.2f} A, measured {:.1f} A)", worst->axis,
                    feed_of(worst->feed), percent_off(worst->extended.current, worst->measured.current),
                    worst->extended.current, worst->measured.current);
  return left;
}

std::vector<std::string> note_words(const ReferenceExtension& extension) {
  std::vector<std::string> notes;
  notes.push_back(
      fmt::format("Training rows: steady friction of {}, presliding, and the circle at {:g} m/min, for which the "
                  "published simulation was also tuned. All other feeds are predicted.",
                  extension.axes.front().law_from, feed_of(extension.training_feed)));
  for (const auto& axis : extension.axes)
    if (!axis.own_rows)
      notes.push_back(
          fmt::format("Record constant speeds of {} both ways, from 0.02 m/min to its highest speed, because its "
                      "sliding law is taken from {}.",
                      axis.axis, axis.law_from));
  notes.push_back(
      "Record small reversals of 1 to 200 um on the machine itself, because the presliding rows come from a test rig "
      "and only their scale could be determined.");
  return notes;
}

}  // namespace stiction::host
