#include "host/log/channel_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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
  const auto* found = std::ranges::find_if(log_channels, [&](const LogChannel& c) {
    return name == c.name || (c.rotary_name != nullptr && name == c.rotary_name);
  });
  return found == log_channels.end() ? nullptr : found;
}

ChannelScale channel_scale(const LogChannel& channel, std::string_view name, std::string_view unit) {
  if (unit.empty() && channel.whole) return {};
  const bool has_rotary = channel.rotary_name != nullptr && name == channel.rotary_name;
  const std::string_view linear_unit = channel.unit;
  if (has_rotary && linear_unit == channel.rotary_unit) return {{unit, linear_unit}, AxisKind::either};
  if (name != channel.name) return {{unit, channel.rotary_unit}, AxisKind::rotary};
  try {
    return {{unit, linear_unit}, AxisKind::linear};
  } catch (const machine::UnitError&) {
    if (!has_rotary) throw;
    try {
      return {{unit, channel.rotary_unit}, AxisKind::rotary};
    } catch (const machine::UnitError&) {
    }
    throw;  // what is wrong with it as a length
  }
}

const char* name_on(const AxisLog& axis, const LogChannel& channel) {
  return axis.rotary && channel.rotary_name != nullptr ? channel.rotary_name : channel.name;
}

const char* unit_on(const AxisLog& axis, const LogChannel& channel) {
  return axis.rotary && channel.rotary_unit != nullptr ? channel.rotary_unit : channel.unit;
}

std::string channel_header(const AxisLog& axis, const LogChannel& channel) {
  return fmt::format("{}{}{}[{}]", axis.axis, axis.axis.empty() ? "" : ".", name_on(axis, channel),
                     unit_on(axis, channel));
}

const char* phase_unit(const AxisLog& axis) { return axis.rotary ? "deg" : "mm"; }

std::string phase_header(const AxisLog& axis) {
  return fmt::format("{}{}{}[{}]", axis.axis, axis.axis.empty() ? "" : ".", phase_name, phase_unit(axis));
}

// A multiple of 2^-32 of 360 deg is a double: nothing is rounded where a turn is one of the axis.
double shown_phase(const AxisLog& axis, std::size_t sample) {
  return std::ldexp(static_cast<double>(axis.phase[sample]) * axis.turn, -32);
}

void AxisKinds::add(std::string_view axis, AxisKind kind, std::string_view header, std::string_view place) {
  if (kind == AxisKind::either) return;
  const auto [found, is_new] = found_.try_emplace(std::string(axis), Found{kind, std::string(header)});
  if (is_new || found->second.kind == kind) return;
  const auto [linear, rotary] = kind == AxisKind::linear ? std::pair(header, std::string_view(found->second.header))
                                                         : std::pair(std::string_view(found->second.header), header);
  throw LogError(fmt::format(
      "{}: found {} of a rotary axis together with {} of a linear one; expected columns of one kind for each axis "
      "(convert the others with the radius or the pitch, or leave them out)",
      place, excerpt(rotary), excerpt(linear)));
}

void AxisKinds::mark(Log& log) const {
  for (auto& axis : log.axes)
    if (const auto found = found_.find(axis.axis); found != found_.end())
      axis.rotary = found->second.kind == AxisKind::rotary;
}

void share_channels(Log& log) {
  const auto common = std::ranges::find_if(log.axes, [](const AxisLog& axis) { return axis.axis.empty(); });
  if (common == log.axes.end() || log.axes.size() < 2) return;
  for (const auto& channel : log_channels)
    if (!channel.shared && !((*common).*channel.values).empty()) return;  // an axis of its own: refused elsewhere
  const AxisLog shared = std::move(*common);
  log.axes.erase(common);
  for (auto& axis : log.axes)
    for (const auto& channel : log_channels)
      if ((axis.*channel.values).empty()) axis.*channel.values = shared.*channel.values;
}

void drop_blank_channels(Log& log) {
  for (auto& axis : log.axes)
    for (const auto& channel : log_channels) {
      auto& values = axis.*channel.values;
      if (values.empty() || !std::ranges::all_of(values, [](double value) { return std::isnan(value); })) continue;
      log.ignored.push_back(channel_header(axis, channel) + " (blank)");
      values.clear();
      values.shrink_to_fit();
    }
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
                    "and u[V] (of a rotary axis x[deg] and T[N m])",
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
