// Motion commands on their way from a server's thread to the loop: a place for each thing that can be commanded, not a
// queue, so that it is never full and the newest value counts. A controlword that takes an axis out of operation has a
// place of its own besides: the loop takes it even where a later word enables again before the loop has looked.
// Wait-free on both sides, for one writer and one reader.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "firmware/stictiond/modbus_registers.hpp"
#include "hal/snapshot.hpp"

namespace stiction::drive {

class MotionMailbox {
 public:
  // Switch on, voltage, no quick stop, operation: an axis moves with all four bits alone (CiA 402, 6040h).
  static bool stops(const MotionWrite& write) {
    return write.what == MotionWrite::What::controlword && (static_cast<unsigned>(write.value) & 0xfu) != 0xfu;
  }

  // By the server's thread: the writes of one request, which the loop takes together.
  void put(std::span<const MotionWrite> writes) {
    for (const MotionWrite& write : writes) {
      AxisOrders& axis = orders_[write.axis];
      const Order order{write.value, ++serial_, write.of_other};
      axis.newest[static_cast<std::size_t>(write.what)] = order;
      if (stops(write)) axis.stop = order;
    }
    snapshot_.publish(orders_);
  }

  // By the loop, once a tick: `act` is called with each command that is new, at most one controlword an axis, a stop
  // before what followed it.
  template <class Act>
  void take(Act act) {
    const Orders& orders = snapshot_.latest();
    if (!snapshot_.is_new() && !more_) return;
    more_ = false;
    for (std::size_t axis = 0; axis < orders.size(); ++axis) take_axis(axis, orders[axis], act);
  }

 private:
  static constexpr std::size_t kinds = MotionWrite::kinds;
  static constexpr auto word_kind = static_cast<std::size_t>(MotionWrite::What::controlword);

  struct Order {
    double value = 0.0;
    std::uint64_t serial = 0;  // 0: never given
    bool of_other = false;
  };
  struct AxisOrders {
    std::array<Order, kinds> newest{};
    Order stop{};
  };
  using Orders = std::array<AxisOrders, most_published_axes>;

  template <class Act>
  void take_axis(std::size_t axis, const AxisOrders& orders, Act act) {
    auto& taken = taken_[axis];
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      Order order = orders.newest[kind];
      if (kind == word_kind && orders.stop.serial > taken[kind]) {
        more_ |= order.serial > orders.stop.serial;
        order = orders.stop;
      }
      if (order.serial <= taken[kind]) continue;
      taken[kind] = order.serial;
      act(MotionWrite{axis, static_cast<MotionWrite::What>(kind), order.value, order.of_other});
    }
  }

  // The writer's.
  Orders orders_{};
  std::uint64_t serial_ = 0;
  // The reader's: serials of what it has acted upon.
  std::array<std::array<std::uint64_t, kinds>, most_published_axes> taken_{};
  bool more_ = false;
  hal::Snapshot<Orders> snapshot_;
};

}  // namespace stiction::drive
