// Charts of a result as charts.js draws them.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

// Each name of a series once, with the role or the friction model whose colour it takes. `points`: it is nowhere a
// line.
nlohmann::ordered_json series_json(const std::vector<sim::Chart>& charts);

// `chart`: what is drawn; `place`: the id of the page's element that it goes into; `record`: the log or run that it
// shows: charts of the same record over the same abscissa are magnified together; empty: of several records, or of
// none. A series is drawn from at most 3000 of its points (decimate.hpp, select_extremes). Throws std::invalid_argument
// when a series' x and y differ in length.
nlohmann::ordered_json chart_json(const sim::Chart& chart, const std::string& place, const std::string& record);

}  // namespace stiction::host
