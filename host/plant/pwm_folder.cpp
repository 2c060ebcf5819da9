#include "host/plant/pwm_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <utility>

#include "host/plant/gpio_sim.hpp"

namespace stiction::plant {
namespace {

namespace fs = std::filesystem;

void make(const fs::path& path, int channels) {
  for (int i = 0; i < channels; ++i) {
    const auto channel = path / fmt::format("pwm{}", i);
    fs::create_directories(channel);
    for (const char* file : {"duty_cycle", "period", "enable"}) std::ofstream(channel / file) << "0\n";
  }
  std::ofstream(path / "npwm") << channels << "\n";
}

}  // namespace

PwmFolder::PwmFolder(fs::path path, int channels) : path_(std::move(path)) {
  std::error_code error;
  if (!fs::exists(path_, error)) {
    try {
      make(path_, channels);
    } catch (const fs::filesystem_error& refused) {
      throw GpioSimError(
          fmt::format("PWM {}: {}; expected a folder that can be created", path_.string(), refused.what()));
    }
    made_here_ = true;
  }
  for (int i = 0; i < channels; ++i) {
    const auto file = path_ / fmt::format("pwm{}", i) / "duty_cycle";
    duty_files_.push_back(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
    if (duty_files_.back() >= 0) continue;
    const char* reason = std::strerror(errno);
    for (const int open : duty_files_) ::close(open);
    throw GpioSimError(
        fmt::format("PWM {}: {}; expected {} channels, or no such folder yet", file.string(), reason, channels));
  }
}

PwmFolder::~PwmFolder() {
  for (const int file : duty_files_) ::close(file);
  std::error_code none;
  if (made_here_) fs::remove_all(path_, none);
}

std::int64_t PwmFolder::duty_ns(int channel) const {
  std::array<char, 24> text{};
  const auto length = ::pread(duty_files_.at(static_cast<std::size_t>(channel)), text.data(), text.size(), 0);
  std::int64_t value = 0;
  if (length < 0 || std::from_chars(text.data(), text.data() + length, value).ec != std::errc{})
    throw GpioSimError(fmt::format("PWM {}: the duty cycle of channel {} is no number", path_.string(), channel));
  return value;
}

}  // namespace stiction::plant
