// Where two pulses are on a machine that does not stop. They cancel what is carried over with the cycle's own residual,
// so they are larger than from rest, and what they excite of the drive's own mode lies in the dwell if they are at the
// end of the rise: there the load is off before anything can ring. So every place of a grid is tried on the drive that
// was identified: what the load does in the dwell from its beginning on, and what the drive has to push.
#pragma once

#include <complex>
#include <vector>

#include "sim/cam/shaping/pulses.hpp"

namespace stiction::sim::cam {

struct RunningResidual {
  std::complex<double> all;      // of the cycle that was recorded, at the end of the rise (modal_residual)
  std::complex<double> carried;  // what of it is there in the next cycle
  double frequency_error = 0.0;  // standard error over the frequency
  double largest_force = 0.0;    // of the drive, at the output
};

// Places for pulses in the rise of `task`, whose drive is the identified one, that cancel `residual` in the next cycle
// and its own part in those behind it; in rising order of the larger area that the load then makes in the dwell, the
// largest within the 95 % interval of the frequency. Without those that ask the drive for more than its largest force.
std::vector<PulsePlaces> running_places(const ShapingTask& task, const RunningResidual& residual);

}  // namespace stiction::sim::cam
