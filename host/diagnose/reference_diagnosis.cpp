#include "host/diagnose/reference_diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "host/diagnose/fisher.hpp"
#include "host/diagnose/reference_charts.hpp"
#include "host/diagnose/reference_extension.hpp"
#include "host/diagnose/reference_words.hpp"
#include "host/identify/measured_machine.hpp"

namespace stiction::host {
namespace {

std::vector<double> measured_feeds(const sim::Machine& machine) {
  std::vector<double> feeds;
  for (const auto& row : machine.circle_references)
    if (row.measured && std::find(feeds.begin(), feeds.end(), row.feed) == feeds.end()) feeds.push_back(row.feed);
  std::sort(feeds.begin(), feeds.end());
  return feeds;
}

// Largest error and current of both axes, by feed.
using Laps = std::map<double, std::array<RowFigures, 2>>;

Laps simulated(const sim::Machine& machine) {
  Laps laps;
  for (const double feed : measured_feeds(machine)) {
    const auto run = reference_circle(machine, feed);
    for (std::size_t k = 0; k < 2; ++k) laps[feed][k] = {run.axes[k].peak_error, run.axes[k].peak_current};
  }
  return laps;
}

std::optional<RowFigures> published_row(const sim::Machine& machine, const sim::Axis& axis, double feed) {
  for (const auto& row : machine.circle_references)
    if (!row.measured && row.axis == axis.name && row.feed == feed && row.friction == axis.friction.use)
      return RowFigures{row.error, row.current};
  return std::nullopt;
}

// One row of the measured ones, in the order of axes and feeds.
std::vector<DiagnosedRow> rows_of(const sim::Machine& machine, double training_feed, const Laps& before,
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
                      {}});
    }
  return rows;
}

RowScores scores_of(const std::vector<DiagnosedRow>& rows) {
  RowScores scores;
  double count = 0.0, published = 0.0;
  const auto add = [](RowScore& score, const RowFigures& simulated, const RowFigures& measured) {
    score.error += std::abs(simulated.error / measured.error - 1.0);
    score.current += std::abs(simulated.current / measured.current - 1.0);
  };
  for (const auto& row : rows) {
    if (row.training) continue;
    add(scores.machine_file, row.machine_file, row.measured);
    add(scores.extended, row.extended, row.measured);
    count += 1.0;
    if (!row.published) continue;
    add(scores.published, *row.published, row.measured);
    published += 1.0;
  }
  const auto mean = [](RowScore& score, double of) { score = {score.error / of, score.current / of}; };
  mean(scores.machine_file, count);
  mean(scores.extended, count);
  mean(scores.published, published);
  return scores;
}

// rms over the unused rows of an axis (of all: empty name), of what is `off` in a row.
template <class Off>
double unused_rms(const std::vector<DiagnosedRow>& rows, const std::string& axis, Off&& off) {
  double square = 0.0, count = 0.0;
  for (const auto& row : rows)
    if (!row.training && (axis.empty() || row.axis == axis)) {
      square += std::pow(off(row), 2);
      count += 1.0;
    }
  return std::sqrt(square / count);
}

// What a row is off without one cause.
RowFigures off_without(const DiagnosedRow& row, std::size_t share) {
  const auto& by = row.shares[share].by;
  return {row.extended.error - by.error - row.measured.error, row.extended.current - by.current - row.measured.current};
}

// 95 % interval over feeds drawn with repetition: a handful of them, so a wide one.
std::array<double, 2> ratio_interval(const std::vector<DiagnosedRow>& rows, const std::string& axis,
                                     std::size_t share) {
  std::vector<std::pair<double, double>> squares;
  for (const auto& row : rows)
    if (!row.training && row.axis == axis)
      squares.emplace_back(std::pow(row.extended.current - row.measured.current, 2),
                           std::pow(off_without(row, share).current, 2));
  std::mt19937_64 random(1);
  std::vector<double> ratios;
  for (int r = 0; r < 400; ++r) {
    double with = 0.0, without = 0.0;
    for (std::size_t i = 0; i < squares.size(); ++i) {
      const auto& drawn = squares[random() % squares.size()];
      with += drawn.first;
      without += drawn.second;
    }
    ratios.push_back(std::sqrt(with / without));
  }
  std::sort(ratios.begin(), ratios.end());
  return {ratios[9], ratios[389]};
}

HoldoutGain gain_of(const std::vector<DiagnosedRow>& rows, const std::string& axis, std::size_t share) {
  HoldoutGain gain;
  gain.force_rms_ratio =
      unused_rms(rows, axis, [](const DiagnosedRow& r) { return r.extended.current - r.measured.current; }) /
      unused_rms(rows, axis, [&](const DiagnosedRow& r) { return off_without(r, share).current; });
  gain.position_error_rms_ratio =
      unused_rms(rows, axis, [](const DiagnosedRow& r) { return r.extended.error - r.measured.error; }) /
      unused_rms(rows, axis, [&](const DiagnosedRow& r) { return off_without(r, share).error; });
  gain.ci95 = ratio_interval(rows, axis, share);
  return gain;
}

EffectParameter parameter(const char* name, double value, double error) { return {name, {value}, {error}}; }

