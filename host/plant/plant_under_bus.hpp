// What moves behind a bus, for whatever speaks on it.
#pragma once

#include <functional>
#include <span>

#include "stiction/drive/exchange.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {

struct PlantUnderBus {
  std::function<void(std::span<const Command<FixedSignals>>)> advance;  // one tick under these voltages
  std::function<void(std::span<Feedback<FixedSignals>>, std::span<DigitalInputs<FixedSignals>>)> sample;
  std::function<void(std::span<ProtectionInputs<FixedSignals>>)> sample_protection;
  std::function<MotorSignalSet(std::size_t axis)> motor_signals;  // that an axis has
  std::function<void(std::size_t axis, bool closed)> set_brake;   // of the ticks to come; open where nobody says
};

}  // namespace stiction::host
