// How a table of numbers is written, as far as its own text tells: the separator from the header, the decimal mark from
// the numbers.
#pragma once

#include <cstddef>
#include <limits>
#include <string_view>
#include <vector>

namespace stiction::host {

// The separator of a header: of tab, semicolon and comma the one that it has most of outside of quotes and units;
// CsvRows::words where it has none of them and several words. `line`: the header, without its line end. A comma where
// nothing separates.
char header_separator(std::string_view line);

// "t[ms],x_set[mm],x[mm]": the names of columns as --columns states them. A comma inside of brackets separates nothing.
std::vector<std::string_view> column_names(std::string_view columns);

// The separator by which `line` falls into `columns` fields of which each is a number or blank; -1: none does.
// `line`: of numbers; `columns`: how many it should have.
int number_separator(std::string_view line, std::size_t columns);

// Numbers whose decimal mark is the one that the first of them has.
class Decimals {
 public:
  // `separator`: of the table; where it is a comma, the mark is a point.
  explicit Decimals(char separator) : mark_(separator == ',' ? '.' : '\0') {}

  // False: `text` is no finite number, or it has the other decimal mark. `text`: the whole field, without blanks around
  // it; `value`: is written where it is one.
  bool read(std::string_view text, double& value);

  char mark() const { return mark_; }  // '\0': no number had one yet

 private:
  char mark_;
};

}  // namespace stiction::host
