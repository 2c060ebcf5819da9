// The marks of a table that a command writes: what separates its columns, and its decimal mark.
#pragma once

#include <string>

namespace stiction::host {

struct CsvMarks {
  char separator, decimal;
};

// Of the options --separator (`separator`: one character, or "tab") and --decimal (`decimal`: a point or a comma).
// Throws UsageError where they are not, or are the same.
CsvMarks csv_marks(const std::string& separator, const std::string& decimal);

}  // namespace stiction::host
