// The rows of a CSV text (RFC 4180) with any separator: quoted fields, doubled quotes, LF or CRLF. Words are separated
// by any number of blanks, and have no quotes.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "host/log/text_source.hpp"

namespace stiction::host {

class CsvRows {
 public:
  // `text` must outlive the fields. `name` and `first_line` are for messages. `separator`: between the fields.
  CsvRows(std::string_view text, char separator, std::string name, std::size_t first_line = 1)
      : rest_(text), separator_(separator), name_(std::move(name)), next_line_(first_line) {}
  // The same of `text`, the rest of a block of `source`, and of all blocks behind it. `source` must outlive the rows;
  // `separator`, `name` and `first_line`: as above.
  CsvRows(std::string_view text, TextSource& source, char separator, std::string name, std::size_t first_line)
      : CsvRows(text, separator, std::move(name), first_line) {
    source_ = &source;
  }

  // As `separator`: words with any number of blanks and tabs between them, outside of brackets ("T[N m]").
  static constexpr char words = '\0';

  // The next row's fields, valid until the call after; false at the end of the text. An empty line is one empty field.
  // Throws LogError for a quote that is never closed, or text behind one that is.
  bool next(std::vector<std::string_view>& fields);

  std::size_t line() const { return line_; }  // where the row began
  std::string place() const;                  // "run.csv:17"
  bool only_blanks_follow() const { return rest_.find_first_not_of(" \t\r\n") == std::string_view::npos; }

 private:
  std::string_view quoted_field();
  void split_words(std::vector<std::string_view>& fields);

  std::string_view rest_;
  TextSource* source_ = nullptr;
  char separator_;
  std::string name_;
  std::size_t next_line_;
  std::size_t line_ = 0;
  std::deque<std::string> unescaped_;  // of this row; a deque, because fields point into it
};

}  // namespace stiction::host
