#include "host/diagnose/judge/command_residual.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/machine/configuration/double_signals.hpp"
#include "host/diagnose/classes/command_parameter.hpp"
#include "host/diagnose/judge/holdout.hpp"
#include "host/diagnose/record/command_replay.hpp"
#include "host/diagnose/record/moved_values.hpp"
#include "host/diagnose/statistics/evidence.hpp"
#include "host/diagnose/statistics/fisher.hpp"
#include "host/diagnose/statistics/level.hpp"
#include "host/diagnose/statistics/most_odds.hpp"
#include "host/identify/filter.hpp"
#include "host/identify/identification.hpp"
#include "host/identify/regression.hpp"
#include "sim/effects/effects.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

// Odds of the loss ratio, against as many parameters as there are.
// Of a change: where the file's own run shows so much of it, it is the replay's.
constexpr double of_own_run = 0.5;
constexpr double least_command_gain = 0.01;  // of the cross-validated residual
// Slower than this the residual is the integrator's, which adds up the position quantizer's rounding and does not know
// where the record began.
constexpr double slowest = 1.0;  // Hz
// The rest of a command that is another controller's, over the command itself.
constexpr double foreign = 0.3;
constexpr int refinements = 2;
// Of a gain: what the digits of a file and a drive's number formats leave open. On the EMPS record, whose command the
// replay meets to 1 mV, 0.02 % of the velocity gain is significant, and without any effect.
constexpr double least_change = 1e-3;
// Times the file's: the range of a gain in which its slope says anything. What leaves it is something else.
constexpr double smallest = 0.2, largest = 5.0;

using Places = std::vector<std::size_t>;  // of command_parameters()

// The records' commands in the rows of the residual force, without what is slower than `slowest`.
class Commands {
 public:
  Commands(const CommandRecords& records, const machine::Timing& timing, const machine::AxisModel& axis,
           double record_delay)
      : records_(records), timing_(timing), axis_(axis) {
    std::vector<std::vector<double>> logged, rates;
    for (const auto& log : records.logs) {
      const auto& channels = channels_of(log, axis);
      auto values = channels.*(recorded_command(channels, axis)->values);
      logged.push_back(shown_earlier(values, record_delay / log.period));
      if (record_delay != 0.0) rates.push_back(rate_over(logged.back(), log.period));
    }
    logged_ = rows_of(logged);
    if (!rates.empty()) nuisances_.push_back(rows_of(rates));
  }

  const LogRows& rows() const { return records_.rows; }
  const Eigen::VectorXd& logged() const { return logged_; }
  // What a parameter must stand beside: what is left of a record's delay, which is known to microseconds only.
  const std::vector<Eigen::VectorXd>& nuisances() const { return nuisances_; }
  template <class S>
  Eigen::VectorXd replayed(const machine::AxisModel& axis) const {
    std::vector<std::vector<double>> all;
    for (const auto& log : records_.logs) all.push_back(replay_command<S>(timing_, axis, log, channels_of(log, axis_)));
    return rows_of(all);
  }
  // By the firmware's numbers, where they hold the axis.
  Eigen::VectorXd as_driven(const machine::AxisModel& axis) const {
    return axis.beyond_formats.empty() ? replayed<FixedSignals>(axis) : replayed<machine::DoubleSignals>(axis);
  }
  // What the command changes by with each parameter, per its unit. In doubles: the drive's rounding has no slope.
  std::vector<Eigen::VectorXd> slopes(const machine::AxisModel& axis, const Places& places) const {
    std::vector<Eigen::VectorXd> all;
    const auto base = replayed<machine::DoubleSignals>(axis);
    for (const auto place : places) {
      const auto& parameter = command_parameters()[place];
      const double step = parameter.step(axis, timing_);
      auto changed = axis;
      parameter.set(changed, *parameter.value(axis) + step);
      all.push_back((replayed<machine::DoubleSignals>(changed) - base) / step);
    }
    return all;
  }

