#include <fmt/format.h>

#include "host/cli/cam_output.hpp"

namespace stiction::host {

nlohmann::ordered_json rank_json(const Ranking& ranking, const RankTask& task, const AxisLoad& load) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const RankedLaw& row : ranking.laws)
    rows.push_back({{"name", std::string(row.law->name)},
                    {"task", task_of(*row.law)},
                    {"speed", row.speed},
                    {"acceleration", row.acceleration},
                    {"jerk", row.jerk},
                    {"effort", row.effort},
                    {"residual", row.residual},
                    {"jumps", row.jumps},
                    {"breaks_a_limit", row.broken},
                    {"pareto", row.front}});
  return {{"schema", "stiction.cam-rank/1"},
          {"axis", load.axis},
          {"slave_unit", load.unit()},
          {"effort_unit", load.effort_unit()},
          {"stroke", task.stroke},
          {"rise", task.rise},
          {"master_speed", task.master_speed},
          {"band_Hz", {task.lowest, task.highest}},
          {"laws", rows},
          {"recommended", ranking.recommended
                              ? nlohmann::ordered_json(std::string(ranking.laws[*ranking.recommended].law->name))
                              : nlohmann::ordered_json(nullptr)},
          {"reason", ranking.reason}};
}

std::string rank_text(const Ranking& ranking, const RankTask& task, const AxisLoad& load) {
  const std::string unit = load.unit();
  std::string text =
      fmt::format("Laws {} on {}, {:.4g} {} in {:.4g} s; residual oscillation for {:.4g} to {:.4g} Hz.\n\n", task.task,
                  load.axis, task.stroke, unit, task.rise / task.master_speed, task.lowest, task.highest);
  text += fmt::format("  {:<29} {:<4} {:>12} {:>12} {:>12} {:>12}  {}\n", "law", "task", unit + "/s", unit + "/s²",
                      load.effort_unit(), "residual " + unit, "");
  for (const RankedLaw& row : ranking.laws)
    text += fmt::format("{} {:<29} {:<4} {:>12.5g} {:>12.5g} {:>12.5g} {:>12.3g}  {}{}\n", row.front ? "*" : " ",
                        row.law->name, task_of(*row.law), row.speed, row.acceleration, row.effort, row.residual,
                        row.jumps ? "J " : "", row.broken ? "breaks a limit" : "");
  return text + "\n*: no law is better in speed, acceleration, " + (unit == "rad" ? "torque" : "force") +
         " and residual. J: its acceleration jumps.\n" + ranking.reason + "\n";
}

}  // namespace stiction::host
