// Voltages as duty cycles of half bridges behind the kernel's PWM class (Documentation/ABI/testing/sysfs-class-pwm:
// a folder pwmN a channel, with period and duty_cycle in ns, and enable). The class knows no dead time and no
// relation between channels, so that it drives the inputs of a power-stage module, never transistors.
//
// Half bridges switch between the rails: u = 0 is half of the period. Three phases: duty = 1/2 + u / u_dc each. One
// voltage over a full bridge: duty = 1/2 +- u / (2 u_dc).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "hal/gpio/config.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::hal {

// Time that a half bridge is on in a period, ns, for the voltages of its phases; beyond the rails it stays at them.
class DutyMap {
 public:
  // Throws GpioError where a value makes no sense.
  explicit DutyMap(const PwmConfig& config);

  std::size_t half_bridges() const { return half_bridges_; }
  std::int64_t duty_ns(std::size_t half_bridge, std::span<const FixedSignals::Voltage, 3> voltage) const;

 private:
  std::size_t half_bridges_;
  std::int64_t period_ns_;
  std::int64_t most_raw_;  // voltage of a duty of 0 or 1
  std::int64_t gain_;      // ns * 2^32 a bit of voltage
};

// The channels of one motor. Files stay open; a tick writes those whose duty has changed, and allocates nothing.
class PwmBridge {
 public:
  // Exports the channels, sets their period and a voltage of 0, and starts them. Throws GpioError.
  explicit PwmBridge(const PwmConfig& config);
  ~PwmBridge();  // stops them
  PwmBridge(const PwmBridge&) = delete;
  PwmBridge& operator=(const PwmBridge&) = delete;

  void write(std::span<const FixedSignals::Voltage, 3> voltage);
  // The duties of no voltage, beside the thread that writes and in a signal handler.
  void rest() const noexcept;
  bool failed() const { return failed_; }  // whether a write was ever refused

 private:
  struct Channel {
    std::filesystem::path folder;
    int number = 0;
    int duty_file = -1;
    std::int64_t duty_ns = 0;
    std::int64_t rest_ns = 0;  // of no voltage
    bool exported_here = false;
  };

  void open(Channel& channel, const PwmConfig& config);
  void close(Channel& channel);
  void close_all();

  std::filesystem::path chip_;
  DutyMap map_;
  std::vector<Channel> channels_;
  bool failed_ = false;
};

}  // namespace stiction::hal
