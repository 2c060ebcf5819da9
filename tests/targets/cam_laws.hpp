// The cam's laws as functions of one argument with names of their own, so that their instructions can be counted, and
// what they work on: two axes' worth of masters, a cam with phasing and bridges, and switch tracks.
#pragma once

#include <array>
#include <cstdint>

#include "stiction/motion/cam_motion.hpp"
#include "stiction/motion/cam_switch.hpp"
#include "stiction/motion/master.hpp"
#include "stiction/motion/master_estimator.hpp"
#include "tests/targets/platform/platform.hpp"

namespace stiction::targets {

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

  // Of the tick.
  MasterPoint at{};
  MasterPoint estimated{};
  CamTable::Output found{};
  MotionPoint point{};
  CamSwitch::Output outputs{};
};

struct CamLaw {
  const char* name;
  Work step;
};

// In the order of a tick.
extern const std::array<CamLaw, 6> cam_laws;

}  // namespace stiction::targets
