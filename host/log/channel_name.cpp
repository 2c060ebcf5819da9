#include "host/log/channel_name.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/log/message.hpp"

namespace stiction::host {
namespace {

constexpr std::string_view blanks = " \t";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

bool is_word(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

}  // namespace

ChannelName split_channel_name(std::string_view header) {
  ChannelName split{{}, trimmed(header), {}};
  if (const auto open = split.name.find('['); open != std::string_view::npos && split.name.back() == ']') {
    split.unit = trimmed(split.name.substr(open + 1, split.name.size() - open - 2));
    split.name = trimmed(split.name.substr(0, open));
  }
  if (const auto point = split.name.rfind('.');
      point != std::string_view::npos && is_word(split.name.substr(0, point))) {
    split.axis = split.name.substr(0, point);
    split.name = split.name.substr(point + 1);
  }
  return split;
}

const LogChannel* find_channel(std::string_view name) {
  const auto* found = std::ranges::find_if(log_channels, [&](const LogChannel& c) { return name == c.name; });
  return found == log_channels.end() ? nullptr : found;
}

std::string channel_header(std::string_view axis, const LogChannel& channel) {
  return fmt::format("{}{}{}[{}]", axis, axis.empty() ? "" : ".", channel.name, channel.unit);
}

AxisLog& axis_of(Log& log, std::string_view axis) {
  for (auto& each : log.axes)
    if (each.axis == axis) return each;
  log.axes.emplace_back().axis = axis;
  return log.axes.back();
}

void require_channels(const Log& log, std::string_view place) {
  std::string ignored;
  for (const auto& header : log.ignored)
    if (ignored.size() < 60) ignored += (ignored.empty() ? "" : ", ") + excerpt(header);
  const std::string others = ignored.empty() ? "" : fmt::format(" (columns with unknown names: {})", ignored);
  if (log.axes.empty())
    throw LogError(
        fmt::format("{}: found no channel of an axis{}; expected at least t[s], x[m] and one of i[A], F[N] "
                    "and u[V]",
                    place, others));
  for (const auto& axis : log.axes) {
    const std::string prefix = axis.axis.empty() ? "" : axis.axis + ".";
    if (axis.axis.empty() && log.axes.size() > 1)
      throw LogError(
          fmt::format("{}: found channels with an axis ({}.) together with channels without one; expected the axis in "
                      "all names or in none",
                      place, log.axes[log.axes[0].axis.empty() ? 1 : 0].axis));
    if (axis.x.empty() && axis.v.empty())
      throw LogError(
          fmt::format("{}: found no {}x[m]{}; expected the measured position of every axis", place, prefix, others));
    if (axis.i.empty() && axis.force.empty() && axis.u.empty())
      throw LogError(
          fmt::format("{0}: found neither {1}i[A] nor {1}F[N] nor {1}u[V]{2}; expected the current, the "
                      "force or the voltage of the motor",
                      place, prefix, others));
  }
}

}  // namespace stiction::host
