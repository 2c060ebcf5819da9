// Prints what filter_oracle.py compares: KIND ORDER EDGE PADDING, the values to filter on standard input, one a line.
#include <fmt/format.h>

#include <cstdlib>
#include <iostream>
#include <string_view>
#include <vector>

#include "host/identify/filter.hpp"

int main(int argc, char** argv) {
  using namespace stiction::host;
  if (argc != 5) return 2;
  const int order = std::atoi(argv[2]);
  const double edge = std::atof(argv[3]);
  const auto filter =
      std::string_view(argv[1]) == "butterworth" ? butterworth(order, edge) : chebyshev(order, 0.05, edge);
  std::vector<double> values;
  for (double value = 0.0; std::cin >> value;) values.push_back(value);
  for (const double value : filter_both_ways(filter, values, static_cast<std::size_t>(std::atoi(argv[4]))))
    fmt::print("{:.17g}\n", value);
}
