// What a method against residual vibration is given: a motion with a rise into a dwell, the drive that follows it, the
// band of frequencies that it must hold for, and what a lift may ask for.
#pragma once

#include <complex>
#include <vector>

#include "sim/cam/stand/dwell.hpp"

namespace stiction::sim::cam {

// Of the unit law over the rise: peak speed, acceleration and jerk.
struct LiftLimits {
  double speed = 3.0;
  double acceleration = 8.0;
  double jerk = 120.0;
};

struct ShapingTask {
  Motion motion;
  Dwell dwell;          // the longest one
  double begin = 0.0;   // of the master: from here the motion moves until the dwell
  double start = 0.0;   // where the slave is there
  double stroke = 0.0;  // and by how much it moves
  double master_speed = 0.0;
  ElasticDrive drive;
  double band = 0.2;  // the frequencies from 1 - band to 1 + band times the drive's
  LiftLimits limits;

  double end() const { return dwell.begin; }             // of the rise
  double length() const { return dwell.begin - begin; }  // of the rise
  double rise_time() const { return length() / master_speed; }
  Mode mode() const { return load_mode(drive); }
  // Periods of the load's mode within the rise.
  double periods() const { return rise_time() / mode().period(); }
  // The master's way in one period of the load's mode.
  double period_length() const { return mode().period() * master_speed; }
};

// Of the longest dwell of `motion` and the rise before it, with the master at `master_speed`. `drive`, `band`, `limits`
// as above. Throws CamError where the motion has no dwell, does not rest where the rise begins, or moves over the seam.
ShapingTask shaping_task(const Motion& motion, const ElasticDrive& drive, double master_speed, double band,
                         const LiftLimits& limits);

// How the load's mode of a task vibrates behind `lift`, at the master's place `at` behind its end (modal_residual).
std::complex<double> residual_of(const ShapingTask& task, const Curve& lift, double at);

struct BandFigures {
  std::vector<double> factors;  // of the load's frequency
  std::vector<DwellFigures> figures;
  double worst = 0.0;  // peak to peak
};

// What is left in the task's dwell of `motion` with the load's frequency at `count` factors over the band, by the
// transfer function. `cycles`: the last one counts; 1: from rest.
BandFigures band_figures(const ShapingTask& task, const Motion& motion, int count, int cycles = 1);

}  // namespace stiction::sim::cam
