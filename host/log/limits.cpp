#include "host/log/limits.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "host/log/resolution.hpp"
#include "host/log/statistics.hpp"

namespace stiction::host {
namespace {

using Values = std::vector<double>;

constexpr double near_the_end = 0.9;  // of the greatest magnitude
constexpr double near_the_limit = 0.995;
constexpr double shortest = 0.005;  // s
constexpr std::size_t fewest = 5;   // samples
constexpr double off_for = 0.1;     // s
constexpr double stops = 0.1;       // of the greatest speed, lost within one sample
constexpr double clear = 4.0;       // increments that a smooth peak would have risen

// Calls `found(begin, end)` for every run of equal values of at least `least` samples.
template <typename Found>
void runs_of(const Values& values, std::size_t least, Found&& found) {
  for (std::size_t begin = 0; begin < values.size();) {
    std::size_t end = begin + 1;
    while (end < values.size() && values[end] == values[begin]) ++end;
    if (end - begin >= least) found(begin, end);
    begin = end;
  }
}

// How far a parabola with the slopes beside the run, taken over as many samples as it has, rises within it. A smooth
// peak, rounded, rises by two increments at most.
double rise_of(const Values& values, std::size_t begin, std::size_t end) {
  const std::size_t length = end - begin;
  double drop = 0.0;
  if (begin > 0) drop = std::abs(values[begin] - values[begin - std::min(length, begin)]);
  if (end < values.size())
    drop = std::max(drop, std::abs(values[begin] - values[std::min(end + length, values.size()) - 1]));
  return 0.25 * drop;
}

// Whether what the controller sees changes within the run: the error of position, or without set-points the speed. One
// that stays lets the effort stay.
bool input_changes(const AxisLog& axis, std::size_t begin, std::size_t end) {
  const double increment = increment_of(axis, &AxisLog::x);
  const double slope = (axis.x[end - 1] - axis.x[begin]) / static_cast<double>(end - 1 - begin);
  double least = 0.0, most = 0.0;
  for (std::size_t k = begin; k < end; ++k) {
    const double input = axis.x_set.empty() ? axis.x[k] - axis.x[begin] - slope * static_cast<double>(k - begin)
                                            : axis.x_set[k] - axis.x[k] - (axis.x_set[begin] - axis.x[begin]);
    least = std::min(least, input);
    most = std::max(most, input);
  }
  return most - least > 2.0 * increment;
}

std::size_t least_run(double seconds, double period, std::size_t at_least) {
  return std::max(at_least, static_cast<std::size_t>(std::ceil(seconds / period)));
}

std::optional<LimitedChannel> piled_up(const LogChannel& channel, const AxisLog& axis, double period) {
  const auto& values = axis.*channel.values;
  const double top = largest_magnitude(values);
  if (top == 0.0) return std::nullopt;
  LimitedChannel out{&channel, LimitedChannel::Kind::clipped, 0.0, std::vector<bool>(values.size(), false)};
  const double increment = increment_of(axis, channel.values);
  Values levels;
  runs_of(values, least_run(shortest, period, fewest), [&](std::size_t begin, std::size_t end) {
    if (std::abs(values[begin]) < near_the_end * top) return;
    if (rise_of(values, begin, end) > clear * increment && input_changes(axis, begin, end))
      levels.push_back(values[begin]);
  });
  if (levels.empty()) return std::nullopt;
  // A supply that sags moves the end of the range: every sample from the lowest level on counts.
  for (double& level : levels) level = std::abs(level);
  const double lowest = *std::ranges::min_element(levels);
  for (std::size_t k = 0; k < values.size(); ++k)
    if (std::abs(values[k]) >= lowest) {
      out.samples[k] = true;
      out.level = std::max(out.level, std::abs(values[k]));
    }
  return out;
}

std::optional<LimitedChannel> at_limit(const LogChannel& channel, const Values& values, double limit) {
  LimitedChannel out{&channel, LimitedChannel::Kind::limit, limit, std::vector<bool>(values.size(), false)};
  bool any = false;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (std::abs(values[k]) >= near_the_limit * limit) out.samples[k] = any = true;
  return any ? std::optional(out) : std::nullopt;
}

// A voltage of 0 without a break while the position changes.
std::optional<LimitedChannel> switched_off(const LogChannel& channel, const AxisLog& axis, double period) {
  const auto& values = axis.*channel.values;
  LimitedChannel out{&channel, LimitedChannel::Kind::off, 0.0, std::vector<bool>(values.size(), false)};
  bool any = false;
  runs_of(values, least_run(off_for, period, fewest), [&](std::size_t begin, std::size_t end) {
    if (values[begin] != 0.0) return;
    const auto [least, most] = std::minmax_element(axis.x.begin() + static_cast<std::ptrdiff_t>(begin),
                                                   axis.x.begin() + static_cast<std::ptrdiff_t>(end));
    if (*least == *most) return;
    any = true;
    std::fill(out.samples.begin() + static_cast<std::ptrdiff_t>(begin),
              out.samples.begin() + static_cast<std::ptrdiff_t>(end), true);
  });
  return any ? std::optional(out) : std::nullopt;
}

std::optional<LimitedChannel> stopped(const LogChannel& channel, const AxisLog& axis, double period) {
  const auto& x = axis.x;
  const auto range = std::ranges::minmax(x);  // no structured binding: clang 14 captures none
  double fastest = 0.0;
  for (std::size_t k = 1; k < x.size(); ++k) fastest = std::max(fastest, std::abs(x[k] - x[k - 1]));
  LimitedChannel out{&channel, LimitedChannel::Kind::clipped, 0.0, std::vector<bool>(x.size(), false)};
  bool any = false;
  const double sudden = std::max(stops * fastest, clear * increment_of(axis, &AxisLog::x));
  runs_of(x, least_run(shortest, period, fewest), [&](std::size_t begin, std::size_t end) {
    if (x[begin] != range.min && x[begin] != range.max) return;
    // The step into the end is cut by the end; the one before it is whole.
    const double in = begin > 1 ? std::abs(x[begin - 1] - x[begin - 2]) : 0.0;
    const double out_of = end + 1 < x.size() ? std::abs(x[end + 1] - x[end]) : 0.0;
    if (std::max(in, out_of) <= sudden) return;
    any = true;
    std::fill(out.samples.begin() + static_cast<std::ptrdiff_t>(begin),
              out.samples.begin() + static_cast<std::ptrdiff_t>(end), true);
    out.level = std::max(out.level, std::abs(x[begin]));
  });
  return any ? std::optional(out) : std::nullopt;
}

}  // namespace

std::vector<LimitedChannel> limited_channels(const Log& log, const AxisLog& axis, std::optional<double> limit) {
  std::vector<LimitedChannel> found;
  const auto add = [&](std::optional<LimitedChannel> each) {
    if (each) found.push_back(std::move(*each));
  };
  bool effort = false;
  for (const auto* name : {"i", "F", "u", "x"})
    for (const auto& channel : log_channels) {
      const auto& values = axis.*channel.values;
      if (std::string_view(channel.name) != name || values.size() < fewest) continue;
      if (channel.values == &AxisLog::x) {
        add(stopped(channel, axis, log.period));
      } else if (!effort) {
        effort = true;
        add(limit && channel.values != &AxisLog::force ? at_limit(channel, values, *limit)
                                                       : piled_up(channel, axis, log.period));
        if (channel.values == &AxisLog::u) add(switched_off(channel, axis, log.period));
      }
    }
  return found;
}

std::size_t leave_out(AxisLog& axis, const std::vector<LimitedChannel>& limited) {
  for (const auto& each : limited) {
    axis.left_out.resize(each.samples.size(), false);
    for (std::size_t k = 0; k < each.samples.size(); ++k)
      if (each.samples[k]) axis.left_out[k] = true;
  }
  return static_cast<std::size_t>(std::ranges::count(axis.left_out, true));
}

}  // namespace stiction::host
