#include "host/log/table_form.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "host/log/csv_rows.hpp"
#include "host/log/recording.hpp"

namespace stiction::host {
namespace {

constexpr std::array candidates{'\t', ';', ','};

bool is_blank(std::string_view text) { return text.find_first_not_of(" \t\r") == std::string_view::npos; }

// Calls visit(position, character) for what is outside of quotes and brackets.
template <class Visit>
void outside(std::string_view line, Visit&& visit) {
  bool quoted = false, bracket = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (line[k] == '"') quoted = !quoted;
    if (quoted) continue;
    if (line[k] == '[') bracket = true;
    if (!bracket) visit(k, line[k]);
    if (line[k] == ']') bracket = false;
  }
}

}  // namespace

char header_separator(std::string_view line) {
  std::array<std::size_t, candidates.size()> counts{};
  outside(line, [&](std::size_t, char c) {
    for (std::size_t k = 0; k < candidates.size(); ++k) counts[k] += c == candidates[k];
  });
  const auto most = std::ranges::max_element(counts);
  if (*most > 0) return candidates[static_cast<std::size_t>(most - counts.begin())];
  std::vector<std::string_view> fields;
  CsvRows words(line, CsvRows::words, "");
  words.next(fields);
  return fields.size() > 1 ? CsvRows::words : ',';
}

std::vector<std::string_view> column_names(std::string_view columns) {
  std::vector<std::string_view> names;
  std::size_t begin = 0;
  outside(columns, [&](std::size_t at, char c) {
    if (c != ',') return;
    names.push_back(columns.substr(begin, at - begin));
    begin = at + 1;
  });
  names.push_back(columns.substr(begin));
  return names;
}

int number_separator(std::string_view line, std::size_t columns) {
  if (line.find('"') != std::string_view::npos) return -1;
  for (const char separator : {'\t', ';', ',', CsvRows::words}) {
    std::vector<std::string_view> fields;
    CsvRows rows(line, separator, "");
    rows.next(fields);
    Decimals decimals(separator);
    double value = 0.0;
    std::size_t numbers = 0;
    const bool fits = fields.size() == columns && std::ranges::all_of(fields, [&](std::string_view field) {
                        const auto first = field.find_first_not_of(" \t\r");
                        if (first == std::string_view::npos) return true;
                        ++numbers;
                        return decimals.read(field.substr(first, field.find_last_not_of(" \t\r") - first + 1), value);
                      });
    if (fits && numbers > 0 && !is_blank(line)) return static_cast<unsigned char>(separator);
  }
  return -1;
}

bool Decimals::read(std::string_view text, double& value) {
  auto digits = text;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc{} && end == digits.data() + digits.size()) {
    if (mark_ != '.' && digits.find('.') != std::string_view::npos) {
      if (mark_ == ',') return false;
      mark_ = '.';
    }
    return std::isfinite(value);
  }
  if (mark_ == '.' || digits.find(',') == std::string_view::npos || !parse_number(text, ',', value)) return false;
  mark_ = ',';
  return true;
}

}  // namespace stiction::host
