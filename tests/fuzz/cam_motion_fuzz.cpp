// Any bytes as a motion file: it is refused with a message, or composed, checked, written, and read back as the same.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "firmware/machine/file/machine_file.hpp"
#include "sim/cam/check.hpp"
#include "sim/cam/motion_file.hpp"
#include "sim/cam/segment_table.hpp"

namespace stiction::fuzz {

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sim::cam;
  std::vector<Cam> cams;
  try {
    cams = parse_motion_file("m.toml", std::string(reinterpret_cast<const char*>(data), size));
  } catch (const machine::MachineFileError&) {
    return 0;
  }
  for (const Cam& cam : cams) {
    const Motion motion = compose(cam);
    jumps_of(motion);
    try {
      CamTable table;
      if (CamTable::read(table_of_parts(motion, 4).bytes, table) != CamTableProblem::none) std::abort();
    } catch (const CamError&) {
    }
  }
  const auto text = motion_text(cams);
  if (motion_text(parse_motion_file("m.toml", text)) != text) {
    std::fprintf(stderr, "finding: the file that was written is read as a different one\n%s\n", text.c_str());
    std::abort();
  }
  return 0;
}

}  // namespace stiction::fuzz
