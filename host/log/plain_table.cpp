// Tables of numbers with one header line: see recording.hpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "host/log/channel_name.hpp"
#include "host/log/csv_rows.hpp"
#include "host/log/message.hpp"
#include "host/log/recording.hpp"
#include "host/log/unit_scale.hpp"

namespace stiction::host {
namespace {

std::string_view line_at(std::string_view text) { return text.substr(0, text.find('\n')); }

// The separator that the line has most of.
char separator_of(std::string_view header) {
  char best = '\t';
  std::ptrdiff_t most = 0;
  for (const char candidate : {'\t', ';', ','})
    if (const auto count = std::ranges::count(header, candidate); count > most) best = candidate, most = count;
  return best;
}

// "speed [mm/s]" and "speed (mm/s)" state a unit.
void split_unit(std::string_view header, RecordedChannel& channel) {
  const auto split = split_channel_name(header);
  channel.name = header;
  if (!split.unit.empty()) {
    channel.unit = split.unit;
    channel.name = header.substr(0, header.rfind('['));
  } else if (const auto open = header.rfind('('); open != std::string_view::npos && header.ends_with(')')) {
    channel.unit = header.substr(open + 1, header.size() - open - 2);
    channel.name = header.substr(0, open);
  }
  channel.name.erase(channel.name.find_last_not_of(' ') + 1);
  channel.name.erase(0, std::min(channel.name.size(), channel.name.find_first_not_of(' ')));
}

}  // namespace

Recording read_plain_table(std::string_view text, const std::string& name, const TableForm& form) {
  Recording recording;
  recording.source = name;
  recording.kind = "a table";
  if (!form.time_column.empty()) recording.digits.significant = 0;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::size_t line = 1;
  const auto is_header = [&] {
    if (form.header_line > 0) return line == form.header_line;
    const auto first = line_at(text).find_first_not_of(" \t\r");
    return first != std::string_view::npos && text[first] != '#';
  };
  for (; !text.empty() && !is_header(); ++line) text.remove_prefix(std::min(text.size(), line_at(text).size() + 1));
  if (text.empty())
    throw LogError(fmt::format("{}:{}: found no header; expected the names of the channels", name, line));
  const char separator = form.separator == ' ' ? CsvRows::words
                         : form.separator != 0 ? form.separator
                                               : separator_of(line_at(text));
  CsvRows rows(text, separator, name, line);
  std::vector<std::string_view> fields;
  rows.next(fields);
  const std::size_t width = fields.size();
  std::size_t time = width;
  UnitScale time_scale;
  for (std::size_t k = 0; k < width; ++k) {
    auto& channel = recording.channels.emplace_back();
    split_unit(fields[k], channel);
    if (form.time_column.empty() || channel.name != form.time_column) continue;
    time = k;
    const auto& unit = form.time_unit.empty() ? channel.unit : form.time_unit;
    try {
      time_scale = UnitScale(unit, "s");
    } catch (const machine::UnitError& error) {
      throw LogError(
          fmt::format("{}: column {}, {}: found the unit '{}' ({}); expected one like s in [time] of the "
                      "mapping",
                      rows.place(), k + 1, excerpt(fields[k]), excerpt(unit), excerpt(error.what(), 120)));
    }
  }
  if (!form.time_column.empty() && time == width)
    throw LogError(fmt::format("{}: found no column '{}' among {} columns; expected the time that the mapping names",
                               rows.place(), excerpt(form.time_column), width));
  char decimal = form.decimal;
  if (decimal == 0) {
    const auto data = text.substr(std::min(text.size(), line_at(text).size()));
    decimal = separator != ',' && data.find(',') != std::string_view::npos ? ',' : '.';
  }
  for (std::size_t sample = 0; rows.next(fields);) {
    const bool empty = std::ranges::all_of(fields, [](auto f) { return f.find_first_not_of(" \r") == f.npos; });
    if (empty && rows.only_blanks_follow()) break;
    if (fields.size() != width)
      throw LogError(fmt::format("{}: found {} values; expected {}, one a column", rows.place(), fields.size(), width));
    double t = static_cast<double>(sample++) * form.period;
    if (time < width && !parse_number(fields[time], decimal, t))
      throw LogError(
          fmt::format("{}: column {}: found '{}'; expected a time", rows.place(), time + 1, excerpt(fields[time])));
    for (std::size_t k = 0; k < width; ++k) {
      auto& channel = recording.channels[k];
      double value = 0.0;
      // A blank cell is no sample: the channel begins later, ends earlier or is slower.
      if (k == time || !channel.bad.empty() || fields[k].find_first_not_of(" \t\r") == std::string_view::npos) continue;
      if (!parse_number(fields[k], decimal, value)) {
        channel.bad = fmt::format("{}: column {}, {}: found '{}'", rows.place(), k + 1, excerpt(channel.name),
                                  excerpt(fields[k]));
        continue;
      }
      channel.t.push_back(time_scale(t));
      channel.values.push_back(value);
      channel.lines.push_back(rows.line());
    }
    if (time < width) count_digits(fields[time], recording.digits, time_scale.factor());
  }
  if (time < width) recording.channels.erase(recording.channels.begin() + static_cast<std::ptrdiff_t>(time));
  return recording;
}

}  // namespace stiction::host
