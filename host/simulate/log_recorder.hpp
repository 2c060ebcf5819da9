// Runs as logs in memory, in the channels of docs/formats.md.
#pragma once

#include <utility>
#include <vector>

#include "host/log/log.hpp"
#include "host/log/own_units.hpp"
#include "host/simulate/control_run.hpp"

namespace stiction::host {

// Every tick of a control run: set-points, position, velocity, currents; of what is driven by volts its voltage. It
// must outlive its sink.
class LogRecorder {
 public:
  explicit LogRecorder(const machine::Machine& machine) {
    log_.period = machine.timing.fast_period;
    for (const auto& axis : machine.axes) {
      log_.axes.emplace_back().axis = axis.name;
      axes_.push_back({axis.coordinate, axis.commanded_in_volts(), !axis.motor.driven_by_volts()});
    }
  }
  LogRecorder(const LogRecorder&) = delete;
  LogRecorder& operator=(const LogRecorder&) = delete;
  ~LogRecorder() = default;

  template <class S>
  TraceSink<S> sink() {
    return [this](std::int64_t now_ns, std::span<const AxisSignals<S>> signals) {
      log_.t.push_back(static_cast<double>(now_ns) * 1e-9);
      for (std::size_t k = 0; k < signals.size(); ++k) {
        auto& axis = log_.axes[k];
        const auto& s = signals[k];
        axis.x_set.push_back(machine::to_si(s.x_set));
        axis.v_set.push_back(machine::to_si(s.v_set));
        axis.a_set.push_back(machine::to_si(s.a_set));
        axis.x.push_back(machine::to_si(s.x));
        axis.v.push_back(machine::to_si(s.v));
        if (axes_[k].in_volts) axis.u.push_back(machine::to_si(s.i_set));
        if (!axes_[k].has_current) continue;
        axis.i.push_back(machine::to_si(s.i));
        if (!axes_[k].in_volts) axis.i_set.push_back(machine::to_si(s.i_set));
      }
    };
  }
  // In the units of the axes.
  Log take() {
    for (std::size_t k = 0; k < log_.axes.size(); ++k)
      log_.axes[k] = in_own_units(std::move(log_.axes[k]), axes_[k].coordinate);
    return std::move(log_);
  }

 private:
  struct Axis {
    machine::Coordinate coordinate;
    bool in_volts, has_current;
  };

  Log log_;
  std::vector<Axis> axes_;
};

}  // namespace stiction::host
