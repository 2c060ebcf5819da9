// Reading a project and the motion file beside it; apart, since a page has no files.
#include "firmware/machine/file/machine_file.hpp"
#include "host/cam/step/project.hpp"
#include "sim/cam/motion_file.hpp"

namespace stiction::host::step {

StepProject read_step_project(const std::filesystem::path& file) {
  return detail::parsed(file.string(), machine::content_of(file), [&](const std::string& motion) {
    return sim::cam::read_motion_file(file.parent_path() / motion);
  });
}

}  // namespace stiction::host::step
