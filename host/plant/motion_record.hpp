// What moved after the power was taken: the evidence of a stop, seen from the machine's side.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace stiction::host {

class MotionRecord {
 public:
  explicit MotionRecord(std::size_t axes) : axes_(axes) {}

  // The state after a tick: whether the stage was on in it, and where the axis is then (m). `axis`: its index;
  // `enabled`: the stage was on; `position`: m.
  void add(std::size_t axis, bool enabled, double position) {
    auto& a = axes_[axis];
    ++a.ticks;
    if (enabled) {
      a.ever_on = true;
      a.on_until = a.ticks;
      a.position_at_off = position;
      a.moved_until = a.ticks;
    } else if (std::abs(position - a.position) > rest_step) {
      a.moved_until = a.ticks;
    }
    a.position = position;
  }

  // "axis X: stage off since tick 16000, ran on by 12.3 um for 80 ticks, stands at 90.000 mm"
  std::string describe(const std::string& name, std::size_t axis) const {
    const auto& a = axes_[axis];
    if (!a.ever_on) return fmt::format("axis {}: never switched on, position {:.6f} mm", name, a.position * 1e3);
    if (a.on_until == a.ticks) return fmt::format("axis {}: switched on, position {:.6f} mm", name, a.position * 1e3);
    return fmt::format("axis {}: stage off since tick {}, coasted by {:.3f} um for {} ticks, position {:.6f} mm", name,
                       a.on_until, (a.position - a.position_at_off) * 1e6, a.moved_until - a.on_until,
                       a.position * 1e3);
  }

 private:
  // m a tick, an increment of a fine encoder: the bristles under a carriage that has stopped swing on below it.
  static constexpr double rest_step = 1e-9;

  struct Axis {
    bool ever_on = false;
    std::uint64_t ticks = 0, on_until = 0, moved_until = 0;
    double position = 0.0, position_at_off = 0.0;
  };
  std::vector<Axis> axes_;
};

}  // namespace stiction::host
