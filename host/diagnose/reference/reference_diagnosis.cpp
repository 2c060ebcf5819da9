#include "host/diagnose/reference/reference_diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>

#include "host/diagnose/reference/reference_charts.hpp"
#include "host/diagnose/reference/reference_extension.hpp"
#include "host/diagnose/reference/reference_words.hpp"
#include "host/identify/measured_machine.hpp"
#include "sim/effects/coulomb_mismatch/coulomb_mismatch.hpp"
#include "sim/effects/effects.hpp"
#include "sim/effects/presliding_hysteresis/presliding_hysteresis.hpp"
#include "sim/effects/viscous_mismatch/viscous_mismatch.hpp"
#include "sim/effects/viscous_nonlinear/viscous_nonlinear.hpp"

namespace stiction::host {
namespace {

std::vector<double> measured_feeds(const machine::Machine& machine) {
  std::vector<double> feeds;
  for (const auto& row : machine.circle_references)
    if (row.measured && std::find(feeds.begin(), feeds.end(), row.feed) == feeds.end()) feeds.push_back(row.feed);
  std::sort(feeds.begin(), feeds.end());
  return feeds;
}

// Largest error and current of both axes, by feed.
using Laps = std::map<double, std::array<RowFigures, 2>>;

Laps simulated(const machine::Machine& machine, ReferenceCircles& circles) {
  Laps laps;
  for (const double feed : measured_feeds(machine)) laps[feed] = circles.at(machine, feed);
  return laps;
}

std::optional<RowFigures> published_row(const machine::Machine& machine, const machine::AxisModel& axis, double feed) {
  for (const auto& row : machine.circle_references)
    if (!row.measured && row.axis == axis.name && row.feed == feed && row.friction == axis.friction.use)
      return RowFigures{row.error, row.current};
  return std::nullopt;
}

// One row of the measured ones, in the order of axes and feeds.
std::vector<DiagnosedRow> rows_of(const machine::Machine& machine, double training_feed, const Laps& before,
                                  const Laps& after) {
  std::vector<DiagnosedRow> rows;
  for (std::size_t k = 0; k < machine.axes.size(); ++k)
    for (const double feed : measured_feeds(machine)) {
      const auto& axis = machine.axes[k];
      const auto* measured = measured_row(machine, axis.name, feed);
      if (measured == nullptr) continue;
      rows.push_back({axis.name,
                      feed,
                      std::abs(feed - training_feed) < 1e-6 * feed,
                      {measured->error, measured->current},
                      before.at(feed)[k],
                      after.at(feed)[k],
                      published_row(machine, axis, feed),
                      after.at(feed)[k],
                      {}});
    }
  return rows;
}

RowFigures off(const RowFigures& simulated, const RowFigures& measured) {
  return {simulated.error / measured.error - 1.0, simulated.current / measured.current - 1.0};
}

RowScore score_of(const std::vector<DiagnosedRow>& rows, bool all,
                  const std::function<std::optional<RowFigures>(const DiagnosedRow&)>& of) {
  RowScore sum;
  double count = 0.0;
  for (const auto& row : rows) {
    const auto simulated = of(row);
    if ((row.training && !all) || !simulated) continue;
    const auto deviation = off(*simulated, row.measured);
    sum.error += std::abs(deviation.error);
    sum.current += std::abs(deviation.current);
    count += 1.0;
  }
  return {sum.error / count, sum.current / count};
}

// `all`: every row, each predicted with its feed left out; else the rows of feeds that took no part.
RowScores scores_of(const std::vector<DiagnosedRow>& rows, bool all) {
  return {score_of(rows, all, [](const DiagnosedRow& r) { return r.published; }),
          score_of(rows, all, [](const DiagnosedRow& r) { return r.machine_file; }),
          score_of(rows, all, [&](const DiagnosedRow& r) { return all ? r.left_out : r.extended; })};
}

using Member = double RowFigures::*;

// rms over the unused rows of an axis (of all: empty name), of what `of` gives for a row.
template <class Of>
double unused_rms(const std::vector<DiagnosedRow>& rows, const std::string& axis, Of&& of) {
  double square = 0.0, count = 0.0;
  for (const auto& row : rows)
    if (!row.training && (axis.empty() || row.axis == axis)) {
      square += std::pow(of(row), 2);
      count += 1.0;
    }
  return std::sqrt(square / count);
}

// 95 % interval over feeds drawn with repetition: a handful of them, so a wide one.
std::array<double, 2> ratio_interval(const std::vector<DiagnosedRow>& rows, const std::string& axis,
                                     const Laps& without, std::size_t k) {
  std::vector<std::pair<double, double>> squares;
  for (const auto& row : rows)
    if (!row.training && row.axis == axis)
      squares.emplace_back(std::pow(off(row.extended, row.measured).current, 2),
                           std::pow(off(without.at(row.feed)[k], row.measured).current, 2));
  std::mt19937_64 random(1);
  std::vector<double> ratios;
  for (int r = 0; r < 400; ++r) {
    double with = 0.0, left_out = 0.0;
    for (std::size_t i = 0; i < squares.size(); ++i) {
      const auto& drawn = squares[random() % squares.size()];
      with += drawn.first;
      left_out += drawn.second;
    }
    ratios.push_back(std::sqrt(with / left_out));
  }
  std::sort(ratios.begin(), ratios.end());
  return {ratios[9], ratios[389]};
}

// Ratios of relative deviations: every feed counts alike.
HoldoutGain gain_of(const std::vector<DiagnosedRow>& rows, const std::string& axis, const Laps& without,
                    std::size_t k) {
  const auto ratio = [&](Member member) {
    return unused_rms(rows, axis, [&](const DiagnosedRow& r) { return off(r.extended, r.measured).*member; }) /
           unused_rms(rows, axis,
                      [&](const DiagnosedRow& r) { return off(without.at(r.feed)[k], r.measured).*member; });
  };
  HoldoutGain gain;
  gain.force_rms_ratio = ratio(&RowFigures::current);
  gain.position_error_rms_ratio = ratio(&RowFigures::error);
  gain.ci95 = ratio_interval(rows, axis, without, k);
  return gain;
}

// Values and standard errors. Of an axis without rows of its own the scale's error is
// all that is known, and the rows' own beside it.
std::vector<EffectParameter> parameters_of(const Finding& finding, const machine::AxisModel& file,
                                           const ReferenceExtension& extension, const AxisExtension& axis) {
  const auto& errors = extension.sliding.errors;
  const double scale = axis.force_error / axis.force;
  const auto value = [&](const char* key) { return finding.values.at(key).front(); };
  const auto parameter = [&](const char* key, double error) {
    return effect_parameter(file, finding.effect, key, {value(key)}, {error});
  };
  const auto scaled = [&](double of_law, double result) {
    return std::hypot(axis.force * of_law, axis.own_rows ? 0.0 : scale * result);
  };
  if (sim::is_a<sim::CoulombMismatch>(finding.effect))
    return {parameter("coulomb", scaled(errors.coulomb, value("coulomb")))};
  if (sim::is_a<sim::ViscousMismatch>(finding.effect))
    return {parameter("viscous", scaled(errors.viscous, value("viscous")))};
  if (sim::is_a<sim::ViscousNonlinear>(finding.effect))
    return {parameter("force", scaled(errors.rise, value("force"))), parameter("velocity", errors.rise_velocity)};
  const double displacement = axis.displacement_error / axis.displacement;
  return {parameter("stiffness", displacement * value("stiffness")),
          parameter("distance", displacement * value("distance"))};
}

// How much each cause takes of the training rows' squares, given the others: a part of the sliding law of the rows of
// steady friction, a contact of those and its axis' error at the training feed, all as relative deviations.
void judge(Finding& finding, const ReferenceExtension& extension, const AxisExtension& axis, double measured_error) {
  for (const auto part : sliding_parts) {
    const auto& test = extension.sliding.tests[static_cast<std::size_t>(part)];
    if (finding.effect != effect_of(part)) continue;
    finding.explains = test.explains;
    finding.p_value = test.p_value;
    return;
  }
  const double by = axis.error_with_file_contact - measured_error;
  const double square = std::pow(by / measured_error, 2);
  finding.explains = square / (square + extension.sliding.relative_square);
  finding.p_value = std::erfc(std::abs(by) / error_reading / std::sqrt(2.0));
}

void add_findings(const machine::Machine& machine, const ReferenceExtension& extension, Verdict& verdict) {
  for (std::size_t k = 0; k < machine.axes.size(); ++k)
    for (const auto& effect : effects_of(machine, extension, k)) {
      Finding finding(*sim::find_effect(effect.name));
      finding.axis = machine.axes[k].name;
      finding.values = effect.values;
      finding.parameters = parameters_of(finding, machine.axes[k], extension, extension.axes[k]);
      const auto* row = measured_row(machine, finding.axis, extension.training_feed);
      judge(finding, extension, extension.axes[k], row->error);
      finding.evidence = evidence_words(extension, extension.axes[k], finding.effect, *row);
      finding.confused_with = confusion_words(extension, extension.axes[k], finding.effect);
      verdict.findings.push_back(std::move(finding));
    }
}

// All findings but those of which `leave_away` is true.
Laps simulated_without(const machine::Machine& machine, const Verdict& verdict, ReferenceCircles& circles,
                       const std::function<bool(const Finding&)>& leave_away) {
  auto without = machine;
  for (auto& axis : without.axes)
    for (const auto& finding : verdict.findings)
      if (finding.axis == axis.name && !leave_away(finding)) axis.effects.push_back(finding.row());
  return simulated(without, circles);
}

// What each row loses without each finding, and what that gains. The parts of a borrowed law came from one number and
// are judged together. Both axes' findings of an effect are left away at once: no axis feels the other.
void add_shares(const machine::Machine& machine, const ReferenceExtension& extension, ReferenceCircles& circles,
                Verdict& verdict, const std::function<void()>& progress) {
  auto& rows = verdict.reference->rows;
  const auto is_contact = [](const Finding& f) { return sim::is_a<sim::PreslidingHysteresis>(f.effect); };
  const auto without_law = simulated_without(machine, verdict, circles, std::not_fn(is_contact));
  std::map<sim::EffectId, Laps> without;
  for (auto& finding : verdict.findings) {
    const auto effect = finding.effect;
    if (!without.contains(effect)) {
      without[effect] =
          simulated_without(machine, verdict, circles, [&](const Finding& f) { return f.effect == effect; });
      if (progress) progress();
    }
    const auto k = static_cast<std::size_t>(finding.axis == machine.axes[0].name ? 0 : 1);
    double largest = 0.0;
    for (auto& row : rows) {
      if (row.axis != finding.axis) continue;
      const auto& lap = without.at(effect).at(row.feed)[k];
      row.shares.push_back({effect, {row.extended.error - lap.error, row.extended.current - lap.current}});
      largest = std::max(largest, std::abs(row.shares.back().by.error));
    }
    const bool together = !extension.axes[k].own_rows && !is_contact(finding);
    finding.holdout = gain_of(rows, finding.axis, together ? without_law : without.at(effect), k);
    finding.part_error = largest;
  }
}

void add_figures(const machine::Machine& machine, Verdict& verdict) {
  const auto& rows = verdict.reference->rows;
  const auto figures = [&](const RowFigures DiagnosedRow::*simulated) {
    ResidualFigures f;
    f.force_rms = unused_rms(rows, "", [&](const DiagnosedRow& row) {
      const auto& axis = machine.axes[row.axis == machine.axes[0].name ? 0 : 1];
      return axis.motor.force_constant * ((row.*simulated).current - row.measured.current);
    });
    f.position_error_rms =
        unused_rms(rows, "", [&](const DiagnosedRow& row) { return (row.*simulated).error - row.measured.error; });
    return f;
  };
  verdict.baseline = figures(&DiagnosedRow::machine_file);
  verdict.extended = figures(&DiagnosedRow::extended);
  verdict.unexplained = left_words(rows);
}

// Scales of an axis that make least squares of the relative deviations of some rows, by Gauss-Newton with the
// sensitivities of all rows to a tenth of each scale.
class LeftOut {
 public:
  LeftOut(const machine::Machine& machine, ReferenceExtension extension, const Laps& at, ReferenceCircles& circles)
      : machine_(machine),
        start_(std::move(extension)),
        at_(at),
        circles_(circles),
        force_(changed(&AxisExtension::force, [](const AxisExtension& axis) { return !axis.own_rows; })),
        displacement_(changed(&AxisExtension::displacement, [](const AxisExtension& axis) { return axis.contact; })) {}

