#include "host/plant/gpio_sim.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

namespace stiction::plant {
namespace {

namespace fs = std::filesystem;

std::string first_line(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

}  // namespace

// The label of a chip is in the older interface's folder of the same device.
std::optional<fs::path> GpioSim::find(const std::string& chip) {
  std::error_code none;
  for (const auto& device : fs::directory_iterator("/sys/devices/platform", none)) {
    if (!device.path().filename().string().starts_with("gpio-sim.")) continue;
    std::string label;
    for (const auto& old : fs::directory_iterator(device.path() / "gpio", none))
      label = first_line(old.path() / "label");
    for (const auto& entry : fs::directory_iterator(device.path(), none)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with("gpiochip") && (chip == name || chip == label)) return entry.path();
    }
  }
  return std::nullopt;
}

GpioSim::GpioSim(fs::path folder) : folder_(std::move(folder)) {
  if (!fs::is_directory(folder_)) throw GpioSimError("gpio-sim: there is no folder " + folder_.string());
}

GpioSim::~GpioSim() {
  for (const auto& [line, files] : lines_)
    for (const int file : {files.pull, files.value})
      if (file >= 0) ::close(file);
}

GpioSim::Files& GpioSim::files(int line) {
  auto [found, fresh] = lines_.try_emplace(line);
  if (fresh) {
    const auto folder = folder_ / fmt::format("sim_gpio{}", line);
    found->second.pull = ::open((folder / "pull").c_str(), O_WRONLY | O_CLOEXEC);
    found->second.value = ::open((folder / "value").c_str(), O_RDONLY | O_CLOEXEC);
    if (found->second.pull < 0 || found->second.value < 0)
      throw GpioSimError(fmt::format("gpio-sim: {}: {}", folder.string(), std::strerror(errno)));
  }
  return found->second;
}

void GpioSim::set(int line, bool high) {
  auto& file = files(line);
  if (file.level == int{high}) return;
  const std::string_view text = high ? "pull-up" : "pull-down";
  if (::pwrite(file.pull, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size()))
    throw GpioSimError(fmt::format("gpio-sim: line {}: {}", line, std::strerror(errno)));
  file.level = int{high};
}

bool GpioSim::driven(int line) {
  char level = '0';
  if (::pread(files(line).value, &level, 1, 0) != 1)
    throw GpioSimError(fmt::format("gpio-sim: line {}: {}", line, std::strerror(errno)));
  return level == '1';
}

EncoderLines::EncoderLines(GpioSim& chip, const Wiring& wiring, std::int64_t count)
    : chip_(&chip), wiring_(wiring), count_(count) {
  apply();
}

void EncoderLines::step(bool forward) {
  count_ += forward ? 1 : -1;
  apply();
}

void EncoderLines::move_to(std::int64_t count) {
  while (count_ != count) step(count > count_);
}

void EncoderLines::slip() { reconnect(count_ + 2); }

void EncoderLines::reconnect(std::int64_t count) {
  count_ = count;
  apply();
}

// Gray code 00, 10, 11, 01 for AB.
void EncoderLines::apply() {
  const auto quarter = static_cast<std::uint64_t>(count_) % 4;
  chip_->set(wiring_.a, quarter == 1 || quarter == 2);
  chip_->set(wiring_.b, quarter >= 2);
  if (wiring_.index < 0) return;
  const std::int64_t from_mark = count_ - wiring_.marks.at;
  const bool at_mark = wiring_.marks.every > 0 ? from_mark % wiring_.marks.every == 0 : from_mark == 0;
  chip_->set(wiring_.index, at_mark != wiring_.index_active_low);
}

}  // namespace stiction::plant