 private:
  Eigen::VectorXd rows_of(const std::vector<std::vector<double>>& columns) const {
    const auto& rows = records_.rows;
    Eigen::VectorXd all = rows.stacked(
        [&](const Motion& motion) { return columns[static_cast<std::size_t>(&motion - rows.motions().data())]; });
    for (std::size_t k = 0; k < rows.logs().size(); ++k) {
      const std::size_t begin = rows.logs()[k];
      const std::size_t end = k + 1 < rows.logs().size() ? rows.logs()[k + 1] : static_cast<std::size_t>(all.size());
      const std::span<double> own(all.data() + begin, end - begin);
      const auto lowpass = butterworth(2, std::min(2.0 * slowest * rows.period(k), 0.5));
      const auto slow = filter_both_ways(lowpass, own, own.size() / 4);
      for (std::size_t i = 0; i < own.size(); ++i) own[i] -= slow[i];
    }
    return all;
  }

  const CommandRecords& records_;
  const machine::Timing& timing_;
  const machine::AxisModel& axis_;
  Eigen::VectorXd logged_;
  std::vector<Eigen::VectorXd> nuisances_;
};

struct CommandTerm {
  std::size_t place;
  double value = 0.0, deviation = 0.0;
  double explains = 0.0, p_value = 1.0;
  double in_own_run = 0.0;  // change that the file's own runs seem to have
};

machine::AxisModel with_terms(machine::AxisModel axis, const std::vector<CommandTerm>& terms,
                              std::optional<sim::EffectId> without = {}) {
  for (const auto& term : terms)
    if (const auto& p = command_parameters()[term.place]; !without || p.effect != without) p.set(axis, term.value);
  return axis;
}

// Which parameters the target needs: the best that stands is added, those that stand no longer are dropped.
class Selection {
 public:
  // `nuisances`: columns that stay beside whatever is chosen.
  Selection(const Eigen::VectorXd& target, const LogRows& rows, Places places,
            const std::vector<Eigen::VectorXd>& columns, const std::vector<Eigen::VectorXd>& nuisances)
      : places_(std::move(places)), evidence_(target, blocks_for(target, rows)) {
    evidence_.add(columns);
    Eigen::Index next = evidence_.add(nuisances);
    for (std::size_t k = 0; k < nuisances.size(); ++k) nuisances_.push_back(next++);
  }

  // Indices of columns.
  ColumnIndices run() {
    ColumnIndices chosen;
    while (grow(chosen))
      while (drop(chosen)) continue;
    return chosen;
  }
  // With the nuisances behind the chosen columns.
  Evidence::Fit fit(const ColumnIndices& chosen) const { return evidence_.fit(beside(chosen)); }
  Eigen::MatrixXd covariance(const ColumnIndices& chosen) const {
    return evidence_.covariance(beside(chosen), fit(chosen).coefficients);
  }
  double p_value(const ColumnIndices& chosen, std::size_t term) const {
    const auto fit = this->fit(chosen);
    const auto i = static_cast<Eigen::Index>(term);
    const double variance = covariance(chosen)(i, i);
    const double t = fit.coefficients[i] / std::sqrt(std::max(variance, 1e-300));
    const double freedom =
        std::max(evidence_.bearing_clusters({chosen[term]}, fit.coefficients.segment(i, 1)) - 1.0, 2.0);
    return student_tails(t, freedom);
  }
  double explains(const ColumnIndices& chosen, std::size_t term) const {
    return (fit(without(chosen, term)).left - fit(chosen).left) / evidence_.total();
  }
  std::size_t place(Eigen::Index column) const { return places_[static_cast<std::size_t>(column)]; }