// Values and standard errors under the names of verdict.json. Of an axis without rows of its own the scale's error is
// all that is known, and the rows' own beside it.
std::vector<EffectParameter> parameters_of(const sim::Effect& effect, const ReferenceExtension& extension,
                                           const AxisExtension& axis) {
  const auto& errors = extension.sliding.errors;
  const double scale = axis.force_error / axis.force;
  const auto value = [&](const char* key) { return effect.values.at(key).front(); };
  const auto scaled = [&](double of_law, double result) {
    return std::hypot(axis.force * of_law, axis.own_rows ? 0.0 : scale * result);
  };
  if (effect.name == "coulomb_mismatch")
    return {parameter("coulomb_N", value("coulomb"), scaled(errors.coulomb, value("coulomb")))};
  if (effect.name == "viscous_mismatch")
    return {parameter("viscous_N_s_per_m", value("viscous"), scaled(errors.viscous, value("viscous")))};
  if (effect.name == "viscous_nonlinear")
    return {parameter("force_N", value("force"), scaled(errors.rise, value("force"))),
            parameter("velocity_m_per_s", value("velocity"), errors.rise_velocity)};
  const double displacement = axis.displacement_error / axis.displacement;
  return {parameter("stiffness_N_per_m", value("stiffness"), displacement * value("stiffness")),
          parameter("distance_m", value("distance"), displacement * value("distance"))};
}

// How much each cause takes of its rows' squares, given the others; a contact of its axis' error at the training feed.
void judge(Finding& finding, const ReferenceExtension& extension, const AxisExtension& axis, double measured_error) {
  for (const auto part : sliding_parts) {
    const auto& test = extension.sliding.tests[static_cast<std::size_t>(part)];
    if (finding.effect.name != name_of(part)) continue;
    finding.explains = test.explains;
    finding.p_value = test.p_value;
    return;
  }
  const double off = axis.error_with_file_contact - measured_error;
  finding.explains = 1.0 - std::pow(error_reading / off, 2);
  finding.p_value = std::erfc(std::abs(off) / error_reading / std::sqrt(2.0));
}

void add_findings(const sim::Machine& machine, const ReferenceExtension& extension, Verdict& verdict) {
  for (std::size_t k = 0; k < machine.axes.size(); ++k)
    for (const auto& effect : effects_of(machine, extension, k)) {
      Finding finding;
      finding.axis = machine.axes[k].name;
      finding.effect = effect;
      finding.parameters = parameters_of(effect, extension, extension.axes[k]);
      const auto* row = measured_row(machine, finding.axis, extension.training_feed);
      judge(finding, extension, extension.axes[k], row->error);
      finding.evidence = evidence_words(extension, extension.axes[k], effect.name, *row);
      finding.confused_with = confusion_words(extension, extension.axes[k], effect.name);
      verdict.findings.push_back(std::move(finding));
    }
}

// What each row loses without each finding of its axis.
void add_shares(const sim::Machine& machine, Verdict& verdict, const std::function<void()>& progress) {
  auto& rows = verdict.reference->rows;
  for (auto& finding : verdict.findings) {
    auto without = machine;
    for (auto& axis : without.axes)
      for (const auto& other : verdict.findings)
        if (&other != &finding && other.axis == axis.name) axis.effects.push_back(other.effect);
    const auto laps = simulated(without);
    for (auto& row : rows) {
      if (row.axis != finding.axis) continue;
      const auto& lap = laps.at(row.feed)[row.axis == machine.axes[0].name ? 0 : 1];
      row.shares.push_back({finding.effect.name, {row.extended.error - lap.error, row.extended.current - lap.current}});
    }
    const auto share =
        std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return r.axis == finding.axis; })->shares.size() -
        1;
    finding.holdout = gain_of(rows, finding.axis, share);
    double largest = 0.0;
    for (const auto& row : rows)
      if (row.axis == finding.axis) largest = std::max(largest, std::abs(row.shares[share].by.error));
    finding.part_error = largest;
    if (progress) progress();
  }
}

void add_figures(const sim::Machine& machine, Verdict& verdict) {
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
  verdict.unexplained = left_words(rows, verdict.baseline, verdict.extended);
}

// The same with every other feed as the training feed, where a friction is found that gives its row.
std::vector<OtherTraining> other_trainings(const sim::Machine& machine, const Laps& before, double training_feed,
                                           const std::function<void()>& progress) {
  std::vector<OtherTraining> others;
  for (const double feed : measured_feeds(machine)) {
    if (std::abs(feed - training_feed) < 1e-6 * feed) continue;
    try {
      const auto extension = extend_by_rows(machine, feed);
      const auto after = simulated(extended_by(machine, extension));
      others.push_back({feed, scores_of(rows_of(machine, feed, before, after))});
    } catch (const MissingRows&) {
      // A row that no scale of the friction gives: nothing to score.
    }
    if (progress) progress();
  }
  return others;
}

}  // namespace

Verdict diagnose_reference(const sim::Machine& machine, const std::function<void()>& progress) {
  if (machine.axes.size() != 2)
    throw MissingRows(fmt::format("found a machine with {} axes; expected 2, of a circle", machine.axes.size()));
  const auto extension = extend_by_rows(machine, calibration_feed);
  if (progress) progress();
  const auto before = simulated(machine);
  const auto after = simulated(extended_by(machine, extension));
  Verdict verdict;
  verdict.machine = machine.id + ".toml";
  add_findings(machine, extension, verdict);
  verdict.reference = ReferenceRows{
      "circle", machine.axes.front().friction.use, rows_of(machine, extension.training_feed, before, after), {}, {}};
  verdict.reference->unused = scores_of(verdict.reference->rows);
  add_shares(machine, verdict, progress);
  add_figures(machine, verdict);
  verdict.reference->others = other_trainings(machine, before, extension.training_feed, progress);
  verdict.rejected = rejection_words(machine, verdict);
  verdict.notes = note_words(extension, verdict);
  add_reference_charts(verdict, machine, extension);
  std::stable_sort(verdict.findings.begin(), verdict.findings.end(),
                   [](const Finding& a, const Finding& b) { return a.explains > b.explains; });
  return verdict;
}

}  // namespace stiction::host
