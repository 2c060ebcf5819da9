#include "host/fleet/fleet_list.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "firmware/machine/file/machine_file.hpp"
#include "firmware/machine/file/nearest_name.hpp"
#include "firmware/machine/file/quantity_table.hpp"
#include "firmware/machine/file/whole_file.hpp"

namespace stiction::host {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 5> columns{"axis", "machine", "date", "log", "machine_axis"};
constexpr std::size_t needed = 4;  // of them

struct Entry {
  std::array<std::string, columns.size()> cells;  // in the order of columns
  std::string place;
};

[[noreturn]] void fail(const std::string& place, const std::string& problem) {
  throw machine::MachineFileError(fmt::format("{}: {}", place, problem));
}

// Cells of a line: separated by commas, in double quotes where they contain one (RFC 4180, without line breaks).
std::vector<std::string> cells_of(const std::string& line, const std::string& place) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const char c = line[k];
    if (quoted && c == '"' && k + 1 < line.size() && line[k + 1] == '"') {
      cells.back() += line[++k];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  if (quoted) fail(place, "found a quotation mark that does not end; expected it to end in the same line");
  for (auto& cell : cells) {
    const auto first = cell.find_first_not_of(" \t\r");
    cell = first == std::string::npos ? "" : cell.substr(first, cell.find_last_not_of(" \t\r") - first + 1);
  }
  return cells;
}

std::vector<Entry> csv_entries(const fs::path& file, const std::string& text) {
  std::istringstream in(text);
  std::string line;
  std::vector<Entry> entries;
  std::vector<std::size_t> order;  // of each cell, its column
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    if (number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
    const auto place = fmt::format("{}:{}", file.string(), number);
    const auto cells = cells_of(line, place);
    if (cells.front().starts_with('#') || (cells.size() == 1 && cells.front().empty())) continue;
    if (order.empty()) {
      for (const auto& cell : cells) {
        const auto found = std::find(columns.begin(), columns.end(), cell);
        if (found == columns.end())
          fail(place, fmt::format("found the column '{}'; expected axis, machine, date, log and perhaps machine_axis{}",
                                  cell, machine::did_you_mean(cell, {columns.begin(), columns.end()})));
        order.push_back(static_cast<std::size_t>(found - columns.begin()));
        if (std::count(order.begin(), order.end(), order.back()) > 1)
          fail(place, fmt::format("found the column '{}' twice; expected it once", cell));
      }
      for (std::size_t k = 0; k < needed; ++k)
        if (std::find(order.begin(), order.end(), k) == order.end())
          fail(place, fmt::format("found no column '{}'; expected axis, machine, date and log", columns[k]));
      continue;
    }
    if (cells.size() != order.size())
      fail(place, fmt::format("found {} cells; expected {} as in the first line", cells.size(), order.size()));
    Entry entry{{}, place};
    for (std::size_t k = 0; k < cells.size(); ++k) entry.cells[order[k]] = cells[k];
    entries.push_back(std::move(entry));
  }
  return entries;
}

std::vector<Entry> toml_entries(const fs::path& file, const std::string& text) {
  const machine::Document document(file.string(), text);
  const machine::QuantityTable root(document, document.root(), "");
  root.allow({"schema", "record"});
  if (root.text("schema", "the format") != fleet_list_schema)
    root.fail("schema", root.has("schema") ? "a different one" : "no such key",
              fmt::format("\"{}\"", fleet_list_schema));
  std::vector<Entry> entries;
  for (const auto& record : root.subtables("record", "a record of an axis")) {
    record.allow({columns.begin(), columns.end()});
    Entry entry{{}, document.place(record.table().source(), "record")};
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const auto value = record.text(columns[k], "of the record");
      if (!value && k < needed) record.fail(columns[k], "no such key", fmt::format("{} of the record", columns[k]));
      entry.cells[k] = value.value_or("");
    }
    entries.push_back(std::move(entry));
  }
  return entries;
}

// A file beside the list, else a machine that ships.
fs::path machine_of_list(const std::string& name, const fs::path& folder, const std::string& place) {
  std::error_code none;
  if (fs::is_regular_file(folder / name, none)) return folder / name;
  try {
    return machine::find_machine(name);
  } catch (const machine::MachineFileError& error) {
    fail(place, error.what());
  }
}

