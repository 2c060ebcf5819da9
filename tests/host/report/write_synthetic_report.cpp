// Writes the report of a synthetic circle, for the test that opens it in a browser.
// usage: write_synthetic_report FILE [both] [bare]     both: also clockwise; bare: no measured and published rows
#include <fstream>
#include <iostream>
#include <string_view>

#include "tests/host/report/synthetic_circle.hpp"

int main(int argc, char** argv) {
  using namespace stiction;
  if (argc < 2) {
    std::cerr << "usage: write_synthetic_report FILE [both] [bare]\n";
    return 2;
  }
  host::SyntheticCircle options;
  for (int i = 2; i < argc; ++i) {
    if (std::string_view(argv[i]) == "both") options.directions.push_back(sim::Direction::clockwise);
    if (std::string_view(argv[i]) == "bare") options.measured = options.published = false;
  }
  std::ofstream file(argv[1], std::ios::binary);
  file << host::circle_report_html(host::synthetic_circle(options));
  return file.flush() ? 0 : 1;
}
