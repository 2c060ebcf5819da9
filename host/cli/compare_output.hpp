// "stiction.compare/1" (docs/schemas/compare-1.json): one shape for any number of machines, compared with the rows of
// their files or with a measured log.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"
#include "host/report/circle_table.hpp"
#include "host/simulate/replay_result.hpp"
#include "sim/experiment/circle_result.hpp"

namespace stiction::host {

// How a simulation agrees with the published rows of its machine file.
struct PublishedAgreement {
  int cells = 0;                   // rows with a published error and current
  int equal = 0;                   // quantised error equal to the published one
  int within_increment = 0;        // or one increment beside it
  double current_deviation = 0.0;  // mean |ours / published - 1|
};

// `table`: of the circles; `machine`: whose position controller quantises.
PublishedAgreement agreement_of(const std::vector<CircleTableRow>& table, const machine::Machine& machine);

// One item of `machines`. `result`: the circles that were run; `machine`: on which; `table`: the same circles as rows
// beside the references.
nlohmann::ordered_json compared_circle_json(const sim::CircleResult& result, const machine::Machine& machine,
                                            const std::vector<CircleTableRow>& table);

// The document of `compare --reference circle`. `machines`: items of compared_circle_json(); `signals`: "fixed" or
// "double".
nlohmann::ordered_json compare_reference_json(const std::string& signals, nlohmann::ordered_json machines);

// The document of `compare LOG`. `log`: the measured one; `cases`: its replays, in the order of the machines; `axis`:
// of the machine, for a log without axis names; `signals`: "fixed" or "double".
nlohmann::ordered_json compare_log_json(const Log& log, const std::vector<ReplayCase>& cases, const std::string& axis,
                                        const std::string& signals);

}  // namespace stiction::host
