#include "hal/gpio/pwm.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <thread>

#include "hal/gpio/lines.hpp"

namespace stiction::hal {
namespace {

namespace fs = std::filesystem;
using Voltage = FixedSignals::Voltage;

const PwmConfig& checked(const PwmConfig& config) {
  const auto refuse = [&](const std::string& what) { throw GpioError("PWM " + config.chip + ": " + what); };
  if (config.half_bridges != 2 && config.half_bridges != 3)
    refuse(fmt::format("{} half bridges; expected 2 or 3", config.half_bridges));
  if (config.period_ns < 1000 || config.period_ns > 10'000'000)
    refuse(fmt::format("a period of {} ns; expected 1 us to 10 ms", config.period_ns));
  if (!(config.dc_link >= 1.0) || config.dc_link > 1500.0)
    refuse(fmt::format("{} V between the rails; set drive.gpio.dc_link, 1 V to 1500 V", config.dc_link));
  if (config.first_channel < 0) refuse("no channel is named; set pwm_channel of the axis");
  return config;
}

// One write of one attribute, as the kernel takes it: a number and a line's end. The end also tells the number from
// what an older one left behind where the file is an ordinary one.
bool write_number(int file, std::int64_t value) {
  std::array<char, 24> text;
  char* end = std::to_chars(text.data(), text.data() + text.size() - 1, value).ptr;
  *end++ = '\n';
  return ::pwrite(file, text.data(), static_cast<std::size_t>(end - text.data()), 0) == end - text.data();
}

void set_attribute(const fs::path& path, std::int64_t value) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  const bool written = file >= 0 && write_number(file, value);
  const int error = errno;
  if (file >= 0) ::close(file);
  if (written) return;
  const char* advice = error == EACCES || error == EPERM ? "; run as a member of the group that owns the PWM class, or "
                                                           "install the udev rule of the package"
                       : error == EBUSY                  ? "; the kernel or a different programme uses the channel"
                       : error == EINVAL                 ? "; the hardware does not support that value"
                                                         : "";
  throw GpioError(fmt::format("PWM {}: writing {}: {}{}", path.string(), value, std::strerror(error), advice));
}

std::int64_t attribute(const fs::path& path) {
  std::ifstream file(path);
  std::int64_t value = 0;
  if (!(file >> value)) throw GpioError(fmt::format("PWM {}: cannot be read as a number", path.string()));
  return value;
}

}  // namespace

DutyMap::DutyMap(const PwmConfig& config)
    : half_bridges_(static_cast<std::size_t>(checked(config).half_bridges)),
      period_ns_(config.period_ns),
      // Between the outputs of a full bridge the voltage reaches the rails', against a half bridge's middle half of it.
      most_raw_(std::llround(
          std::ldexp(config.half_bridges == 2 ? config.dc_link : config.dc_link / 2.0, Voltage::fraction_bits))),
      gain_(
          std::llround(std::ldexp(static_cast<double>(config.period_ns) / 2.0, 32) / static_cast<double>(most_raw_))) {}

std::int64_t DutyMap::duty_ns(std::size_t half_bridge, std::span<const Voltage, 3> voltage) const {
  const bool bridge = half_bridges_ == 2;
  const std::int64_t asked = voltage[bridge ? 0 : half_bridge].raw();
  const std::int64_t raw = std::clamp(bridge && half_bridge == 1 ? -asked : asked, -most_raw_, most_raw_);
  // At most half a period times 2^32, 2^55; an odd period's half keeps its fraction until the one rounding here.
  const std::int64_t exact = (period_ns_ << 31) + raw * gain_ + (std::int64_t{1} << 31);
  return std::clamp<std::int64_t>(exact >> 32, 0, period_ns_);
}

PwmBridge::PwmBridge(const PwmConfig& config) : chip_(config.chip), map_(config) {
  std::error_code none;
  if (!fs::is_directory(chip_, none))
    throw GpioError(fmt::format("PWM {}: there is no such folder; set drive.gpio.pwm_chip to one of /sys/class/pwm",
                                chip_.string()));
  const std::int64_t count = attribute(chip_ / "npwm");
  if (config.first_channel + config.half_bridges > count)
    throw GpioError(fmt::format("PWM {}: it has {} channels; expected {} from channel {} on", chip_.string(), count,
                                config.half_bridges, config.first_channel));
  channels_.reserve(map_.half_bridges());
  try {
    for (int i = 0; i < config.half_bridges; ++i) {
      auto& channel = channels_.emplace_back();
      channel.number = config.first_channel + i;
      channel.folder = chip_ / ("pwm" + std::to_string(channel.number));
      open(channel, config);
    }
    for (auto& channel : channels_) set_attribute(channel.folder / "enable", 1);
  } catch (...) {
    close_all();
    throw;
  }
}

PwmBridge::~PwmBridge() { close_all(); }

void PwmBridge::open(Channel& channel, const PwmConfig& config) {
  using namespace std::chrono_literals;
  if (!fs::exists(channel.folder)) {
    set_attribute(chip_ / "export", channel.number);
    channel.exported_here = true;
    // udev sets the group of the new folder's files a moment after the kernel made them.
    for (int attempt = 0; attempt < 100 && ::access((channel.folder / "enable").c_str(), W_OK) != 0; ++attempt)
      std::this_thread::sleep_for(10ms);
  }
  const auto enable = channel.folder / "enable";
  if (config.takes_over) set_attribute(enable, 0);
  if (attribute(enable) != 0)
    throw GpioError(fmt::format(
        "PWM {}: the channel is already running; stop the programme that drives it; where a drive was killed, "
        "stictiond --rest puts it to rest",
        channel.folder.string()));
  // A duty may not be longer than the period at any time.
  set_attribute(channel.folder / "duty_cycle", 0);
  set_attribute(channel.folder / "period", config.period_ns);
  const std::array<Voltage, 3> zero{};
  channel.rest_ns = map_.duty_ns(static_cast<std::size_t>(&channel - channels_.data()), zero);
  channel.duty_ns = channel.rest_ns;
  set_attribute(channel.folder / "duty_cycle", channel.duty_ns);
  channel.duty_file = ::open((channel.folder / "duty_cycle").c_str(), O_WRONLY | O_CLOEXEC);
  if (channel.duty_file < 0) throw GpioError(fmt::format("PWM {}: {}", channel.folder.string(), std::strerror(errno)));
}

// Gives back what was taken, also half of it; what cannot be given back is left to whoever reads the kernel's state.
// A channel that was found running is somebody else's.
void PwmBridge::close(Channel& channel) {
  const bool own = channel.duty_file >= 0;
  if (own) ::close(channel.duty_file);
  channel.duty_file = -1;
  try {
    if (own) set_attribute(channel.folder / "enable", 0);
    if (channel.exported_here) set_attribute(chip_ / "unexport", channel.number);
  } catch (const GpioError&) {
    failed_ = true;
  }
}

void PwmBridge::close_all() {
  for (auto& channel : channels_) close(channel);
}

void PwmBridge::rest() const noexcept {
  for (const auto& channel : channels_) write_number(channel.duty_file, channel.rest_ns);
}

void PwmBridge::write(std::span<const Voltage, 3> voltage) {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    auto& channel = channels_[i];
    const std::int64_t duty_ns = map_.duty_ns(i, voltage);
    if (duty_ns == channel.duty_ns) continue;
    if (write_number(channel.duty_file, duty_ns))
      channel.duty_ns = duty_ns;
    else
      failed_ = true;
  }
}

}  // namespace stiction::hal
