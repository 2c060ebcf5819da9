// The drive behind the record of one cycle: the shaft from frequency and damping of the dwell, and from the rise how
// late the load's encoder is and how much Coulomb friction the motor has. Along the speed a drive with full feedforward
// is not late, so what is late there is the encoder; what the drive does otherwise than its model, by dead time and the
// periods of its loops, goes with the acceleration and is fitted beside it.
#pragma once

#include "sim/cam/shaping/dwell_fit.hpp"
#include "sim/cam/shaping/task.hpp"

namespace stiction::sim::cam {

// The load as its encoder has it, over one cycle from rest.
struct CycleRecord {
  std::vector<double> master;    // rising, from 0
  std::vector<double> position;  // as many, in the slave's unit
};

struct IdentifiedDrive {
  ElasticDrive drive;
  Mode ringing;                               // of the load in the dwell, where the motor may stick
  int cycles = 1;                             // of the motion, the last of which was recorded
  double delay = 0.0, delay_error = 0.0;      // s, of the load's encoder, with its standard error
  double coulomb = 0.0, coulomb_error = 0.0;  // at the motor, as a torque or a force at the output
};

// Of the `record` of a cycle along the motion of `task`, whose dwell was fitted by `fit`. `running`: not from rest, but
// behind many cycles of the same motion.
IdentifiedDrive identify_drive(const ShapingTask& task, const CycleRecord& record, const DwellFit& fit, bool running);

// How the load of the `identified` drive vibrates about its rest behind the last of `cycles` of `motion`, which has the
// dwell of `task`; at the end of the rise.
std::complex<double> modelled_residual(const ShapingTask& task, const IdentifiedDrive& identified, const Motion& motion,
                                       int cycles = 1);

// Where the dwell of a `task` begins for a fit: what the drive's own lag leaves of the rise has died.
double settled(const ShapingTask& task);

}  // namespace stiction::sim::cam
