#include "host/log/csv_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "host/log/channel_name.hpp"
#include "host/log/csv_rows.hpp"
#include "host/log/message.hpp"
#include "host/log/sampling.hpp"
#include "host/log/text_file.hpp"
#include "host/log/unit_scale.hpp"

namespace stiction::host {
namespace {

constexpr std::string_view blanks = " \t";

std::string_view trimmed(std::string_view text) {
  if (text.empty() || (static_cast<unsigned char>(text.front()) > ' ' && static_cast<unsigned char>(text.back()) > ' '))
    return text;
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

// Takes the leading "# key: value" lines off `text`; returns how many there were.
std::size_t take_comments(std::string_view& text, Log& log) {
  std::size_t lines = 0;
  while (text.starts_with('#')) {
    const auto end = text.find('\n');
    auto line = text.substr(1, end == std::string_view::npos ? end : end - 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    const auto colon = line.find(':');
    const auto value = colon == std::string_view::npos ? std::string_view{} : line.substr(colon + 1);
    log.comments.emplace_back(trimmed(line.substr(0, colon)), trimmed(value));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++lines;
  }
  return lines;
}

// One column that is read. A pointer to the axis would not outlive the vector's growth.
struct Column {
  std::size_t field = 0;
  std::size_t axis = 0;
  std::vector<double> AxisLog::*values = nullptr;  // null: the time
  UnitScale scale;
};

UnitScale scale_of(const CsvRows& rows, std::size_t field, std::string_view header, const ChannelName& split,
                   std::string_view unit) {
  const auto place = [&] { return fmt::format("{}: column {}, {}", rows.place(), field + 1, excerpt(header)); };
  const auto wanted = fmt::format("expected a unit like that of {}[{}]", split.name, unit);
  if (split.unit.empty()) throw LogError(fmt::format("{}: found no unit; {}", place(), wanted));
  try {
    return {split.unit, unit};
  } catch (const machine::UnitError& error) {
    throw LogError(
        fmt::format("{}: found [{}] ({}); {}", place(), excerpt(split.unit), excerpt(error.what(), 120), wanted));
  }
}

void refuse_other_separator(const CsvRows& rows, const std::vector<std::string_view>& header) {
  if (header.size() != 1) return;
  for (const auto& [separator, name] : {std::pair{'\t', "tabs"}, std::pair{';', "semicolons"}})
    if (header[0].find(separator) != std::string_view::npos)
      throw LogError(
          fmt::format("{}: found a header with {} between the columns; expected commas (`stiction convert --map` reads "
                      "different tables)",
                      rows.place(), name));
}

std::vector<Column> columns_of(const CsvRows& rows, const std::vector<std::string_view>& header, Log& log) {
  refuse_other_separator(rows, header);
  std::vector<Column> columns;
  std::set<std::string_view> seen;
  std::map<std::string_view, std::size_t> axes;
  bool has_time = false;
  for (std::size_t field = 0; field < header.size(); ++field) {
    const auto split = split_channel_name(header[field]);
    const bool time = split.axis.empty() && split.name == "t";
    const auto* channel = time ? nullptr : find_channel(split.name);
    if (!time && channel == nullptr) {
      log.ignored.emplace_back(header[field]);
      continue;
    }
    // The text from the axis to the name.
    const auto whole = split.axis.empty()
                           ? split.name
                           : std::string_view(split.axis.data(), split.axis.size() + 1 + split.name.size());
    if (!seen.insert(whole).second)
      throw LogError(fmt::format("{}: column {}: found {} a second time; expected it once", rows.place(), field + 1,
                                 excerpt(whole)));
    Column column{field, 0, nullptr, scale_of(rows, field, header[field], split, time ? "s" : channel->unit)};
    if (channel != nullptr) {
      const auto [axis, is_new] = axes.try_emplace(split.axis, axes.size());
      if (is_new) log.axes.emplace_back().axis = split.axis;
      column.axis = axis->second;
      column.values = channel->values;
    }
    has_time = has_time || time;
    columns.push_back(column);
  }
  if (!has_time) throw LogError(rows.place() + ": found no column t[s]; expected the time of every sample");
  return columns;
}

class Reader {
 public:
  Reader(std::string_view text, std::string name) : name_(std::move(name)) {
    log_.source = name_;
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    const auto comments = take_comments(text, log_);
    rows_.emplace_back(text, ',', name_, comments + 1);
  }

  Log read() {
    auto& rows = rows_.front();
    if (rows.only_blanks_follow()) throw LogError(name_ + ":1: found no header; expected t[s], x[m], ...");
    rows.next(fields_);
    const std::size_t width = fields_.size();
    std::vector<std::string> names(fields_.begin(), fields_.end());
    columns_ = columns_of(rows, fields_, log_);
    const auto header_place = rows.place();
    while (rows.next(fields_)) {
      const bool empty = fields_.size() == 1 && trimmed(fields_[0]).empty();
      if (empty && rows.only_blanks_follow()) break;
      if (fields_.size() != width)
        throw LogError(fmt::format("{}: found {}; expected {} values, one a column", rows.place(),
                                   empty ? "an empty line" : fmt::format("{} values", fields_.size()), width));
      add_row(names);
      lines_.push_back(rows.line());
    }
    if (!log_.t.empty()) require_channels(log_, header_place);
    check_sampling(log_, digits_, [&](std::size_t k) {
      return fmt::format("{}:{}", name_, k < lines_.size() ? lines_[k] : rows.line());
    });
    return std::move(log_);
  }

 private:
  void add_row(const std::vector<std::string>& names) {
    for (const auto& column : columns_) {
      const auto text = trimmed(fields_[column.field]);
      const double value = column.scale(number(text, column.field, names));
      if (!std::isfinite(value)) fail(column.field, names, text, "a number in the range of double precision");
      if (column.values != nullptr) {
        (log_.axes[column.axis].*column.values).push_back(value);
        continue;
      }
      if (!log_.t.empty() && !(value > log_.t.back()))
        fail(column.field, names, text,
             fmt::format("a time after that of the sample before ({:.10g} s)", log_.t.back()));
      log_.t.push_back(value);
      count_digits(text, digits_, column.scale.factor());
    }
  }

  double number(std::string_view text, std::size_t field, const std::vector<std::string>& names) const {
    auto digits = text;
    if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc{} && end == digits.data() + digits.size() && std::isfinite(value)) return value;
    if (text.find(',') != std::string_view::npos)
      fail(field, names, text, "a point as decimal mark (`stiction convert --map` reads different tables)");
    fail(field, names, text, "a finite number");
  }

  [[noreturn]] void fail(std::size_t field, const std::vector<std::string>& names, std::string_view found,
                         const std::string& expected) const {
    throw LogError(fmt::format("{}: column {}, {}: found {}; expected {}", rows_.front().place(), field + 1,
                               excerpt(names[field]),
                               found.empty() ? std::string("nothing") : "'" + excerpt(found) + "'", expected));
  }

  std::string name_;
  Log log_;
  std::vector<CsvRows> rows_;  // one, made after the comments are off
  std::vector<Column> columns_;
  std::vector<std::string_view> fields_;
  std::vector<std::size_t> lines_;  // of the samples
  StampDigits digits_{0.0, 0};
};

std::string one_line(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

}  // namespace

Log parse_csv_log(std::string_view text, const std::string& name) { return Reader(text, name).read(); }

Log read_csv_log(const std::filesystem::path& file) { return parse_csv_log(read_text_file(file), file.string()); }

std::string csv_log_text(const Log& log) {
  std::string text;
  for (const auto& [key, value] : log.comments)
    text += one_line(value.empty() ? "# " + key : "# " + key + ": " + value) + "\n";
  std::vector<const std::vector<double>*> columns{&log.t};
  text += "t[s]";
  for (const auto& axis : log.axes)
    for (const auto& channel : log_channels) {
      if ((axis.*channel.values).empty()) continue;
      text += "," + channel_header(axis.axis, channel);
      columns.push_back(&(axis.*channel.values));
    }
  text += '\n';
  for (std::size_t k = 0; k < log.t.size(); ++k) {
    for (const auto* column : columns) {
      if (column != columns.front()) text += ',';
      fmt::format_to(std::back_inserter(text), "{}", (*column)[k]);
    }
    text += '\n';
  }
  return text;
}

void write_csv_log(const std::filesystem::path& file, const Log& log) { write_text_file(file, csv_log_text(log)); }

}  // namespace stiction::host