 private:
  static std::vector<RowBlock> blocks_for(const Eigen::VectorXd& target, const LogRows& rows) {
    const auto n = static_cast<double>(rows.rows());
    const double correlation = std::min(correlation_length(target, rows.logs()), 0.1 / rows.period(0));
    return blocks_of(rows.velocity, rows.logs(),
                     static_cast<std::size_t>(std::clamp(6.0 * correlation, n / 100.0, n / 30.0)) + 1);
  }
  ColumnIndices beside(ColumnIndices chosen) const {
    chosen.insert(chosen.end(), nuisances_.begin(), nuisances_.end());
    return chosen;
  }
  static ColumnIndices without(ColumnIndices chosen, std::size_t term) {
    chosen.erase(chosen.begin() + static_cast<std::ptrdiff_t>(term));
    return chosen;
  }
  bool stands(const ColumnIndices& chosen, std::size_t term) const {
    if (most_odds(p_value(chosen, term)) < loss_ratio * static_cast<double>(command_parameters().size())) return false;
    const auto before = evidence_.held_out(beside(without(chosen, term))), after = evidence_.held_out(beside(chosen));
    std::vector<double> gains(before.size());
    double total = 0.0, gained = 0.0;
    for (std::size_t k = 0; k < gains.size(); ++k) {
      gained += gains[k] = before[k] - after[k];
      total += before[k];
    }
    // Not the doing of one odd event.
    const double most = *std::max_element(gains.begin(), gains.end());
    if (!(gained > least_command_gain * total && gained - most > 0.2 * gained)) return false;
    std::vector<bool> half(evidence_.blocks());
    const double whole = fit(chosen).coefficients[static_cast<Eigen::Index>(term)];
    for (const bool first : {true, false}) {
      for (std::size_t k = 0; k < half.size(); ++k) half[k] = (k < half.size() / 2) == first;
      if (evidence_.fit(beside(chosen), half).coefficients[static_cast<Eigen::Index>(term)] * whole < 0.0) return false;
    }
    return true;
  }
  bool grow(ColumnIndices& chosen) const {
    Eigen::Index best = -1;
    double least = fit(chosen).left;
    for (std::size_t k = 0; k < places_.size(); ++k) {
      auto trial = chosen;
      const auto column = static_cast<Eigen::Index>(k);
      if (std::find(chosen.begin(), chosen.end(), column) != chosen.end()) continue;
      trial.push_back(column);
      if (const double left = fit(trial).left; left < least && stands(trial, trial.size() - 1)) {
        least = left;
        best = column;
      }
    }
    if (best < 0) return false;
    chosen.push_back(best);
    return true;
  }
  bool drop(ColumnIndices& chosen) const {
    for (std::size_t k = 0; k + 1 < chosen.size(); ++k)
      if (!stands(chosen, k)) {
        chosen = without(chosen, k);
        return true;
      }
    return false;
  }

  Places places_;
  Evidence evidence_;
  ColumnIndices nuisances_;
};

ColumnIndices all_of(const Places& places) {
  ColumnIndices all;
  for (std::size_t k = 0; k < places.size(); ++k) all.push_back(static_cast<Eigen::Index>(k));
  return all;
}

Selection select(const Commands& commands, const machine::AxisModel& axis, const Eigen::VectorXd& target,
                 const Places& places) {
  return {target, commands.rows(), places, commands.slopes(axis, places), commands.nuisances()};
}

// The chosen parameters' values by replays around them.
std::vector<CommandTerm> refined(const Commands& commands, const machine::AxisModel& axis, const Selection& selection,
                                 const ColumnIndices& chosen) {
  std::vector<CommandTerm> terms;
  Places places;
  if (chosen.empty()) return terms;
  const auto fit = selection.fit(chosen);
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    places.push_back(selection.place(chosen[k]));
    const double value = *command_parameters()[places[k]].value(axis);
    terms.push_back({places[k], value + fit.coefficients[static_cast<Eigen::Index>(k)], 0.0,
                     selection.explains(chosen, k), selection.p_value(chosen, k)});
  }
  for (int round = 0; round < refinements; ++round) {
    for (auto& term : terms) {
      const double file = *command_parameters()[term.place].value(axis);
      if (file > 0.0) term.value = std::clamp(term.value, smallest * file, largest * file);
      if (file == 0.0) term.value = std::max(term.value, 0.0);
    }
    const auto at = with_terms(axis, terms);
    const auto local = select(commands, at, commands.logged() - commands.as_driven(at), places);
    const auto all = all_of(places);
    const auto step = local.fit(all).coefficients;
    const auto covariance = local.covariance(all);
    for (std::size_t k = 0; k < terms.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      terms[k].value += step[i];
      terms[k].deviation = std::sqrt(covariance(i, i));
    }
  }
  return terms;
}

bool usable(const CommandRecords& records, const machine::AxisModel& axis) {
  return std::all_of(records.logs.begin(), records.logs.end(),
                     [&](const Log& log) { return recorded_command(channels_of(log, axis), axis).has_value(); });
}

bool behind_master(const CommandRecords& records, const machine::AxisModel& axis) {
  return std::ranges::all_of(records.logs, [&](const Log& log) { return !channels_of(log, axis).master.empty(); });
}

