#include "host/log/csv_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <set>

#include "firmware/machine/file/whole_file.hpp"
#include "host/log/channel_name.hpp"
#include "host/log/csv_rows.hpp"
#include "host/log/message.hpp"
#include "host/log/sampling.hpp"
#include "host/log/table_form.hpp"
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
  bool whole = false;  // numbers
};

// `channel`: null for the time.
ChannelScale scale_of(const std::string& header_place, std::size_t field, std::string_view header,
                      const ChannelName& split, const LogChannel* channel) {
  const auto place = [&] { return fmt::format("{}: column {}, {}", header_place, field + 1, excerpt(header)); };
  const bool rotary = channel != nullptr && split.name != channel->name;
  const std::string_view unit = channel == nullptr ? "s" : rotary ? channel->rotary_unit : channel->unit;
  const auto wanted = fmt::format("expected a unit like that of {}[{}]", split.name, unit);
  if (split.unit.empty() && (channel == nullptr || !channel->whole))
    throw LogError(fmt::format("{}: found no unit; {}", place(), wanted));
  try {
    if (channel == nullptr) return {{split.unit, unit}, AxisKind::either};
    return channel_scale(*channel, split.name, split.unit);
  } catch (const machine::UnitError& error) {
    throw LogError(
        fmt::format("{}: found [{}] ({}); {}", place(), excerpt(split.unit), excerpt(error.what(), 120), wanted));
  }
}

std::vector<Column> columns_of(const std::string& header_place, const std::vector<std::string_view>& header, Log& log,
                               AxisKinds& kinds) {
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
      throw LogError(fmt::format("{}: column {}: found {} a second time; expected it once", header_place, field + 1,
                                 excerpt(whole)));
    const auto [scale, kind] = scale_of(header_place, field, header[field], split, channel);
    Column column{field, 0, nullptr, scale};
    if (channel != nullptr) {
      kinds.add(split.axis, kind, header[field], header_place);
      column.whole = channel->whole;
      const auto [axis, is_new] = axes.try_emplace(split.axis, axes.size());
      if (is_new) log.axes.emplace_back().axis = split.axis;
      column.axis = axis->second;
      column.values = channel->values;
    }
    has_time = has_time || time;
    columns.push_back(column);
  }
  if (!has_time) {
    const bool numbers = std::ranges::any_of(header, [](std::string_view name) {
      double value = 0.0;
      return Decimals('\0').read(trimmed(name), value);
    });
    throw LogError(fmt::format(
        "{}: found {}; expected the time of every sample as t[s] ({})", header_place,
        numbers ? "numbers where the names of the columns should be" : "no column t[s]",
        "--columns \"t[ms],x[mm],i[mA]\" names the columns of any table, `stiction convert --map` those of a "
        "recording"));
  }
  return columns;
}

// The lines of the samples. Nearly always they follow each other, and take no memory then.
class SampleLines {
 public:
  void add(std::size_t line) {
    if (count_ == 0) first_ = line;
    if (lines_.empty() && line != first_ + count_)
      for (std::size_t k = 0; k < count_; ++k) lines_.push_back(first_ + k);
    if (!lines_.empty() || line != first_ + count_) lines_.push_back(line);
    ++count_;
  }
  std::size_t of(std::size_t sample, std::size_t behind) const {
    if (sample >= count_) return behind;
    return lines_.empty() ? first_ + sample : lines_[sample];
  }

 private:
  std::size_t first_ = 0, count_ = 0;
  std::vector<std::size_t> lines_;
};

class Reader {
 public:
  Reader(TextSource source, std::string name, std::string_view columns)
      : name_(std::move(name)), source_(std::move(source)), stated_(columns) {
    log_.source = name_;
  }

