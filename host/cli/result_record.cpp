#include "host/cli/result_record.hpp"

#include <algorithm>
#include <array>
#include <fstream>

namespace stiction::host {
namespace {

// One of the first two marks a folder without a record as a result.
constexpr std::array usual_names{
    "result.json",  "verdict.json",         "report.html", "extended.toml", "identified.toml",          "tuned.toml",
    "machine.toml", "next_measurement.csv", "trace.csv",   "hidden.toml",   "next_measurement_cam.toml"};
constexpr std::size_t marks = 2;

}  // namespace

ResultRecord read_result_record(const std::filesystem::path& folder) {
  ResultRecord record;
  std::error_code none;
  std::ifstream file(folder / result_record_file);
  for (std::string line; std::getline(file, line);) {
    const auto tab = line.find('\t');
    if (line.starts_with('#') || tab == std::string::npos) continue;
    if (std::filesystem::exists(folder / line.substr(0, tab), none)) record[line.substr(0, tab)] = line.substr(tab + 1);
  }
  if (file.is_open()) return record;
  const auto there = [&](const char* name) { return std::filesystem::exists(folder / name, none); };
  if (std::none_of(usual_names.begin(), usual_names.begin() + marks, there)) return record;
  for (const char* name : usual_names)
    if (there(name)) record[name] = "";
  return record;
}

std::string result_record_text(const ResultRecord& record) {
  std::string text =
      "# Files that stiction made in this folder, and by which command; it replaces these and no others.\n";
  for (const auto& [name, command] : record) text += name + "\t" + command + "\n";
  return text;
}

}  // namespace stiction::host
