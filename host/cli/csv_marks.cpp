#include "host/cli/csv_marks.hpp"

#include <fmt/format.h>

#include "host/cli/errors.hpp"

namespace stiction::host {

CsvMarks csv_marks(const std::string& separator, const std::string& decimal) {
  const std::string mark = separator == "tab" ? "\t" : separator;
  if (mark.size() != 1) throw UsageError(fmt::format("--separator: found '{}'; expected one character", separator));
  if (decimal != "." && decimal != ",")
    throw UsageError(fmt::format("--decimal: found '{}'; expected a point or a comma", decimal));
  if (mark == decimal)
    throw UsageError(fmt::format("--separator: found '{}', the decimal mark; expected a different one", separator));
  return {mark[0], decimal[0]};
}

}  // namespace stiction::host
