#include "hal/gpio/lines.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

namespace stiction::hal {
namespace {

// How long a level may differ from what the edges say before an edge must have been lost: an interrupt's thread runs
// within tens of microseconds.
constexpr std::int64_t patience_ns = 1'000'000;

// Every chip of this machine, for a message.
struct ChipsFound {
  std::string text = "there is no /dev/gpiochip*";
  bool denied = false;  // one of them at least
};

ChipsFound chips_found() {
  ChipsFound found;
  std::string list;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", none)) {
    const std::string path = entry.path().string();
    if (!path.starts_with("/dev/gpiochip")) continue;
    list += (list.empty() ? "" : ", ") + path;
    if (const auto chip = gpiod::Chip::at(path)) {
      list += fmt::format(" \"{}\" with {} lines", chip.label(), chip.line_count());
    } else {
      found.denied |= errno == EACCES || errno == EPERM;
      list += fmt::format(" ({})", std::strerror(errno));
    }
  }
  if (!list.empty()) found.text = "there is " + list;
  return found;
}

// Looked for by its label, a chip that may not be opened is as one that is not there.
gpiod::Chip open_chip(const std::string& name) {
  if (auto chip = gpiod::Chip::find(name)) return chip;
  const char* error = std::strerror(errno);
  const auto found = chips_found();
  if (found.denied)
    throw GpioError(
        fmt::format("gpiochip \"{}\": no permission; {}. Run as a member of the group that owns the device, or install "
                    "the rules that stictiond --udev prints",
                    name, found.text));
  throw GpioError(fmt::format("gpiochip \"{}\": {}; {}. Set drive.gpio.chip to one of them", name, error, found.text));
}

}  // namespace

std::string chip_name(const std::string& chip) { return open_chip(chip).name(); }

Lines::Lines(const std::string& chip, Bias bias) : chip_(open_chip(chip)), bias_(bias) {
  chip_name_ = fmt::format("{} \"{}\"", chip_.name(), chip_.label());
}

Lines::~Lines() {
  for (std::size_t i = 0; i < outputs_.size(); ++i) set(i, false);
}

void Lines::take_offset(const LineConfig& line, const std::string& name) {
  const int lines = chip_.line_count();
  if (line.offset < 0 || line.offset >= lines)
    throw GpioError(
        fmt::format("{}: line {} of {}: the chip has the lines 0 to {}", name, line.offset, chip_name_, lines - 1));
  for (const auto& [offset, user] : taken_)
    if (offset == line.offset)
      throw GpioError(fmt::format("{}: line {} of {} is \"{}\" already", name, line.offset, chip_name_, user));
  taken_.emplace_back(line.offset, name);
}

void Lines::refuse(const LineConfig& line, const std::string& name) const {
  const int error = errno;
  const auto where = fmt::format("{}: line {} of {}", name, line.offset, chip_name_);
  if (error == EBUSY) {
    const auto user = chip_.user(line.offset);
    throw GpioError(fmt::format("{} is in use by \"{}\"; stop that programme or choose a different line", where,
                                user.empty() ? "the kernel" : user));
  }
  if (error == ENODEV || error == ENXIO || error == ENOTTY)
    throw GpioError(where + " gives no edges: its chip has no interrupt for it; choose a line of a different chip");
  if (error == EINVAL || error == ENOTSUP)
    throw GpioError(fmt::format("{}: {}; the chip may lack the bias of drive.gpio.bias", where, std::strerror(error)));
  throw GpioError(fmt::format("{}: {}", where, std::strerror(error)));
}

std::size_t Lines::add_input(const LineConfig& config, const std::string& name) {
  take_offset(config, name);
  Input input;
  input.line = chip_.input(config, name, bias_);
  if (!input.line) refuse(config, name);
  settle_level(input);
  descriptors_.push_back({input.line.descriptor(), POLLIN, 0});
  inputs_.push_back(std::move(input));
  return inputs_.size() - 1;
}

// An edge between a look at the level and the look at the queue would count as lost: look until none comes between.
void Lines::settle_level(Input& input) {
  for (int attempt = 0; attempt < 100; ++attempt) {
    const int level = input.line.level();
    if (level < 0) failed_ = true;
    input.sequence.start(level > 0);
    input.edge_count = 0;
    drain(input);
    if (input.edge_count == 0) break;
  }
  input.edge_count = 0;
  input.lost = 0;
}

std::size_t Lines::add_output(const LineConfig& config, const std::string& name) {
  take_offset(config, name);
  Output output;
  output.line = chip_.output(config, name);
  if (!output.line) refuse(config, name);
  outputs_.push_back(std::move(output));
  return outputs_.size() - 1;
}

void Lines::poll(std::int64_t now_ns) {
  for (auto& input : inputs_) input.edge_count = 0;
  if (inputs_.empty()) return;
  const timespec at_once{};
  if (::ppoll(descriptors_.data(), descriptors_.size(), &at_once, nullptr) < 0 && errno != EINTR) failed_ = true;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    if ((descriptors_[i].revents & (POLLERR | POLLHUP | POLLNVAL)) != 0) failed_ = true;
    if ((descriptors_[i].revents & POLLIN) != 0) drain(inputs_[i]);
  }
  looked_at_ = (looked_at_ + 1) % inputs_.size();
  look_at(inputs_[looked_at_], now_ns);
}

void Lines::drain(Input& input) {
  std::array<gpiod::KernelEdge, kernel_queue> events;
  const int count = input.line.read_edges(events);
  if (count < 0) {
    if (errno != EAGAIN && errno != EINTR) failed_ = true;
    return;
  }
  if (count > 0) input.differs_since_ns = 0;
  for (int i = 0; i < count; ++i) {
    const auto& event = events[static_cast<std::size_t>(i)];
    input.lost += input.sequence.take(event.rising, event.number);
    input.edges[input.edge_count++] = {event.time_ns, event.rising};
  }
}

// The level may be newer than the edges read; only one that stays different while no edge comes tells.
void Lines::look_at(Input& input, std::int64_t now_ns) {
  const int level = input.line.level();
  if (level < 0) {
    failed_ = true;
    return;
  }
  if ((level > 0) == input.sequence.level()) {
    input.differs_since_ns = 0;
  } else if (input.differs_since_ns == 0) {
    input.differs_since_ns = now_ns;
  } else if (now_ns - input.differs_since_ns > patience_ns) {
    ++input.lost;
    input.sequence.start(level > 0);
    input.differs_since_ns = 0;
  }
}

bool Lines::was_active(std::size_t input) const {
  if (level(input)) return true;
  for (const auto& edge : edges(input))
    if (edge.rising) return true;
  return false;
}

std::span<const Edge> Lines::edges(std::size_t input) const {
  return {inputs_[input].edges.data(), inputs_[input].edge_count};
}

void Lines::set(std::size_t output, bool active) {
  auto& line = outputs_[output];
  if (line.active == active) return;
  if (!line.line.set(active))
    failed_ = true;
  else
    line.active = active;
}

void Lines::cut() noexcept {
  for (const auto& output : outputs_) output.line.set(false);
}

}  // namespace stiction::hal
