#include "hal/gpio/lines.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <gpiod.h>

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
    if (gpiod_chip* chip = ::gpiod_chip_open(path.c_str())) {
      list += fmt::format(" \"{}\" with {} lines", ::gpiod_chip_label(chip), ::gpiod_chip_num_lines(chip));
      ::gpiod_chip_close(chip);
    } else {
      found.denied |= errno == EACCES || errno == EPERM;
      list += fmt::format(" ({})", std::strerror(errno));
    }
  }
  if (!list.empty()) found.text = "there is " + list;
  return found;
}

// Looked for by its label, a chip that may not be opened is as one that is not there.
gpiod_chip* open_chip(const std::string& name) {
  if (gpiod_chip* chip = ::gpiod_chip_open_lookup(name.c_str())) return chip;
  const char* error = std::strerror(errno);
  const auto found = chips_found();
  if (found.denied)
    throw GpioError(
        fmt::format("gpiochip \"{}\": no permission; {}. Run as a member of the group that owns the device, or install "
                    "the rules that stictiond --udev prints",
                    name, found.text));
  throw GpioError(fmt::format("gpiochip \"{}\": {}; {}. Set drive.gpio.chip to one of them", name, error, found.text));
}

int flags_of(const LineConfig& line, Bias bias) {
  static constexpr std::array biases{0, int{GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP},
                                     int{GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN},
                                     int{GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE}};
  return biases[static_cast<std::size_t>(bias)] | (line.active_low ? int{GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW} : 0);
}

std::int64_t ns_of(const timespec& time) { return time.tv_sec * std::int64_t{1'000'000'000} + time.tv_nsec; }

}  // namespace

std::string chip_name(const std::string& chip) {
  const std::unique_ptr<gpiod_chip, void (*)(gpiod_chip*)> opened(open_chip(chip), ::gpiod_chip_close);
  return ::gpiod_chip_name(opened.get());
}

Lines::Lines(const std::string& chip, Bias bias) : chip_(open_chip(chip), ::gpiod_chip_close), bias_(bias) {
  chip_name_ = fmt::format("{} \"{}\"", ::gpiod_chip_name(chip_.get()), ::gpiod_chip_label(chip_.get()));
}

Lines::~Lines() {
  for (std::size_t i = 0; i < outputs_.size(); ++i) set(i, false);
}

gpiod_line* Lines::line_of(const LineConfig& line, const std::string& name) {
  const auto lines = static_cast<int>(::gpiod_chip_num_lines(chip_.get()));
  if (line.offset < 0 || line.offset >= lines)
    throw GpioError(
        fmt::format("{}: line {} of {}: the chip has the lines 0 to {}", name, line.offset, chip_name_, lines - 1));
  for (const auto& [offset, user] : taken_)
    if (offset == line.offset)
      throw GpioError(fmt::format("{}: line {} of {} is \"{}\" already", name, line.offset, chip_name_, user));
  gpiod_line* found = ::gpiod_chip_get_line(chip_.get(), static_cast<unsigned>(line.offset));
  if (found == nullptr)
    throw GpioError(fmt::format("{}: line {} of {}: {}", name, line.offset, chip_name_, std::strerror(errno)));
  taken_.emplace_back(line.offset, name);
  return found;
}

void Lines::refuse(gpiod_line* line, const std::string& name) const {
  const int error = errno;
  const auto where = fmt::format("{}: line {} of {}", name, ::gpiod_line_offset(line), chip_name_);
  if (error == EBUSY) {
    ::gpiod_line_update(line);
    const char* user = ::gpiod_line_consumer(line);
    throw GpioError(fmt::format("{} is in use by \"{}\"; stop that programme or choose a different line", where,
                                user == nullptr ? "the kernel" : user));
  }
  if (error == ENODEV || error == ENXIO || error == ENOTTY)
    throw GpioError(where + " gives no edges: its chip has no interrupt for it; choose a line of a different chip");
  if (error == EINVAL || error == ENOTSUP)
    throw GpioError(fmt::format("{}: {}; the chip may lack the bias of drive.gpio.bias", where, std::strerror(error)));
  throw GpioError(fmt::format("{}: {}", where, std::strerror(error)));
}

std::size_t Lines::add_input(const LineConfig& config, const std::string& name) {
  Input input;
  input.line = line_of(config, name);
  if (::gpiod_line_request_both_edges_events_flags(input.line, name.c_str(), flags_of(config, bias_)) != 0)
    refuse(input.line, name);
  const int descriptor = ::gpiod_line_event_get_fd(input.line);
  if (descriptor < 0 || ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) | O_NONBLOCK) != 0)
    refuse(input.line, name);
  settle_level(input, descriptor);
  inputs_.push_back(input);
  descriptors_.push_back({descriptor, POLLIN, 0});
  return inputs_.size() - 1;
}

