// Machines that the tuner of a cam is tried on, and cycles of them: the firmware's cascade with its sampling on two
// masses with friction, backlash, resolution, noise and delay of the load's encoder. None of it is the tuner's model.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "sim/cam/motion.hpp"
#include "sim/cam/shaping/record_tuner.hpp"
#include "sim/cam/stand/response.hpp"

namespace stiction::cam_tuning {

inline constexpr double degree = 0.017453292519943295;
inline constexpr double stand_speed = 130.0 * 3.141592653589793 / 30.0;  // rad/s
inline constexpr double resolution = 0.015 * degree;

struct Truth {
  double factor = 1.0;    // of the load's frequency
  double rise = 180.0;    // degrees
  double delay = 3.3629;  // ms
  double coulomb = 0.0;   // N m at the motor
  double backlash = 0.0;  // degrees of load
  // A second mode, in which a part of the flywheel hangs on the rest: what a jump of the acceleration makes of it over
  // what that makes of the first one; 0: none.
  double second = 0.0;
  double second_frequency = 40.0;  // Hz, with the motor held
  std::uint64_t seed = 1;
};

// Frequency within 20 %, both rises, delay of 0 to 6 ms, from `random`.
Truth drawn(std::mt19937_64& random);

machine::Machine machine_of(const Truth& truth);
sim::cam::Motion motion_of(const Truth& truth);
// What the tuner is told: the motion, the drive of the test rig as it is published, and the axis' limits.
sim::cam::ShapingTask task_of(const Truth& truth);

sim::cam::TunerSettings settings_of(const Truth& truth);

struct Cycle {
  std::vector<sim::cam::LoadState> load;  // as it is
  sim::cam::CycleRecord record;           // as its encoder has it
  double current = 0.0;                   // A, largest of the cycle
  double quality = 0.0;                   // deg^2, of the load as it is; with friction about its mean
};

// `cycles` of `motion` on the machine of `truth`, from rest; the record and the quality are those of the last. `number`
// draws the noise.
Cycle run(const Truth& truth, const sim::cam::Motion& motion, std::uint64_t number, int cycles = 1);

// The quality of each cycle of a machine that runs along `cams` in turn, and the record of the last one.
struct Running {
  std::vector<double> qualities;  // deg^2
  std::vector<double> settled;    // deg^2, the same without the first 20 degrees, in which the drive itself settles
  sim::cam::CycleRecord last;
};
Running run_on(const Truth& truth, const std::vector<sim::cam::Cam>& cams);

// Frequency (rad/s) and damping ratio with which the load rings in a dwell, from turning points of 4 s without noise:
// no least squares of the tuner's.
struct Ringing {
  double frequency, damping_ratio;
};
Ringing ringing_of(const Truth& truth);

}  // namespace stiction::cam_tuning