  // Rows of `feed`, predicted from those of all others.
  std::array<RowFigures, 2> predict(double feed) const {
    auto extension = start_;
    auto laps = at_;
    for (int step = 0; step < 2; ++step) {
      for (std::size_t k = 0; k < 2; ++k) {
        auto& axis = extension.axes[k];
        if (!axis.own_rows) axis.force *= std::exp(best_step(feed, k, laps, force_, &RowFigures::current));
        if (axis.contact) axis.displacement *= std::exp(best_step(feed, k, laps, displacement_, &RowFigures::error));
      }
      const auto extended = extended_by(machine_, extension);
      for (auto& [each, lap] : laps) {
        if (step == 0 ? each == feed : each != feed) continue;  // the left out row is wanted only at the end
        lap = circles_.at(extended, each);
      }
    }
    return laps.at(feed);
  }

 private:
  static constexpr double tenth = 0.1;

  Laps changed(double AxisExtension::*scale, bool (*counts)(const AxisExtension&)) const {
    auto extension = start_;
    for (auto& axis : extension.axes)
      if (counts(axis)) axis.*scale *= std::exp(tenth);
    return simulated(extended_by(machine_, extension), circles_);
  }

  // Of the scale's logarithm, at most a factor of two.
  double best_step(double feed, std::size_t k, const Laps& laps, const Laps& moved, Member member) const {
    double slope_square = 0.0, moment = 0.0;
    for (const auto& [each, lap] : laps) {
      const auto* row = measured_row(machine_, machine_.axes[k].name, each);
      if (each == feed || row == nullptr) continue;
      const RowFigures measured{row->error, row->current};
      const double slope = (moved.at(each)[k].*member - at_.at(each)[k].*member) / tenth / (measured.*member);
      slope_square += slope * slope;
      moment += slope * (1.0 - lap[k].*member / (measured.*member));
    }
    return std::clamp(moment / slope_square, -std::log(2.0), std::log(2.0));
  }

