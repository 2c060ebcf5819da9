// How a command that has an experiment's result ends: its folder is written, its figures are printed.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/cli/commands.hpp"
#include "host/report/origin.hpp"
#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

// report.html and result.json (`json`) of `result` on `machine` into the folder `out`, all of it or nothing; nothing
// where `out` is empty. `invocation`: of the command; `origin`: what the page says of its sources.
void write_experiment_folder(const std::string& out, const Invocation& invocation, const machine::Machine& machine,
                             const sim::ExperimentResult& result, const Origin& origin,
                             const nlohmann::ordered_json& json);

// A file that was asked for at `place`, as a list; empty: none was.
inline std::vector<std::string> written(const std::string& place) {
  return place.empty() ? std::vector<std::string>{} : std::vector{place};
}

// The figures of `result` on `machine` as text, with the places of the `logs` and of the report in `out` that were
// written (empty: none).
void print_experiment(const sim::ExperimentResult& result, const machine::Machine& machine,
                      const std::vector<std::string>& logs, const std::string& out);

}  // namespace stiction::host
