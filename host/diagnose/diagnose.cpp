#include "host/diagnose/diagnose.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include "firmware/machine/model/motor_force.hpp"
#include "host/diagnose/classes/candidate_columns.hpp"
#include "host/diagnose/describe/diagnosis_charts.hpp"
#include "host/diagnose/describe/residual_diagnostics.hpp"
#include "host/diagnose/judge/closed_loop.hpp"
#include "host/diagnose/judge/closed_loop_description.hpp"
#include "host/diagnose/judge/command_residual.hpp"
#include "host/diagnose/judge/holdout.hpp"
#include "host/diagnose/next_measurement/next_measurement.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/diagnose/record/record_checks.hpp"
#include "host/diagnose/record/record_rows.hpp"
#include "host/diagnose/record/replay_setup.hpp"
#include "host/diagnose/search/search.hpp"
#include "host/diagnose/search/second_band.hpp"
#include "host/diagnose/statistics/noise_model.hpp"
#include "host/identify/identification.hpp"
#include "host/identify/own_identification.hpp"
#include "host/identify/standstill.hpp"
#include "host/identify/suitability.hpp"
#include "sim/effects/effects.hpp"
#include "sim/effects/force_map/force_map.hpp"
#include "sim/effects/time_skew/time_skew.hpp"

namespace stiction::host {
namespace {

constexpr double of_training = 0.1;  // residuals hold more than noise: a p-value claims too much
constexpr double shortest = 3.0;     // s, of the training logs together
SearchContext context_of(const machine::AxisModel& axis, const LogRows& rows, const SignalSettings& settings) {
  SearchContext context;
  context.axis = axis;
  context.signals = settings;
  context.reversals = excitation_of(rows).reversals;
  context.force_is_current = context.other_axis = true;
  context.lowest_position = context.highest_position = rows.motions().front().x.front();
  for (const auto& motion : rows.motions()) {
    context.force_is_current = context.force_is_current && motion.force_is_current;
    context.other_axis = context.other_axis && !motion.other_a.empty();
    for (const double force : force_along(axis, motion))
      context.highest_force = std::max(context.highest_force, std::abs(force));
    context.duration = std::max(context.duration, motion.t.back() - motion.t.front());
    for (std::size_t i = 0; i < motion.x.size(); ++i) {
      context.highest_speed = std::max(context.highest_speed, std::abs(motion.v[i]));
      context.lowest_position = std::min(context.lowest_position, motion.x[i]);
      context.highest_position = std::max(context.highest_position, motion.x[i]);
    }
  }
  return context;
}

// The pair that no motion of this axis alone separates; else of the alias table and beside it what the data show.
std::vector<ConfusedWith> confused_with(const Term& term) {
  std::vector<ConfusedWith> list;
  const auto known = sim::confusions_of(*candidates()[term.candidate].effect);
  for (const auto& confusion : known)
    if (confusion.always) list.push_back({confusion.other, std::string(confusion.separate_by), true});
  for (const auto& [candidate, probability] : term.alternatives) {
    if (candidates()[candidate].outside()) continue;
    const sim::EffectId other = *candidates()[candidate].effect;
    if (std::any_of(list.begin(), list.end(), [&](const ConfusedWith& l) { return l.effect == other; })) continue;
    const auto alias = std::find_if(known.begin(), known.end(), [&](const auto& a) { return a.other == other; });
    list.push_back({other,
                    alias != known.end() ? std::string(alias->separate_by)
                                         : "record longer, with different speeds, accelerations and strokes: in "
                                           "these records both explain the residual equally well",
                    false, probability});
  }
  return list;
}

std::string repeated(const HeldOutAmplitude& held_out_amplitude) {
  return fmt::format("{:.2f} +- {:.2f}", held_out_amplitude.size, held_out_amplitude.deviation);
}

std::string evidence_of(const Term& term, const HeldOutAmplitude& held_out_amplitude, std::size_t blocks) {
  const auto& j = term.judgement;
  return fmt::format(
      "Explains {:.1f} % of the residual variance given the other findings ({:.1f} % cross-validated), p = {:.2g} from "
      "{} blocks of rows. Amplitude in the first half of the blocks: {:.2f} of the fitted one, in the second half: "
      "{:.2f}. Held-out amplitude: {} of the fitted one{}.",
      100.0 * term.explains, 100.0 * j.gain, j.p_value, blocks, j.first_half, j.second_half,
      repeated(held_out_amplitude),
      held_out_amplitude.against() < 0.0 ? "" : ", which neither confirms nor refutes it");
}

// What the data say for a finding that has its parameters.
void give_evidence(Finding& finding, const Term& term, const HoldoutGain& gain,
                   const HeldOutAmplitude& held_out_amplitude, std::size_t blocks) {
  finding.explains = term.explains;
  finding.holdout = gain;
  finding.p_value = term.judgement.p_value;
  finding.probability = term.probability;
  finding.confused_with = confused_with(term);
  finding.evidence = evidence_of(term, held_out_amplitude, blocks);
}

// What the residual force says of a current that is recorded late: by a cause found, and in what is left.
RecordDelay record_delay(const LogRows& rows, const SearchContext& context, const SearchResult& found) {
  RecordDelay delay;
  const auto skew = *candidate_index(sim::id_of<sim::TimeSkew>());
  for (const auto& term : found.terms)
    if (term.candidate == skew) delay.found = term.coefficients[0];
  Evidence evidence(found.residual,
                    blocks_of(rows.velocity, rows.logs(), static_cast<std::size_t>(rows.rows() / 60 + 1)));
  evidence.add(group_columns(rows, context, candidates()[skew], 1e-4));
  delay.estimate = evidence.fit({0}).coefficients[0];
  delay.deviation = std::sqrt(evidence.covariance({0}, evidence.fit({0}).coefficients)(0, 0));
  return delay;
}

// Up to where held-out records may speak against a term (Repetition::against) that stays: not at all, where they would
// know it; else a small part of what the training records say for it, by the most that its p-value can mean as a Bayes
// factor (Sellke, Bayarri, Berger, Am. Stat. 55, 2001) among so many candidates: records on which it hardly acts speak
// by chance.
double most_against(const Term& term, const HeldOutAmplitude& held_out_amplitude) {
  if (!held_out_amplitude.may_be_all()) return 0.0;
  const double p = std::clamp(term.judgement.p_value, 1e-300, 0.1);
  const double chance = -std::numbers::e * p * std::log(p) * static_cast<double>(candidates().size());
  return std::max(-2.0 * of_training * std::log(chance), 0.0);
}

std::vector<Term> joined(std::vector<Term> terms, std::span<const Term> more) {
  terms.insert(terms.end(), more.begin(), more.end());
  return terms;
}

// Withdraws the term that held-out data speak against most, until they do against none and not against all of them
// together. Returns the candidates that were withdrawn. `maps`: terms without a name that the machine is extended by,
// beside them.
std::vector<std::size_t> keep_what_holds(const LogRows& rows, const Eigen::VectorXd& target,
                                         const SearchContext& context, std::vector<Term>& terms,
                                         std::span<const Term> maps, Verdict& verdict, std::uint64_t seed) {
  std::vector<std::size_t> withdrawn;
  for (;;) {
    if (terms.empty()) return withdrawn;
    const auto figures = evaluate_held_out(rows, target, context, joined(terms, maps), seed);
    std::vector<double> too_much;
    for (std::size_t k = 0; k < terms.size(); ++k)
      too_much.push_back(figures.held_out_amplitudes[k].against() -
                         most_against(terms[k], figures.held_out_amplitudes[k]));
    const auto worst =
        static_cast<std::size_t>(std::distance(too_much.begin(), std::max_element(too_much.begin(), too_much.end())));
    // Each may gain beside the others and all of them together lose: wrong names that lean on each other.
    const bool holds_alone = too_much[worst] < 0.0;
    if (holds_alone && (terms.size() == 1 || figures.together.against() < 0.0)) return withdrawn;
    const auto& term = terms[worst];
    const auto& candidate = candidates()[term.candidate];
    withdrawn.push_back(term.candidate);
    verdict.rejected.push_back(
        {*candidate.effect,
         fmt::format(
             "withdrawn: found in the training data, but without improvement on held-out data: held-out amplitude {} "
             "of the fitted one{}, residual force {:.4f} times that without it",
             repeated(holds_alone ? figures.together : figures.held_out_amplitudes[worst]),
             holds_alone ? ", together with all other findings" : "",
             holds_alone ? figures.force_extended / figures.force_baseline : figures.gains[worst].force_rms_ratio)});
    terms.erase(terms.begin() + static_cast<std::ptrdiff_t>(worst));
  }
}

std::string why_motion_is_measured(const DiagnoseInput& input) {
  auto all = input.logs;
  all.insert(all.end(), input.held_out.begin(), input.held_out.end());
  const auto refused = why_not_simulated(input.machine, input.axis, all);
  return fmt::format(
      "{} The regressors were computed from the measured motion, which contains the response of the control loop to "
      "the disturbances.{}",
      refused.empty() ? "The logs have no set-points, or the simulation could not follow them." : refused + ".",
      refused.empty() ? " Log x_set." : "");
}

// Takes the terms without a name out of those that were found.
std::vector<Term> take_unnamed(SearchResult& found) {
  const auto first = std::stable_partition(found.terms.begin(), found.terms.end(),
                                           [](const Term& term) { return !candidates()[term.candidate].outside(); });
  std::vector<Term> unnamed(std::make_move_iterator(first), std::make_move_iterator(found.terms.end()));
  found.terms.erase(first, found.terms.end());
  return unnamed;
}

// Those that a table of the machine file holds.
std::vector<Term> maps_of(const std::vector<Term>& unnamed) {
  std::vector<Term> maps;
  std::copy_if(unnamed.begin(), unnamed.end(), std::back_inserter(maps),
               [](const Term& term) { return candidates()[term.candidate].has_map(); });
  return maps;
}

Finding map_finding(const SearchContext& context, const Term& term, const HoldoutGain& gain,
                    const HeldOutAmplitude& held_out_amplitude) {
  const auto& candidate = candidates()[term.candidate];
  Finding finding(sim::id_of<sim::ForceMap>());
  finding.axis = context.axis.name;
  candidate.describe(context, term.shape, term.coefficients, term.covariance, finding);
  finding.explains = term.explains;
  finding.holdout = gain;
  finding.p_value = term.judgement.p_value;
  finding.probability = term.probability;
  finding.evidence =
      fmt::format("{}. Held-out amplitude: {} of the fitted one.",
                  candidate.looks_like(context, term.shape, term.coefficients), repeated(held_out_amplitude));
  return finding;
}

Unexplained unexplained_by(const SearchContext& context, const std::vector<Term>& unnamed) {
  Unexplained unexplained;
  std::vector<std::string> words;
  for (const auto& term : unnamed) {
    unexplained.share += term.explains;
    words.push_back(candidates()[term.candidate].looks_like(context, term.shape, term.coefficients));
  }
  if (!words.empty()) unexplained.signature = fmt::format("{}", fmt::join(words, "; and "));
  return unexplained;
}

double rms_about_mean(const Eigen::VectorXd& values, const Eigen::VectorXd& counts) {
  const Eigen::VectorXd centred = values.array() - values.mean();
  return std::sqrt(centred.cwiseProduct(counts).squaredNorm() / static_cast<double>(std::max<long>(values.size(), 1)));
}

void judge_agreement(Verdict& verdict, const NoiseFloor& floor, double record_force_rms) {
  verdict.noise_floor = floor;
  verdict.agreement = agreement_of({verdict.extended.force_rms, verdict.extended.position_error_rms, floor.force(),
                                    floor.position, record_force_rms},
                                   verdict.closed_loop_withheld, verdict.units);
}

}  // namespace

Verdict diagnose(const DiagnoseInput& input) {
  auto axis = sim::plant_axis(input.machine.axes.at(input.axis));
  axis.motor.force_constant = machine::acting_force_constant(axis.motor);  // true values are told against what acts
  const auto settings = wide_band();
  const auto begin = [&](std::size_t part) {
    if (input.progress) input.progress(diagnosis_parts[part]);
  };
  Verdict verdict;
  verdict.axis = axis.name;
  verdict.units = ShownUnits(axis.coordinate);
  verdict.machine = input.machine.id + ".toml";
  for (const auto* records : {&input.logs, &input.held_out})
    for (auto& question : questions_before(*records, axis)) verdict.questions.push_back(std::move(question));
  auto logs = linear_logs(input.logs, input.machine.axes);
  auto held_out = linear_logs(input.held_out, input.machine.axes);
  for (auto* records : {&logs, &held_out})
    for (auto& log : *records) count_from_start(log);
  for (const auto& log : logs) verdict.logs.push_back(log.source);
  for (const auto& log : held_out) verdict.holdout.push_back(log.source);
  for (const auto* records : {&logs, &held_out})
    for (const auto& log : *records)
      for (const auto& note : log.notes) verdict.notes.push_back(fmt::format("{}: {}", log.source, note));
  for (const auto& log : logs) refuse_unreachable_set_points(log, axis);
  for (const auto& log : held_out) refuse_unreachable_set_points(log, axis);
  refuse_same_record(logs, held_out, axis);
  if (held_out.empty()) {
    verdict.holdout_is_a_part = true;
    verdict.notes.push_back(
        "No held-out log was given: the first two thirds of each log were used for the search and the last third for "
        "validation. Effects that repeat with the motion in both can still be taken for a cause. Record a different "
        "trajectory, with different speeds, stroke and accelerations, and give it with --holdout.");
    for (auto& log : logs) {
      const std::size_t cut = log.t.size() * 2 / 3;
      held_out.push_back(part_of(log, cut, log.t.size()));
      log = part_of(log, 0, cut);
    }
  }
  const auto rows = rows_of(logs, axis, settings);
  const auto held_rows = rows_of(held_out, axis, settings);
  if (excitation_of(rows).duration < shortest)
    throw LogError(fmt::format("{}: found {:.3g} s of training data; expected at least {:g} s",
                               sources_of(rows.motions()), excitation_of(rows).duration, shortest));
  const auto expected = expected_force(rows, axis);
  refuse_other_units(rows, expected);
  refuse_other_units(held_rows, expected_force(held_rows, axis));
  if (const auto note = suspected_file(rows, expected); !note.empty()) verdict.notes.push_back(note);

  Eigen::VectorXd target = rows.force - expected;
  Eigen::VectorXd held_target = held_rows.force - expected_force(held_rows, axis);
  auto context = context_of(axis, rows, settings);
  context.timing = input.machine.timing;
  begin(0);
  auto simulated = without_noise(input.machine, input.axis, logs);
  const auto held_simulated =
      simulated.motion.empty() ? WithoutNoise{} : without_noise(input.machine, input.axis, held_out);
  const bool known_motion = !held_simulated.motion.empty();
  if (!known_motion) verdict.notes.push_back(why_motion_is_measured(input));
  auto regressors = known_motion ? rows_of(simulated.motion, axis, settings) : rows;
  auto held_regressors = known_motion ? rows_of(held_simulated.motion, axis, settings) : held_rows;
  if (known_motion) {
    target -= own_residual(simulated.replayed, logs, axis, settings);
    held_target -= own_residual(held_simulated.replayed, held_out, axis, settings);
  }
  regressors.weigh(moving_rows(regressors, axis, settings.cutoff));
  held_regressors.weigh(moving_rows(held_regressors, axis, settings.cutoff));
  target = target.cwiseProduct(regressors.counts());
  held_target = held_target.cwiseProduct(held_regressors.counts());
  context.highest_residual = target.cwiseAbs().maxCoeff();
  std::vector<EffectResponse> responses;
  if (known_motion) {
    auto all = logs;
    all.insert(all.end(), held_out.begin(), held_out.end());
    auto& replayed = simulated.replayed;
    replayed.insert(replayed.end(), held_simulated.replayed.begin(), held_simulated.replayed.end());
    responses.emplace_back(input.machine, input.axis, all, settings, QuantizerLimitCycle::simulated, replayed);
    responses.emplace_back(input.machine, input.axis, all, settings, QuantizerLimitCycle::smoothed);
    context.disturb = [&, all](const Eigen::VectorXd& force) {
      context.response = EffectResponse(input.machine, input.axis, all, settings,
                                        Disturbance(force, rows.logs(), rows.period(0)), replayed);
    };
    context.disturb(target);
    EffectResponse own(input.machine, input.axis, all, settings, Disturbance(target, rows.logs(), rows.period(0)),
                       replayed);
    const auto of_disturbance = [&own](const Motion& motion) { return own.of_disturbance(motion); };
    // Where the record is quieter than what is left of it would make it, the runs in silence are the nearer ones.
    const Eigen::VectorXd disturbed = target - regressors.stacked(of_disturbance).cwiseProduct(regressors.counts());
    if (noise_log_likelihood(disturbed, rows.logs()) > noise_log_likelihood(target, rows.logs())) {
      target = disturbed;
      held_target -= held_regressors.stacked(of_disturbance).cwiseProduct(held_regressors.counts());
    }
  }
  begin(1);
  const bool resolved = target.norm() > resolution_of_dynamics * expected.norm();
  if (!resolved)
    verdict.notes.push_back(fmt::format(
        "The residual force of these records is {:.2g} % of the expected force, less than the {:g} % that inverse "
        "dynamics can resolve: causes were not looked for in it.",
        100.0 * target.norm() / expected.norm(), 100.0 * resolution_of_dynamics));
  auto found = resolved ? search_causes(regressors, target, context) : SearchResult{{}, {}, target};
  begin(2);
  auto unnamed = take_unnamed(found);
  const auto describe = [&](std::vector<Term> named, std::vector<Term> without_name) {
    return describe_in_closed_loop(std::move(named), std::move(without_name), responses, regressors, target,
                                   found.residual, context);
  };
  auto described = describe(std::move(found.terms), std::move(unnamed));
  auto maps = maps_of(described.unnamed);
  begin(3);
  const auto withdrawn =
      keep_what_holds(held_regressors, held_target, context, described.terms, maps, verdict, input.seed);
  if (!withdrawn.empty()) described = describe(std::move(described.terms), std::move(described.unnamed));
  found.terms = std::move(described.terms);
  verdict.findings = std::move(described.findings);
  for (const auto& remainder : described.remainders)
    if (const auto& candidate = candidates()[remainder.candidate]; !candidate.outside())
      verdict.rejected.push_back(
          {*candidate.effect, "the other findings, described in closed loop, leave nothing of it"});
  Eigen::VectorXd inside = target;
  for (const auto& term : described.unnamed)
    inside -= weighted_columns(regressors, context, candidates()[term.candidate], term.shape, term.coefficients);
  maps = maps_of(described.unnamed);
  auto figures = evaluate_held_out(held_regressors, held_target, context, joined(found.terms, maps), input.seed);
  for (std::size_t k = 0; k < maps.size();) {
    if (figures.held_out_amplitudes[found.terms.size() + k].against() < 0.0) {
      ++k;
      continue;
    }
    maps.erase(maps.begin() + static_cast<std::ptrdiff_t>(k));
    figures = evaluate_held_out(held_regressors, held_target, context, joined(found.terms, maps), input.seed);
    k = 0;
  }
  verdict.baseline.force_rms = figures.force_baseline;
  verdict.extended.force_rms = figures.force_extended;
  for (std::size_t k = 0; k < found.terms.size(); ++k)
    give_evidence(verdict.findings[k], found.terms[k], figures.gains[k], figures.held_out_amplitudes[k], found.blocks);
  for (std::size_t k = 0; k < maps.size(); ++k)
    verdict.findings.push_back(map_finding(context, maps[k], figures.gains[found.terms.size() + k],
                                           figures.held_out_amplitudes[found.terms.size() + k]));
  compare_bands(verdict, found.terms, regressors, inside, context);
  add_cause_charts(verdict, regressors, context, joined(found.terms, maps), found.residual);
  begin(4);
  propose_next_measurement(verdict, {input.machine, input.axis, settings, regressors, inside, context, found},
                           input.next_measurement);
  const auto& judged = input.machine.axes[input.axis];
  if (judged.elastic() && judged.velocity_encoder)
    verdict.notes.push_back(
        "The gains of the drive were not evaluated: its velocity controller sees a different encoder than the recorded "
        "one, with an elastic shaft between them.");
  else if (judged.cascaded())
    judge_command(verdict, input, {logs, rows}, {held_out, held_rows}, record_delay(regressors, context, found));
  for (const auto& d : found.discarded) verdict.rejected.push_back({*candidates()[d.candidate].effect, d.why});
  if (!described.unnamed.empty())
    verdict.unexplained = unexplained_by(context, described.unnamed);
  else if (resolved && withdrawn.empty())
    verdict.unexplained =
        signature_of(regressors, found.residual, target.squaredNorm(), found.correlation, verdict.units);
  add_charts(verdict, rows, target, found.residual);
  begin(5);
  if (input.closed_loop) judge_in_closed_loop(verdict, input.machine, input.axis, held_out);
  const auto& counts = held_regressors.counts();
  const auto floor = noise_floor(held_out, axis, settings, counts, held_simulated.replayed,
                                 expected_force(held_rows, axis), input.seed);
  judge_agreement(verdict, floor, rms_about_mean(held_rows.force, counts));
  return verdict;
}

}  // namespace stiction::host
