// Writes the report of a synthetic experiment, for the test that opens it in a browser.
// usage: write_synthetic_experiment FILE [bench]     bench: other kinds of charts, no control, nothing expected
#include <fstream>
#include <iostream>
#include <string_view>

#include "tests/host/report/synthetic_experiment.hpp"

int main(int argc, char** argv) {
  using namespace stiction;
  if (argc < 2) {
    std::cerr << "usage: write_synthetic_experiment FILE [bench]\n";
    return 2;
  }
  const bool bench = argc > 2 && std::string_view(argv[2]) == "bench";
  std::ofstream file(argv[1], std::ios::binary);
  file << host::experiment_report_html(bench ? host::synthetic_friction_bench() : host::synthetic_experiment());
  return file.flush() ? 0 : 1;
}
