#include "host/diagnose/next_measurement/next_measurement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/diagnose/describe/diagnosis_charts.hpp"
#include "host/diagnose/next_measurement/separation.hpp"
#include "host/diagnose/next_measurement/trajectory_rehearsal.hpp"
#include "host/log/own_units.hpp"
#include "sim/effects/effects.hpp"

namespace stiction::host {
namespace {

// Standard errors that a record must promise: the search names a cause from three to four on, and a record always turns
// out to hold less than was expected of it.
constexpr double enough = 5.0;
constexpr double ample = 2.0 * enough;   // more is not worth a fiercer motion
constexpr double usual_duration = 20.0;  // s, for which separations of long and short trajectories are compared
// Of what the findings take away: as much by a cause that the search could not try on these records, and it may be
// that.
constexpr double as_good = 0.9;
constexpr std::size_t most_questions = 6;

struct AskedQuestion {
  OpenQuestion shown;
  std::vector<Explanation> truth;
  std::vector<Explanation> rival;   // none with an empty shown.rival
  std::vector<Explanation> others;  // that act beside either
};

double separation_of(const Separation& separation, const Records& records, const AskedQuestion& question) {
  const double one = separation.expected(records, question.truth, question.rival, question.others);
  if (question.rival.empty()) return one;
  // Either may be true: what is certain is the smaller.
  return std::min(one, separation.expected(records, question.rival, question.truth, question.others));
}

class Questions {
 public:
  Questions(const Searched& searched, const Separation& separation)
      : searched_(searched), separation_(separation), scene_(searched.context) {
    // Few reversals keep the search from trying a contact, but not these records from holding one.
    scene_.reversals = enough_reversals;
    for (const auto& term : searched.found.terms) terms_.push_back(explanation_of(term));
  }

  // What the search does not try on records like these, and what alone takes away as much as all findings.
  void add_untried(std::vector<Finding>& findings) {
    if (terms_.empty()) return;
    const double by_all = separation_.explained(records_, searched_.target, terms_);
    for (std::size_t c = 0; c < candidates().size(); ++c) {
      const auto rival = candidates()[c].effect;
      if (!rival || !candidates()[c].grid(searched_.context).empty() || candidates()[c].grid(scene_).empty()) continue;
      const auto fit = separation_.best_fit(records_, searched_.target, c, {});
      if (!fit || separation_.explained(records_, searched_.target, {&*fit, 1}) < as_good * by_all) continue;
      const auto known = sim::confusions_of(*rival);
      const auto told_by = [&](sim::EffectId other) {
        const auto alias = std::find_if(known.begin(), known.end(), [&](const auto& a) { return a.other == other; });
        return alias != known.end() ? std::string(alias->separate_by)
                                    : "small reversals of several amplitudes, which these records do not contain";
      };
      if (terms_.size() > 1)
        ask({{findings.front().effect, *rival, told_by(findings.front().effect)}, terms_, {*fit}, {}});
      for (auto& finding : findings) finding.confused_with.push_back({*rival, told_by(finding.effect)});
    }
  }
  // Which of a finding and what it may be confused with, the largest finding first.
  void add_confusions(const std::vector<Finding>& findings) {
    for (std::size_t k = 0; k < findings.size(); ++k)
      for (const auto& other : findings[k].confused_with) add(findings[k], k, other);
  }
  // Whether there is what was not quite significant.
  void add_nearly_found() {
    for (const auto& discarded : searched_.found.discarded) {
      if (!discarded.nearly || candidates()[discarded.candidate].outside()) continue;
      const auto fit = separation_.best_fit(records_, searched_.target, discarded.candidate, terms_);
      if (!fit) continue;
      const AskedQuestion question{
          {*candidates()[discarded.candidate].effect, {}, "more data, in motions where its force is largest"},
          {*fit},
          {},
          terms_};
      // What these records should have shown and did not, more of the kind will not.
      if (separation_of(separation_, records_, question) < enough) ask(question);
    }
  }
  std::vector<AskedQuestion> take() { return std::move(questions_); }

 private:
  void ask(AskedQuestion question) {
    if (questions_.size() == most_questions) return;
    if (question.shown.by_motion) question.shown.these_logs = separation_of(separation_, records_, question);
    questions_.push_back(std::move(question));
  }
  std::vector<Explanation> others_than(std::size_t term) const {
    std::vector<Explanation> others;
    for (std::size_t k = 0; k < terms_.size(); ++k)
      if (k != term) others.push_back(terms_[k]);
    return others;
  }
  void add(const Finding& finding, std::size_t k, const ConfusedWith& other) {
    const OpenQuestion shown{finding.effect, other.effect, other.separate_by, !other.always};
    if (other.always) return ask({shown, {}, {}, {}});
    const auto rival = candidate_index(other.effect);
    if (!rival || asked(*rival)) return;
    auto others = others_than(k);
    if (auto fit = separation_.best_fit(records_, searched_.target, *rival, others))
      ask({shown, {terms_[k]}, {std::move(*fit)}, std::move(others)});
  }
  // Whether it is already asked after instead of all findings.
  bool asked(std::size_t rival) const {
    return std::any_of(questions_.begin(), questions_.end(), [&](const AskedQuestion& q) {
      return q.truth.size() > 1 && q.rival.front().candidate == rival;
    });
  }

