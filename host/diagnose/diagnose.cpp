#include "host/diagnose/diagnose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>

#include "host/diagnose/behind_master.hpp"
#include "host/diagnose/between_encoders.hpp"
#include "host/diagnose/classes/candidate_columns.hpp"
#include "host/diagnose/describe/diagnosis_charts.hpp"
#include "host/diagnose/describe/master_charts.hpp"
#include "host/diagnose/exact_records.hpp"
#include "host/diagnose/judge/changed_between.hpp"
#include "host/diagnose/judge/closed_loop.hpp"
#include "host/diagnose/judge/closed_loop_description.hpp"
#include "host/diagnose/judge/command_residual.hpp"
#include "host/diagnose/judge/finding_evidence.hpp"
#include "host/diagnose/judge/withdrawal.hpp"
#include "host/diagnose/next_measurement/next_measurement.hpp"
#include "host/diagnose/prepare.hpp"
#include "host/diagnose/record/followed_set_points.hpp"
#include "host/diagnose/record/record_rows.hpp"
#include "host/diagnose/search/search.hpp"
#include "host/diagnose/search/second_band.hpp"
#include "sim/effects/time_skew/time_skew.hpp"

namespace stiction::host {
namespace {

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

// What was found and how the machine shows it.
struct Explained {
  SearchResult found;             // its terms have names and hold; its residual is what those leave
  std::vector<Finding> findings;  // of its terms, with parameters
  std::vector<Term> unnamed;
  Eigen::VectorXd inside;  // N, the target less the unnamed
  bool withdrew = false;
};

SearchResult search(Prepared& prepared, Verdict& verdict) {
  const auto& training = prepared.training;
  const double resolved = training.target.norm() / training.expected.norm();
  if (resolved > resolution_of_dynamics) return search_causes(training.regressors, training.target, prepared.context);
  verdict.notes.push_back(fmt::format(
      "The residual force of these records is {:.2g} % of the expected force, less than the {:g} % that inverse "
      "dynamics can resolve: causes were not looked for in it.",
      100.0 * resolved, 100.0 * resolution_of_dynamics));
  return {{}, {}, training.target};
}

Eigen::VectorXd less(Eigen::VectorXd target, const Prepared& prepared, const std::vector<Term>& terms) {
  for (const auto& term : terms)
    target -= weighted_columns(prepared.training.regressors, prepared.context, candidates()[term.candidate], term.shape,
                               term.coefficients);
  return target;
}

void reject(Verdict& verdict, std::size_t candidate, std::string why) {
  if (!candidates()[candidate].outside()) verdict.rejected.push_back({*candidates()[candidate].effect, std::move(why)});
}

// The terms of the search as the machine shows them, as far as held-out data bear them out.
Explained explain(Prepared& prepared, SearchResult found, const HeldOutData& held_out,
                  const std::function<void(std::size_t)>& begin, Verdict& verdict) {
  const auto& training = prepared.training;
  auto unnamed = take_unnamed(found);
  std::vector<Term> remainders;
  const auto describe = [&](std::vector<Term> named, std::vector<Term> without_name) {
    auto described = describe_in_closed_loop(std::move(named), std::move(without_name), prepared.responses,
                                             training.regressors, training.target, found.residual, prepared.context);
    std::move(described.remainders.begin(), described.remainders.end(), std::back_inserter(remainders));
    return described;
  };
  auto described = describe(std::move(found.terms), std::move(unnamed));
  begin(3);
  const auto withdrawn = keep_what_holds(held_out, described.terms, maps_of(described.unnamed));
  for (const auto& each : withdrawn) reject(verdict, each.candidate, each.why);
  if (!withdrawn.empty()) described = describe(std::move(described.terms), std::move(described.unnamed));
  for (const auto& remainder : remainders)
    reject(verdict, remainder.candidate,
           "described in closed loop together with the other findings it explains nothing");
  Explained explained{
      std::move(found), std::move(described.findings), std::move(described.unnamed), {}, !withdrawn.empty()};
  explained.found.terms = std::move(described.terms);
  explained.inside = less(training.target, prepared, explained.unnamed);
  explained.found.residual = less(explained.inside, prepared, explained.found.terms);
  return explained;
}

// Figures of the findings on held-out data, and the tables that extend the machine where no name does. Returns the
// terms of all of them, in their order.
std::vector<Term> give_figures(Verdict& verdict, const Prepared& prepared, const Explained& explained,
                               const HeldOutData& held_out) {
  const auto& terms = explained.found.terms;
  auto maps = maps_of(explained.unnamed);
  const auto figures = keep_confirmed_maps(held_out, terms, maps);
  verdict.baseline.force_rms = figures.force_baseline;
  verdict.extended.force_rms = figures.force_extended;
  verdict.findings = explained.findings;
  for (std::size_t k = 0; k < terms.size(); ++k)
    give_evidence(verdict.findings[k], terms[k], figures.gains[k], figures.held_out_amplitudes[k],
                  explained.found.blocks);
  for (std::size_t k = 0; k < maps.size(); ++k)
    verdict.findings.push_back(map_finding(prepared.context, maps[k], figures.gains[terms.size() + k],
                                           figures.held_out_amplitudes[terms.size() + k]));
  const auto& rows = prepared.training.regressors;
  compare_bands(verdict, terms, rows, explained.inside, prepared.context);
  auto shown = terms;
  shown.insert(shown.end(), maps.begin(), maps.end());
  add_cause_charts(verdict, rows, prepared.context, shown, explained.found.residual);
  return shown;
}

// The residuals that the extended machine file leaves where keys are withheld: those without their findings. `terms`:
// of the first findings.
void leave_out_withheld(Verdict& verdict, const std::vector<Term>& terms, const HeldOutData& held_out) {
  const auto& findings = verdict.findings;
  const auto written = written_findings(findings);
  if (written.size() == findings.size()) return;
  std::vector<bool> counted;
  for (std::size_t k = 0; k < terms.size(); ++k) counted.push_back(findings[k].withheld.empty());
  verdict.extended.force_rms = held_out_force(held_out, terms, counted);
  if (std::none_of(written.begin(), written.end(),
                   [](const Finding& finding) { return finding.residual == Residual::command; }))
    verdict.extended.command_rms = verdict.baseline.command_rms;
}

std::string said_of(const ChangedParameter& changed) {
  return fmt::format(
      "The held-out records are of a different state of the machine. {0}: {1} = {2:.4g} {3} in them, {4:.4g} {3} in "
      "the training records; the difference has a standard error of {5:.2g} {3}. Causes were confirmed on the "
      "held-out force without this difference; the positions of the closed loop have it.",
      changed.effect->title, changed.key, changed.held_out, changed.unit, changed.training, changed.standard_error);
}

// The held-out residual force (N) as it were in the state of the machine in which the training records were made; what
// has changed goes to the verdict. Parts of the same logs are of the same state.
Eigen::VectorXd in_same_state(Verdict& verdict, const Prepared& prepared, const SearchResult& found) {
  const auto &training = prepared.training, &held_out = prepared.held_out;
  Eigen::VectorXd target = held_out.target;
  if (verdict.holdout_is_a_part) return target;
  // What has no name is a force of its own records.
  std::vector<Term> named;
  std::copy_if(found.terms.begin(), found.terms.end(), std::back_inserter(named),
               [](const Term& term) { return !candidates()[term.candidate].outside(); });
  const Eigen::VectorXd left = less(training.target, prepared, named);
  const Eigen::VectorXd rest = without_terms(held_out.regressors, target, prepared.context, named);
  for (const auto& change :
       changes_between({training.regressors, left}, {held_out.regressors, rest}, prepared.context, named)) {
    target -= change.force;
    const auto changed = changed_parameter(prepared.context, change);
    verdict.notes.push_back(said_of(changed));
    verdict.changed.push_back(changed);
  }
  return target;
}

// What the drive commanded, less what the file's controller gives.
// `of_file`: the records with the file's own runs; `searched`: those in whose force the causes were looked for.
void judge_drive(Verdict& verdict, const DiagnoseInput& input, const Prepared& of_file, const Prepared& searched,
                 const SearchResult& found) {
  const auto& axis = input.machine.axes[input.axis];
  const auto &training = of_file.training, &held_out = of_file.held_out;
  if (axis.elastic() && axis.velocity_encoder)
    verdict.notes.push_back(
        "The gains of the drive were not evaluated: its velocity controller sees a different encoder than the recorded "
        "one, with an elastic shaft between them.");
  else if (axis.cascaded())
    judge_command(
        verdict, input, {training.logs, training.rows, training.simulated},
        {held_out.logs, held_out.rows, held_out.simulated},
        record_delay(searched.training.regressors, searched.context, found),
        exact_logs(
            of_file, input,
            searched.on_axis.parts_of(found.residual.cwiseProduct(searched.training.regressors.counts())).on_axis));
}

void say_what_is_left(Verdict& verdict, const Prepared& prepared, const Explained& explained) {
  const auto& training = prepared.training;
  const auto& found = explained.found;
  for (const auto& discarded : found.discarded) reject(verdict, discarded.candidate, discarded.why);
  if (!explained.unnamed.empty()) verdict.unexplained = unexplained_by(prepared.context, explained.unnamed);
  add_charts(verdict, training.rows, training.target, found.residual);
  add_master_charts(verdict, training.logs, prepared.axis, training.rows, training.target, found.residual);
}

double rms_about_mean(const Eigen::VectorXd& values, const Eigen::VectorXd& counts) {
  const Eigen::VectorXd centred = values.array() - values.mean();
  return std::sqrt(centred.cwiseProduct(counts).squaredNorm() / static_cast<double>(std::max<long>(values.size(), 1)));
}

// What was found and withdrawn, or whose keys are withheld, is still there, and what the held-out records have beyond
// the training ones was looked for in neither: both are no disturbance.
void judge_agreement(Verdict& verdict, const Prepared& prepared, const Explained& explained, std::uint64_t seed,
                     double disturbed_position) {
  const auto& held_out = prepared.held_out;
  const auto& counts = held_out.regressors.counts();
  const auto floor =
      noise_floor(held_out.logs, prepared.axis, prepared.settings, counts, held_out.simulated, held_out.expected, seed);
  verdict.noise_floor = floor;
  const double known = std::hypot(floor.force(), rms(explained.found.residual));
  const bool missing = explained.withdrew || written_findings(verdict.findings).size() < verdict.findings.size();
  const bool repeats =
      verdict.unexplained.signature.has_value() || missing || verdict.extended.force_rms > force_margin * known;
  verdict.agreement =
      agreement_of({verdict.extended.force_rms, verdict.extended.position_error_rms, floor.force(), floor.position,
                    rms_about_mean(held_out.rows.force, counts), repeats, disturbed_position},
                   verdict.closed_loop_withheld, verdict.units);
}

// In the wide band nothing where no run of the file is taken off the records, or no force has a name.
std::optional<Verdict> diagnose_in(RowBand band, const DiagnoseInput& input) {
  const auto begin = [&](std::size_t part) {
    if (input.progress) input.progress(diagnosis_parts[part]);
  };
  Verdict verdict;
  begin(0);
  const auto of_file = prepare(input, band, verdict);
  if (band == RowBand::wide && !of_file->known_motion) return {};
  // Said once.
  Verdict again;
  const auto behind = behind_master(input, *of_file);
  const auto late = behind ? prepare(*behind, band, again) : nullptr;
  const auto between = between_encoders(behind ? *behind : input, late ? *late : *of_file);
  const auto twisted = between.input ? prepare(*between.input, band, again) : nullptr;
  Prepared& records = twisted ? *twisted : late ? *late : *of_file;
  const auto &training = records.training, &held_out = records.held_out;
  begin(1);
  auto found = search(records, verdict);
  verdict.exact_records = found.exact_records;
  begin(2);
  const Eigen::VectorXd comparable = in_same_state(verdict, records, found);
  const HeldOutData unseen{held_out.regressors, comparable, records.context, records.responses, input.seed};
  const auto explained = explain(records, std::move(found), unseen, begin, verdict);
  if (band == RowBand::wide && explained.found.terms.empty()) return {};
  const auto terms = give_figures(verdict, records, explained, unseen);
  begin(4);
  propose_next_measurement(verdict,
                           {input.machine, input.axis, records.settings, training.logs, training.regressors,
                            explained.inside, records.context, explained.found},
                           input.next_measurement);
  // Behind the terms of the residual force, whose places the next measurement knows.
  const auto& of_shaft = between.causes;
  verdict.findings.insert(verdict.findings.end(), of_shaft.findings.begin(), of_shaft.findings.end());
  verdict.rejected.insert(verdict.rejected.end(), of_shaft.rejected.begin(), of_shaft.rejected.end());
  judge_drive(verdict, input, *of_file, records, explained.found);
  say_what_is_left(verdict, records, explained);
  begin(5);
  double disturbed_position = 0.0;
  if (input.closed_loop) {
    const auto& rows = training.regressors;
    const auto left = records.on_axis.parts_of(explained.found.residual.cwiseProduct(rows.counts()));
    const Disturbance disturbance(left.on_axis, rows.logs(), rows.period(0));
    disturbed_position = judge_in_closed_loop(verdict, input.machine, input.axis, held_out.logs, disturbance);
    leave_out_withheld(verdict, terms, unseen);
  }
  judge_agreement(verdict, records, explained, input.seed, disturbed_position);
  return verdict;
}

// Where faster forces give a name, what was found in those.
std::optional<Verdict> diagnose_faster(const DiagnoseInput& input) {
  auto logs = input.logs;
  logs.insert(logs.end(), input.held_out.begin(), input.held_out.end());
  // Without set-points the motion is known no further than the usual band.
  if (!have_set_points(logs, input.machine.axes[input.axis])) return {};
  const double usual = end_of_band(signals_in(RowBand::usual, logs));
  const double wide = end_of_band(signals_in(RowBand::wide, logs));
  constexpr double worth_it = 1.5;  // of the usual band: less shows what has been looked at
  if (wide < worth_it * usual) return {};
  if (input.progress) input.progress(diagnosis_parts.back());
  auto silent = input;
  silent.progress = nullptr;
  auto verdict = diagnose_in(RowBand::wide, silent);
  if (verdict)
    verdict->notes.push_back(
        fmt::format("In forces up to {:.0f} Hz no cause was found, and they do not agree with the file. These are the "
                    "causes found in forces up to {:.0f} Hz.",
                    usual, wide));
  return verdict;
}

}  // namespace

Verdict diagnose(const DiagnoseInput& input) {
  auto verdict = *diagnose_in(RowBand::usual, input);
  const bool named = std::any_of(verdict.findings.begin(), verdict.findings.end(),
                                 [](const Finding& finding) { return finding.names_cause(); });
  if (named || !verdict.agreement || verdict.agreement->status != Status::does_not_agree) return verdict;
  return diagnose_faster(input).value_or(std::move(verdict));
}

}  // namespace stiction::host
