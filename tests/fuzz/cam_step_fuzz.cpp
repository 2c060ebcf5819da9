// Any bytes as the project of a step cam, with a motion that is sound: refused with a message, or profiles.
#include <cstdint>
#include <stdexcept>
#include <string>

#include "host/cam/step/spring_cam.hpp"
#include "host/cam/step/synthesis.hpp"

namespace stiction::fuzz {
namespace {

constexpr const char* motion =
    "schema = \"stiction.cam/1\"\n[cam.step]\ncycle = \"360 deg\"\nmodulo = \"90 deg\"\n"
    "[[cam.step.segment]]\nlength = \"90 deg\"\n"
    "[[cam.step.segment]]\nlength = \"180 deg\"\nstroke = \"90 deg\"\nlaw = \"3-4-5\"\n"
    "[[cam.step.segment]]\nend = \"360 deg\"\n";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    auto project = host::step::parse_step_project("project.toml", text, motion);
    project.steps = 720;
    if (project.spring)
      host::step::synthesize_spring_cam(project);
    else
      host::step::synthesize(project);
  } catch (const std::runtime_error&) {
  }
  return 0;
}

}  // namespace stiction::fuzz
