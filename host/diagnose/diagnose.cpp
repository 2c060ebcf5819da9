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
#include "host/diagnose/judge/closed_loop_refinement.hpp"
#include "host/diagnose/judge/command_residual.hpp"
#include "host/diagnose/judge/holdout.hpp"
#include "host/diagnose/next_measurement/next_measurement.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/diagnose/record/record_checks.hpp"
#include "host/diagnose/record/record_rows.hpp"
#include "host/diagnose/record/replay_setup.hpp"
#include "host/diagnose/search/search.hpp"
#include "host/diagnose/search/second_band.hpp"
#include "host/identify/identification.hpp"
#include "host/identify/own_identification.hpp"
#include "host/identify/standstill.hpp"
#include "host/identify/suitability.hpp"
#include "sim/effects/effects.hpp"
#include "sim/effects/time_skew/time_skew.hpp"

namespace stiction::host {
namespace {

constexpr double of_training = 0.1;  // residuals hold more than noise: a p-value claims too much
constexpr double shortest = 3.0;     // s, of the training logs together
// Of what a shape takes that other records speak against: causes in its place take nearly as much of the training data,
// or they are no more than what they share with it.
constexpr double as_much = 0.7;
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
  for (const auto c : term.alternatives) {
    const sim::EffectId other = *candidates()[c].effect;
    if (std::any_of(list.begin(), list.end(), [&](const ConfusedWith& l) { return l.effect == other; })) continue;
    const auto alias = std::find_if(known.begin(), known.end(), [&](const auto& a) { return a.other == other; });
    list.push_back({other, alias != known.end() ? std::string(alias->separate_by)
                                                : "record longer, with different speeds, accelerations and strokes: in "
                                                  "these records both explain the residual equally well"});
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

Finding finding_of(const SearchContext& context, const Term& term, const HoldoutGain& gain,
                   const HeldOutAmplitude& held_out_amplitude, std::size_t blocks) {
  const auto& candidate = candidates()[term.candidate];
  Finding finding(*candidate.effect);
  finding.axis = context.axis.name;
  candidate.describe(context, term.shape, term.coefficients, term.covariance, finding);
  finding.explains = term.explains;
  finding.holdout = gain;
  finding.p_value = term.judgement.p_value;
  finding.confused_with = confused_with(term);
  finding.evidence = evidence_of(term, held_out_amplitude, blocks);
  return finding;
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

// Withdraws the term that held-out data speak against most, until they do against none and not against all of them
// together. Returns the candidates that were withdrawn.
std::vector<std::size_t> keep_what_holds(const LogRows& rows, const Eigen::VectorXd& target,
                                         const SearchContext& context, SearchResult& found, Verdict& verdict,
                                         std::uint64_t seed) {
  std::vector<std::size_t> withdrawn;
  for (;;) {
    const auto figures = evaluate_held_out(rows, target, context, found.terms, seed);
    if (found.terms.empty()) return withdrawn;
    std::vector<double> too_much;
    for (std::size_t k = 0; k < found.terms.size(); ++k)
      too_much.push_back(figures.held_out_amplitudes[k].against() -
                         most_against(found.terms[k], figures.held_out_amplitudes[k]));
    const auto worst =
        static_cast<std::size_t>(std::distance(too_much.begin(), std::max_element(too_much.begin(), too_much.end())));
    // Each may gain beside the others and all of them together lose: wrong names that lean on each other.
    const bool holds_alone = too_much[worst] < 0.0;
    if (holds_alone && (found.terms.size() == 1 || figures.together.against() < 0.0)) return withdrawn;
    const auto& term = found.terms[worst];
    const auto& candidate = candidates()[term.candidate];
    withdrawn.push_back(term.candidate);
    if (candidate.outside())
      verdict.unexplained = {term.explains, candidate.looks_like(context, term.shape, term.coefficients) +
                                                " (in the training logs; the held-out logs do not confirm it)"};
    else
      verdict.rejected.push_back(
          {*candidate.effect,
           fmt::format(
               "withdrawn: found in the training data, but without improvement on held-out data: held-out amplitude {} "
               "of the fitted one{}, residual force {:.4f} times that without it",
               repeated(holds_alone ? figures.together : figures.held_out_amplitudes[worst]),
               holds_alone ? ", together with all other findings" : "",
               holds_alone ? figures.force_extended / figures.force_baseline : figures.gains[worst].force_rms_ratio)});
    found.terms.erase(found.terms.begin() + static_cast<std::ptrdiff_t>(worst));
  }
}

std::vector<std::size_t> outside_among(std::vector<std::size_t> of) {
  std::erase_if(of, [](std::size_t candidate) { return !candidates()[candidate].outside(); });
  return of;
}

double explained(const std::vector<Term>& terms) {
  return std::accumulate(terms.begin(), terms.end(), 0.0,
                         [](double sum, const Term& term) { return sum + term.explains; });
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

// What was found outside of the vocabulary: taken out of the terms, with the force (N, of the rows) that it makes.
struct Outside {
  Eigen::VectorXd force;
  Unexplained unexplained;
};
Outside take_outside(const LogRows& rows, const SearchContext& context, SearchResult& found) {
  Outside outside{Eigen::VectorXd::Zero(rows.rows()), {}};
  std::vector<std::string> words;
  std::erase_if(found.terms, [&](const Term& term) {
    const auto& candidate = candidates()[term.candidate];
    if (!candidate.outside()) return false;
    outside.force += weighted_columns(rows, context, candidate, term.shape, term.coefficients);
    outside.unexplained.share += term.explains;
    words.push_back(candidate.looks_like(context, term.shape, term.coefficients));
    return true;
  });
  if (!words.empty()) outside.unexplained.signature = fmt::format("{}", fmt::join(words, "; and "));
  return outside;
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
  const auto keep = [&](SearchResult& searched) {
    return keep_what_holds(held_regressors, held_target, context, searched, verdict, input.seed);
  };
  auto withdrawn = keep(found);
  // A shape outside of the vocabulary that other records speak against may have stood in a cause's place.
  if (const auto refuted = outside_among(withdrawn); found.terms.empty() && !refuted.empty()) {
    auto again = search_causes(regressors, target, context, refuted);
    const double taken = verdict.unexplained.share;
    auto withdrawn_again = keep(again);
    if (!again.terms.empty() && explained(again.terms) > as_much * taken) {
      verdict.unexplained = {};
      found = std::move(again);
      withdrawn = std::move(withdrawn_again);
    }
  }
  const auto outside = take_outside(regressors, context, found);
  // What is outside extends no machine file: the names have to gain without it, too.
  if (outside.unexplained.signature) keep_what_holds(held_regressors, held_target, context, found, verdict, input.seed);
  const Eigen::VectorXd inside = target - outside.force;
  const auto figures = evaluate_held_out(held_regressors, held_target, context, found.terms, input.seed);
  verdict.baseline.force_rms = figures.force_baseline;
  verdict.extended.force_rms = figures.force_extended;
  for (std::size_t k = 0; k < found.terms.size(); ++k)
    verdict.findings.push_back(
        finding_of(context, found.terms[k], figures.gains[k], figures.held_out_amplitudes[k], found.blocks));
  compare_bands(verdict, found.terms, regressors, inside, context);
  begin(3);
  refine_in_closed_loop(verdict.findings, found, responses, regressors, inside, context);
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
  if (outside.unexplained.signature)
    verdict.unexplained = outside.unexplained;
  else if (resolved && withdrawn.empty())
    verdict.unexplained =
        signature_of(regressors, found.residual, target.squaredNorm(), found.correlation, verdict.units);
  add_cause_charts(verdict, regressors, context, found.terms, found.residual);
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
