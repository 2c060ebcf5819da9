#include "host/log/resample.hpp"

#include <algorithm>
#include <cmath>

#include "host/log/resolution.hpp"

namespace stiction::host {
namespace {

using Values = std::vector<double>;

// Slope at the middle one of three samples, of the parabola through them; h: the steps, d: the slopes of both lines.
double parabola_slope(double h0, double d0, double h1, double d1) { return (d0 * h1 + d1 * h0) / (h0 + h1); }

// Steps, and the slopes of the lines between neighbours.
struct Lines {
  Values h, d;
  Lines(std::span<const double> t, std::span<const double> values) : h(t.size() - 1), d(t.size() - 1) {
    for (std::size_t k = 0; k < h.size(); ++k) {
      h[k] = t[k + 1] - t[k];
      d[k] = (values[k + 1] - values[k]) / h[k];
    }
  }
  double first() const { return d.size() < 2 ? d[0] : d[0] + (d[0] - d[1]) * h[0] / (h[0] + h[1]); }
  double last() const {
    const std::size_t n = d.size();
    return n < 2 ? d[0] : d[n - 1] + (d[n - 1] - d[n - 2]) * h[n - 1] / (h[n - 1] + h[n - 2]);
  }
};

// Slopes of the cubic spline whose ends have those of the parabola through three samples.
Values spline_slopes(const Lines& lines) {
  const std::size_t n = lines.h.size() + 1;
  Values slope(n), upper(n);
  slope[0] = lines.first();
  slope[n - 1] = lines.last();
  double before = slope[0];
  for (std::size_t k = 1; k + 1 < n; ++k) {
    const double h0 = lines.h[k - 1], h1 = lines.h[k];
    const double right = 3.0 * (h1 * lines.d[k - 1] + h0 * lines.d[k]);
    const double pivot = 2.0 * (h0 + h1) - (k > 1 ? h1 * upper[k - 1] : 0.0);
    upper[k] = h0 / pivot;
    before = slope[k] = (right - h1 * before) / pivot;
  }
  for (std::size_t k = n - 1; k-- > 1;) slope[k] -= upper[k] * slope[k + 1];
  return slope;
}

Values monotone_slopes(const Lines& lines) {
  const std::size_t n = lines.h.size() + 1;
  Values slope(n);
  for (std::size_t k = 1; k + 1 < n; ++k) {
    const double d0 = lines.d[k - 1], d1 = lines.d[k];
    const double p = parabola_slope(lines.h[k - 1], d0, lines.h[k], d1);
    const double least = std::min({std::abs(d0), std::abs(d1), 0.5 * std::abs(p)});
    slope[k] = d0 * d1 > 0.0 ? std::copysign(2.0 * least, d0) : 0.0;
  }
  const auto end = [](double p, double d) {
    return p * d <= 0.0 ? 0.0 : std::copysign(std::min(std::abs(p), 2.0 * std::abs(d)), d);
  };
  slope[0] = end(lines.first(), lines.d.front());
  slope[n - 1] = end(lines.last(), lines.d.back());
  return slope;
}

bool is_smooth_channel(const LogChannel& channel) {
  return channel.values == &AxisLog::x || channel.values == &AxisLog::x_set || channel.values == &AxisLog::x_load;
}

bool is_whole(const auto& channel) {
  if constexpr (requires { channel.whole; })
    return channel.whole;
  else
    return false;
}

}  // namespace

std::vector<double> interpolated(std::span<const double> t, std::span<const double> values, std::span<const double> at,
                                 Interpolation how) {
  const Lines lines(t, values);
  Values slope;
  if (how == Interpolation::spline) slope = spline_slopes(lines);
  if (how == Interpolation::monotone) slope = monotone_slopes(lines);
  Values out;
  out.reserve(at.size());
  std::size_t k = 0;
  for (const double time : at) {
    while (k + 2 < t.size() && t[k + 1] <= time) ++k;
    const double h = lines.h[k], s = std::clamp((time - t[k]) / h, 0.0, 1.0);
    if (how == Interpolation::held) {
      out.push_back(values[s < 1.0 ? k : k + 1]);
    } else if (how == Interpolation::line) {
      out.push_back(values[k] + s * (values[k + 1] - values[k]));
    } else {
      // Newton's form of the cubic with these two slopes, exact at s = 0.
      const double rise = values[k + 1] - values[k], a = slope[k] * h, b = slope[k + 1] * h;
      out.push_back(s < 1.0 ? values[k] + s * (a + s * ((3.0 * rise - 2.0 * a - b) + s * (a + b - 2.0 * rise)))
                            : values[k + 1]);
    }
  }
  return out;
}

Interpolation interpolation_of(std::span<const double> values, bool smooth, double increment) {
  if (!smooth || values.size() < 4) return Interpolation::monotone;
  Values bends;
  double largest = 0.0;
  for (std::size_t k = 1; k < values.size(); ++k) largest = std::max(largest, std::abs(values[k] - values[k - 1]));
  for (std::size_t k = 2; k + 1 < values.size(); ++k) {
    const double before = std::abs(values[k - 1] - values[k - 2]), here = std::abs(values[k] - values[k - 1]),
                 behind = std::abs(values[k + 1] - values[k]);
    bends.push_back(std::abs(values[k] - 2.0 * values[k - 1] + values[k - 2]));
    // A mass has no step that is much longer than both of its neighbours: this is a jump, at which a spline rings.
    if (here > 0.25 * largest && here > 4.0 * std::max(before, behind)) return Interpolation::monotone;
  }
  // A line is off by an eighth of the second difference at most.
  std::ranges::sort(bends);
  return bends[bends.size() * 9 / 10] <= increment * 8.0 / std::sqrt(12.0) ? Interpolation::line
                                                                           : Interpolation::spline;
}

Log made_even(const Log& log) {
  Log even = log;
  const std::size_t size = log.t.size();
  even.period = (log.t.back() - log.t.front()) / static_cast<double>(size - 1);
  for (std::size_t k = 0; k < size; ++k) even.t[k] = log.t.front() + static_cast<double>(k) * even.period;
  even.t.back() = log.t.back();
  even.clock.resampled = true;
  for (auto& axis : even.axes) {
    for (const auto& channel : log_channels) {
      auto& values = axis.*channel.values;
      if (values.empty()) continue;
      const auto how = is_whole(channel)
                           ? Interpolation::held
                           : interpolation_of(values, is_smooth_channel(channel), increment_of(axis, channel.values));
      values = interpolated(log.t, values, even.t, how);
    }
    if (axis.left_out.empty()) continue;
    const auto left_out = axis.left_out;
    for (std::size_t k = 0, from = 0; k < size; ++k) {
      while (from + 2 < size && log.t[from + 1] <= even.t[k]) ++from;
      axis.left_out[k] = left_out[from] || left_out[from + 1];
    }
  }
  return even;
}

}  // namespace stiction::host
