// The two-rate control loop of all axes over any backend. Allocates at construction only.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hal/backend.hpp"
#include "stiction/drive/axis.hpp"
#include "stiction/drive/friction_compensation.hpp"
#include "stiction/drive/ticker.hpp"

namespace stiction::hal {

// Whose power a fault takes off in its tick.
enum class FaultScope {
  all_axes,  // a path is lost with any of its axes
  own_axis,  // the others are stopped by who runs the loop
};

template <Backend B>
class ControlLoop {
 public:
  using S = typename B::Signals;

  // One configuration per axis of the backend, in its order. The first tick happens here: it starts the axes at rest
  // where they are.
  // `compensations`: as many, or none where no axis has friction compensation. `configs`: of the axes; `ticker`: period
  // and slow ticks; `scope`: axes that a fault switches off.
  ControlLoop(B& backend, std::span<const AxisConfig<S>> configs, Ticker ticker,
              std::span<const FrictionCompensationConfig<S>> compensations = {},
              FaultScope scope = FaultScope::all_axes)
      : backend_(backend),
        ticker_(ticker),
        scope_(scope),
        feedback_(configs.size()),
        command_(configs.size()),
        signals_(configs.size()),
        compensation_signals_(compensations.size()) {
    axes_.reserve(configs.size());
    for (const auto& config : configs) axes_.emplace_back(config);
    for (const auto& config : compensations) compensations_.emplace_back(config);
    start();
  }

  // Makes the first tick again, now: the axes are at rest where they are found. Only before tick().
  void start() {
    now_ns_ = backend_.wait_for_tick();
    backend_.read(feedback_);
    for (std::size_t i = 0; i < axes_.size(); ++i) axes_[i].start(feedback_[i]);
    for (std::size_t i = 0; i < compensations_.size(); ++i) compensations_[i].start(feedback_[i].position);
  }

  // Controls this tick with one set-point an axis, then waits for the next.
  void tick(std::span<const SetPoint<S>> set_points) {
    control(set_points, [this](std::size_t axis) -> AxisSignals<S>& { return signals_[axis]; });
  }

  // The same where nobody reads signals(), which stay as they were: 40 instructions a tick of 770 less in doubles.
  void tick_untraced(std::span<const SetPoint<S>> set_points) {
    control(set_points, [](std::size_t) { return AxisSignals<S>{}; });
  }

  std::int64_t now_ns() const { return now_ns_; }  // time of the tick that comes next
  bool slow() const { return ticker_.slow(); }     // whether that one is a slow tick
  std::span<const Axis<S>> axes() const { return axes_; }
  // For who starts, stops and trips axes between ticks, as a drive's state machine does.
  std::span<Axis<S>> axes() { return axes_; }
  std::span<const Feedback<S>> feedback() const { return feedback_; }   // of the tick that comes next
  std::span<const AxisSignals<S>> signals() const { return signals_; }  // of the tick controlled last
  // Of the same tick; empty without friction compensation.
  std::span<const FrictionCompensationSignals<S>> compensation_signals() const { return compensation_signals_; }
  std::span<const FrictionCompensation<S>> compensations() const { return compensations_; }

  bool faulted() const {
    for (const auto& axis : axes_)
      if (axis.fault() != Fault::none) return true;
    return false;
  }

 private:
  // `place` gives where an axis' signals go. Into a value that ends with the tick the compiler writes none of them.
  // With all it calls inline: the call of the axis alone costs 40 instructions around a tick of 250 in doubles.
  template <class Place>
  [[gnu::flatten]] void control(std::span<const SetPoint<S>> set_points, Place place) {
    bool fault_seen = false;
    std::size_t i = 0;
    for (auto& axis : axes_) {
      auto&& signals = place(i);
      if (compensations_.empty()) [[likely]]
        command_[i] = axis.tick(set_points[i], feedback_[i], now_ns_, ticker_.slow(), signals);
      else
        command_[i] = tick_compensated(i, set_points[i], signals);
      fault_seen |= axis.fault() != Fault::none;
      ++i;
    }
    if (fault_seen && scope_ == FaultScope::all_axes)
      for (auto& command : command_) command = {};
    backend_.write(command_);
    ticker_.advance();
    now_ns_ = backend_.wait_for_tick();
    backend_.read(feedback_);
  }

  // Not inline: an axis without compensation keeps its registers.
  [[gnu::noinline]] Command<S> tick_compensated(std::size_t i, const SetPoint<S>& newest, AxisSignals<S>& signals) {
    SetPoint<S> set = newest;
    compensations_[i].step(set, compensation_signals_[i]);
    const auto command = axes_[i].tick(set, feedback_[i], now_ns_, ticker_.slow(), signals);
    compensations_[i].observe(signals, compensation_signals_[i]);
    return command;
  }

  B& backend_;
  Ticker ticker_;
  FaultScope scope_;
  std::int64_t now_ns_ = 0;
  std::vector<Axis<S>> axes_;
  std::vector<Feedback<S>> feedback_;
  std::vector<Command<S>> command_;
  std::vector<AxisSignals<S>> signals_;
  std::vector<FrictionCompensation<S>> compensations_;
  std::vector<FrictionCompensationSignals<S>> compensation_signals_;
};

}  // namespace stiction::hal
