// Between the loop and the thread of one server: the state that the loop hands over, with peaks and mean squares, and
// the commands that it takes. Wait-free on both sides.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "firmware/machine/configuration/conversion.hpp"
#include "firmware/stictiond/modbus_registers.hpp"
#include "firmware/stictiond/motion_mailbox.hpp"
#include "hal/snapshot.hpp"
#include "stiction/drive/axis_signals.hpp"
#include "stiction/drive/state_machine.hpp"

namespace stiction::drive {

// What a client sees of a loop that makes no progress.
inline void mark_stale(PublishedState& state) {
  constexpr std::uint16_t gone = statusword::state_bits | statusword::voltage_bit;
  state.fault = Fault::watchdog_starved;
  for (PublishedAxis& axis : state.axes) {
    axis.statusword = static_cast<std::uint16_t>((axis.statusword & ~gone) | statusword::fault_bit);
    axis.fault = Fault::watchdog_starved;
  }
}

class LoopExchange {
 public:
  // The loop's side.
  // `signals` of the tick; `status` gives positions, statusword, mode, fault and inputs of an axis: status(axis,
  // PublishedAxis&). `now_ns`: time of the tick; `fault`: of programme or bus.
  template <class S, class Status>
  void publish(std::span<const AxisSignals<S>> signals, std::int64_t now_ns, Fault fault, Status status) {
    if (first_ns_ == 0) first_ns_ = now_ns;
    ++rows_;
    PublishedState& next = loop_state_;
    next.seconds = static_cast<std::uint32_t>((now_ns - first_ns_) / 1'000'000'000);
    next.fault = fault;
    for (std::size_t i = 0; i < signals.size() && i < next.axes.size(); ++i) {
      PublishedAxis& axis = next.axes[i];
      const AxisSignals<S>& s = signals[i];
      axis.velocity = machine::to_si(s.v);
      axis.current = machine::to_si(s.i);
      axis.following_error = machine::to_si(s.e);
      axis.peak_following_error = std::max(axis.peak_following_error, std::abs(axis.following_error));
      axis.peak_current = std::max(axis.peak_current, std::abs(axis.current));
      square_sum_[i] += axis.current * axis.current;
      axis.rms_current = std::sqrt(square_sum_[i] / static_cast<double>(rows_));
      status(i, axis);
    }
    snapshot_.publish(next);
  }
  // Once a tick: `act` is called with each command that is new (MotionMailbox::take).
  template <class Act>
  void take_motion(Act act) {
    motion_.take(act);
  }

  // The server's side.
  const PublishedState& latest() { return snapshot_.latest(); }
  // Commands of one request.
  void put(std::span<const MotionWrite> writes) { motion_.put(writes); }

 private:
  PublishedState loop_state_;
  std::array<double, most_published_axes> square_sum_{};
  std::uint64_t rows_ = 0;
  std::int64_t first_ns_ = 0;
  hal::Snapshot<PublishedState> snapshot_;
  MotionMailbox motion_;
};

}  // namespace stiction::drive
