// Text exports of the TwinCAT Scope: see recording.hpp.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "host/log/csv_rows.hpp"
#include "host/log/message.hpp"
#include "host/log/recording.hpp"

namespace stiction::host {
namespace {

// The keys of rows that stand once a channel.
bool is_key(std::string_view text) {
  for (const auto* key :
       {"Name", "SymbolComment", "Data-Type", "SampleTime[ms]", "VariableSize", "SymbolBased", "IndexGroup",
        "IndexOffset", "SymbolName", "NetId", "NetID", "Port", "Offset", "ScaleFactor", "BitMask", "Unit"})
    if (text == key) return true;
  return false;
}

std::string_view without_mark(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  return text;
}

constexpr std::int64_t least_filetime = 10'000'000'000'000'000;  // the year 1632; no offset in ms is as large

// Numbers begin with these, keys do not.
bool begins_a_number(std::string_view text) {
  return !text.empty() && (text[0] == '-' || text[0] == '+' || (text[0] >= '0' && text[0] <= '9'));
}

class Reader {
 public:
  Reader(std::string_view text, const std::string& name) : text_(without_mark(text)), rows_(text_, '\t', name) {
    recording_.source = name;
    recording_.kind = "a TwinCAT Scope export";
    recording_.digits.finest = 1e-7;  // FILETIME, and finer than any offset in ms that matters
  }

  Recording read() {
    bool more = rows_.next(fields_);
    for (; more && !begins_a_number(fields_[0]); more = rows_.next(fields_)) read_head();
    name_channels();
    decimal_ = decimal_mark();
    for (; more; more = rows_.next(fields_)) {
      if (fields_[0] == "EOF") break;
      if (std::ranges::all_of(fields_, [](auto f) { return f.empty(); })) continue;
      read_row();
    }
    return std::move(recording_);
  }

 private:
  void read_head() {
    const auto key = fields_[0];
    if (key == "Name") names_.assign(fields_.begin(), fields_.end());  // the last one is the channels'
    if (key == "Name") symbols_.clear(), units_.clear();
    if (key == "SymbolName") symbols_.assign(fields_.begin(), fields_.end());
    if (key == "Unit") units_.assign(fields_.begin(), fields_.end());
    if (!is_key(key) && !key.empty() && fields_.size() > 1)
      recording_.comments.emplace_back(excerpt(key, 80), excerpt(fields_[1], 200));
  }

  // A column is a time where its name is the key again, else a channel of the last time column.
  void name_channels() {
    if (names_.size() < 2)
      throw LogError(fmt::format("{}: found no row 'Name' with channels; expected the head of a TwinCAT Scope export",
                                 rows_.place()));
    for (std::size_t column = 0, time = 0; column < names_.size(); ++column) {
      if (names_[column] == "Name") {
        time = column;
        continue;
      }
      if (names_[column].empty()) continue;
      Column c{column, time, recording_.channels.size()};
      RecordedChannel channel;
      channel.name = names_[column];
      const bool repeated = std::ranges::count(names_, names_[column]) > 1;
      if (repeated && column < symbols_.size() && !symbols_[column].empty()) channel.name = symbols_[column];
      if (column < units_.size() && units_[column] != "(None)" && units_[column] != "Unit")
        channel.unit = units_[column];
      recording_.channels.push_back(std::move(channel));
      columns_.push_back(c);
    }
  }

  // A comma anywhere in the data is a decimal mark: the separator is the tab.
  char decimal_mark() const {
    std::string_view rest = text_;
    while (!rest.empty()) {
      const auto line = rest.substr(0, rest.find('\n'));
      if (begins_a_number(line) && line.find(',') != std::string_view::npos) return ',';
      rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    }
    return '.';
  }

  void read_row() {
    for (const auto& column : columns_) {
      auto& channel = recording_.channels[column.channel];
      if (!channel.bad.empty() || column.field >= fields_.size()) continue;
      const auto text = fields_[column.field], stamp = fields_[column.time];
      if (text.empty() || stamp.empty()) continue;  // a slower channel
      double t = 0.0, value = 0.0;
      if (!time_of(stamp, t))
        throw LogError(fmt::format("{}: column {}: found '{}'; expected a time in ms or as FILETIME", rows_.place(),
                                   column.time + 1, excerpt(stamp)));
      // A slower group is filled up with its last row.
      if (!channel.t.empty() && t == channel.t.back()) continue;
      if (!parse_number(text, decimal_, value)) {
        channel.bad = fmt::format("{}: column {}, {}: found '{}'", rows_.place(), column.field + 1,
                                  excerpt(channel.name), excerpt(text));
        continue;
      }
      channel.t.push_back(t);
      channel.values.push_back(value);
      channel.lines.push_back(rows_.line());
    }
  }

  bool time_of(std::string_view text, double& t) {
    std::int64_t ticks = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), ticks);
    if (error == std::errc{} && end == text.data() + text.size() && ticks >= least_filetime) {
      if (origin_ == 0) origin_ = ticks;
      t = static_cast<double>(ticks - origin_) * 1e-7;
      return true;
    }
    double ms = 0.0;
    if (!parse_number(text, decimal_, ms)) return false;
    t = ms / 1e3;
    return true;
  }

  struct Column {
    std::size_t field, time, channel;
  };

  std::string_view text_;
  CsvRows rows_;
  Recording recording_;
  std::vector<std::string_view> fields_;
  std::vector<std::string> names_, symbols_, units_;
  std::vector<Column> columns_;
  char decimal_ = '.';
  std::int64_t origin_ = 0;  // FILETIME of the first stamp
};

}  // namespace

bool is_scope_export(std::string_view text) {
  text = without_mark(text);
  if (!text.starts_with("Name\t")) return false;
  return text.find("\nStartRecord\t") != std::string_view::npos ||
         text.find("\nSampleTime[ms]\t") != std::string_view::npos ||
         text.find("\nSymbolName\t") != std::string_view::npos ||
         text.find("\nStarttime of export\t") != std::string_view::npos;
}

Recording read_scope_export(std::string_view text, const std::string& name) { return Reader(text, name).read(); }

}  // namespace stiction::host
