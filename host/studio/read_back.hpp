// Motions read back from what has no laws: the drive's table, and the log of an axis that followed a cam.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "host/log/log.hpp"
#include "sim/cam/motion.hpp"

namespace stiction::host {

// The motion of the drive's table `bytes`, through position, speed and acceleration at the joints of its segments,
// which is what the drive evaluates between them but for rounding; a joint where the acceleration jumps is smoothed.
// `name`: of the cam. Throws sim::cam::CamError for what is no table.
sim::cam::Cam cam_of_table(std::span<const std::uint8_t> bytes, const std::string& name);

// The motion of the first whole cycle of a `log` with the channels of a master and of a set position, or a measured
// one where there is none, through at most 720 of its samples. `name`: of the cam. Throws sim::cam::CamError for a log
// without them or without a whole cycle.
sim::cam::Cam cam_of_log(const Log& log, const std::string& name);

}  // namespace stiction::host
