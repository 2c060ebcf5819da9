// Any bytes as a recording of a foreign drive with a mapping: refused with a reason, or a log that keeps its promises.
// The mapping file comes first, up to a line "====", then the recording: a scope's text, a recorder's JSON, also in a
// zip archive, or a plain table. Without that line all is the recording, and the mapping is the first seed's.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "firmware/machine/file/machine_file.hpp"
#include "host/log/mapping.hpp"
#include "tests/fuzz/log_promises.hpp"

namespace stiction::fuzz {
namespace {

constexpr std::string_view usual_mapping = R"(schema = "stiction.mapping/1"
[[channel]]
from = "ActPos"
to = "X.x"
unit = "mm"
[[channel]]
from = "ActCurrent"
to = "X.i"
unit = "A"
amperes = "rms"
)";
constexpr std::string_view border = "\n====\n";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static FileInMemory mapping_file, recording_file;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto at = bytes.find(border);
  const bool both = at != std::string_view::npos;
  mapping_file.replace_by(both ? bytes.substr(0, at + 1) : usual_mapping);
  recording_file.replace_by(both ? bytes.substr(at + border.size()) : bytes);
  try {
    const auto mapping = host::read_mapping(mapping_file.path());
    check_promises(host::apply_mapping(mapping, host::read_recording(recording_file.path(), mapping.table)));
  } catch (const host::LogError&) {
  } catch (const machine::MachineFileError&) {
  }
  return 0;
}

}  // namespace stiction::fuzz
