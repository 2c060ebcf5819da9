#include "host/diagnose/reference/reference_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "sim/effects/backlash/backlash.hpp"
#include "sim/effects/coulomb_mismatch/coulomb_mismatch.hpp"
#include "sim/effects/effects.hpp"
#include "sim/effects/mass_mismatch/mass_mismatch.hpp"
#include "sim/effects/presliding_hysteresis/presliding_hysteresis.hpp"
#include "sim/effects/viscous_mismatch/viscous_mismatch.hpp"
#include "sim/effects/viscous_nonlinear/viscous_nonlinear.hpp"

namespace stiction::host {
namespace {

double feed_of(double metres_per_second) { return metres_per_second * 60.0; }  // m/min

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

bool named(const Verdict& verdict, sim::EffectId effect) {
  return std::any_of(verdict.findings.begin(), verdict.findings.end(),
                     [&](const Finding& f) { return f.effect == effect; });
}

std::string contact_evidence(const AxisExtension& axis, double feed, const machine::CircleReference& row) {
  return fmt::format(
      "With the extended sliding friction and the contact of the file, the error at {:g} m/min is {:.2f} um, measured "
      "{:.1f} um. The contact has the shape of the presliding rows (loaded against the previous motion) with "
      "displacements scaled by {:.2g}; one error determines this scale only.",
      feed_of(feed), axis.error_with_file_contact * 1e6, row.error * 1e6, axis.displacement);
}

}  // namespace

sim::EffectId effect_of(SlidingPart part) {
  return part == SlidingPart::coulomb   ? sim::id_of<sim::CoulombMismatch>()
         : part == SlidingPart::viscous ? sim::id_of<sim::ViscousMismatch>()
                                        : sim::id_of<sim::ViscousNonlinear>();
}

std::string evidence_words(const ReferenceExtension& extension, const AxisExtension& axis, sim::EffectId effect,
                           const machine::CircleReference& row) {
  if (sim::is_a<sim::PreslidingHysteresis>(effect)) return contact_evidence(axis, extension.training_feed, row);
  const auto& fit = extension.sliding;
  if (!axis.own_rows)
    return fmt::format(
        "Two numbers per row cannot separate the parts of the friction of this axis. Its law is that of {}, scaled by "
        "{:.2f} from one number, {:.1f} A at {:g} m/min, and the parts are evaluated together. The interval contains "
        "that of this scale (with a drift of friction of 3 % from day to day) and that of the law of {}.",
        axis.law_from, axis.force, row.current, feed_of(extension.training_feed), axis.law_from);
  const auto test = std::find_if(fit.tests.begin(), fit.tests.end(),
                                 [&](const SlidingPartTest& each) { return effect == effect_of(each.part); });
  return fmt::format(
      "The friction of the file deviates by {:.1f} N rms from the rows of steady friction, the extended one by {:.1f} "
      "N rms. Without this cause, and with the others fitted again, {:.0f} % of the squared deviation of the file "
      "returns (p = {:.1g}).",
      fit.deviation_before, fit.deviation_after, 100.0 * test->explains, test->p_value);
}

std::vector<ConfusedWith> confusion_words(const ReferenceExtension& extension, const AxisExtension& axis,
                                          sim::EffectId effect) {
  std::vector<ConfusedWith> list;
  if (sim::is_a<sim::PreslidingHysteresis>(effect)) {
    for (const auto& confusion : sim::confusions_of(effect))
      if (sim::is_a<sim::Backlash>(confusion.other))
        list.push_back({confusion.other, std::string(confusion.separate_by)});
    return list;
  }
  const auto record = fmt::format("constant speeds of {} itself, from 0.02 m/min up, both ways", axis.axis);
  if (!axis.own_rows)
    for (const auto& test : extension.sliding.tests)
      if (test.named && effect != effect_of(test.part)) list.push_back({effect_of(test.part), record});
  return list;
}

std::vector<Rejected> rejection_words(const machine::Machine& machine, const Verdict& verdict) {
  std::vector<Rejected> list;
  for (const sim::EffectId effect : sim::all_effects()) {
    if (named(verdict, effect)) continue;
    std::string why(effect->not_in_rows.empty() ? "not identifiable from two numbers per row" : effect->not_in_rows);
    if (sim::is_a<sim::MassMismatch>(effect)) why = why_not_mass(machine, verdict);
    list.push_back({effect, why});
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
