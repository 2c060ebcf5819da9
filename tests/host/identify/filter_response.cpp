// Prints what filter_oracle.py compares: KIND ORDER EDGE PADDING, the values to filter on standard input, one a line.
// The kinds "first" and "second" are derivatives, with the step in place of EDGE.
#include <fmt/format.h>

#include <cstdlib>
#include <iostream>
#include <string_view>
#include <utility>
#include <vector>

#include "host/identify/filter.hpp"

int main(int argc, char** argv) {
  using namespace stiction::host;
  if (argc != 5) return 2;
  const std::string_view kind = argv[1];
  const int order = std::atoi(argv[2]);
  const double edge = std::atof(argv[3]);
  std::vector<double> values;
  for (double value = 0.0; std::cin >> value;) values.push_back(value);
  std::vector<double> answer;
  if (kind == "first" || kind == "second") {
    auto d = derivatives(values, edge);
    answer = std::move(kind == "first" ? d.first : d.second);
  } else {
    const auto filter = kind == "butterworth" ? butterworth(order, edge) : chebyshev(order, 0.05, edge);
    answer = filter_both_ways(filter, values, static_cast<std::size_t>(std::atoi(argv[4])));
  }
  for (const double value : answer) fmt::print("{:.17g}\n", value);
}
