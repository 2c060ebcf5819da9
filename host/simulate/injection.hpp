// The known test signal of a log on its way into the control of the simulated axis, where the drive adds it: to the set
// current, or to the voltage of a force source.
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

class Injection {
 public:
  // `log` with its `channels` of this axis, which must outlive this; `axis`: of the machine.
  Injection(const Log& log, const AxisLog& channels, const machine::AxisModel& axis);

  // At t (s, on the log's clock): A, or V of a force source; 0 outside the log. Between two samples it is a cubic
  // through them whose slopes come from their neighbours: half-way it keeps 99.6 % of a sine at a tenth of the sampling
  // rate, where a straight line keeps 95 %.
  double at(double t) const;

 private:
  const std::vector<double>* signal_;
  double begin_, period_;
};

// Why the test signal of a log cannot act in the simulation of `axis`: a clause that begins with "found". Empty when it
// can, or where `channels` has none.
std::string refused_injection(const AxisLog& channels, const machine::AxisModel& axis);

// The same of the first axis of `log` for which there is a reason. `axes`: of the machine, one an axis of the log.
std::string refused_injection(const Log& log, const std::vector<const machine::AxisModel*>& axes);

}  // namespace stiction::host
