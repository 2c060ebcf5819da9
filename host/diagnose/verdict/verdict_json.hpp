// "stiction.verdict/1" (docs/schemas/verdict-1.json), and the same for a terminal.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/diagnose/verdict/verdict.hpp"

namespace stiction::host {

// Beside verdict.json: the set-points of what to record next.
inline constexpr const char* next_measurement_file = "next_measurement.csv";

// That of one axis of several: "next_measurement_X.csv". `axis`: its name; empty: the only one.
std::string next_measurement_file_of(const std::string& axis);

// The motion file of a cam to record next, in the same folder.
inline constexpr const char* next_measurement_cam_file = "next_measurement_cam.toml";

// That of one axis of several: "next_measurement_X_cam.toml". `axis`: its name; empty: the only one.
std::string next_measurement_cam_of(const std::string& axis);
// What runs the cam of `next` in that folder on the simulation of the extended machine. `axis`: as above.
std::string next_measurement_command(const NextMeasurement& next, const std::string& axis);

nlohmann::ordered_json verdict_json(const Verdict& verdict);
// Of several axes of the same logs, each under its name; of one the same as above.
nlohmann::ordered_json verdict_json(const std::vector<Verdict>& verdicts);
std::string verdict_text(const Verdict& verdict);
// One line: what to record next and what is expected of it.
std::string next_measurement_text(const NextMeasurement& next);

}  // namespace stiction::host
