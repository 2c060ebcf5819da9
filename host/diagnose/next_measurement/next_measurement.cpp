#include "host/diagnose/next_measurement/next_measurement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "host/diagnose/describe/diagnosis_charts.hpp"
#include "host/diagnose/next_measurement/cam_charts.hpp"
#include "host/diagnose/next_measurement/cam_rehearsal.hpp"
#include "host/diagnose/next_measurement/separation.hpp"
#include "host/diagnose/next_measurement/trajectory_rehearsal.hpp"
#include "host/diagnose/search/price.hpp"
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

// From that share on a cam counts in full: where twice the least one was expected, records were seen to hold less.
constexpr double ample_share = 5.0 * least_share;
static_assert(least_share == of_strongest);

double separation_of(const Separation& separation, const Records& records, const AskedQuestion& question) {
  const double one = separation.expected(records, question.truth, question.rival, question.others);
  if (question.rival.empty()) return one;
  // Either may be true: what is certain is the smaller.
  return std::min(one, separation.expected(records, question.rival, question.truth, question.others));
}

// Of what either answer does in the records, squared, the smaller part that the other one does not imitate.
double share_of(const Separation& separation, const Records& records, const AskedQuestion& question) {
  const std::vector<Explanation> nothing;
  double share = 1.0;
  for (const bool first : {true, false}) {
    const auto& truth = first ? question.truth : question.rival;
    const auto& rival = first ? question.rival : question.truth;
    const double whole = separation.expected(records, truth, nothing, question.others);
    if (whole > 0.0)
      share = std::min(share, std::pow(separation.expected(records, truth, rival, question.others) / whole, 2));
  }
  return share;
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
  for (std::size_t k = 0; k < trajectory.separations.size(); ++k) {
    const double settled =
        std::min(trajectory.separations[k] * std::sqrt(usual_duration / trajectory.duration) / ample, 1.0);
    sum += trajectory.shares.empty() ? settled : settled * std::min(trajectory.shares[k] / ample_share, 1.0);
  }
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

// Sorted by worth. The index of the best one, where it is of any.
std::optional<std::size_t> rank(NextMeasurement& next, const std::vector<Rehearsal>& rehearsals,
                                const std::vector<RehearsedTrajectory>& judged) {
  std::vector<std::size_t> order(judged.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<double> worths;
  for (std::size_t k = 0; k < judged.size(); ++k) worths.push_back(worth(judged[k], rehearsals[k].log));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return worths[a] > worths[b]; });
  for (const auto k : order) next.trajectories.push_back(judged[k]);
  if (order.empty()) return std::nullopt;
  // Of the questions that the best one bears on, that which it settles last.
  double weakest = enough;
  bool any = false;
  const auto& first = next.trajectories.front();
  for (std::size_t k = 0; k < first.separations.size(); ++k) {
    if (!first.answers(k)) continue;
    weakest = std::min(weakest, first.separations[k]);
    any = true;
  }
  if (!any) return std::nullopt;
  next.times = static_cast<int>(std::ceil(std::pow(enough / weakest, 2) - 1e-9));
  return order.front();
}

// The present records and the one of a cam, repeated until it lasts as long as records usually do. A cause that a cam
// shows as a function of the place is told from one by two cams, and by neither alone.
class JointRecords {
 public:
  JointRecords(const Searched& searched, const Rehearsal& rehearsal)
      : copies_(static_cast<std::size_t>(std::ceil(usual_duration / rehearsal.log.t.back()))),
        present_(searched.rows.motions().size()),
        context_(rehearsal.context),
        rows_(motions_of(searched, rehearsal, copies_), searched.settings) {
    const auto& source = rehearsal.rows.motions().front().source;
    if (!searched.context.response || !rehearsal.context.response) return;
    context_.response = [source, now = searched.context.response, then = rehearsal.context.response](
                            const Motion& motion, const machine::Effect& effect, std::size_t most_runs) {
      return (motion.source == source ? then : now)(motion, effect, most_runs);
    };
  }
  JointRecords(const JointRecords&) = delete;
  JointRecords& operator=(const JointRecords&) = delete;
  ~JointRecords() = default;

  Records records() const { return {rows_, context_}; }
  std::size_t copies() const { return copies_; }
  // Those of `values`, one a row, that are of the cam, once.
  Eigen::VectorXd of_cam(const Eigen::VectorXd& values) const {
    const auto begin = static_cast<Eigen::Index>(rows_.logs()[present_]);
    return values.segment(begin, static_cast<Eigen::Index>(rows_.end(present_)) - begin);
  }

 private:
  static std::vector<Motion> motions_of(const Searched& searched, const Rehearsal& rehearsal, std::size_t copies) {
    auto motions = searched.rows.motions();
    motions.insert(motions.end(), copies, rehearsal.rows.motions().front());
    return motions;
  }

