// Any bytes as a drive's parameter file: refused whole with a message, or a set that is written back as the same set.
// A first byte of 'x' gives the rest the head that it should have, so that the lines behind the checksum are reached.
#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "firmware/stictiond/parameter_store.hpp"

namespace {

std::string with_head(const std::string& body) {
  char head[96];
  const auto sum = static_cast<unsigned>(
      ::crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<unsigned>(body.size())));
  std::snprintf(head, sizeof head, "stiction.parameters/1\nlength %zu\ncrc32 %08x\n", body.size(), sum);
  return head + body;
}

void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "finding: %s\n", what);
  std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  if (!bytes.empty() && bytes[0] == 'x') bytes = with_head(bytes.substr(1));
  try {
    const auto set = stiction::drive::decode(bytes, "parameters");
    require(stiction::drive::decode(stiction::drive::encode(set), "again") == set, "a set changes when it is written");
  } catch (const stiction::drive::ParametersDamaged& error) {
    require(std::string_view(error.what()).starts_with("parameters:"), "a message without its place");
  }
  return 0;
}
