// The list of a fleet's records: which axis, of which machine file, measured when, in which log. A table (CSV) or a
// TOML file; docs/scale.md describes both.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace stiction::host {

inline constexpr std::string_view fleet_list_schema = "stiction.fleet-list/1";

struct FleetRecord {
  std::size_t axis = 0;        // index in FleetList::axes
  std::string date;            // "2026-03-01"
  double day = 0.0;            // since 1970-01-01
  std::string log;             // as the list names it
  std::filesystem::path file;  // where it is: relative names are those of the list's folder
  std::string place;           // "LIST:LINE", for messages
};

struct FleetAxis {
  std::string name;                  // unique in the fleet
  std::string machine;               // as the list names it
  std::filesystem::path file;        // of the machine
  std::string machine_axis;          // the axis in the machine file; empty: its only one
  std::vector<std::size_t> records;  // indices in FleetList::records, by date
};

struct FleetList {
  std::string file;
  std::vector<FleetAxis> axes;       // in the order in which the list has them
  std::vector<FleetRecord> records;  // by axis, then by date
};

// The list in `place`: a file *.csv or *.toml, or a folder with fleet.csv or fleet.toml. Throws
// machine::MachineFileError with the line: an unknown column or key, a date that is none, two records of an axis on one
// date, an axis with two machine files, a machine that is not found, an empty list.
FleetList read_fleet_list(const std::filesystem::path& place);

// The same of a `text` in the format that the ending of `file` says; names are relative to the folder of `file`.
FleetList parse_fleet_list(const std::filesystem::path& file, const std::string& text);

// Days from 1970-01-01 to `date`, "YYYY-MM-DD". Throws std::invalid_argument for what is no date.
double day_of(const std::string& date);

}  // namespace stiction::host
