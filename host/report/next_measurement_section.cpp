#include "host/report/next_measurement_section.hpp"

#include <fmt/format.h>

#include "host/diagnose/verdict/verdict_json.hpp"
#include "host/report/typeset.hpp"

namespace stiction::host {
namespace {

using json = nlohmann::ordered_json;

std::string title_of(const OpenQuestion& question) {
  const auto title = question.effect->title;
  return question.rival ? fmt::format("{} or {}", title, (*question.rival)->title)
                        : fmt::format("{}: is it there?", title);
}

std::string standard_errors(double value) { return fmt::format("{:.{}f}", value, value < 9.95 ? 1 : 0); }

std::string cam_to_run(const NextMeasurement& next, const std::string& axis) {
  const auto& best = next.trajectories.front();
  return typeset(
      fmt::format("Give the axis the cam of {} ({}: {}) and let the master turn at {}. Record {} cycles once it turns "
                  "steadily, with the master's angle, set and measured position and current. {} Diagnose the new log "
                  "together with these logs, or with these as --holdout. In the simulation, from the folder of this "
                  "page: {}",
                  next_measurement_cam_of(axis), best.name, best.words, next.cam->speed, next.cam->cycles, next.note,
                  next_measurement_command(next, axis)));
}

std::string what_to_do(const NextMeasurement& next, const std::string& axis) {
  if (next.cam) return cam_to_run(next, axis);
  if (next.trajectories.empty()) return "No trajectory could be run in the simulation of the machine file.";
  if (!next.log) return "None of the simulated motions of this axis answers the open questions.";
  const auto& best = next.trajectories.front();
  return typeset(
      fmt::format("Run the set-points of {} on the machine and record a log{}: {} ({:.0f} s), {}. {} Diagnose the new "
                  "log together with these logs, or with these as --holdout.",
                  next_measurement_file_of(axis), next.times > 1 ? fmt::format(" {} times", next.times) : "", best.name,
                  best.duration, best.words, next.note));
}

}  // namespace

json next_measurement_json(const std::optional<NextMeasurement>& next, const std::string& axis) {
  if (!next) return nullptr;
  json asked = json::array(), rows = json::array(), elsewhere = json::array(), present = json::array();
  for (const auto& q : next->questions) {
    if (!q.by_motion) {
      elsewhere.push_back({{"title", title_of(q)}, {"separate_by", typeset(q.separate_by)}});
      continue;
    }
    asked.push_back(title_of(q));
    present.push_back(standard_errors(q.these_logs));
  }
  if (!asked.empty()) rows.push_back({{"name", "these logs"}, {"duration", nullptr}, {"standard_errors", present}});
  for (const auto& t : next->trajectories) {
    json separations = json::array();
    for (std::size_t k = 0; k < t.separations.size(); ++k)
      if (next->questions[k].by_motion) separations.push_back(standard_errors(t.separations[k]));
    rows.push_back(
        {{"name", t.name}, {"duration", fmt::format("{:.0f}", t.duration)}, {"standard_errors", separations}});
  }
  return {{"axis", next->axis},
          {"what", asked.empty() ? json(nullptr) : json(what_to_do(*next, axis))},
          {"spectrum", next->cam ? json(typeset(next->cam->spectrum)) : json(nullptr)},
          {"proposed", next->log.has_value()},
          {"questions", asked},
          {"rows", rows},
          {"elsewhere", elsewhere}};
}

}  // namespace stiction::host
