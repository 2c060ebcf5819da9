// A circle's figures as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "firmware/machine/model/machine.hpp"
#include "sim/experiment/circle_result.hpp"

namespace stiction::host {

// "stiction.circle/1": a row an axis, friction model, feed and direction; published and measured figures where the
// machine file has them.
nlohmann::ordered_json circle_json(const sim::CircleResult& result, const machine::Machine& machine);

// The same as a table for a terminal, with the circular errors of each run behind it.
std::string circle_text(const sim::CircleResult& result, const machine::Machine& machine);

}  // namespace stiction::host
