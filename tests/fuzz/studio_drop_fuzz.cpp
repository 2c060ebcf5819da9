// Any bytes as a file that is dropped on the studio's page, of whatever kind, behind a motion and a project that are
// sound: refused with a message, and the studio is as it was; or taken, and what it then saves opens as the same. The
// first byte says of which kind, and which step of editing follows.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>

#include "host/studio/studio.hpp"

namespace stiction::fuzz {
namespace {

using host::Studio;

constexpr const char* sound_motion =
    "schema = \"stiction.cam/1\"\n[cam.step]\ncycle = \"360 deg\"\nmodulo = \"90 deg\"\n"
    "[[cam.step.segment]]\nlength = \"90 deg\"\n"
    "[[cam.step.segment]]\nlength = \"180 deg\"\nstroke = \"90 deg\"\nlaw = \"3-4-5\"\n"
    "[[cam.step.segment]]\nend = \"360 deg\"\n";

constexpr const char* sound_project =
    "schema = \"stiction.step-cam/1\"\nmotion = \"motion.toml\"\nsteps = 720\n[mechanism]\naxis_distance = \"105 mm\"\n"
    "arm = \"52 mm\"\nroller_radius = \"13 mm\"\nroller_width = \"12 mm\"\nrollers = 4\n"
    "[cam_material]\nmodulus = \"210 GPa\"\npoisson = 0.3\n[roller_material]\nmodulus = \"210 GPa\"\npoisson = 0.3\n"
    "[load]\ninertia = \"0.02 kg m^2\"\nspeed = \"300 rpm\"\n";

[[noreturn]] void finding(const char* what, const std::string& text) {
  std::fprintf(stderr, "finding: %s\n%s\n", what, text.c_str());
  std::abort();
}

std::string saved(const Studio& studio) { return studio.motion_text() + studio.step_text(); }

// What `studio` saves opens in an empty one as the same.
void check_saved(const Studio& studio) {
  Studio again;
  again.load_motion("motion.toml", studio.motion_text());
  again.load_step("project.toml", studio.step_text());
  if (again.motion_text() != studio.motion_text()) finding("a saved motion opens as a different one", saved(studio));
  if (again.step_text() != studio.step_text()) finding("a saved project opens as a different one", saved(studio));
}

void step_of_editing(Studio& studio, unsigned which) {
  switch (which % 6) {
    case 0:
      return studio.edit({.verb = "split", .x = 0.3 * studio.cam().cycle()});
    case 1:
      return studio.edit({.verb = "track", .key = "one more", .x = 0.0, .y = 0.5 * studio.cam().cycle()});
    case 2:
      return studio.set_step_number("relief.valley.blend", 3.0);
    case 3:
      return studio.set_step_choice("relief.law", "polynomial_4_5_6_7");
    case 4:
      return studio.choose_cam(1);
    default:
      return studio.edit({.verb = "level", .y = 0.1});
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const unsigned first = data[0];
  const std::string text(reinterpret_cast<const char*>(data + 1), size - 1);
  Studio studio;
  studio.load_motion("motion.toml", sound_motion);
  studio.load_step("project.toml", sound_project);
  const auto before = saved(studio);
  try {
    if (first % 3 == 0)
      studio.load_motion("dropped.toml", text);
    else if (first % 3 == 1)
      studio.load_step("dropped.toml", text);
    else
      studio.load_machine("dropped.toml", text);
  } catch (const std::runtime_error&) {
    if (saved(studio) != before) finding("a refused file changes the studio", saved(studio));
    return 0;
  }
  studio.state_json(1.0);
  check_saved(studio);
  try {
    step_of_editing(studio, first / 3);
  } catch (const std::runtime_error&) {
  }
  check_saved(studio);
  while (studio.undo()) {
  }
  while (studio.redo()) {
  }
  check_saved(studio);
  return 0;
}

}  // namespace stiction::fuzz
