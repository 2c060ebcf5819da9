// The test rig of Dostrasil 2014 and its motions: its Table 2 as it is printed, without the shipped machine.
#pragma once

#include <numbers>

#include "sim/cam/motion.hpp"
#include "sim/cam/stand/elastic_drive.hpp"
#include "sim/cam/stand/transfer_function.hpp"

namespace stiction::sim::cam {

inline constexpr double degree = std::numbers::pi / 180.0;
inline constexpr double turns_a_minute = std::numbers::pi / 30.0;  // rad/s

inline StudyParameters table_2() {
  const double p = 1.0 / 33.0;
  return {.rotor_inertia = 0.005235 + 0.00279 + p * p * 0.0009341,
          .load_inertia = 0.1035711,
          .drive_stiffness = 226.09864,
          .drive_damping = 1.7502567,
          .shaft_stiffness = 859.67506,
          .shaft_damping = 0.2353522,
          .ratio = p};
}

inline ElasticDrive study_drive() {
  const auto t = table_2();
  const double square = 33.0 * 33.0;
  return {.load_inertia = t.load_inertia,
          .rotor_inertia = t.rotor_inertia * square,
          .shaft_stiffness = t.shaft_stiffness,
          .shaft_damping = t.shaft_damping,
          .drive_stiffness = t.drive_stiffness * square,
          .drive_damping = t.drive_damping * square};
}

// A rise of `stroke` degrees in `rise` degrees by `law`, then rest to the end of the turn.
inline Motion indexing(const std::string& law, double stroke, double rise) {
  Cam cam{.name = "index"};
  cam.modulo = stroke * degree;
  cam.segments = {{.length = rise * degree, .stroke = stroke * degree, .law = law},
                  {.length = (360.0 - rise) * degree}};
  return compose(cam);
}

}  // namespace stiction::sim::cam
