// What a record of a dwell tells of a vibration: a damped sine about a constant, by least squares (Gauss and Newton),
// with the standard errors of its frequency and its damping. The constant is fitted beside it, since friction at the
// motor leaves the dwell off by more than what is to be left.
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "sim/cam/stand/transfer_function.hpp"

namespace stiction::sim::cam {

// Of the load, less where it should be.
struct DwellRecord {
  std::vector<double> time;      // s, rising
  std::vector<double> position;  // as many, in the slave's unit
};

struct DwellFit {
  Mode mode;
  std::complex<double> residual;  // the load deviates by 2 Re(residual e^(pole t)) + offset at the time t
  double offset = 0.0;
  double scatter = 0.0;          // rms of what is left
  double frequency_error = 0.0;  // standard error, rad/s
  double damping_error = 0.0;    // of the damping ratio
  double residual_error = 0.0;   // of the residual's magnitude

  // From peak to peak at the time 0.
  double peak_to_peak() const { return 4.0 * std::abs(residual); }
};

// Means of blocks of a `record`: a fast drive's has far more samples than a vibration needs.
DwellRecord thinned(const DwellRecord& record);

// Of a `record`, with a frequency within 35 % of `guess` (rad/s). None in a record of less than one period of the
// guess, or whose vibration is below its scatter.
std::optional<DwellFit> fit_dwell(const DwellRecord& record, double guess);

// By how much the vibration of a `record`, whose `fit` that is, grows from peak to peak until its end, as that of a
// mode by itself does not; 0 where it does not grow for sure.
double growth_of(const DwellRecord& record, const DwellFit& fit);

// The residual of a `record` that vibrates with a `mode`, as fit_dwell() has it; the record's constant becomes
// `offset`, where it is given.
std::complex<double> residual_with_mode(const DwellRecord& record, const Mode& mode, double* offset = nullptr);

// The `drive` with the shaft that makes its load's mode `mode`.
ElasticDrive drive_with_mode(const ElasticDrive& drive, const Mode& mode);

}  // namespace stiction::sim::cam
