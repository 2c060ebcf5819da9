// The control loop over the simulated machine, as every experiment runs it.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/configuration/compensation_configuration.hpp"
#include "hal/control_loop.hpp"
#include "hal/simulated/simulated_backend.hpp"
#include "host/simulate/late_current.hpp"
#include "sim/effects/effects.hpp"
#include "sim/experiment/set_point.hpp"

namespace stiction::host {

// A fault that stopped a run. what() says axis, fault and time.
class FaultTripped : public std::runtime_error {
 public:
  // `axis_name`: that tripped; `which`: its fault; `when`: s, since the start.
  FaultTripped(std::string axis_name, Fault which, double when)
      : std::runtime_error(fmt::format("axis {}: fault {} '{}' at {:.4f} ms", axis_name, static_cast<int>(which),
                                       name_of(which), when * 1e3)),
        axis(std::move(axis_name)),
        fault(which),
        time(when) {}

  std::string axis;
  Fault fault;
  double time;  // s
};

// Called for every tick with its time in ns and the signals of every axis, the currents as late as they are recorded.
template <class S>
using TraceSink = std::function<void(std::int64_t, std::span<const AxisSignals<S>>)>;

template <class S>
class ControlRun {
 public:
  // Rests at `positions` (m), one an axis of the machine. Throws sim::ConfigurationError.
  ControlRun(const machine::Machine& machine, std::span<const double> positions)
      : machine_(machine),
        set_point_delay_(machine::set_point_delay(machine)),
        backend_(machine, positions),
        configs_(configure(machine)),
        compensations_(machine::configure_compensations<S>(machine)),
        loop_(backend_, std::span<const AxisConfig<S>>(configs_),
              Ticker(machine::fast_period_ns(machine.timing),
                     static_cast<std::uint32_t>(machine::slow_ratio(machine.timing))),
              std::span<const FrictionCompensationConfig<S>>(compensations_)),
        set_(machine.axes.size()),
        late_(machine) {}
  ControlRun(const ControlRun&) = delete;
  ControlRun& operator=(const ControlRun&) = delete;
  ~ControlRun() = default;

  double time() const { return static_cast<double>(loop_.now_ns()) * 1e-9; }  // s, of the tick that comes next
  sim::AxisPlant& plant(std::size_t axis) { return backend_.plant(axis); }    // as the samples of that tick see it
  const AxisSignals<S>& signals(std::size_t axis) const { return loop_.signals()[axis]; }  // of the tick before
  // Of an axis; none where the machine has no friction compensation.
  const FrictionCompensation<S>* compensation(std::size_t axis) const {
    return loop_.compensations().empty() ? nullptr : &loop_.compensations()[axis];
  }
  std::span<const FrictionCompensationSignals<S>> compensation_signals() const { return loop_.compensation_signals(); }
  // The time (s) of the set-points that the axes follow in the tick that comes next: friction compensation holds them
  // back.
  double set_point_time() const { return time() - set_point_delay_; }

  // Controls one tick with a set-point an axis. Throws FaultTripped after the trace has had the tick.
  void tick(std::span<const sim::AxisSetPoint> set_points, const TraceSink<S>& trace = {}) {
    for (std::size_t i = 0; i < set_.size(); ++i) set_[i] = sim::to_set_point<S>(set_points[i]);
    const std::int64_t now_ns = loop_.now_ns();
    loop_.tick(set_);
    if (trace) late_.record(now_ns, loop_.signals(), trace);
    if (loop_.faulted()) throw_fault();
  }

 private:
  static std::vector<AxisConfig<S>> configure(const machine::Machine& machine) {
    std::vector<AxisConfig<S>> configs;
    for (const auto& axis : machine.axes)
      configs.push_back(machine::configure_axis<S>(machine.timing, sim::drive_axis(axis)));
    return configs;
  }
  [[noreturn]] void throw_fault() const {
    std::size_t first = 0;
    std::int64_t time = INT64_MAX;
    for (std::size_t i = 0; i < loop_.axes().size(); ++i)
      if (const auto& axis = loop_.axes()[i]; axis.fault() != Fault::none && axis.fault_time_ns() < time) {
        first = i;
        time = axis.fault_time_ns();
      }
    throw FaultTripped(machine_.axes[first].name, loop_.axes()[first].fault(), static_cast<double>(time) * 1e-9);
  }

  const machine::Machine& machine_;
  double set_point_delay_;
  hal::SimulatedBackend<S> backend_;
  std::vector<AxisConfig<S>> configs_;
  std::vector<FrictionCompensationConfig<S>> compensations_;
  hal::ControlLoop<hal::SimulatedBackend<S>> loop_;
  std::vector<SetPoint<S>> set_;
  LateCurrent<S> late_;
};

}  // namespace stiction::host
