// Any bytes as the response test of a SINUMERIK: refused with a reason, or responses whose every number is one.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "host/response/response_test.hpp"
#include "tests/fuzz/machine_bytes.hpp"

namespace stiction::fuzz {
namespace {

void check(const std::vector<host::TestResponsePoint>& points) {
  for (const auto& point : points)
    if (std::isnan(point.frequency) || std::isnan(point.coherence) || point.coherence < 0.0)
      finding("a point of a response is no number");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  host::is_response_test(bytes);
  try {
    const auto test = host::parse_response_test(bytes, "bytes");
    check(host::computed_response(test));
    check(host::stored_response(test));
  } catch (const host::ResponseTestError& error) {
    if (std::string_view(error.what()).find("expected") == std::string_view::npos) finding(error.what());
  }
  return 0;
}

}  // namespace stiction::fuzz
