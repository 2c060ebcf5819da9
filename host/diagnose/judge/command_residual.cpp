#include "host/diagnose/judge/command_residual.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/diagnose/classes/command_parameter.hpp"
#include "host/diagnose/judge/command_search.hpp"
#include "host/diagnose/judge/holdout.hpp"
#include "host/diagnose/record/command_replay.hpp"
#include "host/diagnose/statistics/level.hpp"
#include "host/identify/identification.hpp"
#include "host/identify/regression.hpp"
#include "sim/effects/effects.hpp"

namespace stiction::host {
namespace {

// The rest of a command that is another controller's, over the command itself.
constexpr double foreign = 0.3;
bool usable(const CommandRecords& records, const machine::AxisModel& axis) {
  return std::all_of(records.logs.begin(), records.logs.end(),
                     [&](const Log& log) { return recorded_command(channels_of(log, axis), axis).has_value(); });
}

bool behind_master(const CommandRecords& records, const machine::AxisModel& axis) {
  return std::ranges::all_of(records.logs, [&](const Log& log) { return !channels_of(log, axis).master.empty(); });
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
    finding.p_value = std::min(finding.p_value, term.p_value);
  }
  return finding;
}

// The current's record that is late looks like a delay in the loop, but shows in the residual force too.
bool is_record_delay(const RecordDelay& delay, double loop_delay) {
  return std::abs(delay.estimate) > 2.0 * delay.deviation &&
         std::abs(delay.estimate - loop_delay) < std::abs(delay.estimate);
}

std::vector<CommandTerm> without_effect(const std::vector<CommandTerm>& terms, sim::EffectId effect) {
  auto rest = terms;
  std::erase_if(rest,
                [&](const CommandTerm& term) { return command_parameters()[term.place].effect.value() == effect; });
  return rest;
}

// What the drive with some of the terms leaves of a command.
class LeftWith {
 public:
  LeftWith(const CommandRows& commands, const Whitening& noise, const std::vector<CommandTerm>& terms)
      : commands_(commands), noise_(noise), terms_(terms), file_(left({})), all_(terms.empty() ? file_ : left(terms)) {}

  const Eigen::VectorXd& file() const { return file_; }
  const Eigen::VectorXd& all() const { return all_; }
  // Whitened, without each log's nuisances: with all terms, and with those of other effects than this.
  struct Pair {
    Eigen::VectorXd with, without;
  };
  Pair about(sim::EffectId effect) const {
    const auto rest = without_effect(terms_, effect);
    return {white(all_), white(rest.empty() ? file_ : left(rest))};
  }

 private:
  Eigen::VectorXd left(const std::vector<CommandTerm>& terms) const {
    return commands_.logged() - commands_.as_driven(with_terms(commands_.axis(), terms));
  }
  Eigen::VectorXd white(const Eigen::VectorXd& values) const {
    return whitened_without_nuisances(commands_, values, noise_);
  }

