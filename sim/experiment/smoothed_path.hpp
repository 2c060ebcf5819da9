// The set-points of a path as a controller's jerk filter gives them: the mean of the path over the last `window`. A
// step of the acceleration becomes a ramp as long as the window, so that the jerk is the step over the window at most;
// a standstill is reached one window later and left at the same instant.
//   x = 1/T int_{t-T}^{t} x_p,  v = (x_p(t) - x_p(t-T)) / T,  a = (v_p(t) - v_p(t-T)) / T
#pragma once

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "sim/experiment/set_point.hpp"

namespace stiction::sim {

// Path: at(t) gives two AxisSetPoints, at rest before 0 s; knots() the instants (s, rising) at which its acceleration
// steps. A window (s) of 0 leaves the path as it is.
template <class Path>
class SmoothedPath {
 public:
  SmoothedPath(Path path, double window) : path_(std::move(path)), window_(window), knots_(path_.knots()) {}

  const Path& path() const { return path_; }
  double window() const { return window_; }
  double duration() const { return path_.duration() + window_; }

  std::array<AxisSetPoint, 2> at(double t) const {
    if (window_ <= 0.0) return path_.at(t);
    const auto now = at_rest_before(t), before = at_rest_before(t - window_);
    const auto mean = mean_place(t - window_, t);
    std::array<AxisSetPoint, 2> points;
    for (std::size_t k = 0; k < 2; ++k)
      points[k] = {mean[k], (now[k].position - before[k].position) / window_,
                   (now[k].velocity - before[k].velocity) / window_};
    return points;
  }

 private:
  std::array<AxisSetPoint, 2> at_rest_before(double t) const { return path_.at(std::max(t, 0.0)); }

  // Gauss and Legendre's rule of five points on each piece between knots: an arc turns by some tenths of a radian in a
  // window, and the rule's error is of the tenth power of that.
  std::array<double, 2> mean_place(double from, double to) const {
    constexpr std::array<double, 5> node{-0.906179845938663993, -0.538469310105683091, 0.0, 0.538469310105683091,
                                         0.906179845938663993};
    constexpr std::array<double, 5> weight{0.236926885056189088, 0.478628670499366468, 0.568888888888888889,
                                           0.478628670499366468, 0.236926885056189088};
    std::array<double, 2> sum{};
    double begin = from;
    const auto add_piece = [&](double end) {
      const double half = 0.5 * (end - begin), middle = 0.5 * (begin + end);
      for (std::size_t i = 0; i < node.size(); ++i) {
        const auto point = at_rest_before(middle + half * node[i]);
        for (std::size_t k = 0; k < 2; ++k) sum[k] += half * weight[i] * point[k].position;
      }
      begin = end;
    };
    for (auto knot = std::upper_bound(knots_.begin(), knots_.end(), from); knot != knots_.end() && *knot < to; ++knot)
      add_piece(*knot);
    add_piece(to);
    for (double& value : sum) value /= window_;
    return sum;
  }

  Path path_;
  double window_;
  std::vector<double> knots_;
};

}  // namespace stiction::sim