class ListBuilder {
 public:
  explicit ListBuilder(const fs::path& file) : folder_(file.parent_path()) { list_.file = file.string(); }

  void add(const Entry& entry) {
    for (std::size_t k = 0; k < needed; ++k)
      if (entry.cells[k].empty()) fail(entry.place, fmt::format("found no {}; expected one", columns[k]));
    const auto& [axis, machine, date, log, machine_axis] = entry.cells;
    FleetRecord record;
    record.axis = axis_index(entry);
    record.date = date;
    try {
      record.day = day_of(date);
    } catch (const std::invalid_argument& error) {
      fail(entry.place, fmt::format("date: {}", error.what()));
    }
    record.log = log;
    record.file = fs::path(log).is_absolute() ? fs::path(log) : folder_ / log;
    record.place = entry.place;
    list_.records.push_back(std::move(record));
  }

  FleetList finish() {
    if (list_.records.empty()) fail(list_.file, "found no record; expected at least one");
    std::stable_sort(list_.records.begin(), list_.records.end(), [](const FleetRecord& a, const FleetRecord& b) {
      return a.axis != b.axis ? a.axis < b.axis : a.day < b.day;
    });
    for (std::size_t k = 0; k < list_.records.size(); ++k) {
      const auto& record = list_.records[k];
      auto& axis = list_.axes[record.axis];
      if (!axis.records.empty() && list_.records[axis.records.back()].day == record.day)
        fail(record.place, fmt::format("found a second record of axis {} on {}, after {}; expected one a day",
                                       axis.name, record.date, list_.records[axis.records.back()].place));
      axis.records.push_back(k);
    }
    return std::move(list_);
  }

 private:
  std::size_t axis_index(const Entry& entry) {
    const auto& [name, machine, date, log, machine_axis] = entry.cells;
    const auto known = index_.find(name);
    if (known == index_.end()) {
      index_[name] = list_.axes.size();
      list_.axes.push_back({name, machine, machine_of_list(machine, folder_, entry.place), machine_axis, {}});
      return list_.axes.size() - 1;
    }
    const auto& axis = list_.axes[known->second];
    if (axis.machine != machine || axis.machine_axis != machine_axis)
      fail(entry.place, fmt::format("found axis {} with machine '{}{}{}'; expected '{}{}{}' as in its first record",
                                    name, machine, machine_axis.empty() ? "" : ", axis ", machine_axis, axis.machine,
                                    axis.machine_axis.empty() ? "" : ", axis ", axis.machine_axis));
    return known->second;
  }

  fs::path folder_;
  FleetList list_;
  std::map<std::string, std::size_t> index_;
};

}  // namespace

double day_of(const std::string& date) {
  const auto wrong = [&] {
    return std::invalid_argument(fmt::format("found '{}'; expected a day as 2026-03-01", date));
  };
  if (date.size() != 10 || date[4] != '-' || date[7] != '-') throw wrong();
  for (const std::size_t k : {0U, 1U, 2U, 3U, 5U, 6U, 8U, 9U})
    if (date[k] < '0' || date[k] > '9') throw wrong();
  const std::chrono::year_month_day day{std::chrono::year(std::stoi(date.substr(0, 4))),
                                        std::chrono::month(static_cast<unsigned>(std::stoi(date.substr(5, 2)))),
                                        std::chrono::day(static_cast<unsigned>(std::stoi(date.substr(8, 2))))};
  if (!day.ok()) throw wrong();
  return static_cast<double>(std::chrono::sys_days(day).time_since_epoch().count());
}

FleetList parse_fleet_list(const fs::path& file, const std::string& text) {
  ListBuilder builder(file);
  for (const auto& entry : file.extension() == ".toml" ? toml_entries(file, text) : csv_entries(file, text))
    builder.add(entry);
  return builder.finish();
}

FleetList read_fleet_list(const fs::path& place) {
  auto file = place;
  if (fs::is_directory(place)) {
    file = place / "fleet.csv";
    if (!fs::exists(file)) file = place / "fleet.toml";
    if (!fs::exists(file))
      fail(place.string(), "found a folder without fleet.csv and fleet.toml; expected one of them in it");
  }
  return parse_fleet_list(file, machine::read_whole_file(file, "a list of records"));
}

}  // namespace stiction::host