// Sets by how much each parameter of `terms` seems to differ in the file's own runs of these records: a replay knows no
// positions between the samples, and a smaller gain makes less noise of the encoder's steps.
void look_at_own_runs(const CommandRecords& records, const machine::Timing& timing, const machine::AxisModel& axis,
                      std::vector<CommandTerm>& terms) {
  const CommandRecords own{records.simulated, records.rows, {}};
  if (terms.empty() || own.logs.size() != records.logs.size() || !usable(own, axis)) return;
  Places places;
  for (const auto& term : terms) places.push_back(term.place);
  const Commands commands(own, timing, axis, 0.0);
  const auto fit = select(commands, axis, commands.logged() - commands.as_driven(axis), places).fit(all_of(places));
  for (std::size_t k = 0; k < terms.size(); ++k) terms[k].in_own_run = fit.coefficients[static_cast<Eigen::Index>(k)];
}

Finding finding_of(const machine::AxisModel& file, sim::EffectId effect, const std::vector<CommandTerm>& terms) {
  Finding finding(effect);
  finding.axis = file.name;
  finding.residual = Residual::command;
  for (const auto& known : file.effects)
    if (sim::find_effect(known.name) == effect) finding.values = known.values;
  for (const auto& term : terms) {
    const auto& p = command_parameters()[term.place];
    if (p.effect != effect) continue;
    finding.values[p.key] = {term.value};
    finding.parameters.push_back(effect_parameter(file, effect, p.key, {term.value}, {term.deviation}));
    finding.explains += term.explains;
    finding.p_value = std::min(finding.p_value, term.p_value);
  }
  return finding;
}

// The current's record that is late looks like a delay in the loop, but shows in the residual force too.
bool is_record_delay(const RecordDelay& delay, double loop_delay) {
  return std::abs(delay.estimate) > 2.0 * delay.deviation &&
         std::abs(delay.estimate - loop_delay) < std::abs(delay.estimate);
}

void judge_held_out(Verdict& verdict, std::vector<Finding>& findings, const Commands& held_out,
                    const machine::AxisModel& axis, const std::vector<CommandTerm>& terms, std::uint64_t seed) {
  const auto residual_with = [&](const machine::AxisModel& each) {
    return Eigen::VectorXd(held_out.logged() - held_out.as_driven(each));
  };
  const auto before = residual_with(axis);
  verdict.baseline.command_rms = rms(before);
  if (axis.motor.driven_by_volts()) verdict.command_unit = std::string("V");
  verdict.extended.command_rms = verdict.baseline.command_rms;
  if (findings.empty()) return;
  const auto after = residual_with(with_terms(axis, terms));
  verdict.extended.command_rms = rms(after);
  for (auto& finding : findings) {
    const auto other = findings.size() == 1 ? before : residual_with(with_terms(axis, terms, finding.effect));
    finding.holdout.command_rms_ratio = rms(after) / rms(other);
    finding.holdout.ci95 = ratio_interval(after, other, held_out.rows(), seed);
  }
}

