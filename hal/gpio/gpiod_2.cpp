// libgpiod 2.
#include <fcntl.h>
#include <gpiod.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <utility>

#include "hal/gpio/edge_queue.hpp"
#include "hal/gpio/gpiod.hpp"

namespace stiction::hal::gpiod {

template <auto Free>
struct Freed {
  void operator()(auto* object) const { Free(object); }
};
using OpenChip = std::unique_ptr<gpiod_chip, Freed<::gpiod_chip_close>>;
using ChipInfo = std::unique_ptr<gpiod_chip_info, Freed<::gpiod_chip_info_free>>;
using LineInfo = std::unique_ptr<gpiod_line_info, Freed<::gpiod_line_info_free>>;
using Settings = std::unique_ptr<gpiod_line_settings, Freed<::gpiod_line_settings_free>>;
using LinesConfig = std::unique_ptr<gpiod_line_config, Freed<::gpiod_line_config_free>>;
using RequestConfig = std::unique_ptr<gpiod_request_config, Freed<::gpiod_request_config_free>>;
using Request = std::unique_ptr<gpiod_line_request, Freed<::gpiod_line_request_release>>;
using Buffer = std::unique_ptr<gpiod_edge_event_buffer, Freed<::gpiod_edge_event_buffer_free>>;

struct Line::Native {
  Request request;
  unsigned offset = 0;
  Buffer buffer;  // of an input
};

struct Chip::Native {
  OpenChip chip;
  ChipInfo info;
};

bool numbers_edges() { return true; }

Line::Line() = default;
Line::Line(std::unique_ptr<Native> native) : native_(std::move(native)) {}
Line::Line(Line&&) noexcept = default;
Line& Line::operator=(Line&&) noexcept = default;
Line::~Line() = default;

int Line::level() const {
  const auto value = ::gpiod_line_request_get_value(native_->request.get(), native_->offset);
  return value == GPIOD_LINE_VALUE_ERROR ? -1 : value == GPIOD_LINE_VALUE_ACTIVE ? 1 : 0;
}

bool Line::set(bool active) const noexcept {
  return ::gpiod_line_request_set_value(native_->request.get(), native_->offset,
                                        active ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE) == 0;
}

int Line::descriptor() const { return ::gpiod_line_request_get_fd(native_->request.get()); }

int Line::read_edges(std::span<KernelEdge> edges) const {
  gpiod_edge_event_buffer* const buffer = native_->buffer.get();
  const int count =
      ::gpiod_line_request_read_edge_events(native_->request.get(), buffer, std::min(edges.size(), kernel_queue));
  for (int i = 0; i < count; ++i) {
    // Points into the buffer.
    gpiod_edge_event* const event = ::gpiod_edge_event_buffer_get_event(buffer, static_cast<unsigned long>(i));
    edges[static_cast<std::size_t>(i)] = {
        .time_ns = static_cast<std::int64_t>(::gpiod_edge_event_get_timestamp_ns(event)),
        .rising = ::gpiod_edge_event_get_event_type(event) == GPIOD_EDGE_EVENT_RISING_EDGE,
        .number = static_cast<std::uint32_t>(::gpiod_edge_event_get_line_seqno(event))};
  }
  return count;
}

Chip::Chip(std::unique_ptr<Native> native) : native_(std::move(native)) {}
Chip::Chip(Chip&&) noexcept = default;
Chip& Chip::operator=(Chip&&) noexcept = default;
Chip::~Chip() = default;

Chip Chip::at(const std::string& path) {
  OpenChip chip(::gpiod_chip_open(path.c_str()));
  if (!chip) return Chip(nullptr);
  ChipInfo info(::gpiod_chip_get_info(chip.get()));
  if (!info) {
    const int reason = errno;
    chip.reset();
    errno = reason;
    return Chip(nullptr);
  }
  return Chip(std::make_unique<Native>(std::move(chip), std::move(info)));
}

// Version 2 of the library opens by path alone.
Chip Chip::find(const std::string& name) {
  if (name.find('/') != std::string::npos) return at(name);
  const bool is_number = !name.empty() && name.find_first_not_of("0123456789") == std::string::npos;
  const std::string path = "/dev/" + (is_number ? "gpiochip" + name : name);
  std::error_code none;
  if (std::filesystem::exists(path, none)) return at(path);
  for (const auto& entry : std::filesystem::directory_iterator("/dev", none)) {
    if (!entry.path().string().starts_with("/dev/gpiochip")) continue;
    if (auto chip = at(entry.path().string()); chip && chip.label() == name) return chip;
  }
  errno = ENOENT;
  return Chip(nullptr);
}

std::string Chip::name() const { return ::gpiod_chip_info_get_name(native_->info.get()); }
std::string Chip::label() const { return ::gpiod_chip_info_get_label(native_->info.get()); }
int Chip::line_count() const { return static_cast<int>(::gpiod_chip_info_get_num_lines(native_->info.get())); }

std::string Chip::user(int offset) const {
  const LineInfo info(::gpiod_chip_get_line_info(native_->chip.get(), static_cast<unsigned>(offset)));
  const char* user = info ? ::gpiod_line_info_get_consumer(info.get()) : nullptr;
  return user == nullptr ? "" : user;
}

namespace {

// Nothing, with errno, where the library or the kernel refuses.
std::unique_ptr<Line::Native> requested(gpiod_chip* chip, const LineConfig& line, const std::string& user,
                                        gpiod_line_settings* settings) {
  const LinesConfig lines(::gpiod_line_config_new());
  const RequestConfig config(::gpiod_request_config_new());
  const auto offset = static_cast<unsigned>(line.offset);
  if (!lines || !config || ::gpiod_line_config_add_line_settings(lines.get(), &offset, 1, settings) != 0)
    return nullptr;
  ::gpiod_request_config_set_consumer(config.get(), user.c_str());
  ::gpiod_request_config_set_event_buffer_size(config.get(), kernel_queue);
  Request request(::gpiod_chip_request_lines(chip, config.get(), lines.get()));
  if (!request) return nullptr;
  return std::make_unique<Line::Native>(std::move(request), offset, Buffer());
}

gpiod_line_bias bias_of(Bias bias) {
  static constexpr std::array biases{GPIOD_LINE_BIAS_AS_IS, GPIOD_LINE_BIAS_PULL_UP, GPIOD_LINE_BIAS_PULL_DOWN,
                                     GPIOD_LINE_BIAS_DISABLED};
  return biases[static_cast<std::size_t>(bias)];
}

}  // namespace

Line Chip::input(const LineConfig& config, const std::string& user, Bias bias) const {
  const Settings settings(::gpiod_line_settings_new());
  if (!settings) return {};
  ::gpiod_line_settings_set_direction(settings.get(), GPIOD_LINE_DIRECTION_INPUT);
  ::gpiod_line_settings_set_edge_detection(settings.get(), GPIOD_LINE_EDGE_BOTH);
  ::gpiod_line_settings_set_event_clock(settings.get(), GPIOD_LINE_CLOCK_MONOTONIC);
  ::gpiod_line_settings_set_bias(settings.get(), bias_of(bias));
  ::gpiod_line_settings_set_active_low(settings.get(), config.active_low);
  auto native = requested(native_->chip.get(), config, user, settings.get());
  if (!native) return {};
  native->buffer.reset(::gpiod_edge_event_buffer_new(kernel_queue));
  const int descriptor = ::gpiod_line_request_get_fd(native->request.get());
  if (!native->buffer || ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) | O_NONBLOCK) != 0) return {};
  return Line(std::move(native));
}

Line Chip::output(const LineConfig& config, const std::string& user) const {
  const Settings settings(::gpiod_line_settings_new());
  if (!settings) return {};
  ::gpiod_line_settings_set_direction(settings.get(), GPIOD_LINE_DIRECTION_OUTPUT);
  ::gpiod_line_settings_set_output_value(settings.get(), GPIOD_LINE_VALUE_INACTIVE);
  ::gpiod_line_settings_set_active_low(settings.get(), config.active_low);
  return Line(requested(native_->chip.get(), config, user, settings.get()));
}

}  // namespace stiction::hal::gpiod