  const Searched& searched_;
  const Separation& separation_;
  SearchContext scene_;
  Records records_{searched_.rows, scene_};
  std::vector<Explanation> terms_;
  std::vector<AskedQuestion> questions_;
};

// How much of the questions as much time of it is expected to settle; of equal ones the gentler is worth more: what a
// model has wrong grows with the force, and the first run of a machine's new motion should not be its fiercest.
double worth(const RehearsedTrajectory& trajectory, const Log& log) {
  double sum = 0.0, highest = 0.0;
  for (const double separation : trajectory.separations)
    sum += std::min(separation * std::sqrt(usual_duration / trajectory.duration) / ample, 1.0);
  const auto& axis = log.axes.front();
  for (const double effort : axis.i.empty() ? axis.u : axis.i) highest = std::max(highest, std::abs(effort));
  return sum - 1e-5 * highest;
}

std::vector<sim::Chart> charts_of(const Log& log, const std::string& name, const ShownUnits& own) {
  const auto& axis = log.axes.front();
  const auto over_time = [&](const char* label, const ShownQuantity& shown, const std::vector<double>& values) {
    sim::Chart chart;
    chart.x_label = "time of the proposed record, s";
    chart.y_label = axis_label(label, shown);
    chart.shape = {true, sim::Shape::Height::low};
    chart.series = {{.name = "proposed", .x = log.t, .y = values}};
    for (double& v : chart.series.front().y) v *= shown.factor;
    return chart;
  };
  auto position = over_time("set position", own.position, axis.x_set),
       speed = over_time("set velocity", own.slow, axis.v_set);
  position.title = "Proposed: " + name;
  return {position, speed};
}

// Sorted by worth; the log of the best one, where it is of any.
void rank(NextMeasurement& next, std::vector<Rehearsal>& rehearsals, std::vector<RehearsedTrajectory> judged,
          const ShownUnits& own) {
  std::vector<std::size_t> order(judged.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<double> worths;
  for (std::size_t k = 0; k < judged.size(); ++k) worths.push_back(worth(judged[k], rehearsals[k].log));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return worths[a] > worths[b]; });
  for (const auto k : order) next.trajectories.push_back(judged[k]);
  if (order.empty()) return;
  // Of the questions that the best one bears on, that which it settles last.
  double weakest = enough;
  bool any = false;
  for (const double s : next.trajectories.front().separations) {
    if (s < least_separation) continue;
    weakest = std::min(weakest, s);
    any = true;
  }
  if (!any) return;
  next.times = static_cast<int>(std::ceil(std::pow(enough / weakest, 2) - 1e-9));
  next.log = std::move(rehearsals[order.front()].log);
  next.charts = charts_of(*next.log, next.trajectories.front().name, own);
}

}  // namespace

void propose_next_measurement(Verdict& verdict, const Searched& searched, bool propose) {
  if (searched.found.residual.squaredNorm() <= 0.0) return;
  const Separation separation(searched.rows, searched.found.residual);
  Questions collected(searched, separation);
  collected.add_untried(verdict.findings);
  if (!propose) return;
  collected.add_confusions(verdict.findings);
  collected.add_nearly_found();
  const auto questions = collected.take();
  if (questions.empty()) return;
  NextMeasurement next;
  next.axis = searched.context.axis.name;
  for (const auto& question : questions) next.questions.push_back(question.shown);
  if (std::any_of(questions.begin(), questions.end(), [](const AskedQuestion& q) { return q.shown.by_motion; })) {
    const auto range = motion_range(searched.machine.axes[searched.axis], searched.rows);
    auto rehearsals =
        rehearse(searched.machine, searched.axis, range, searched.rows, searched.context, searched.settings);
    std::vector<RehearsedTrajectory> judged;
    for (const auto& rehearsal : rehearsals) {
      judged.push_back({rehearsal.trajectory->name, rehearsal.trajectory->words, rehearsal.log.t.back(), {}});
      const Records records{rehearsal.rows, rehearsal.context};
      for (const auto& question : questions)
        judged.back().separations.push_back(question.shown.by_motion ? separation_of(separation, records, question)
                                                                     : 0.0);
    }
    rank(next, rehearsals, std::move(judged), verdict.units);
    if (next.log) {
      next.note = extent_words(*next.log, searched.rows, verdict.units);
      auto& channels = next.log->axes.front();
      channels = in_own_units(std::move(channels), searched.machine.axes[searched.axis].coordinate);
    }
  }
  // What was nearly found and no trajectory shows is no news.
  if (next.log || next.questions.front().rival) verdict.next = std::move(next);
}

}  // namespace stiction::host
