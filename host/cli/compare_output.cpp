#include "host/cli/compare_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/log/own_units.hpp"
#include "host/output/circle_output.hpp"
#include "host/simulate/replay.hpp"

namespace stiction::host {
namespace {

using CompareJson = nlohmann::ordered_json;

CompareJson percent_of(const std::optional<double>& fraction) {
  return fraction ? CompareJson(*fraction * 100.0) : CompareJson(nullptr);
}

// `reference` or `log` is null: a document says with which of them it compares.
CompareJson compare_document(const CompareJson& reference, const CompareJson& log, const std::string& signals,
                             CompareJson machines) {
  return {{"schema", "stiction.compare/1"},
          {"reference", reference},
          {"log", log},
          {"signals", signals},
          {"machines", std::move(machines)}};
}

// Rows and deviations of one replay, an axis each.
void add_replayed(CompareJson& machine, const Log& log, const ReplayCase& replayed, const std::string& axis) {
  const auto matched = match_axes(replayed.machine, log, axis);
  for (std::size_t k = 0; k < log.axes.size(); ++k) {
    const auto& model = replayed.machine.axes[matched[k]];
    const auto d = compare_replay(log, replayed.simulated, k, replay_offset(log, replayed, k, axis));
    const auto [factor, unit] = shown_deviation(log.axes[k].rotary);
    const auto key = [unit = unit](const char* name) { return fmt::format("{}_{}", name, unit); };
    const auto withheld = withheld_replay(log, replayed, k, axis);
    CompareJson row{{"axis", model.name}, {"friction", model.friction.use}};
    if (withheld.empty()) {
      row[key("position_difference_rms")] = d.position * factor;
      row[key("following_error_rms")] = d.following_error * factor;
    } else {
      row["withheld"] = withheld;
    }
    CompareJson measured{{key("following_error_rms"), d.measured_following_error * factor}};
    CompareJson deviation{{"axis", model.name}, {"friction", model.friction.use}};
    if (const auto effort = effort_name(d); !effort.empty()) {
      const std::string in = effort == "torque" ? "N_m" : d.effort_unit;
      if (withheld.empty()) row[fmt::format("{}_difference_rms_{}", effort, in)] = d.effort;
      measured[fmt::format("{}_rms_{}", effort, in)] = d.measured_effort;
      const bool known = withheld.empty() && d.measured_effort > 0.0;
      deviation[effort + "_percent"] = percent_of(known ? std::optional(d.effort / d.measured_effort) : std::nullopt);
    }
    row["measured"] = std::move(measured);
    machine["rows"].push_back(std::move(row));
    machine["deviations"].push_back(std::move(deviation));
  }
}

}  // namespace

PublishedAgreement agreement_of(const std::vector<CircleTableRow>& table, const machine::Machine& machine) {
  PublishedAgreement a;
  for (const auto& row : table) {
    if (!row.error_quantised.published || !row.current.published) continue;
    const auto axis = std::find_if(machine.axes.begin(), machine.axes.end(),
                                   [&](const auto& candidate) { return candidate.name == row.axis; });
    const double increment = axis->position_controller.increment;
    const double off = std::abs(row.error_quantised.simulated - *row.error_quantised.published);
    ++a.cells;
    a.equal += off < 0.5 * increment;
    a.within_increment += off < 1.5 * increment;
    a.current_deviation += std::abs(row.current.simulated / *row.current.published - 1.0);
  }
  if (a.cells > 0) a.current_deviation /= a.cells;
  return a;
}

CompareJson compared_circle_json(const sim::CircleResult& result, const machine::Machine& machine,
                                 const std::vector<CircleTableRow>& table) {
  auto json = circle_json(result, machine);
  // The document has these.
  json.erase("schema");
  json.erase("signals");
  const auto a = agreement_of(table, machine);
  json["published_agreement"] = {{"cells", a.cells},
                                 {"equal", a.equal},
                                 {"within_one_increment", a.within_increment},
                                 {"mean_current_deviation_percent", a.current_deviation * 100.0}};
  json["deviations"] = CompareJson::array();
  for (const auto& mean : mean_deviations(table))
    json["deviations"].push_back({{"axis", mean.axis},
                                  {"friction", mean.friction},
                                  {"error_percent", percent_of(mean.error)},
                                  {"error_quantised_percent", percent_of(mean.error_quantised)},
                                  {"published_error_percent", percent_of(mean.error_published)},
                                  {"current_percent", percent_of(mean.current)},
                                  {"published_current_percent", percent_of(mean.current_published)}});
  return json;
}

CompareJson compare_reference_json(const std::string& signals, CompareJson machines) {
  return compare_document("circle", nullptr, signals, std::move(machines));
}

CompareJson compare_log_json(const Log& log, const std::vector<ReplayCase>& cases, const std::string& axis,
                             const std::string& signals) {
  auto machines = CompareJson::array();
  for (const auto& replayed : cases) {
    // The cases of a machine follow each other.
    if (machines.empty() || machines.back()["machine"] != replayed.machine.id)
      machines.push_back(
          {{"machine", replayed.machine.id}, {"rows", CompareJson::array()}, {"deviations", CompareJson::array()}});
    add_replayed(machines.back(), log, replayed, axis);
  }
  return compare_document(nullptr, log.source, signals, std::move(machines));
}

}  // namespace stiction::host
