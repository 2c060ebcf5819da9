// Runs of the friction bench as logs in memory, in the channels of docs/formats.md.
#pragma once

#include <utility>

#include "host/log/log.hpp"
#include "host/simulate/friction_bench.hpp"

namespace stiction::host {

// Every `stride`-th step of a mass on a bench: position, velocity, and the force on it as F. No axis has a name.
class BenchRecorder {
 public:
  explicit BenchRecorder(int stride = 50) : stride_(stride) {
    log_.period = stride * FrictionBench::step;
    log_.axes.resize(1);
  }

  // After a step under `force` (N).
  void add(const FrictionBench& bench, double force) {
    if (count_++ % stride_ != 0) return;
    // Counted, because the bench's own time adds up its rounding.
    log_.t.push_back(static_cast<double>(count_) * FrictionBench::step);
    log_.axes[0].x.push_back(bench.position());
    log_.axes[0].v.push_back(bench.velocity());
    log_.axes[0].force.push_back(force);
  }
  Log take() { return std::move(log_); }

 private:
  int stride_;
  long count_ = 0;
  Log log_;
};

}  // namespace stiction::host
