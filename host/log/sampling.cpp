#include "host/log/sampling.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "host/log/blank_cells.hpp"
#include "host/log/limits.hpp"
#include "host/log/resample.hpp"
#include "host/log/resolution.hpp"
#include "host/log/uneven_clock.hpp"

namespace stiction::host {
namespace {

double median_step(const std::vector<double>& t) {
  std::vector<double> steps(t.size() - 1);
  for (std::size_t k = 0; k < steps.size(); ++k) steps[k] = t[k + 1] - t[k];
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

std::string ms(double seconds) { return fmt::format("{:.6g} ms", seconds * 1e3); }

void refuse_stamps(const std::vector<double>& t, const std::function<std::string(std::size_t)>& place) {
  if (t.size() < 2)
    throw LogError(
        fmt::format("{}: found {} sample{}; expected at least 2", place(t.size()), t.size(), t.size() == 1 ? "" : "s"));
  for (std::size_t k = 0; k < t.size(); ++k) {
    if (!std::isfinite(t[k])) throw LogError(place(k) + ": found no time in this row; expected the time of every row");
    if (k > 0 && !(t[k] > t[k - 1]))
      throw LogError(
          fmt::format("{}: found the time {:.10g} s; expected one after that of the sample before ({:.10g} s)",
                      place(k), t[k], t[k - 1]));
  }
}

// The first place where a clock is not even.
struct Uneven {
  std::size_t sample = 0;
  std::string text;    // what is found there
  double usual = 0.0;  // s, step
};

std::optional<Uneven> first_uneven(const std::vector<double>& t, const StampDigits& digits) {
  const double period = (t.back() - t.front()) / static_cast<double>(t.size() - 1);
  // Stamps coarser than half a step can only be whole steps: rounding explains nothing then.
  const double coarsest = std::max(digits.resolution_at(t.front()), digits.resolution_at(t.back()));
  const bool rounded = coarsest <= 0.5 * period;
  const double usual = rounded && coarsest > 0.1 * period ? period : median_step(t);
  const auto allowed = [&](std::size_t k) { return rounded ? digits.resolution_at(t[k]) : 0.0; };
  for (std::size_t k = 1; k < t.size(); ++k) {
    const double step = t[k] - t[k - 1];
    // Compared first without the digits' resolution, whose logarithm costs more than the rest of the loop.
    const double off = std::abs(step - usual);
    if (off <= step_tolerance * usual || off <= step_tolerance * usual + allowed(k)) continue;
    const double missing = std::round(step / usual) - 1.0;
    if (missing >= 1.0)
      return Uneven{k,
                    fmt::format("a gap of {} before this sample, where {:.0f} sample{} missing", ms(step), missing,
                                missing > 1.0 ? "s are" : " is"),
                    usual};
    return Uneven{k, fmt::format("a step of {} before this sample", ms(step)), usual};
  }
  // A rate that drifts within the tolerance of each step.
  for (std::size_t k = 1; k < t.size(); ++k) {
    const double off = t[k] - (t.front() + static_cast<double>(k) * period);
    if (std::abs(off) > 0.5 * usual && std::abs(off) > 0.5 * usual + allowed(k))
      return Uneven{k, fmt::format("this sample {} away from a uniform rate", ms(off)), period};
  }
  return std::nullopt;
}

// Positions from a speed, by the trapezoidal rule, from 0.
void integrate_speeds(Log& log) {
  for (auto& axis : log.axes) {
    if (!axis.x.empty() || axis.v.empty()) continue;
    axis.x.assign(axis.v.size(), 0.0);
    for (std::size_t k = 1; k < axis.v.size(); ++k)
      axis.x[k] = axis.x[k - 1] + 0.5 * (log.t[k] - log.t[k - 1]) * (axis.v[k - 1] + axis.v[k]);
    log.notes.push_back(fmt::format(
        "{}x is integrated from {}v, from 0 on: the record has no position, and an offset of the speed grows in it.",
        axis.axis.empty() ? "" : axis.axis + ".", axis.axis.empty() ? "" : axis.axis + "."));
  }
}

// Period, jitter, even samples where they are not, and what is left out.
void finish(Log& log, const StampDigits& digits, bool resample) {
  const auto jitter = jitter_of(log.t, digits);
  log.period = (log.t.back() - log.t.front()) / static_cast<double>(log.t.size() - 1);
  for (auto& axis : log.axes)
    for (const auto& channel : log_channels)
      axis.increments.push_back(increment_of(std::span<const double>(axis.*channel.values)));
  integrate_speeds(log);
  if (resample) log = made_even(log);
  log.clock.jitter = jitter;
  for (auto& axis : log.axes) leave_out(axis, limited_channels(log, axis));
}

Log part_of(const Log& log, const Segment& segment) {
  Log part;
  part.source = log.source;
  part.comments = log.comments;
  part.ignored = log.ignored;
  part.notes = log.notes;
  const auto cut = [&](const auto& values) {
    using Vector = std::decay_t<decltype(values)>;
    return values.empty() ? Vector{}
                          : Vector(values.begin() + static_cast<std::ptrdiff_t>(segment.begin),
                                   values.begin() + static_cast<std::ptrdiff_t>(segment.end));
  };
  part.t = cut(log.t);
  for (const auto& axis : log.axes) {
    auto& to = part.axes.emplace_back();
    to.axis = axis.axis;
    to.rotary = axis.rotary;
    to.left_out = cut(axis.left_out);
    for (const auto& channel : log_channels) to.*channel.values = cut(axis.*channel.values);
  }
  return part;
}

// Splits the log into its stretches; it becomes the longest of them.
void split(Log& log, const StampDigits& digits, const Uneven& uneven,
           const std::function<std::string(std::size_t)>& place) {
  auto segments = segments_of(log.t, digits);
  std::vector<std::string> dropped;
  std::erase_if(segments, [&](const Segment& s) {
    if (s.end - s.begin >= shortest_stretch) return false;
    dropped.push_back(fmt::format("{} from {}", s.end - s.begin, place(s.begin)));
    return true;
  });
  if (segments.empty())
    throw LogError(fmt::format("{}: found {}, and no {} samples without a gap anywhere; expected uniform steps of {}",
                               place(uneven.sample), uneven.text, shortest_stretch, ms(uneven.usual)));
  if (!dropped.empty()) {
    const auto shown = std::min<std::size_t>(dropped.size(), 5);
    log.notes.push_back(
        fmt::format("{} stretches of fewer than {} samples are dropped: {}{}.", dropped.size(), shortest_stretch,
                    fmt::join(dropped.begin(), dropped.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
                    dropped.size() > shown ? ", ..." : ""));
  }
  std::size_t longest = 0;
  std::vector<Log> stretches;
  for (std::size_t k = 0; k < segments.size(); ++k) {
    const auto& segment = segments[k];
    if (segment.end - segment.begin > segments[longest].end - segments[longest].begin) longest = k;
    auto part = part_of(log, segment);
    part.clock.stretch = k;
    part.clock.stretches = segments.size();
    if (segments.size() > 1) part.source += fmt::format(", stretch {} of {}", k + 1, segments.size());
    finish(part, digits, first_uneven(part.t, digits).has_value());
    stretches.push_back(std::move(part));
  }
  log = std::move(stretches[longest]);
  stretches.erase(stretches.begin() + static_cast<std::ptrdiff_t>(longest));
  log.others = std::move(stretches);
}

}  // namespace

double StampDigits::resolution_at(double t) const {
  const double magnitude = std::abs(t);
  const double rounding = magnitude > 0.0 ? std::pow(10.0, std::floor(std::log10(magnitude)) + 1.0 - significant) : 0.0;
  return std::max(finest, rounding);
}

void count_digits(std::string_view stamp, StampDigits& digits, double unit) {
  int significant = 0, decimals = 0, exponent = 0;
  bool fraction = false;
  std::size_t i = 0;
  for (; i < stamp.size() && stamp[i] != 'e' && stamp[i] != 'E'; ++i) {
    if (stamp[i] == '.' || stamp[i] == ',') fraction = true;
    if (stamp[i] < '0' || stamp[i] > '9') continue;
    significant += significant > 0 || stamp[i] != '0';
    decimals += fraction;
  }
  if (i < stamp.size()) {
    const auto* begin = stamp.data() + i + 1 + (i + 1 < stamp.size() && stamp[i + 1] == '+');
    std::from_chars(begin, stamp.data() + stamp.size(), exponent);
  }
  digits.significant = std::max(digits.significant, significant);
  const double last = unit * std::pow(10.0, std::clamp(exponent, -300, 300) - decimals);
  if (digits.finest == 0.0 || last < digits.finest) digits.finest = last;
}

void check_sampling(Log& log, const StampDigits& digits, const std::function<std::string(std::size_t)>& place) {
  refuse_stamps(log.t, place);
  const auto rows = treat_blank_cells(log, place);
  const auto place_of_row = [&](std::size_t k) { return place(k < rows.size() ? rows[k] : k); };
  const auto uneven = first_uneven(log.t, digits);
  if (!uneven) {
    finish(log, digits, false);
    return;
  }
  if (log.t.size() < shortest_stretch)
    throw LogError(fmt::format("{}: found {}; expected uniform steps of {}, or at least {} samples",
                               place_of_row(uneven->sample), uneven->text, ms(uneven->usual), shortest_stretch));
  split(log, digits, *uneven, place_of_row);
}

}  // namespace stiction::host
