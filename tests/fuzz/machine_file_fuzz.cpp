// Any bytes as a machine file.
#include <cstddef>
#include <cstdint>

#include "tests/fuzz/machine_bytes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static stiction::fuzz::FileInMemory file;
  file.replace_by({reinterpret_cast<const char*>(data), size});
  stiction::fuzz::read_and_run(file.path(), {});
  return 0;
}
