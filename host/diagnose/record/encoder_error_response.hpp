// What a small error of the measured position makes of the force that a log shows, by frequency: the drive closes its
// loop on what it reads. Below half the log's rate the carriage follows the current and the residual force is that of
// the acceleration that was not there. Above it the drive answers with currents that the log's samples fold down.
#pragma once

#include <complex>

#include "firmware/machine/model/machine.hpp"

namespace stiction::host {

class EncoderErrorResponse {
 public:
  // `log_period`: s, of the log's samples. `axis` and `timing`: of the machine file.
  EncoderErrorResponse(const machine::AxisModel& axis, const machine::Timing& timing, double log_period);

  // Residual force (N) for an error of 1 m at `frequency` (Hz, not negative), as the log's samples show it.
  std::complex<double> operator()(double frequency) const;
  double mass() const { return axis_.mass; }  // kg
  // The frequency (Hz) at which the log shows it.
  double shown_at(double frequency) const;
  // The drive's answer alone, N per m: position by velocity estimate, PI, notch and current loop in the steps of the
  // fast tick (discretised as the firmware's), with the carriage's own motion. The position loop, weak there, is left
  // out. 0 for an axis without a velocity controller.
  std::complex<double> drive(double frequency) const;

 private:
  std::complex<double> current_loop(std::complex<double> back) const;

  machine::AxisModel axis_;
  double tick_;
  double log_period_;
};

}  // namespace stiction::host