void find_and_judge(Verdict& verdict, const DiagnoseInput& input, const CommandRecords& training,
                    const CommandRecords& held_out, const RecordDelay& delay, const machine::AxisModel& axis) {
  const auto& file = input.machine.axes[input.axis];
  const auto& timing = input.machine.timing;
  Places places;
  const bool slave = behind_master(training, axis) && behind_master(held_out, axis);
  for (std::size_t k = 0; k < command_parameters().size(); ++k)
    if (const auto& p = command_parameters()[k]; p.value(axis) && (slave || !p.of_master)) places.push_back(k);
  // A delay of the record that the residual force names is taken out where the command, whatever the gains, agrees.
  const Commands as_recorded(training, timing, axis, 0.0), moved(training, timing, axis, delay.found);
  const auto replayed = as_recorded.as_driven(axis);
  const auto slopes = as_recorded.slopes(axis, places);
  const auto selection_of = [&](const Commands& each) {
    return Selection(each.logged() - replayed, each.rows(), places, slopes, each.nuisances());
  };
  const auto left_by = [&](const Commands& each) { return selection_of(each).fit(all_of(places)).left; };
  const bool late = delay.found != 0.0 && left_by(moved) < left_by(as_recorded);
  const Commands& commands = late ? moved : as_recorded;
  const Commands held(held_out, timing, axis, late ? delay.found : 0.0);
  const Eigen::VectorXd target = commands.logged() - replayed;

  auto selection = selection_of(commands);
  const auto chosen = selection.run();
  auto terms = refined(commands, axis, selection, chosen);
  const Eigen::VectorXd left = terms.empty() ? target : commands.logged() - commands.as_driven(with_terms(axis, terms));
  if (rms(left) > foreign * rms(commands.logged())) {
    verdict.notes.push_back(
        fmt::format("No gains of the controller in the machine file reproduce the recorded command from the recorded "
                    "set-points and positions: {:.0f} % of its rms value above {:g} Hz remain. Controller, filters or "
                    "set-points of the drive differ from the machine file; the gains were not evaluated.",
                    100.0 * rms(left) / rms(commands.logged()), slowest));
    return;
  }
  look_at_own_runs(training, timing, axis, terms);
  std::erase_if(terms, [&](const CommandTerm& term) {
    const auto& p = command_parameters()[term.place];
    const double change = term.value - *p.value(axis);
    if (term.in_own_run / change > of_own_run) return true;
    if (p.is_delay) return change <= 0.0 || is_record_delay(delay, change);
    const double ratio = term.value / *p.value(axis);
    return std::abs(ratio - 1.0) < least_change || ratio < smallest || ratio > largest;
  });

  std::vector<Finding> findings;
  for (const auto& parameter : command_parameters())
    if (std::none_of(findings.begin(), findings.end(),
                     [&](const Finding& f) { return f.effect == parameter.effect; }) &&
        std::any_of(terms.begin(), terms.end(),
                    [&](const CommandTerm& t) { return command_parameters()[t.place].effect == parameter.effect; }))
      findings.push_back(finding_of(file, *parameter.effect, terms));
  judge_held_out(verdict, findings, held, axis, terms, input.seed);
  for (auto& finding : findings) {
    if (const auto& [least, most] = finding.holdout.ci95; most >= 1.0) {
      verdict.rejected.push_back(
          {finding.effect, fmt::format("withdrawn: found in the command residual of the training data, but on held-out "
                                       "data without a certain gain: {:.4g} times the residual without it, {:.4g} to "
                                       "{:.4g} with 95 %",
                                       *finding.holdout.command_rms_ratio, least, most)});
      continue;
    }
    finding.evidence = fmt::format(
        "Explains {:.1f} % of the variance of the command residual (recorded command minus that of the controller in "
        "the machine file for the recorded set-points and positions); it has no effect on the residual force.",
        100.0 * finding.explains);
    const auto same = std::find_if(verdict.findings.begin(), verdict.findings.end(),
                                   [&](const Finding& f) { return f.effect == finding.effect; });
    if (same == verdict.findings.end()) {
      verdict.findings.push_back(std::move(finding));
      continue;
    }
    // A delay of the record and one of the loop are keys of one effect.
    same->values.merge(finding.values);
    for (const auto& parameter : finding.parameters) same->values[parameter.key] = parameter.values;
    same->parameters.insert(same->parameters.end(), finding.parameters.begin(), finding.parameters.end());
    same->evidence += " " + finding.evidence;
  }
  std::stable_sort(verdict.findings.begin(), verdict.findings.end(), told_before);
}

}  // namespace

void judge_command(Verdict& verdict, const DiagnoseInput& input, const CommandRecords& training,
                   const CommandRecords& held_out, const RecordDelay& delay) {
  auto axis = sim::drive_axis(input.machine.axes[input.axis]);
  // What the drive has of them is in its parameters now.
  std::erase_if(axis.effects, [](const machine::Effect& effect) {
    const auto known = sim::find_effect(effect.name);
    return known && (*known)->law.change_drive != nullptr;
  });
  if (!usable(training, axis) || !usable(held_out, axis)) return;
  try {
    find_and_judge(verdict, input, training, held_out, delay, axis);
  } catch (const LogError& error) {
    verdict.notes.push_back(fmt::format("The gains of the drive were not evaluated: {}.", error.what()));
  }
}

}  // namespace stiction::host
