// The cam's laws as functions of one argument with names of their own, so that their instructions can be counted, and
// what they work on: two axes' worth of masters, a cam with phasing and bridges, and switch tracks.
#pragma once

#include <array>
#include <cstdint>

#include "stiction/motion/cam_motion.hpp"
#include "stiction/motion/cam_switch.hpp"
#include "stiction/motion/cam_tuning.hpp"
#include "stiction/motion/master.hpp"
#include "stiction/motion/master_estimator.hpp"
#include "tests/targets/platform/platform.hpp"

namespace stiction::targets {

// A load that vibrates at 14.5 Hz about the place of its set-point, which turns by a step at the end of each rise.
struct Elastic {
  std::int64_t at = 0, speed = 0;  // 2^-40 units, and the same a tick times 2^16

  // One tick of it about the place `wanted`: the acceleration is -(w T)^2 of the deviation, with w T = 0.00569.
  constexpr void step(std::int64_t wanted) {
    const std::int64_t off = at - wanted;
    speed -= (off * 2125) / 1000 + speed / 6400;
    at += speed / 65536;
  }
};

struct CamContext {
  CamContext();

  CamTable table;
  CamCurve cam, scaled, gear;
  CamMotion::Config config;
  VirtualMaster master;
  MasterEstimator estimator;
  CamMotion motion;
  std::array<CamSwitch::Track, 8> tracks{};
  CamSwitch::State switches{};
  CamTuning::Config tuning_config{};
  CamTuning::State tuning{};
  Elastic elastic;  // load behind the master, whose dwell is tuned

  // Of the tick.
  MasterPoint at{};
  MasterPoint estimated{};
  CamTable::Output found{};
  MotionPoint point{};
  CamSwitch::Output outputs{};
  CamTuning::Input tuned{};
  CamTuning::Fit fit{};  // of the last dwell
};

struct CamLaw {
  const char* name;
  Work step;
};

// In the order of a tick.
extern const std::array<CamLaw, 7> cam_laws;

}  // namespace stiction::targets
