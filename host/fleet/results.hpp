// What a fleet leaves behind: a summary (JSON), the estimates as a table (CSV and NumPy), sentences.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "host/fleet/run.hpp"

namespace stiction::host {

// "stiction.fleet/1" of `result` (docs/schemas/fleet-1.json).
nlohmann::ordered_json fleet_json(const FleetResult& result);

// A row for each record and parameter, a record that could not be judged has one row with its message.
std::string fleet_csv(const FleetResult& result);

// The same columns for NumPy. `place`: of fleet.npz. Throws std::runtime_error.
void write_fleet_npz(const FleetResult& result, const std::filesystem::path& place);

// "2 of 50 axes have alarms; the first: axis 7, Coulomb friction, up by 6.1 % since 2025-11-01 (alarm on 2026-01-01)."
std::string fleet_sentence(const FleetResult& result);

// One sentence of `result` on an alarm of the parameter `cause` of the axis `axis` (index in FleetTrends::axes).
std::string alarm_sentence(const FleetResult& result, std::size_t axis, FleetCause cause);

}  // namespace stiction::host
