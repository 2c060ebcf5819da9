// Writes the report of a synthetic diagnosis, for the test that opens it in a browser.
// usage: write_synthetic_diagnosis FILE [agreement]     agreement: nothing found
#include <fstream>
#include <iostream>
#include <string_view>

#include "tests/host/report/synthetic_diagnosis.hpp"

int main(int argc, char** argv) {
  using namespace stiction;
  if (argc < 2) {
    std::cerr << "usage: write_synthetic_diagnosis FILE [agreement]\n";
    return 2;
  }
  const bool agreement = argc > 2 && std::string_view(argv[2]) == "agreement";
  std::ofstream file(argv[1], std::ios::binary);
  file << host::diagnosis_report_html(agreement ? host::synthetic_agreement() : host::synthetic_diagnosis());
  return file.flush() ? 0 : 1;
}
