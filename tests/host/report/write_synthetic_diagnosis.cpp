// Writes the report of a synthetic diagnosis, for the test that opens it in a browser.
// usage: write_synthetic_diagnosis FILE [agreement|cam]     agreement: nothing found; cam: one is proposed
#include <fstream>
#include <iostream>
#include <string_view>

#include "tests/host/report/synthetic_diagnosis.hpp"

int main(int argc, char** argv) {
  using namespace stiction;
  if (argc < 2) {
    std::cerr << "usage: write_synthetic_diagnosis FILE [agreement|cam]\n";
    return 2;
  }
  const std::string_view kind = argc > 2 ? argv[2] : "";
  std::ofstream file(argv[1], std::ios::binary);
  file << host::diagnosis_report_html(kind == "agreement" ? host::synthetic_agreement()
                                      : kind == "cam"     ? host::synthetic_cam_proposal()
                                                          : host::synthetic_diagnosis());
  return file.flush() ? 0 : 1;
}
