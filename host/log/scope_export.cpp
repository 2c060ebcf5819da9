// Text exports of the TwinCAT Scope: see recording.hpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>

#include "host/log/csv_rows.hpp"
#include "host/log/message.hpp"
#include "host/log/recording.hpp"

namespace stiction::host {
namespace {

// The keys of rows that stand once a channel.
bool is_key(std::string_view text) {
  for (const auto* key : {"Name", "SymbolComment", "Data-Type", "SampleTime[ms]", "VariableSize", "SymbolBased",
                          "IndexGroup", "IndexOffset", "SymbolName", "NetId", "NetID", "Port", "Offset", "ScaleFactor",
                          "BitMask", "Unit", "Unit ScaleFactor", "Unit Offset"})
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

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

// What the export's setting "Separator" may be; none: the first line is not that of an export.
std::optional<char> separator_of(std::string_view text) {
  constexpr std::string_view key = "Name", separators = "\t ;:,";
  if (!text.starts_with(key) || text.size() == key.size()) return std::nullopt;
  const char separator = text[key.size()];
  return separators.find(separator) == std::string_view::npos ? std::nullopt : std::optional(separator);
}

class Reader {
 public:
  Reader(std::string_view text, const std::string& name)
      : text_(without_mark(text)), separator_(separator_of(text_).value_or('\t')), rows_(text_, separator_, name) {
    recording_.source = name;
    recording_.kind = "a TwinCAT Scope export";
    recording_.digits.finest = 1e-7;  // FILETIME, and finer than any offset in ms that matters
  }

  Recording read() {
    bool more = next();
    for (; more && !begins_a_number(fields_[0]); more = next()) read_head();
    name_channels();
    decimal_ = separator_ == ',' ? '.' : decimal_mark();
    for (; more; more = next()) {
      if (fields_[0] == "EOF") break;
      if (std::ranges::all_of(fields_, [](auto f) { return f.empty(); })) continue;
      read_row();
    }
    return std::move(recording_);
  }

 private:
  bool next() {
    const bool more = rows_.next(fields_);
    for (auto& field : fields_) field = trimmed(field);  // a cell without sample may be a blank
    return more;
  }

  using Row = std::vector<std::string>;

  void read_head() {
    const auto key = fields_[0];
    if (key == "Name") head_.clear();  // the last block of such rows is the channels'
    Row row(fields_.begin(), fields_.end());
    if (separator_ == ' ' && key == "Unit")
      row = with_words_joined(row, fields_[1] == "ScaleFactor" || fields_[1] == "Offset");
    const std::string name = row.front();
    if (is_key(name)) {
      head_[name] = std::move(row);
      return;
    }
    if (!key.empty() && fields_.size() > 1)
      recording_.comments.emplace_back(excerpt(key, 80), excerpt(fields_[1], 200));
  }

  // Blanks separate, and belong to "Unit Offset" and to "V (Voltage)".
  static Row with_words_joined(const Row& words, bool key_of_two) {
    Row row;
    for (std::size_t k = 0; k < words.size(); ++k) {
      const bool of_key = key_of_two && words[k] == "Unit" && k + 1 < words.size();
      if (!row.empty() && words[k].starts_with('(') && words[k] != "(None)")
        row.back() += " " + words[k];
      else
        row.push_back(of_key ? "Unit " + words[++k] : words[k]);
    }
    return row;
  }

  const std::string* of_head(const char* key, std::size_t column) const {
    const auto found = head_.find(key);
    return found == head_.end() || column >= found->second.size() ? nullptr : &found->second[column];
  }

  // A column is a time where its name is the key again, else a channel of the last time column.
  void name_channels() {
    auto& names = head_["Name"];
    if (separator_ == ' ') names = names_of_words(names);
    if (names.size() < 2)
      throw LogError(fmt::format("{}: found no row 'Name' with channels; expected the head of a TwinCAT Scope export",
                                 rows_.place()));
    for (std::size_t column = 0, time = 0; column < names.size(); ++column) {
      if (names[column] == "Name") {
        time = column;
        continue;
      }
      if (names[column].empty()) continue;
      columns_.push_back({column, time, recording_.channels.size()});
      RecordedChannel channel;
      channel.name = names[column];
      const auto* symbol = of_head("SymbolName", column);
      const bool repeated = std::ranges::count(names, names[column]) > 1;
      if (repeated && symbol != nullptr && !symbol->empty()) channel.name = *symbol;
      // "mm (Length)"
      if (const auto* unit = of_head("Unit", column); unit != nullptr && *unit != "(None)" && *unit != "Unit")
        channel.unit = unit->substr(0, unit->find(" ("));
      channel.scaling = scaling_of(column, names.size());
      recording_.channels.push_back(std::move(channel));
    }
  }

  // The head's scale factors and offsets where they change a value. A decimal comma beside commas as separators moves
  // the row's columns: nothing is known then.
  std::optional<HeadScaling> scaling_of(std::size_t column, std::size_t columns) const {
    HeadScaling scaling;
    const std::array<std::pair<const char*, double*>, 4> rows{{{"ScaleFactor", &scaling.factor},
                                                               {"Offset", &scaling.offset},
                                                               {"Unit ScaleFactor", &scaling.unit_factor},
                                                               {"Unit Offset", &scaling.unit_offset}}};
    for (const auto& [key, value] : rows) {
      const auto found = head_.find(key);
      if (found == head_.end()) continue;
      const auto* text = of_head(key, column);
      const bool moved = separator_ == ',' && found->second.size() > columns + 1;  // a last one may be empty
      if (moved ||
          (text != nullptr && !text->empty() && !parse_number(*text, '.', *value) && !parse_number(*text, ',', *value)))
        scaling.known = false;
    }
    return scaling == HeadScaling{} ? std::nullopt : std::optional(scaling);
  }

  // Names whose words are separated like the names themselves. How many there are in each group is known from a row of
  // single words. Words belong together where the export itself shows it: "(1)" to the name before, and two words that
  // occur again with "(1)" behind them. Where that does not explain all of a group, its columns are named by number.
  Row names_of_words(const Row& words) const {
    const Row* model = nullptr;
    for (const auto* key : {"Data-Type", "VariableSize", "Port", "SampleTime[ms]"})
      if (const auto found = head_.find(key); model == nullptr && found != head_.end()) model = &found->second;
    if (model == nullptr || model->size() == words.size()) return words;
    Row joined, names;
    for (const auto& word : words)
      if (!joined.empty() && word.size() > 2 && word.front() == '(' && word[1] >= '0' && word[1] <= '9')
        joined.back() += " " + word;
      else
        joined.push_back(word);
    const auto has_second = [&](const std::string& a, const std::string& b) {
      for (std::size_t k = 0; k + 1 < joined.size(); ++k)
        if (joined[k] == a && joined[k + 1].starts_with(b + " (")) return true;
      return false;
    };
    Row whole;
    for (std::size_t k = 0; k < joined.size(); ++k) {
      const auto base = k + 1 < joined.size() ? joined[k + 1].substr(0, joined[k + 1].find(" (")) : std::string();
      const bool pair = !base.empty() && joined[k] != "Name" && has_second(joined[k], base);
      whole.push_back(pair ? joined[k] + " " + joined[k + 1] : joined[k]);
      k += pair;
    }
    std::size_t at = 0;
    for (std::size_t column = 0; column < model->size();) {
      const auto& key = model->front();
      std::size_t end = column + 1, until = at + 1;
      while (end < model->size() && (*model)[end] != key) ++end;
      while (until < whole.size() && whole[until] != "Name") ++until;
      names.emplace_back("Name");
      const bool clear = until - at == end - column;
      for (std::size_t k = 1; k < end - column; ++k)
        names.push_back(clear ? whole[at + k] : fmt::format("column {}", column + k + 1));
      column = end;
      at = until;
    }
    return names;
  }

  // A comma anywhere in the data is a decimal mark where it does not separate.
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
  char separator_;
  CsvRows rows_;
  Recording recording_;
  std::vector<std::string_view> fields_;
  std::map<std::string, Row, std::less<>> head_;  // the rows of the channels by their key
  std::vector<Column> columns_;
  char decimal_ = '.';
  std::int64_t origin_ = 0;  // FILETIME of the first stamp
};

}  // namespace

bool is_scope_export(std::string_view text) {
  text = without_mark(text);
  const auto separator = separator_of(text);
  if (!separator) return false;
  // With blanks as separators a key of several words is quoted.
  for (const std::string key : {"StartRecord", "SampleTime[ms]", "SymbolName", "Starttime of export"})
    for (const auto& written : {key, "\"" + key + "\""})
      if (text.find("\n" + written + *separator) != std::string_view::npos) return true;
  return false;
}

Recording read_scope_export(std::string_view text, const std::string& name) { return Reader(text, name).read(); }

}  // namespace stiction::host
