#include "host/identify/steady_table.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numbers>
#include <set>

#include "firmware/machine/model/motor_force.hpp"
#include "host/log/channel_name.hpp"
#include "host/log/csv_rows.hpp"
#include "host/log/message.hpp"
#include "host/log/unit_scale.hpp"

namespace stiction::host {
namespace {

constexpr std::size_t least_speeds = 3;  // with fewer, a straight line has no residual

std::string_view without_blanks(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// Takes the leading comments off; calls take(key, value) for each. Returns how many lines there were.
template <class Take>
std::size_t skip_comments(std::string_view& text, Take&& take) {
  std::size_t lines = 0;
  for (; text.starts_with('#'); ++lines) {
    const auto end = std::min(text.find('\n'), text.size());
    const auto line = text.substr(1, end - 1);
    const auto colon = std::min(line.find(':'), line.size());
    take(without_blanks(line.substr(0, colon)), without_blanks(line.substr(std::min(colon + 1, line.size()))));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

double number(const CsvRows& rows, std::string_view header, std::string_view field) {
  const auto text = without_blanks(field);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
    throw LogError(
        fmt::format("{}: column {}: found '{}'; expected a number", rows.place(), excerpt(header), excerpt(field)));
  return value;
}

UnitScale scale_of(const CsvRows& rows, std::string_view header, std::string_view unit, std::string_view wanted) {
  try {
    if (!unit.empty()) return {unit, wanted};
  } catch (const machine::UnitError&) {
  }
  throw LogError(
      fmt::format("{}: found the column {}; expected a unit like [{}]", rows.place(), excerpt(header), wanted));
}

}  // namespace

std::optional<Amperes> parse_amperes(std::string_view text) {
  if (text == "peak" || text == "amplitude") return Amperes::amplitude;
  if (text == "rms" || text == "RMS") return Amperes::rms;
  return std::nullopt;
}

bool is_steady_table(std::string_view text) {
  skip_comments(text, [](auto, auto) {});
  CsvRows rows(text.substr(0, text.find('\n')), ',', "");
  std::vector<std::string_view> header;
  try {
    if (!rows.next(header)) return false;
  } catch (const LogError&) {
    return false;
  }
  bool time = false, speed = false;
  for (const auto& each : header) {
    const auto name = split_channel_name(without_blanks(each));
    time = time || name.name == "t" || name.name == "x";
    speed = speed || name.name == "v";
  }
  return speed && !time;
}

SteadyTable parse_steady_table(std::string_view text, const std::string& name) {
  SteadyTable table;
  table.source = name;
  std::string unread;
  const auto lines = skip_comments(text, [&](std::string_view key, std::string_view value) {
    if (key != "amperes") return;
    table.amperes = parse_amperes(value);
    if (!table.amperes) unread = value;
  });
  if (!unread.empty())
    throw LogError(fmt::format("{}: found amperes: '{}'; expected peak, amplitude or rms", name, excerpt(unread)));
  CsvRows rows(text, ',', name, lines + 1);
  std::vector<std::string_view> fields;
  if (!rows.next(fields))
    throw LogError(fmt::format("{}: found no header; expected v[m/min],i[A] or v[m/s],F[N]", name));
  struct Column {
    std::string header;
    UnitScale scale;
    std::vector<double>* values;
  };
  std::vector<Column> columns;
  for (const auto& field : fields) {
    const auto header = without_blanks(field);
    const auto split = split_channel_name(header);
    if (split.name == "v")
      columns.push_back({std::string(header), scale_of(rows, header, split.unit, "m/s"), &table.speed});
    else if (split.name == "i")
      columns.push_back({std::string(header), scale_of(rows, header, split.unit, "A"), &table.current});
    else if (split.name == "F")
      columns.push_back({std::string(header), scale_of(rows, header, split.unit, "N"), &table.force});
    else
      columns.push_back({std::string(header), {}, nullptr});
  }
  while (rows.next(fields)) {
    if (fields.size() == 1 && without_blanks(fields[0]).empty() && rows.only_blanks_follow()) break;
    if (fields.size() != columns.size())
      throw LogError(fmt::format("{}: found {} fields; expected {}, as in the header", rows.place(), fields.size(),
                                 columns.size()));
    for (std::size_t k = 0; k < fields.size(); ++k)
      if (columns[k].values != nullptr)
        columns[k].values->push_back(columns[k].scale(number(rows, columns[k].header, fields[k])));
  }
  if (table.current.size() != table.speed.size() && table.force.size() != table.speed.size())
    throw LogError(
        fmt::format("{}: found a table without forces; expected a column i[A] or F[N] in addition to v", name));
  return table;
}

SlidingData sliding_data(const SteadyTable& table, const machine::AxisModel& axis, std::optional<Amperes> stated) {
  std::vector<double> force = table.force;
  if (force.empty()) {
    const auto amperes = table.amperes ? table.amperes : stated;
    if (!amperes)
      throw LogError(
          fmt::format("{}: found currents without their convention; expected --amperes peak or --amperes rms, or a "
                      "line \"# amperes: rms\" before the header",
                      table.source));
    const double scale =
        machine::acting_force_constant(axis.motor) * (*amperes == Amperes::rms ? std::numbers::sqrt2 : 1.0);
    for (const double i : table.current) force.push_back(scale * i);
  }
  std::set<double> speeds;
  double dissipated = 0.0;
  for (std::size_t k = 0; k < force.size(); ++k) {
    speeds.insert(std::abs(table.speed[k]));
    dissipated += force[k] * (table.speed[k] > 0.0 ? 1.0 : -1.0);
  }
  speeds.erase(0.0);
  if (speeds.size() < least_speeds)
    throw LogError(
        fmt::format("{}: found {} different speeds; expected at least {}. Record constant speeds from a few "
                    "mm/s up to the highest",
                    table.source, speeds.size(), least_speeds));
  if (dissipated <= 0.0)
    throw LogError(
        fmt::format("{}: found forces with the opposite sign of the speed, although friction opposes motion; expected "
                    "the same sign. Reverse one of them",
                    table.source));
  SlidingData data;
  const auto n = static_cast<Eigen::Index>(force.size());
  data.speed = Eigen::Map<const Eigen::VectorXd>(table.speed.data(), n);
  data.force = Eigen::Map<const Eigen::VectorXd>(force.data(), n);
  data.sign = data.speed.cwiseSign();
  const bool both_ways = data.sign.minCoeff() < 0.0 && data.sign.maxCoeff() > 0.0;
  data.others = Eigen::MatrixXd::Ones(n, both_ways ? 1 : 0);
  for (std::size_t k = 0; k < force.size(); ++k) data.blocks.push_back({k, k + 1});
  return data;
}

}  // namespace stiction::host
