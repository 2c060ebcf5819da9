#include "host/log/csv_rows.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/log/log.hpp"
#include "host/log/message.hpp"

namespace stiction::host {

std::string CsvRows::place() const { return fmt::format("{}:{}", name_, line_); }

// rest_ begins behind the opening quote.
std::string_view CsvRows::quoted_field() {
  std::string* copy = nullptr;  // only for a field with doubled quotes
  std::size_t from = 0;
  for (;;) {
    const auto quote = rest_.find('"', from);
    if (quote == std::string_view::npos)
      throw LogError(place() + ": found a quote that is never closed; expected a second \"");
    for (std::size_t i = from; i < quote; ++i) next_line_ += rest_[i] == '\n';
    const auto part = rest_.substr(from, quote - from);
    if (copy != nullptr) *copy += part;
    if (quote + 1 < rest_.size() && rest_[quote + 1] == '"') {
      if (copy == nullptr) copy = &unescaped_.emplace_back(part);
      *copy += '"';
      from = quote + 2;
      continue;
    }
    rest_.remove_prefix(quote + 1);
    return copy != nullptr ? std::string_view(*copy) : part;
  }
}

void CsvRows::split_words(std::vector<std::string_view>& fields) {
  const auto end = rest_.find('\n');
  const auto line = rest_.substr(0, end);
  constexpr std::string_view blanks = " \t\r";
  for (auto at = line.find_first_not_of(blanks); at < line.size();) {
    bool inside = false;
    auto stop = at;
    for (; stop < line.size() && (inside || blanks.find(line[stop]) == std::string_view::npos); ++stop)
      inside = line[stop] == '[' || (inside && line[stop] != ']');
    // "x [mm]" is one header.
    if (const auto behind = line.find_first_not_of(blanks, stop);
        behind != std::string_view::npos && line[behind] == '[')
      stop = std::min(line.size(), line.find(']', behind) + (line.find(']', behind) == std::string_view::npos ? 0 : 1));
    fields.push_back(line.substr(at, stop - at));
    at = line.find_first_not_of(blanks, stop);
  }
  if (fields.empty()) fields.emplace_back();
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  ++next_line_;
}

bool CsvRows::next(std::vector<std::string_view>& fields) {
  fields.clear();
  unescaped_.clear();
  if (rest_.empty() && source_ != nullptr) rest_ = source_->next();
  if (rest_.empty()) return false;
  line_ = next_line_;
  if (separator_ == words) {
    split_words(fields);
    return true;
  }
  for (;;) {
    if (!rest_.empty() && rest_.front() == '"') {
      rest_.remove_prefix(1);
      fields.push_back(quoted_field());
      if (rest_.starts_with("\r\n")) rest_.remove_prefix(1);
      if (!rest_.empty() && rest_.front() != separator_ && rest_.front() != '\n')
        throw LogError(
            fmt::format("{}: found \"{}\" behind a closing quote; expected a separator or the end of the "
                        "line",
                        place(), excerpt(rest_.substr(0, rest_.find('\n')))));
    } else {
      std::size_t end = 0;
      while (end < rest_.size() && rest_[end] != separator_ && rest_[end] != '\n') ++end;
      auto field = rest_.substr(0, end);
      const bool last = end == rest_.size() || rest_[end] == '\n';
      if (last && !field.empty() && field.back() == '\r') field.remove_suffix(1);
      fields.push_back(field);
      rest_.remove_prefix(end);
    }
    if (rest_.empty()) return true;
    const bool row_ends = rest_.front() == '\n';
    rest_.remove_prefix(1);
    if (row_ends) {
      ++next_line_;
      return true;
    }
    // A separator at the very end of the text leaves one more, empty field.
    if (rest_.empty()) {
      fields.emplace_back();
      return true;
    }
  }
}

}  // namespace stiction::host