// An edge between a look at the level and the look at the queue would count as lost: look until none comes between.
void Lines::settle_level(Input& input, int descriptor) {
  for (int attempt = 0; attempt < 100; ++attempt) {
    const int level = ::gpiod_line_get_value(input.line);
    if (level < 0) failed_ = true;
    input.level = level > 0;
    input.edge_count = 0;
    drain(input, descriptor);
    if (input.edge_count == 0) break;
  }
  input.edge_count = 0;
  input.lost = 0;
}

std::size_t Lines::add_output(const LineConfig& config, const std::string& name) {
  Output output;
  output.line = line_of(config, name);
  if (::gpiod_line_request_output_flags(output.line, name.c_str(), flags_of(config, Bias::as_is), 0) != 0)
    refuse(output.line, name);
  outputs_.push_back(output);
  return outputs_.size() - 1;
}

void Lines::poll(std::int64_t now_ns) {
  for (auto& input : inputs_) input.edge_count = 0;
  if (inputs_.empty()) return;
  const timespec at_once{};
  if (::ppoll(descriptors_.data(), descriptors_.size(), &at_once, nullptr) < 0 && errno != EINTR) failed_ = true;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    if ((descriptors_[i].revents & (POLLERR | POLLHUP | POLLNVAL)) != 0) failed_ = true;
    if ((descriptors_[i].revents & POLLIN) != 0) drain(inputs_[i], descriptors_[i].fd);
  }
  looked_at_ = (looked_at_ + 1) % inputs_.size();
  look_at(inputs_[looked_at_], now_ns);
}

void Lines::drain(Input& input, int descriptor) {
  std::array<gpiod_line_event, kernel_queue> events;
  const int count = ::gpiod_line_event_read_fd_multiple(descriptor, events.data(), kernel_queue);
  if (count < 0) {
    if (errno != EAGAIN && errno != EINTR) failed_ = true;
    return;
  }
  if (count > 0) input.differs_since_ns = 0;
  for (int i = 0; i < count; ++i) {
    const auto& event = events[static_cast<std::size_t>(i)];
    const bool rising = event.event_type == GPIOD_LINE_EVENT_RISING_EDGE;
    if (rising == input.level) ++input.lost;
    input.level = rising;
    input.edges[input.edge_count++] = {ns_of(event.ts), rising};
  }
}

// The level may be newer than the edges read; only one that stays different while no edge comes tells.
void Lines::look_at(Input& input, std::int64_t now_ns) {
  const int level = ::gpiod_line_get_value(input.line);
  if (level < 0) {
    failed_ = true;
    return;
  }
  if ((level > 0) == input.level) {
    input.differs_since_ns = 0;
  } else if (input.differs_since_ns == 0) {
    input.differs_since_ns = now_ns;
  } else if (now_ns - input.differs_since_ns > patience_ns) {
    ++input.lost;
    input.level = level > 0;
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
  if (::gpiod_line_set_value(line.line, active ? 1 : 0) != 0)
    failed_ = true;
  else
    line.active = active;
}

void Lines::cut() noexcept {
  for (const auto& output : outputs_) ::gpiod_line_set_value(output.line, 0);
}

}  // namespace stiction::hal
