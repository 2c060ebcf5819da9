// Prints the checksum of the drive's table of each drawn motion file; `toolchain/suites/cam_bytes` compares what builds
// for different processors print.
#include <cstdio>

#include "tests/sim/cam/table_bytes.hpp"

int main() {
  using namespace stiction::sim::cam;
  for (std::uint64_t seed = 1; seed <= drawn_files; ++seed)
    std::printf("%03d %08x\n", static_cast<int>(seed), static_cast<unsigned>(table_checksum(seed)));
}
