// Runs as logs in memory, in the channels of docs/formats.md.
#pragma once

#include <utility>
#include <vector>

#include "host/log/log.hpp"
#include "host/simulate/control_run.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {

// Every tick of a control run: set-points, position, velocity, currents; of a force source its voltage. It must outlive
// its sink.
class LogRecorder {
 public:
  explicit LogRecorder(const machine::Machine& machine) {
    log_.period = machine.timing.fast_period;
    for (const auto& axis : machine.axes) {
      log_.axes.emplace_back().axis = axis.name;
      force_source_.push_back(axis.motor.driven_by_volts());
    }
  }
  LogRecorder(const LogRecorder&) = delete;
  LogRecorder& operator=(const LogRecorder&) = delete;
  ~LogRecorder() = default;

  TraceSink<FixedSignals> sink() {
    return [this](std::int64_t now_ns, std::span<const AxisSignals<FixedSignals>> signals) {
      log_.t.push_back(static_cast<double>(now_ns) * 1e-9);
      for (std::size_t k = 0; k < signals.size(); ++k) {
        auto& axis = log_.axes[k];
        const auto& s = signals[k];
        axis.x_set.push_back(machine::to_si(s.x_set));
        axis.v_set.push_back(machine::to_si(s.v_set));
        axis.a_set.push_back(machine::to_si(s.a_set));
        axis.x.push_back(machine::to_si(s.x));
        axis.v.push_back(machine::to_si(s.v));
        if (force_source_[k]) {
          axis.u.push_back(machine::to_si(s.i_set));
          continue;
        }
        axis.i.push_back(machine::to_si(s.i));
        axis.i_set.push_back(machine::to_si(s.i_set));
      }
    };
  }
  Log take() { return std::move(log_); }

 private:
  Log log_;
  std::vector<bool> force_source_;
};

}  // namespace stiction::host
