// The log that a replay writes.
#pragma once

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

// The values of one axis that a replay keeps, at one time.
struct ReplaySample {
  double x = 0.0, v = 0.0, i = 0.0, i_set = 0.0, force = 0.0, x_load = 0.0;
  std::uint32_t phase = 0;  // 2^-32 turns
};

// Collects the simulated values at the log's times; currents at the times at which the machine's record has them.
class ReplaySampler {
 public:
  // `log`: whose times and axes; `axes`: of the `machine`, one for each of the log's. Both outlive this.
  ReplaySampler(const Log& log, const std::vector<std::size_t>& axes, const machine::Machine& machine);

  bool done() const;
  // The values of the tick at t s; ticks come in order. Leaves `values` with others.
  void add(double t, std::vector<ReplaySample>& values);
  Log finish() { return std::move(out_); }

 private:
  struct Place {
    std::size_t axis;  // of the machine
    double delay;      // s
    std::size_t next_motion = 0, next_current = 0;
  };
  template <class Keep>
  void take(std::size_t& next, double delay, double earlier, Keep&& keep) const;
  void keep_motion(std::size_t k, const ReplaySample& sample);
  void keep_current(std::size_t k, const ReplaySample& sample);

  const std::vector<double>& times_;
  const machine::Machine& machine_;
  std::vector<Place> places_;
  std::vector<ReplaySample> before_, now_;
  double time_ = -std::numeric_limits<double>::infinity();
  Log out_;
};

}  // namespace stiction::host
