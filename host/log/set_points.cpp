#include "host/log/set_points.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "host/algebra/least_squares.hpp"

namespace stiction::host {
namespace {

using Values = std::vector<double>;

// Increments over the period squared, rms: what the second derivative of a spline or quintic makes of rounding.
constexpr double second_derivative_of_rounding = 1.7;
// Of a quintic's acceleration, over the way that it has beyond the cubic's and over the period squared.
constexpr double most_of_way = 5.77;
// Of the accelerations, rms: what the way adds to half of them where the channels belong to each other. A velocity that
// is a tenth of a sample late adds more than half of them.
constexpr double inconsistent = 0.02;

// The step of the grid that all values lie on; 0 when they lie on none. Rounding shows in the second differences: they
// are whole steps and change all the time, where those of a constant acceleration are equal too but stay.
double grid_of(const Values& x) {
  double largest = 0.0;
  for (const double value : x) largest = std::max(largest, std::abs(value));
  Values bends;
  double least = 0.0;
  for (std::size_t k = 1; k + 1 < x.size(); ++k) {
    const double bend = x[k + 1] - 2.0 * x[k] + x[k - 1];
    bends.push_back(std::abs(bend) > 1e-12 * largest ? bend : 0.0);  // less is the rounding of doubles
    if (bends.back() != 0.0 && (least == 0.0 || std::abs(bend) < least)) least = std::abs(bend);
  }
  if (least == 0.0) return 0.0;
  std::size_t bent = 0, changes = 0;
  for (std::size_t k = 0; k < bends.size(); ++k) {
    const double steps = bends[k] / least;
    if (std::abs(steps) > 1e6 || std::abs(steps - std::round(steps)) > 0.05) return 0.0;
    bent += bends[k] != 0.0;
    changes += k > 0 && std::abs(bends[k] - bends[k - 1]) > 0.5 * least;
  }
  return 4 * changes >= bent ? least : 0.0;
}

// Half the width in samples of the window whose cubic fit leaves `acceleration_noise` of a rounding to `increment`.
// The variance of its second derivative is 720 / (N (N^2 - 1) (N^2 - 4)) of that of a sample, N = 2 half + 1.
int half_window(double increment, double period, std::size_t samples) {
  const double rounding = increment / std::sqrt(12.0) / (period * period);  // m/s^2
  const auto most = static_cast<int>((samples - 1) / 2);
  for (int half = 2; half < most; ++half) {
    const double n = 2.0 * half + 1.0;
    if (rounding * std::sqrt(720.0 / (n * (n * n - 1.0) * (n * n - 4.0))) <= acceleration_noise) return half;
  }
  return most;
}

// Replaces x by, and fills v and a from, the cubic fitted to each sample's window; at the ends the window stays inside.
void smooth(Values& x, Values& v, Values& a, int half, double period) {
  const int width = 2 * half + 1;
  Eigen::MatrixXd powers(width, 4);
  for (int i = 0; i < width; ++i)
    for (int p = 0; p < 4; ++p) powers(i, p) = std::pow(static_cast<double>(i - half) / half, p);
  const Eigen::MatrixXd fit = solve_symmetric(transposed_product(powers, powers), powers.transpose());  // 4 x width
  const auto samples = static_cast<int>(x.size());
  const double unit = half * period;  // s, of the fit's abscissa
  const Values raw = x;
  for (int k = 0; k < samples; ++k) {
    const int middle = std::clamp(k, half, samples - 1 - half);
    const Eigen::Map<const Eigen::VectorXd> window(raw.data() + middle - half, width);
    // About the window's middle, so that a long way from the origin costs no digits.
    const Eigen::Vector4d c = fit * (window.array() - raw[static_cast<std::size_t>(middle)]).matrix();
    const double s = static_cast<double>(k - middle) / half;
    const auto at = static_cast<std::size_t>(k);
    x[at] = raw[static_cast<std::size_t>(middle)] + c[0] + s * (c[1] + s * (c[2] + s * c[3]));
    v[at] = (c[1] + s * (2.0 * c[2] + s * 3.0 * c[3])) / unit;
    a[at] = (2.0 * c[2] + s * 6.0 * c[3]) / (unit * unit);
  }
}

// Velocity and acceleration of the cubic spline through x, with constant acceleration in the first and last interval.
void spline(const Values& x, Values& v, Values& a, double period) {
  const std::size_t n = x.size();
  if (n == 2) {
    v.assign(2, (x[1] - x[0]) / period);
    a.assign(2, 0.0);
    return;
  }
  // (a[k-1] + 4 a[k] + a[k+1]) / 6 = second difference; forward elimination and substitution.
  Values ratio(n, 0.0);
  const auto difference = [&](std::size_t k) { return (x[k + 1] - 2.0 * x[k] + x[k - 1]) / (period * period); };
  for (std::size_t k = 1; k + 1 < n; ++k) {
    const double left = k == 1 ? 0.0 : 1.0;
    const double diagonal = (k == 1 ? 5.0 : 4.0) + (k + 2 == n ? 1.0 : 0.0) - left * ratio[k - 1];
    ratio[k] = 1.0 / diagonal;
    a[k] = (6.0 * difference(k) - left * a[k - 1]) / diagonal;
  }
  for (std::size_t k = n - 2; k-- > 1;) a[k] -= ratio[k] * a[k + 1];
  a[0] = a[1];
  a[n - 1] = a[n - 2];
  for (std::size_t k = 0; k + 1 < n; ++k) v[k] = (x[k + 1] - x[k]) / period - period * (2.0 * a[k] + a[k + 1]) / 6.0;
  v[n - 1] = v[n - 2] + 0.5 * period * (a[n - 2] + a[n - 1]);
}

bool agrees(const Values& logged, const Values& derived, double tolerance) {
  if (logged.empty()) return false;
  double off = 0.0, size = 0.0;
  for (std::size_t k = 0; k < logged.size(); ++k) {
    off += (logged[k] - derived[k]) * (logged[k] - derived[k]);
    size += derived[k] * derived[k];
  }
  return off <= tolerance * tolerance * size;
}

}  // namespace

SetPoints::SetPoints(const Log& log, const AxisLog& axis)
    : begin_(log.t.front()), period_(log.period), x_(axis.x_set), v_(axis.x_set.size()), a_(axis.x_set.size()) {
  if (axis.x_set.empty()) {
    const auto prefix = axis.axis.empty() ? "" : axis.axis + ".";
    throw LogError(fmt::format("{}: found no {}x_set[m]; expected the set position: record it with the measured one",
                               log.source, prefix));
  }
  increment_ = grid_of(x_);
  if (x_.size() > 5 && second_derivative_of_rounding * increment_ > acceleration_noise * period_ * period_) {
    const int half = half_window(increment_, period_, x_.size());
    smooth(x_, v_, a_, half, period_);
    smoothing_ = 2.0 * half * period_;
  } else {
    spline(x_, v_, a_, period_);
  }
  velocity_is_logged_ = agrees(axis.v_set, v_, 0.02);
  acceleration_is_logged_ = agrees(axis.a_set, a_, 0.2);
  if (velocity_is_logged_) {
    v_ = axis.v_set;
    x_ = axis.x_set;  // nothing is derived from it any more
    smoothing_ = 0.0;
  }
  if (acceleration_is_logged_) a_ = axis.a_set;
  way_agrees_ = smoothing_ == 0.0 && way_agrees();
}

// m, beyond what the cubic of the velocities makes of the way from sample k to the next.
double SetPoints::beyond_velocity(std::size_t k) const {
  return x_[k + 1] - x_[k] - period_ * (0.5 * (v_[k] + v_[k + 1]) + period_ * (a_[k] - a_[k + 1]) / 12.0);
}

// Whether what the way adds to the acceleration between samples is small but at few of them, where it jumps.
bool SetPoints::way_agrees() const {
  if (x_.size() < 2 || second_derivative_of_rounding * increment_ > acceleration_noise * period_ * period_)
    return false;
  Values added;
  double square = 0.0;
  for (std::size_t k = 0; k + 1 < x_.size(); ++k) {
    if (a_[k] == 0.0 && a_[k + 1] == 0.0) continue;
    added.push_back(most_of_way * std::abs(beyond_velocity(k)) / (period_ * period_));
    square += a_[k] * a_[k];
  }
  if (added.empty()) return false;
  const auto middle = added.begin() + static_cast<std::ptrdiff_t>(added.size() / 2);
  std::nth_element(added.begin(), middle, added.end());
  return *middle <= inconsistent * std::sqrt(square / static_cast<double>(added.size()));
}

sim::AxisSetPoint SetPoints::at(double t) const {
  double place = (t - begin_) / period_;
  // A tick that falls on a sample takes it as it is: a millionth of a step is the rounding of the two clocks. A cast,
  // because every tick of every replay comes here and std::round is a call.
  if (const auto nearest = static_cast<double>(static_cast<std::int64_t>(place + 0.5));
      std::abs(place - nearest) < 1e-6)
    place = nearest;
  if (!(place > 0.0)) return {x_.front(), place < 0.0 ? 0.0 : v_.front(), place < 0.0 ? 0.0 : a_.front()};
  const auto last = x_.size() - 1;
  if (place >= static_cast<double>(last))
    return {x_.back(), place > static_cast<double>(last) ? 0.0 : v_.back(),
            place > static_cast<double>(last) ? 0.0 : a_.back()};
  const auto k = static_cast<std::size_t>(place);
  const double s = place - static_cast<double>(k), h = period_;
  if (s == 0.0) return {x_[k], v_[k], a_[k]};
  const double v0 = v_[k] * h, v1 = v_[k + 1] * h, a0 = a_[k] * h * h, a1 = a_[k + 1] * h * h;
  const double dx = x_[k + 1] - x_[k], beyond = beyond_velocity(k);
  const auto quintic = [&](double way) {
    const double c3 = 10.0 * way - 6.0 * v0 - 4.0 * v1 - 1.5 * a0 + 0.5 * a1;
    const double c4 = -15.0 * way + 8.0 * v0 + 7.0 * v1 + 1.5 * a0 - a1;
    const double c5 = 6.0 * way - 3.0 * (v0 + v1) + 0.5 * (a1 - a0);
    return sim::AxisSetPoint{x_[k] + s * (v0 + s * (0.5 * a0 + s * (c3 + s * (c4 + s * c5)))),
                             (v0 + s * (a0 + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)))) / h,
                             (a0 + s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5))) / (h * h)};
  };
  auto point = quintic(way_agrees_ ? dx : dx - beyond);
  if (!way_agrees_) point.position = quintic(dx).position;
  // Speeds that were smoothed have noise of their own, which must not swing the acceleration.
  if (smoothing_ > 0.0) point.acceleration = a_[k] + s * (a_[k + 1] - a_[k]);
  return point;
}

}  // namespace stiction::host
