// The control loop of axes that have structures other than the firmware's cascade: hal::ControlLoop's part over the
// simulated machine, with StructuredAxis in place of the drive's axis.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "firmware/machine/configuration/conversion.hpp"
#include "hal/simulated/simulated_backend.hpp"
#include "host/simulate/structured_axis.hpp"
#include "stiction/drive/axis_signals.hpp"

namespace stiction::host {

template <class S>
class StructuredLoop {
 public:
  using Backend = hal::SimulatedBackend<S>;

  // All axes of the `machine` have such structures. Waits for the first tick of `backend`.
  StructuredLoop(const machine::Machine& machine, Backend& backend) : backend_(backend), signals_(machine.axes.size()) {
    for (const auto& axis : machine.axes) axes_.emplace_back(machine.timing, axis);
    now_ns_ = backend_.wait_for_tick();
  }

  std::int64_t now_ns() const { return now_ns_; }  // of the tick that comes next
  std::span<const AxisSignals<S>> signals() const { return signals_; }

  // Controls one tick with a set-point an axis, then waits for the next.
  void tick(std::span<const sim::AxisSetPoint> set_points) {
    for (std::size_t k = 0; k < axes_.size(); ++k) {
      auto& plant = backend_.plant(k);
      const double x = plant.read_encoder();
      const StructuredAxis::Seen seen{x, plant.read_velocity_encoder(), plant.encoder_velocity(), plant.current()};
      const auto command = axes_[k].tick(set_points[k], seen);
      plant.command(command.voltage, true);
      note(set_points[k], seen, command, signals_[k]);
    }
    now_ns_ = backend_.wait_for_tick();
  }

  // Whether an axis has left the range of numbers.
  bool ran_away(std::size_t axis) const { return !std::isfinite(backend_.plant(axis).position()); }

 private:
  static void note(const sim::AxisSetPoint& set, const StructuredAxis::Seen& seen,
                   const StructuredAxis::Command& command, AxisSignals<S>& s) {
    using machine::convert;
    convert(set.position, s.x_set);
    convert(set.velocity, s.v_set);
    convert(set.acceleration, s.a_set);
    convert(seen.position, s.x);
    convert(seen.velocity, s.v);
    convert(set.position - seen.position, s.e);
    convert(command.output, s.i_set);
    convert(command.current, s.i);
    for (std::size_t k = 0; k < s.i_phase.size(); ++k) {
      convert(seen.current[k], s.i_phase[k]);
      convert(command.voltage[k], s.u_phase[k]);
    }
  }

  Backend& backend_;
  std::int64_t now_ns_ = 0;
  std::vector<StructuredAxis> axes_;
  std::vector<AxisSignals<S>> signals_;
};

}  // namespace stiction::host
