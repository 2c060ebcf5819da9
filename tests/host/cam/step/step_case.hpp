// Step cams for the tests: the four of independent prototypes (docs/step_cams.md), and mechanisms drawn at random.
#pragma once

#include <string>

#include "host/cam/step/synthesis.hpp"
#include "tests/sim/cam/random_motion.hpp"

namespace stiction::host::step {

// A step of `stroke` during `rise` degrees, centred in the turn, by `law`; the turning point of it at `lambda`.
inline sim::cam::Cam step_motion(double stroke, double rise, const std::string& law = "modified_sine",
                                 double lambda = 0.5) {
  sim::cam::Cam cam{.name = "step", .modulo = stroke * degree};
  const double rest = 0.5 * (360.0 - rise) * degree;
  cam.segments = {{.length = rest},
                  {.length = rise * degree, .stroke = stroke * degree, .law = law},
                  {.length = turn - rest - rise * degree}};
  if (lambda != 0.5) cam.segments[1].values = {{"lambda", {lambda}}};
  return cam;
}

// Lengths in mm, angles in degrees; steel on steel, rollers 12 mm wide, 0.02 kg m^2 at 300/min.
inline StepProject step_project(double a, double b, double c, int rollers, double stroke, double rise) {
  StepProject project;
  project.mechanism = {1e-3 * a, 1e-3 * b, 1e-3 * c, 12e-3, rollers, 180.0 * degree / rollers, 90.0 * degree / rollers};
  project.cam = step_motion(stroke, rise);
  project.load.inertia = 0.02;
  project.load.speed = 10.0 * std::numbers::pi;
  project.load.cam = project.load.roller = {210e9, 0.3};
  return project;
}

// The first row of the published cases.
inline StepProject first_case() { return step_project(105, 52, 13, 4, 90, 180); }

// With relief of 0.1 mm and blends of 4 degrees.
inline StepProject relieved_case() {
  StepProject project = first_case();
  project.relief.valley = project.relief.peak = {1e-4, 4.0 * degree, false};
  return project;
}

// A mechanism that can be built, drawn by `seed`: sizes of gearboxes, 3 to 6 rollers, five laws.
inline StepProject drawn_case(std::uint64_t seed) {
  constexpr const char* laws[] = {"modified_sine", "sloping_sine", "modified_trapezoid", "3-4-5", "4-5-6-7"};
  for (sim::cam::RandomMotion random(seed);;) {
    const double a = random.between(60.0, 140.0), b = a * random.between(0.38, 0.5), c = a * random.between(0.08, 0.13);
    const int rollers = 3 + static_cast<int>(random.whole(4));
    const double rise = random.between(150.0, 260.0);
    StepProject project = step_project(a, b, c, rollers, 360.0 / rollers, rise);
    project.cam = step_motion(360.0 / rollers, rise, laws[random.whole(5)]);
    try {
      synthesize(project);
      return project;
    } catch (const sim::cam::CamError&) {
      // It cannot be built: the next one.
    }
  }
}

}  // namespace stiction::host::step