  const CommandRows& commands_;
  const Whitening& noise_;
  const std::vector<CommandTerm>& terms_;
  Eigen::VectorXd file_, all_;
};

// What each finding takes off the command of the training records and of the held-out ones.
void give_figures(Verdict& verdict, std::vector<Finding>& findings, const CommandRows& training,
                  const CommandRows& held_out, const CommandSearch& found, std::uint64_t seed) {
  const LeftWith in_held_out(held_out, found.noise, found.terms);
  if (held_out.axis().motor.driven_by_volts()) verdict.command_unit = std::string("V");
  verdict.baseline.command_rms = rms(held_out.shown(in_held_out.file()));
  verdict.extended.command_rms = rms(held_out.shown(in_held_out.all()));
  if (findings.empty()) return;
  const LeftWith in_training(training, found.noise, found.terms);
  for (auto& finding : findings) {
    const auto trained = in_training.about(finding.effect), held = in_held_out.about(finding.effect);
    finding.explains = 1.0 - trained.with.squaredNorm() / trained.without.squaredNorm();
    finding.holdout.command_rms_ratio = rms(held.with) / rms(held.without);
    finding.holdout.ci95 = ratio_interval(held.with, held.without, held_out.rows(), seed);
  }
}

// How often chance may give one parameter to a drive that has none.
double level_of_each() { return level_of_design / static_cast<double>(command_parameters().size()); }

// That held-out records gain as much by chance, from the interval of the ratio.
double chance_of_gain(const HoldoutGain& gain) {
  const double deviation = (gain.ci95[1] - gain.ci95[0]) / (2.0 * normal_limit);
  return 0.5 * std::erfc((1.0 - *gain.command_rms_ratio) / std::max(deviation, 1e-12) / std::numbers::sqrt2);
}

// Those of the terms that say something of the drive.
void drop_artefacts(std::vector<CommandTerm>& terms, const machine::AxisModel& axis, const RecordDelay& delay) {
  std::erase_if(terms, [&](const CommandTerm& term) {
    const auto& p = command_parameters()[term.place];
    const double change = term.value - *p.value(axis);
    if (p.is_delay) return change <= 0.0 || (!p.of_master && is_record_delay(delay, change));
    const double ratio = term.value / *p.value(axis);
    return ratio <= least_of_file || ratio >= most_of_file;
  });
}

// And those that records of the exact machine seem to have too, which the verdict says.
void drop_what_exact_records_have(std::vector<CommandTerm>& terms, Verdict& verdict) {
  std::erase_if(terms, [&](const CommandTerm& term) {
    if (term.p_of_exact <= level_of_each()) return false;
    const auto& parameter = command_parameters()[term.place];
    verdict.rejected.push_back(
        {*parameter.effect, fmt::format("the command residual seems to have a different {}, but records of the machine "
                                        "as its file says show as much, or could not be made",
                                        parameter.key)});
    return true;
  });
}

void find_and_judge(Verdict& verdict, const DiagnoseInput& input, const CommandRecords& training,
                    const CommandRecords& held_out, const RecordDelay& delay, const ExactLogs& exact,
                    const machine::AxisModel& axis) {
  const auto& file = input.machine.axes[input.axis];
  const auto& timing = input.machine.timing;
  Places places;
  const bool slave = behind_master(training, axis) && behind_master(held_out, axis);
  for (std::size_t k = 0; k < command_parameters().size(); ++k)
    if (const auto& p = command_parameters()[k]; p.value(axis) && (slave || !p.of_master)) places.push_back(k);
  // A delay of the record that the residual force names is taken out where the command, whatever the gains, agrees.
  const CommandRows as_recorded(training, timing, axis, 0.0), moved(training, timing, axis, delay.found);
  const bool late = delay.found != 0.0 && likelihood_of_rest(moved, places) > likelihood_of_rest(as_recorded, places);
  const CommandRows& commands = late ? moved : as_recorded;
  const CommandRows held(held_out, timing, axis, late ? delay.found : 0.0);

  auto found = search_command(commands, places);
  const double rest = rms(commands.shown(found.left)), whole = rms(commands.shown(commands.logged()));
  if (rest > foreign * whole) {
    verdict.notes.push_back(
        fmt::format("No gains of the controller in the machine file reproduce the recorded command from the recorded "
                    "set-points and positions: {:.0f} % of its rms value above {:g} Hz remain. Controller, filters or "
                    "set-points of the drive differ from the machine file; the gains were not evaluated.",
                    100.0 * rest / whole, slowest_shown));
    return;
  }
  auto& terms = found.terms;
  compare_with_exact(training, commands, exact, found);
  drop_artefacts(terms, axis, delay);
  drop_what_exact_records_have(terms, verdict);

  std::vector<Finding> findings;
  for (const auto& parameter : command_parameters())
    if (std::none_of(findings.begin(), findings.end(),
                     [&](const Finding& f) { return f.effect == parameter.effect; }) &&
        std::any_of(terms.begin(), terms.end(),
                    [&](const CommandTerm& t) { return command_parameters()[t.place].effect == parameter.effect; }))
      findings.push_back(finding_of(file, *parameter.effect, terms));
  give_figures(verdict, findings, commands, held, found, input.seed);
  for (auto& finding : findings) {
    if (const auto& [least, most] = finding.holdout.ci95; chance_of_gain(finding.holdout) > level_of_each()) {
      verdict.rejected.push_back(
          {finding.effect, fmt::format("withdrawn: found in the command residual of the training data, but on held-out "
                                       "data its gain may be chance: {:.4g} times the residual without it, {:.4g} to "
                                       "{:.4g} with 95 %, and {} parameters were tried",
                                       *finding.holdout.command_rms_ratio, least, most, command_parameters().size())});
      continue;
    }
    finding.evidence = fmt::format(
        "Explains {:.1f} % of the variance of the command residual (recorded command minus that of the controller in "
        "the machine file for the recorded set-points and positions, each frequency weighed by its noise); it has no "
        "effect on the residual force.",
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
                   const CommandRecords& held_out, const RecordDelay& delay, const ExactLogs& exact) {
  auto axis = sim::drive_axis(input.machine.axes[input.axis]);
  // What the drive has of them is in its parameters now.
  std::erase_if(axis.effects, [](const machine::Effect& effect) {
    const auto known = sim::find_effect(effect.name);
    return known && (*known)->law.change_drive != nullptr;
  });
  if (!usable(training, axis) || !usable(held_out, axis)) return;
  try {
    find_and_judge(verdict, input, training, held_out, delay, exact, axis);
  } catch (const LogError& error) {
    verdict.notes.push_back(fmt::format("The gains of the drive were not evaluated: {}.", error.what()));
  }
}

}  // namespace stiction::host
