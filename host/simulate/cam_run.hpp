// An electronic cam through the simulated axis: the set-points of the motion over a master that comes to its speed in
// about one cycle and then turns steadily. Set-points are those of the firmware's cam (cam_set_points.hpp).
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"
#include "host/simulate/cam_set_points.hpp"
#include "sim/cam/motion.hpp"

namespace stiction::host {

struct CamRunSettings {
  double master_speed = 0.0;  // rad/s or m/s
  int cycles = 3;             // that are measured, behind those in which the master comes to its speed and a load that
                              // swings behind an elastic shaft settles
  MasterSignal master = MasterSignal::ideal;
  bool feedforward = true;   // as the machine file has it; false: none
  bool compensation = true;  // of friction, as the machine file has it; false: none
  double table = 1.0;        // number of the cam, for the log
};

struct FollowingError {
  double mean = 0.0;  // of its magnitude, in the unit of the slave
  double peak = 0.0;
  double place = 0.0;  // of the master, of the peak
};

struct CamRun {
  FollowingError error;
  std::vector<FollowingError> segments;  // of each segment of the motion
  double peak_effort = 0.0;              // N or N m of the motor, at the axis
  double rms_effort = 0.0;
  double peak_power = 0.0;  // W
  double energy = 0.0;      // J a cycle
  // Of the last cycle, over the master: the error, the motor's effort.
  std::vector<double> master, following, effort;
  Log log;  // of the measured cycles, with the channels master, master_speed and table
};

// `motion` on the only axis of `machine`, with those `settings`; set-points move it from where it is at the master's 0.
// S: FixedSignals or machine::DoubleSignals. Throws FaultTripped, and as CamSetPoints.
template <class S>
CamRun run_cam(machine::Machine machine, const sim::cam::Motion& motion, const CamRunSettings& settings);

}  // namespace stiction::host