  std::size_t copies_, present_;
  SearchContext context_;
  LogRows rows_;
};

// What a cam is expected to show together with the present records.
RehearsedTrajectory judged_cam(Rehearsal& rehearsal, const std::vector<AskedQuestion>& questions,
                               const Searched& searched, const Separation& separation) {
  const JointRecords joint(searched, rehearsal);
  const auto records = joint.records();
  rehearsal.cam->cycles *= static_cast<int>(joint.copies());
  RehearsedTrajectory judged{
      rehearsal.name, rehearsal.words, rehearsal.log.t.back() * static_cast<double>(joint.copies()), {}};
  for (const auto& question : questions) {
    const bool by_motion = question.shown.by_motion;
    judged.separations.push_back(by_motion ? separation_of(separation, records, question) : 0.0);
    judged.shares.push_back(by_motion && !question.rival.empty() ? share_of(separation, records, question) : 1.0);
  }
  return judged;
}

RehearsedTrajectory judged_path(const Rehearsal& rehearsal, const std::vector<AskedQuestion>& questions,
                                const Separation& separation) {
  RehearsedTrajectory judged{rehearsal.name, rehearsal.words, rehearsal.log.t.back(), {}};
  const Records records{rehearsal.rows, rehearsal.context};
  for (const auto& question : questions)
    judged.separations.push_back(question.shown.by_motion ? separation_of(separation, records, question) : 0.0);
  return judged;
}

// Of the question that the rehearsal answers best: the forces of both candidates, and what separates them.
CamSpectrum spectrum_of(const Searched& searched, const Separation& separation, const Rehearsal& rehearsal,
                        const std::vector<AskedQuestion>& questions, const std::vector<double>& separations) {
  const auto best =
      static_cast<std::size_t>(std::max_element(separations.begin(), separations.end()) - separations.begin());
  const auto& question = questions[best];
  const JointRecords joint(searched, rehearsal);
  const auto records = joint.records();
  CamSpectrum spectrum;
  for (const auto* causes : {&question.truth, &question.rival})
    for (const auto& cause : *causes)
      spectrum.candidates.push_back(
          {std::string((*candidates()[cause.candidate].effect)->title), joint.of_cam(force_of(records, cause))});
  auto part = separation.separating_part(records, question.truth, question.rival, question.others);
  if (!question.rival.empty()) {
    // What is certain is the smaller.
    auto other = separation.separating_part(records, question.rival, question.truth, question.others);
    if (other.norm() < part.norm()) part = std::move(other);
  }
  spectrum.separating = joint.of_cam(part);
  return spectrum;
}

// What the best one is made of, with its pictures. More cycles of a cam are one longer record.
void describe_cam(NextMeasurement& next, const Searched& searched, const Separation& separation,
                  const Rehearsal& rehearsal, const std::vector<AskedQuestion>& questions, const ShownUnits& own) {
  auto picture = cam_picture(
      rehearsal, spectrum_of(searched, separation, rehearsal, questions, next.trajectories.front().separations),
      searched.machine.axes[searched.axis], own);
  next.cam = rehearsal.cam;
  next.cam->cycles *= next.times;
  next.times = 1;
  next.cam->spectrum = std::move(picture.words);
  next.charts = std::move(picture.charts);
  next.note = cam_words(*next.cam, rehearsal.log, own);
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
    const auto& axis = searched.machine.axes[searched.axis];
    const auto recorded = recorded_cam(searched.logs, axis);
    auto rehearsals = recorded ? rehearse_cams(searched.machine, searched.axis, *recorded, searched.rows,
                                               searched.context, searched.settings)
                               : rehearse(searched.machine, searched.axis, motion_range(axis, searched.rows),
                                          searched.rows, searched.context, searched.settings);
    std::vector<RehearsedTrajectory> judged;
    for (auto& rehearsal : rehearsals)
      judged.push_back(recorded ? judged_cam(rehearsal, questions, searched, separation)
                                : judged_path(rehearsal, questions, separation));
    if (const auto best = rank(next, rehearsals, judged)) {
      auto& rehearsal = rehearsals[*best];
      if (rehearsal.cam) {
        describe_cam(next, searched, separation, rehearsal, questions, verdict.units);
      } else {
        next.charts = charts_of(rehearsal.log, rehearsal.name, verdict.units);
        next.note = extent_words(rehearsal.log, searched.rows, verdict.units);
      }
      next.log = std::move(rehearsal.log);
      auto& channels = next.log->axes.front();
      channels = in_own_units(std::move(channels), axis.coordinate);
    }
  }
  // What was nearly found and no trajectory shows is no news.
  if (next.log || next.questions.front().rival) verdict.next = std::move(next);
}

}  // namespace stiction::host
