// libgpiod 1.6.
#include <fcntl.h>
#include <gpiod.h>

#include <algorithm>
#include <array>
#include <utility>

#include "hal/gpio/edge_queue.hpp"
#include "hal/gpio/gpiod.hpp"

namespace stiction::hal::gpiod {

struct Line::Native {
  explicit Native(gpiod_line* held) : line(held) {}
  ~Native() { ::gpiod_line_release(line); }
  Native(const Native&) = delete;
  Native& operator=(const Native&) = delete;

  gpiod_line* line;
};

struct Chip::Native {
  explicit Native(gpiod_chip* opened) : chip(opened) {}
  ~Native() { ::gpiod_chip_close(chip); }
  Native(const Native&) = delete;
  Native& operator=(const Native&) = delete;

  gpiod_chip* chip;
};

namespace {

int flags_of(const LineConfig& line, Bias bias) {
  static constexpr std::array biases{0, int{GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP},
                                     int{GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN},
                                     int{GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE}};
  return biases[static_cast<std::size_t>(bias)] | (line.active_low ? int{GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW} : 0);
}

gpiod_line* line_at(gpiod_chip* chip, int offset) { return ::gpiod_chip_get_line(chip, static_cast<unsigned>(offset)); }

}  // namespace

bool numbers_edges() { return false; }

Line::Line() = default;
Line::Line(std::unique_ptr<Native> native) : native_(std::move(native)) {}
Line::Line(Line&&) noexcept = default;
Line& Line::operator=(Line&&) noexcept = default;
Line::~Line() = default;

int Line::level() const { return ::gpiod_line_get_value(native_->line); }
bool Line::set(bool active) const noexcept { return ::gpiod_line_set_value(native_->line, active ? 1 : 0) == 0; }
int Line::descriptor() const { return ::gpiod_line_event_get_fd(native_->line); }

int Line::read_edges(std::span<KernelEdge> edges) const {
  std::array<gpiod_line_event, kernel_queue> events;
  const auto room = static_cast<unsigned>(std::min(edges.size(), events.size()));
  const int count = ::gpiod_line_event_read_fd_multiple(descriptor(), events.data(), room);
  for (int i = 0; i < count; ++i) {
    const auto& event = events[static_cast<std::size_t>(i)];
    edges[static_cast<std::size_t>(i)] = {.time_ns = event.ts.tv_sec * std::int64_t{1'000'000'000} + event.ts.tv_nsec,
                                          .rising = event.event_type == GPIOD_LINE_EVENT_RISING_EDGE,
                                          .number = std::nullopt};
  }
  return count;
}

Chip::Chip(std::unique_ptr<Native> native) : native_(std::move(native)) {}
Chip::Chip(Chip&&) noexcept = default;
Chip& Chip::operator=(Chip&&) noexcept = default;
Chip::~Chip() = default;

Chip Chip::at(const std::string& path) {
  gpiod_chip* chip = ::gpiod_chip_open(path.c_str());
  return Chip(chip == nullptr ? nullptr : std::make_unique<Native>(chip));
}

Chip Chip::find(const std::string& name) {
  gpiod_chip* chip = ::gpiod_chip_open_lookup(name.c_str());
  return Chip(chip == nullptr ? nullptr : std::make_unique<Native>(chip));
}

std::string Chip::name() const { return ::gpiod_chip_name(native_->chip); }
std::string Chip::label() const { return ::gpiod_chip_label(native_->chip); }
int Chip::line_count() const { return static_cast<int>(::gpiod_chip_num_lines(native_->chip)); }

std::string Chip::user(int offset) const {
  gpiod_line* line = line_at(native_->chip, offset);
  if (line == nullptr || ::gpiod_line_update(line) != 0) return "";
  const char* user = ::gpiod_line_consumer(line);
  return user == nullptr ? "" : user;
}

Line Chip::input(const LineConfig& config, const std::string& user, Bias bias) const {
  gpiod_line* line = line_at(native_->chip, config.offset);
  if (line == nullptr || ::gpiod_line_request_both_edges_events_flags(line, user.c_str(), flags_of(config, bias)) != 0)
    return {};
  auto native = std::make_unique<Line::Native>(line);
  const int descriptor = ::gpiod_line_event_get_fd(line);
  if (descriptor < 0 || ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) | O_NONBLOCK) != 0) return {};
  return Line(std::move(native));
}

Line Chip::output(const LineConfig& config, const std::string& user) const {
  gpiod_line* line = line_at(native_->chip, config.offset);
  if (line == nullptr || ::gpiod_line_request_output_flags(line, user.c_str(), flags_of(config, Bias::as_is), 0) != 0)
    return {};
  return Line(std::make_unique<Line::Native>(line));
}

}  // namespace stiction::hal::gpiod