  const machine::Machine& machine_;
  ReferenceExtension start_;
  const Laps& at_;
  ReferenceCircles& circles_;
  Laps force_, displacement_;
};

void leave_each_feed_out(const machine::Machine& machine, const ReferenceExtension& extension, const Laps& after,
                         ReferenceCircles& circles, ReferenceRows& reference, const std::function<void()>& progress) {
  const LeftOut left_out(machine, extension, after, circles);
  for (const double feed : measured_feeds(machine)) {
    const auto predicted = left_out.predict(feed);
    for (auto& row : reference.rows)
      if (row.feed == feed) row.left_out = predicted[row.axis == machine.axes[0].name ? 0 : 1];
    if (progress) progress();
  }
  reference.left_out = scores_of(reference.rows, true);
}

}  // namespace

Verdict diagnose_reference(const machine::Machine& machine, const std::function<void()>& progress) {
  if (machine.axes.size() != 2)
    throw MissingRows(fmt::format("found a machine with {} axes; expected 2, of a circle", machine.axes.size()));
  ReferenceCircles circles;
  const auto extension = extend_by_rows(machine, calibration_feed, circles);
  if (progress) progress();
  const auto before = simulated(machine, circles);
  const auto after = simulated(extended_by(machine, extension), circles);
  Verdict verdict;
  verdict.machine = machine.id + ".toml";
  add_findings(machine, extension, verdict);
  verdict.reference = ReferenceRows{
      "circle", machine.axes.front().friction.use, rows_of(machine, extension.training_feed, before, after), {}, {}};
  verdict.reference->unused = scores_of(verdict.reference->rows, false);
  add_shares(machine, extension, circles, verdict, progress);
  add_figures(machine, verdict);
  leave_each_feed_out(machine, extension, after, circles, *verdict.reference, progress);
  verdict.rejected = rejection_words(machine, verdict);
  verdict.notes = note_words(extension);
  add_reference_charts(verdict, machine, extension);
  std::stable_sort(verdict.findings.begin(), verdict.findings.end(),
                   [](const Finding& a, const Finding& b) { return a.explains > b.explains; });
  return verdict;
}

}  // namespace stiction::host
