// The control loop over the simulated machine, as every experiment runs it.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/configuration/compensation_configuration.hpp"
#include "hal/control_loop.hpp"
#include "hal/simulated/simulated_backend.hpp"
#include "host/simulate/late_current.hpp"
#include "host/simulate/late_set_points.hpp"
#include "host/simulate/structured_loop.hpp"
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
  // Rests at `positions` (m), one an axis of the machine. Throws sim::ConfigurationError; a machine has the cascade on
  // every axis or on none.
  ControlRun(const machine::Machine& machine, std::span<const double> positions)
      : machine_(machine),
        set_point_delay_(machine::set_point_delay(machine)),
        backend_(machine, positions),
        set_(machine.axes.size()),
        held_(machine),
        late_(machine) {
    if (std::ranges::any_of(machine.axes, [](const machine::AxisModel& axis) { return axis.modulo.has_value(); }))
      counts_.resize(machine.axes.size());
    const auto cascades = std::count_if(machine.axes.begin(), machine.axes.end(),
                                        [](const machine::AxisModel& axis) { return axis.cascaded(); });
    if (cascades == 0) {
      structured_.emplace(machine, backend_);
      return;
    }
    if (static_cast<std::size_t>(cascades) != machine.axes.size())
      throw machine::ConfigurationError(
          "found axes with the cascade and axes with a different controller.structure; expected one kind on all "
          "axes of a machine that is simulated");
    configs_ = configure(machine);
    compensations_ = machine::configure_compensations<S>(machine);
    loop_.emplace(backend_, std::span<const AxisConfig<S>>(configs_),
                  Ticker(machine::fast_period_ns(machine.timing),
                         static_cast<std::uint32_t>(machine::slow_ratio(machine.timing))),
                  std::span<const FrictionCompensationConfig<S>>(compensations_));
  }
  ControlRun(const ControlRun&) = delete;
  ControlRun& operator=(const ControlRun&) = delete;
  ~ControlRun() = default;

  double time() const {  // s, of the tick that comes next
    return static_cast<double>(structured_ ? structured_->now_ns() : loop_->now_ns()) * 1e-9;
  }
  sim::AxisPlant& plant(std::size_t axis) { return backend_.plant(axis); }  // as the samples of that tick see it
  const AxisSignals<S>& signals(std::size_t axis) const {                   // of the tick before
    return structured_ ? structured_->signals()[axis] : loop_->signals()[axis];
  }
  // Of the same tick: the encoder of an endless axis, in counts from zero; of other axes 0.
  std::int64_t encoder_counts(std::size_t axis) const { return counts_.empty() ? 0 : counts_[axis]; }
  // Of an axis; none where the machine has no friction compensation.
  const FrictionCompensation<S>* compensation(std::size_t axis) const {
    return !loop_ || loop_->compensations().empty() ? nullptr : &loop_->compensations()[axis];
  }
  std::span<const FrictionCompensationSignals<S>> compensation_signals() const { return loop_->compensation_signals(); }
  // The time (s) of the set-points that the axes follow in the tick that comes next: friction compensation holds them
  // back.
  double set_point_time() const { return time() - set_point_delay_; }

  // Controls one tick with a set-point an axis. Throws FaultTripped after the trace has had the tick.
  void tick(std::span<const sim::AxisSetPoint> set_points, const TraceSink<S>& trace = {}) {
    if (held_.any()) {
      given_.clear();
      for (const auto& point : set_points) given_.push_back(sim::to_set_point<S>(point));
      set_points = held_(set_points);
    }
    if (structured_) [[unlikely]]
      return tick_structured(set_points, trace);
    for (std::size_t i = 0; i < set_.size(); ++i) set_[i] = sim::to_set_point<S>(set_points[i]);
    tick_cascade(trace);
  }
  // The same with set-points in the formats of the drive; only where every axis has the cascade.
  void tick(std::span<const SetPoint<S>> set_points, const TraceSink<S>& trace = {}) {
    if (held_.any()) {
      std::vector<sim::AxisSetPoint> in_si;
      for (const auto& point : set_points)
        in_si.push_back({machine::to_si(point.position), machine::to_si(point.velocity),
                         machine::to_si(point.acceleration), machine::to_si(point.injection)});
      return tick(in_si, trace);
    }
    std::copy(set_points.begin(), set_points.end(), set_.begin());
    tick_cascade(trace);
  }
  bool cascaded() const { return !structured_; }

 private:
  void tick_cascade(const TraceSink<S>& trace) {
    const std::int64_t now_ns = loop_->now_ns();
    count();  // what this tick works on was read when the one before ended
    loop_->tick(set_);
    if (trace) late_.record(now_ns, as_given(loop_->signals()), trace);
    if (loop_->faulted()) throw_fault();
  }

  void tick_structured(std::span<const sim::AxisSetPoint> set_points, const TraceSink<S>& trace) {
    const std::int64_t now_ns = structured_->now_ns();
    structured_->tick(set_points);
    count();
    if (trace) late_.record(now_ns, as_given(structured_->signals()), trace);
    for (std::size_t k = 0; k < machine_.axes.size(); ++k)
      if (structured_->ran_away(k))
        throw FaultTripped(machine_.axes[k].name, Fault::position_lost, static_cast<double>(now_ns) * 1e-9);
  }

  // With the set-points that belong to the time, where the drive has them late: the record is the master's.
  std::span<const AxisSignals<S>> as_given(std::span<const AxisSignals<S>> signals) {
    if (!held_.any()) return signals;
    traced_.assign(signals.begin(), signals.end());
    for (std::size_t i = 0; i < traced_.size(); ++i) {
      traced_[i].x_set = given_[i].position;
      traced_[i].v_set = given_[i].velocity;
      traced_[i].a_set = given_[i].acceleration;
    }
    return traced_;
  }

  void count() {
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] = backend_.plant(i).encoder_counts();
  }

  static std::vector<AxisConfig<S>> configure(const machine::Machine& machine) {
    std::vector<AxisConfig<S>> configs;
    for (const auto& axis : machine.axes)
      configs.push_back(machine::configure_axis<S>(machine.timing, sim::drive_axis(axis)));
    return configs;
  }
  [[noreturn]] void throw_fault() const {
    std::size_t first = 0;
    std::int64_t time = INT64_MAX;
    for (std::size_t i = 0; i < loop_->axes().size(); ++i)
      if (const auto& axis = loop_->axes()[i]; axis.fault() != Fault::none && axis.fault_time_ns() < time) {
        first = i;
        time = axis.fault_time_ns();
      }
    throw FaultTripped(machine_.axes[first].name, loop_->axes()[first].fault(), static_cast<double>(time) * 1e-9);
  }

  const machine::Machine& machine_;
  double set_point_delay_;
  hal::SimulatedBackend<S> backend_;
  std::vector<AxisConfig<S>> configs_;
  std::vector<FrictionCompensationConfig<S>> compensations_;
  std::optional<hal::ControlLoop<hal::SimulatedBackend<S>>> loop_;
  std::optional<StructuredLoop<S>> structured_;  // in place of the one above
  std::vector<SetPoint<S>> set_;
  LateSetPoints held_;
  std::vector<SetPoint<S>> given_;      // where those are late: as they came
  std::vector<AxisSignals<S>> traced_;  // and with them the signals
  LateCurrent<S> late_;
  std::vector<std::int64_t> counts_;  // none without an endless axis
};

}  // namespace stiction::host
