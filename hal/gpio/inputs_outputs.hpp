// Enable, brake, fault and switches of every axis on digital lines: beside a power stage on another bus
// (beside_lines.hpp), or as part of the GPIO backend.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/gpio/config.hpp"
#include "hal/gpio/lines.hpp"
#include "hal/gpio/watchdog_pulse.hpp"
#include "stiction/drive/exchange.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::hal {

class GpioInputsOutputs {
 public:
  // Reserves the lines of every axis and that of the watchdog, outputs inactive. `lines` must outlive this; `axes`: one
  // an axis of the machine; `watchdog`: of the pulse; `tracks`: of a cam switch. Throws GpioError.
  GpioInputsOutputs(Lines& lines, std::span<const AxisLines> axes, const WatchdogConfig& watchdog = {},
                    std::span<const LineConfig> tracks = {});

  // From the last Lines::poll. Lines that are not wired leave the inputs as they are.
  void read_inputs(std::size_t axis, DigitalInputs<FixedSignals>& inputs) const;
  // What is wired of them takes the place of what is there.
  void read_protection(std::size_t axis, ProtectionInputs<FixedSignals>& inputs) const;
  MotorSignalSet motor_signals(std::size_t axis) const;
  // The power stage's fault input, or a chip that failed.
  bool fault(std::size_t axis) const;
  bool has_index(std::size_t axis) const { return axes_[axis].index.has_value(); }
  std::span<const Edge> index_edges(std::size_t axis) const;  // empty where none is wired
  bool index_queue_was_full(std::size_t axis) const;
  // Edges of the axis' lines that must have been lost, at least; none of them is a fault by itself.
  std::uint64_t lost_edges(std::size_t axis) const;

  // Power stage, and with it the brake: released while the power stage is on, unless set_brake() said otherwise.
  void set_enable(std::size_t axis, bool on);
  // From the next set_enable() on. A drive engages its brake while the power still holds the axis.
  void set_brake(std::size_t axis, bool released) { axes_[axis].released = released; }

  // A track of the cam switch; one that is not wired is left alone.
  void set_track(std::size_t track, bool on) {
    if (track < tracks_.size() && tracks_[track]) lines_.set(*tracks_[track], on);
  }

  // At the end of each tick: the pulse for a watchdog outside of the computer. `now_ns`: time of the tick.
  void pulse(std::int64_t now_ns) {
    if (watchdog_) lines_.set(*watchdog_, pulse_.step(now_ns));
  }

 private:
  using Place = std::optional<std::size_t>;
  struct Axis {
    Place enable, brake, fault, limit_negative, limit_positive, home, index;
    std::array<Place, 2> torque_off;
    std::array<Place, 3> hall;
    bool has_hall() const { return hall[0] && hall[1] && hall[2]; }
    bool released = true;  // the brake, while the power is on
  };

  Lines& lines_;
  std::vector<Axis> axes_;
  std::vector<Place> tracks_;
  Place watchdog_;
  WatchdogPulse pulse_;
};

}  // namespace stiction::hal
