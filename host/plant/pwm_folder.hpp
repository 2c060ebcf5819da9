// A folder of the shape of /sys/class/pwm/pwmchipN, whose duty cycles can be read: no simulated PWM chip exists in the
// kernel. A channel is a folder pwmN with the files duty_cycle and period (ns) and enable.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace stiction::plant {

class PwmFolder {
 public:
  // Made with that many channels where there is none, and removed again by the destructor. Throws GpioSimError.
  PwmFolder(std::filesystem::path path, int channels);
  ~PwmFolder();
  PwmFolder(const PwmFolder&) = delete;
  PwmFolder& operator=(const PwmFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::int64_t duty_ns(int channel) const;  // throws GpioSimError where it cannot be read

 private:
  std::filesystem::path path_;
  bool made_here_ = false;
  std::vector<int> duty_files_;
};

}  // namespace stiction::plant