  Log read() {
    auto text = source_.next();
    std::size_t line = 1 + take_comments(text, log_);
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
      throw LogError(name_ + ":1: found no header; expected t[s], x[m], ...");
    if (!stated_.empty()) line += skip_header(text, line);
    const auto first = text.substr(0, text.find('\n'));
    const char separator = stated_.empty() ? header_separator(first)
                                           : static_cast<char>(number_separator(first, column_names(stated_).size()));
    decimals_ = Decimals(separator);
    rows_.emplace_back(text, source_, separator, name_, line);
    auto& rows = rows_.front();
    if (stated_.empty())
      rows.next(fields_);
    else
      fields_ = column_names(stated_);
    names_.assign(fields_.begin(), fields_.end());
    const std::vector<std::string_view> header(names_.begin(), names_.end());
    const auto header_place = stated_.empty() ? rows.place() : name_ + ": --columns";
    columns_ = columns_of(header_place, header, log_, kinds_);
    read_rows(rows);
    share_channels(log_);
    kinds_.mark(log_);
    drop_blank_channels(log_);
    if (!log_.t.empty()) require_channels(log_, header_place);
    check_sampling(log_, digits_,
                   [&](std::size_t k) { return fmt::format("{}:{}", name_, lines_.of(k, rows.line())); });
    return std::move(log_);
  }

 private:
  // Takes off what stands before the first row of numbers: names of columns that --columns replaces, lines of units.
  std::size_t skip_header(std::string_view& text, std::size_t first_line) {
    constexpr std::size_t most = 100;
    const auto width = column_names(stated_).size();
    auto rest = text;
    std::string_view begin = text.substr(0, text.find('\n'));
    for (std::size_t skipped = 0; skipped < most && !rest.empty(); ++skipped) {
      const auto end = rest.find('\n');
      const auto line = rest.substr(0, end);
      if (number_separator(line, width) >= 0) {
        text = rest;
        return skipped;
      }
      if (!line.empty() && ((line[0] >= '0' && line[0] <= '9') || line[0] == '-' || line[0] == '+' || line[0] == '.')) {
        begin = line;
        first_line += skipped;
        break;
      }
      rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    }
    throw LogError(fmt::format("{}:{}: found '{}'; expected a row of {} numbers, as --columns names so many", name_,
                               first_line, excerpt(trimmed(begin)), width));
  }

  void read_rows(CsvRows& rows) {
    const std::size_t width = names_.size();
    std::string blank_place;
    while (rows.next(fields_)) {
      const bool blank = std::ranges::all_of(fields_, [](auto field) { return trimmed(field).empty(); });
      if (!blank_place.empty() && !blank)
        throw LogError(fmt::format("{}: found an empty line; expected {} values, one a column", blank_place, width));
      if (blank) {
        if (blank_place.empty()) blank_place = rows.place();
        continue;
      }
      if (fields_.size() != width)
        throw LogError(
            fmt::format("{}: found {} values; expected {}, one a column", rows.place(), fields_.size(), width));
      add_row();
      lines_.add(rows.line());
    }
  }

  void add_row() {
    for (const auto& column : columns_) {
      const auto text = trimmed(fields_[column.field]);
      if (column.values != nullptr) {
        const double value = text.empty() ? std::numeric_limits<double>::quiet_NaN() : scaled(column, text);
        (log_.axes[column.axis].*column.values).push_back(value);
        continue;
      }
      const double value = scaled(column, text);
      if (!log_.t.empty() && !(value > log_.t.back()))
        fail(column.field, text, fmt::format("a time after that of the sample before ({:.10g} s)", log_.t.back()));
      log_.t.push_back(value);
      count_digits(text, digits_, column.scale.factor());
    }
  }

  double scaled(const Column& column, std::string_view text) {
    double value = 0.0;
    if (!decimals_.read(text, value)) refuse_number(column.field, text);
    if (column.whole && value != std::round(value)) fail(column.field, text, "a whole number");
    value = column.scale(value);
    if (!std::isfinite(value)) fail(column.field, text, "a number in the range of double precision");
    return value;
  }

