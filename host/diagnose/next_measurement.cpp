#include "host/diagnose/next_measurement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/diagnose/separation.hpp"
#include "host/diagnose/trajectory_rehearsal.hpp"
#include "sim/plant/effects/effects.hpp"

namespace stiction::host {
namespace {

// Standard errors from which the search names a cause: p < 0.01/22 from some tens of blocks asks for four to five.
constexpr double enough = 5.0;
constexpr double least = 1.0;           // less, and nothing is worth proposing
constexpr double not_told_apart = 2.0;  // standard errors between causes that the search could not compare
constexpr std::size_t most_questions = 6;

struct Question {
  OpenQuestion shown;
  Explanation truth;
  std::optional<Explanation> rival;  // none with an empty shown.rival
  std::vector<Explanation> others;   // that act beside either
};

double separation_of(const Separation& separation, const Records& records, const Question& question) {
  const double one = separation.expected(records, question.truth, question.rival, question.others);
  if (!question.rival) return one;
  // Either may be true: what is certain is the smaller.
  return std::min(one, separation.expected(records, *question.rival, question.truth, question.others));
}

class Questions {
 public:
  Questions(const Searched& searched, const Separation& separation)
      : searched_(searched), separation_(separation), scene_(searched.scene) {
    // Few reversals keep the search from trying a contact, but not these records from holding one.
    scene_.reversals = enough_reversals;
  }

  // Which of a finding and what it may be confused with, the largest finding first.
  void add_confusions(std::vector<Finding>& findings) {
    for (std::size_t k = 0; k < findings.size(); ++k) {
      add_untried(findings[k], k);
      for (const auto& other : findings[k].confused_with) add(findings[k], k, other);
    }
  }
  // Whether there is what was not quite significant.
  void add_nearly_found() {
    std::vector<Explanation> terms;
    for (const auto& term : searched_.found.terms) terms.push_back(explanation_of(term));
    for (const auto& discarded : searched_.found.discarded) {
      if (!discarded.nearly) continue;
      const auto fit = separation_.best_fit(records_, searched_.target, discarded.candidate, terms);
      if (fit) ask({{candidates()[discarded.candidate].name, "", "more data, where it shows most"}, *fit, {}, terms});
    }
  }
  std::vector<Question> take() { return std::move(questions_); }

 private:
  void ask(Question question) {
    if (questions_.size() == most_questions) return;
    if (question.shown.by_motion) question.shown.these_logs = separation_of(separation_, records_, question);
    questions_.push_back(std::move(question));
  }
  std::vector<Explanation> others_than(std::size_t term) const {
    std::vector<Explanation> others;
    for (std::size_t k = 0; k < searched_.found.terms.size(); ++k)
      if (k != term) others.push_back(explanation_of(searched_.found.terms[k]));
    return others;
  }
  static std::optional<std::size_t> index_of(const std::string& effect) {
    for (std::size_t c = 0; c < candidates().size(); ++c)
      if (effect == candidates()[c].name) return c;
    return std::nullopt;
  }
  void add(const Finding& finding, std::size_t k, const ConfusedWith& other) {
    const auto truth = explanation_of(searched_.found.terms[k]);
    const OpenQuestion shown{finding.effect.name, other.effect, other.separate_by, !other.always};
    if (other.always) return ask({shown, truth, {}, {}});
    const auto rival = index_of(other.effect);
    if (!rival) return;
    auto others = others_than(k);
    if (auto fit = separation_.best_fit(records_, searched_.target, *rival, others))
      ask({shown, truth, std::move(fit), std::move(others)});
  }
  // Known aliases of a finding that the search does not try on records like these, and that these cannot tell from it.
  void add_untried(Finding& finding, std::size_t k) {
    const auto others = others_than(k);
    for (const auto& alias : sim::find_effect_kind(finding.effect.name)->aliases) {
      const auto rival = index_of(std::string(alias.effect));
      if (!rival || !candidates()[*rival].grid(searched_.scene).empty() || candidates()[*rival].grid(scene_).empty())
        continue;
      const auto fit = separation_.best_fit(records_, searched_.target, *rival, others);
      if (!fit) continue;
      const Question question{{}, explanation_of(searched_.found.terms[k]), fit, others};
      if (separation_of(separation_, records_, question) < not_told_apart)
        finding.confused_with.push_back({std::string(alias.effect), std::string(alias.separate_by)});
    }
  }

