// An axis on a bench: its feedback is prescribed, so that nothing answers to its commands.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

#include "firmware/machine/configuration/conversion.hpp"
#include "firmware/machine/configuration/double_signals.hpp"
#include "stiction/drive/axis.hpp"
#include "stiction/drive/ticker.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::test {

inline constexpr std::int64_t tick_ns = 62500;
inline constexpr std::uint32_t ticks_per_slow_tick = 16;
inline constexpr double tick = 62.5e-6;  // s

template <class T>
T si(double value) {
  return machine::to_signal<T>(value).value();
}

// The X axis of the cross table (Mendricky 2006, Tab 3.1 to 3.3) without quantizer and notch, with a DC motor and round
// limits.
template <class S>
AxisConfig<S> bench_config() {
  AxisConfig<S> c;
  c.period_ns = tick_ns;
  c.inverse_period = si<typename S::PeriodInverse>(1.0 / 62500.0);
  c.position_gain = si<typename S::PositionGain>(83.0);
  c.velocity_feedforward = si<typename S::VelocityWeight>(1.0);
  c.velocity_feedback = VelocityFeedback::difference;
  c.velocity = {si<typename S::VelocityGain>(600.0), si<typename S::VelocityIntegralGain>(600.0 * tick / 5e-3),
                si<typename S::VelocityTracking>(tick / 5e-3)};
  c.current_feedforward = si<typename S::AccelerationGain>(2.5);
  c.current_loop = CurrentLoop::direct;
  c.current = {si<typename S::CurrentGain>(35.0), si<typename S::CurrentIntegralGain>(35.0 * tick / 2e-3),
               si<typename S::CurrentTracking>(tick / 2e-3)};
  c.inverse_pole_pair_pitch = si<typename S::PitchInverse>(16.0);
  c.velocity_limit = si<typename S::Velocity>(1.5);
  c.current_limit = si<typename S::Current>(40.0);
  c.voltage_limit = si<typename S::Voltage>(300.0);
  c.following_error_fault = si<typename S::Distance>(2e-3);
  c.over_current_fault = si<typename S::Current>(48.0);
  c.over_speed_fault = si<typename S::Velocity>(1.75);
  c.limit_cycle_window_ticks = 2000;  // 125 ms
  return c;
}

template <class S>
class Bench {
 public:
  explicit Bench(const AxisConfig<S>& config = bench_config<S>()) : axis(config) { start(); }

  void start() {
    feedback.position_time_ns = ticker.now_ns();
    feedback.position_valid = true;
    axis.start(feedback);
  }
  void hold_at(double position) {
    feedback.position = si<typename S::Position>(position);
    set.position = feedback.position;
  }
  // A tick with a sample taken `age_ns` before it.
  Command<S> tick(std::int64_t age_ns = 0) {
    feedback.position_time_ns = ticker.now_ns() - age_ns;
    return tick_as_it_is();
  }
  // A tick with the feedback as the test left it, time stamp included.
  Command<S> tick_as_it_is() {
    command = axis.tick(set, feedback, ticker.now_ns(), ticker.slow(), signals);
    ticker.advance();
    return command;
  }

  Axis<S> axis;
  Ticker ticker{tick_ns, ticks_per_slow_tick};
  SetPoint<S> set{};
  Feedback<S> feedback{};
  Command<S> command{};
  AxisSignals<S> signals{};
};

using FixedBench = Bench<FixedSignals>;

}  // namespace stiction::test