  [[noreturn]] void refuse_number(std::size_t field, std::string_view text) const {
    const bool point = text.find('.') != std::string_view::npos, comma = text.find(',') != std::string_view::npos;
    if (decimals_.mark() == '.' && comma)
      fail(field, text, "a point as decimal mark, as a comma separates or the numbers before have a point");
    if (decimals_.mark() == ',' && point) fail(field, text, "a comma as decimal mark, as the numbers before have it");
    fail(field, text, "a finite number");
  }

  [[noreturn]] void fail(std::size_t field, std::string_view found, const std::string& expected) const {
    throw LogError(fmt::format("{}: column {}, {}: found {}; expected {}", rows_.front().place(), field + 1,
                               excerpt(names_[field]),
                               found.empty() ? std::string("nothing") : "'" + excerpt(found) + "'", expected));
  }

  std::string name_;
  TextSource source_;
  std::string_view stated_;  // by --columns
  Log log_;
  AxisKinds kinds_;
  std::vector<CsvRows> rows_;  // one, made after the comments are off
  std::vector<Column> columns_;
  std::vector<std::string> names_;
  std::vector<std::string_view> fields_;
  SampleLines lines_;
  StampDigits digits_{0.0, 0};
  Decimals decimals_{','};
};

std::string one_line(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

// One column of a log that is written: a channel, or the phase of an endless axis.
struct WrittenColumn {
  const std::vector<double>* values = nullptr;
  const AxisLog* endless = nullptr;

  // Blank for NaN.
  void print(std::size_t sample, std::string& text) const {
    if (values == nullptr)
      fmt::format_to(std::back_inserter(text), "{}", shown_phase(*endless, sample));
    else if (!std::isnan((*values)[sample]))
      fmt::format_to(std::back_inserter(text), "{}", (*values)[sample]);
  }
};

// Calls sink(text) with one piece after the other.
void print_csv_log(const Log& log, const std::function<void(std::string_view)>& sink) {
  constexpr std::size_t piece = std::size_t{1} << 18;
  std::string text;
  for (const auto& [key, value] : log.comments)
    text += one_line(value.empty() ? "# " + key : "# " + key + ": " + value) + "\n";
  std::vector<WrittenColumn> columns{{&log.t}};
  text += "t[s]";
  for (const auto& axis : log.axes) {
    for (const auto& channel : log_channels) {
      if ((axis.*channel.values).empty()) continue;
      text += "," + channel_header(axis, channel);
      columns.push_back({&(axis.*channel.values)});
    }
    if (axis.phase.empty()) continue;
    text += "," + phase_header(axis);
    columns.push_back({nullptr, &axis});
  }
  text += '\n';
  for (std::size_t k = 0; k < log.t.size(); ++k) {
    for (const auto& column : columns) {
      if (&column != &columns.front()) text += ',';
      column.print(k, text);
    }
    text += '\n';
    if (text.size() < piece) continue;
    sink(text);
    text.clear();
  }
  sink(text);
}

}  // namespace

Log parse_csv_log(std::string_view text, const std::string& name, std::string_view columns) {
  return Reader(TextSource(text, name), name, columns).read();
}

Log read_csv_log(const std::filesystem::path& file, std::string_view columns, const BytesRead& progress) {
  return Reader(TextSource(file, progress), file.string(), columns).read();
}

std::string csv_log_text(const Log& log) {
  std::string text;
  print_csv_log(log, [&](std::string_view piece) { text += piece; });
  return text;
}

void write_csv_log(const std::filesystem::path& file, const Log& log) {
  std::ofstream out(file, std::ios::binary);
  print_csv_log(log,
                [&](std::string_view piece) { out.write(piece.data(), static_cast<std::streamsize>(piece.size())); });
  out.close();
  if (!out)
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", file.string(), machine::file_error_words(errno)));
}

}  // namespace stiction::host
