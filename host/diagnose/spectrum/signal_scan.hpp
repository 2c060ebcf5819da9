// Lines in a residual over the encoder's signal: what an error of its reading leaves by the acceleration of crawls and
// by the drive's answers that the samples of the log fold down (encoder_error_response.hpp).
#pragma once

#include <Eigen/Dense>
#include <cstddef>

#include "firmware/machine/model/machine.hpp"
#include "host/diagnose/spectrum/line_scan.hpp"
#include "host/diagnose/statistics/whitening.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

// Signal periods (m), from 2 um, or four of the encoder's increments, to 1 mm or 1/200 turn. The count knows the
// signal: one phase in all records. `residual` force (N) of the `rows`, looked at through `whitening`; `axis` and
// `timing` of the machine file; `settings` of the rows; `count`: of lines at most.
LineScan scan_signal_periods(const LogRows& rows, const Eigen::VectorXd& residual, const Whitening& whitening,
                             const machine::AxisModel& axis, const machine::Timing& timing,
                             const SignalSettings& settings, std::size_t count);

}  // namespace stiction::host