  const Searched& searched_;
  const Separation& separation_;
  Scene scene_;
  Records records_{searched_.rows, scene_};
  std::vector<Question> questions_;
};

// How much of the questions a record is expected to settle; beyond that, how clearly.
double worth(const std::vector<double>& separations) {
  return std::accumulate(separations.begin(), separations.end(), 0.0,
                         [](double sum, double s) { return sum + std::min(s / enough, 1.0) + 1e-3 * std::log1p(s); });
}

std::vector<sim::Chart> charts_of(const Log& log, const std::string& name) {
  const auto& axis = log.axes.front();
  const auto over_time = [&](const char* label, const std::vector<double>& values) {
    sim::Chart chart;
    chart.x_label = "time of the proposed record, s";
    chart.y_label = label;
    chart.shape = {true, sim::Shape::Height::low};
    chart.series = {{.name = "proposed", .x = log.t, .y = values}};
    for (double& v : chart.series.front().y) v *= 1e3;
    return chart;
  };
  auto position = over_time("set position, mm", axis.x_set), speed = over_time("set velocity, mm/s", axis.v_set);
  position.title = "Proposed: " + name;
  return {position, speed};
}

// Sorted by worth; the log of the best one, where it is of any.
void rank(NextMeasurement& next, std::vector<Rehearsal>& rehearsals, std::vector<RehearsedTrajectory> judged) {
  std::vector<std::size_t> order(judged.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return worth(judged[a].separations) > worth(judged[b].separations);
  });
  for (const auto k : order) next.trajectories.push_back(judged[k]);
  if (order.empty()) return;
  // Of the questions that the best one bears on, that which it settles last.
  double weakest = enough;
  bool any = false;
  for (const double s : next.trajectories.front().separations) {
    if (s < least) continue;
    weakest = std::min(weakest, s);
    any = true;
  }
  if (!any) return;
  next.times = static_cast<int>(std::ceil(std::pow(enough / weakest, 2) - 1e-9));
  next.log = std::move(rehearsals[order.front()].log);
  next.charts = charts_of(*next.log, next.trajectories.front().name);
}

}  // namespace

void propose_next_measurement(Verdict& verdict, const Searched& searched) {
  if (searched.found.residual.squaredNorm() <= 0.0) return;
  const Separation separation(searched.rows, searched.found.residual);
  Questions collected(searched, separation);
  collected.add_confusions(verdict.findings);
  collected.add_nearly_found();
  const auto questions = collected.take();
  if (questions.empty()) return;
  NextMeasurement next;
  next.axis = searched.scene.axis.name;
  for (const auto& question : questions) next.questions.push_back(question.shown);
  if (std::any_of(questions.begin(), questions.end(), [](const Question& q) { return q.shown.by_motion; })) {
    const auto range = motion_range(searched.machine.axes[searched.axis], searched.rows);
    auto rehearsals =
        rehearse(searched.machine, searched.axis, range, searched.rows, searched.scene, searched.settings);
    std::vector<RehearsedTrajectory> judged;
    for (const auto& rehearsal : rehearsals) {
      judged.push_back({rehearsal.trajectory->name, rehearsal.trajectory->words, rehearsal.log.t.back(), {}});
      for (const auto& question : questions)
        judged.back().separations.push_back(
            question.shown.by_motion ? separation_of(separation, {rehearsal.rows, rehearsal.scene}, question) : 0.0);
    }
    rank(next, rehearsals, std::move(judged));
    if (next.log) next.note = range_words(range, searched.rows);
  }
  verdict.next = std::move(next);
}

}  // namespace stiction::host
