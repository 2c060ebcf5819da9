#include "host/log/rigid_motion.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host/log/resolution.hpp"

namespace stiction::host {
namespace {

using Values = std::vector<double>;

constexpr int columns = 9;  // acceleration, speed, its sign, root, fall near 0, one, friction built up over distances
constexpr int parts = 12;   // of the record, one of which the jackknife leaves out
constexpr double most_noise = 0.01;        // of the acceleration's variance that the position's noise may make
constexpr std::size_t fewest_samples = 8;  // in a window; a fourth power of a cosine is summed exactly from 5 on
constexpr int delays = 61;                 // that are tried
constexpr double falls_within = 0.01;      // of the greatest speed: friction near standstill
constexpr double most_standing = 0.25;     // of a window
constexpr std::array<double, 3> distances{3e-4, 3e-3, 3e-2};                  // of the stroke
constexpr std::array<double, 6> windows{0.04, 0.08, 0.16, 0.32, 0.64, 1.28};  // s

using Matrix = Eigen::Matrix<double, columns, columns>;
using Vector = Eigen::Matrix<double, columns, 1>;

// The fourth power of a cosine over [-1, 1], and its derivatives.
struct Window {
  double value, first, second;
};
Window window_at(double s) {
  if (std::abs(s) >= 1.0) return {0.0, 0.0, 0.0};
  const double w = std::numbers::pi / 2.0, c = std::cos(w * s), d = std::sin(w * s);
  return {c * c * c * c, -4.0 * w * c * c * c * d, 4.0 * w * w * c * c * (3.0 * d * d - c * c)};
}

struct Sums {
  Matrix normal = Matrix::Zero();
  std::vector<Vector> right{std::size_t{delays}, Vector::Zero()};  // of each delay
  Values square = Values(delays, 0.0);
  Values mean = Values(delays, 0.0);
  double rows = 0.0;

  void add(const Sums& other, double sign) {
    normal += sign * other.normal;
    for (std::size_t d = 0; d < right.size(); ++d) {
      right[d] += sign * other.right[d];
      square[d] += sign * other.square[d];
      mean[d] += sign * other.mean[d];
    }
    rows += sign * other.rows;
  }
};

double delay_at(double index) { return longest_delay * (2.0 * index / static_cast<double>(delays - 1) - 1.0); }

class Fit {
 public:
  Fit(const Log& log, const AxisLog& axis, const Values& effort, double window)
      : log_(log), axis_(axis), effort_(effort), half_(0.5 * window), taps_(half_ / log.period) {
    for (int k = -static_cast<int>(taps_); k <= static_cast<int>(taps_); ++k)
      shape_.push_back(window_at(static_cast<double>(k) / taps_));
    middle_ = x_mean();
    set_speeds();
    gather();
  }

  // Of the acceleration's variance, what the noise of the position makes (partial of the other columns).
  double noise_share() const {
    if (total_.rows < 4.0 * parts) return 1e9;
    double sum = 0.0;
    for (const auto& s : shape_) sum += s.second * s.second;
    const double scale = log_.period / (half_ * half_);
    const double noise = std::max(noise_of(axis_.x), increment_of(axis_, &AxisLog::x) / std::sqrt(12.0));
    const double variance = noise * noise * sum * scale * scale;
    return variance * total_.rows * regularised(total_.normal).inverse()(0, 0);
  }

  std::optional<RigidMotion> result(double at) const {
    RigidMotion out;
    out.window = 2.0 * half_;
    const double best = best_delay(total_);
    const auto here =
        static_cast<std::size_t>(std::lround((at / longest_delay + 1.0) * 0.5 * static_cast<double>(delays - 1)));
    const auto all = solved(total_, here);
    out.delay = best;
    out.mass = all[0];
    out.friction_power = friction_part(total_, here);
    out.explained =
        1.0 - squares(total_, here) /
                  std::max(1e-300, total_.square[here] - total_.mean[here] * total_.mean[here] / total_.rows);
    out.mass_by_rest = std::sqrt(squares(total_, here) * regularised(total_.normal).inverse()(0, 0));
    const auto none = static_cast<std::size_t>(delays / 2);
    double least_rest = squares(total_, none);
    for (std::size_t d = 0; d < std::size_t{delays}; ++d) least_rest = std::min(least_rest, squares(total_, d));
    out.rest_ratio = squares(total_, none) / std::max(1e-300, least_rest);
    double mass = 0.0, delay = 0.0, friction = 0.0;
    int used = 0;
    for (const auto& part : parts_) {
      if (part.rows == 0.0) continue;
      Sums rest = total_;
      rest.add(part, -1.0);
      ++used;
      mass += std::pow(solved(rest, here)[0] - out.mass, 2);
      delay += std::pow(best_delay(rest) - best, 2);
      friction += std::pow(friction_part(rest, here) - out.friction_power, 2);
    }
    if (used < parts / 2) return std::nullopt;
    const double jackknife = static_cast<double>(used - 1) / static_cast<double>(used);
    out.mass_error = std::sqrt(jackknife * mass);
    out.delay_error = std::sqrt(jackknife * delay);
    out.friction_power_error = std::sqrt(jackknife * friction);
    return out;
  }

 private:
  double x_mean() const {
    double sum = 0.0;
    for (const double x : axis_.x) sum += x;
    return sum / static_cast<double>(axis_.x.size());
  }

  // Speeds, and below which of them the sign is uncertain.
  void set_speeds() {
    const auto size = static_cast<std::ptrdiff_t>(axis_.x.size());
    // A quarter of the window is enough for a speed.
    const auto near = std::max<std::ptrdiff_t>(1, static_cast<std::ptrdiff_t>(shape_.size() / 8));
    const auto x = [&](std::ptrdiff_t k) { return axis_.x[static_cast<std::size_t>(k)]; };
    speed_.assign(axis_.x.size(), 0.0);
    for (std::ptrdiff_t k = 0; k < size; ++k) {
      const auto from = std::max<std::ptrdiff_t>(0, k - near), to = std::min(size - 1, k + near);
      auto& v = speed_[static_cast<std::size_t>(k)];
      v = (x(to) - x(from)) / (static_cast<double>(to - from) * log_.period);
      // Exact for a cubic where there is room.
      if (k >= 2 * near && k + 2 * near < size)
        v = (8.0 * (x(to) - x(from)) - (x(k + 2 * near) - x(k - 2 * near))) /
            (12.0 * static_cast<double>(near) * log_.period);
    }
    for (const double v : speed_) fastest_ = std::max(fastest_, std::abs(v));
    rest_ = std::max(0.005 * fastest_,
                     2.0 * increment_of(axis_, &AxisLog::x) / (2.0 * static_cast<double>(near) * log_.period));
    const auto [least, most] = std::ranges::minmax(axis_.x);
    for (std::size_t d = 0; d < distances.size(); ++d) {
      const double distance = distances[d] * (most - least);
      auto& state = built_up_[d];
      state.assign(axis_.x.size(), 0.0);
      double z = 0.0;
      for (std::size_t k = 0; k < state.size(); ++k) {
        const double v = speed_[k];
        // P. R. Dahl, Aerospace Report TOR-0158(3107-18)-1, 1968, exact over a step of one speed.
        const double step = std::abs(v) < 0.5 * rest_ ? 0.0 : std::abs(v) * log_.period / distance;
        const double side = std::copysign(1.0, v);
        z = side + (z - side) * std::exp(-step);
        state[k] = z;
      }
    }
  }

  void gather() {
    const auto reach = static_cast<std::ptrdiff_t>(shape_.size() / 2);
    const auto late = static_cast<std::ptrdiff_t>(std::ceil(longest_delay / log_.period)) + 1;
    const auto size = static_cast<std::ptrdiff_t>(axis_.x.size());
    const std::ptrdiff_t step = std::max<std::ptrdiff_t>(1, reach / 2);
    const std::ptrdiff_t begin = reach + late, end = size - reach - late;
    parts_.assign(std::size_t{parts}, Sums{});
    if (end <= begin) return;
    Values row_effort(std::size_t{delays});
    for (std::ptrdiff_t k = begin; k < end; k += step) {
      Vector row = Vector::Zero();
      bool usable = true, moves = false;
      double standing = 0.0;
      for (std::ptrdiff_t m = -reach; m <= reach && usable; ++m) {
        const auto at = static_cast<std::size_t>(k + m);
        const auto& s = shape_[static_cast<std::size_t>(m + reach)];
        usable = axis_.left_out.empty() || !axis_.left_out[at];
        const double v = speed_[at], sign = std::clamp(v / rest_, -1.0, 1.0);
        moves = moves || std::abs(v) > rest_;
        row[0] += s.second / (half_ * half_) * (axis_.x[at] - middle_);
        row[1] -= s.first / half_ * (axis_.x[at] - middle_);
        row[2] += s.value * sign;
        row[3] += s.value * sign * std::sqrt(std::abs(v) / fastest_);
        row[4] += s.value;
        row[8] += s.value * sign * std::exp(-std::abs(v) / (falls_within * fastest_));
        standing += std::abs(v) < rest_ ? s.value : 0.0;
        for (std::size_t d = 0; d < distances.size(); ++d)
          row[5 + static_cast<Eigen::Index>(d)] += s.value * built_up_[d][at];
      }
      // At rest friction takes any force below its own: no column can tell it.
      if (!usable || !moves || standing > most_standing * row[4]) continue;
      row *= log_.period;
      for (int d = 0; d < delays; ++d) row_effort[static_cast<std::size_t>(d)] = effort_near(k, delay_at(d));
      auto& part = parts_[static_cast<std::size_t>((k - begin) * parts / (end - begin))];
      part.normal += row * row.transpose();
      for (std::size_t d = 0; d < row_effort.size(); ++d) {
        part.right[d] += row * row_effort[d];
        part.square[d] += row_effort[d] * row_effort[d];
        part.mean[d] += row_effort[d];
      }
      part.rows += 1.0;
    }
    for (const auto& part : parts_) total_.add(part, 1.0);
  }

  // Integral of the effort, `late` s behind sample k, over the window. The sums at whole samples are interpolated: the
  // window keeps what is faster than it off them.
  double effort_near(std::ptrdiff_t k, double late) {
    if (sums_.empty()) sums_.assign(axis_.x.size(), NAN);
    const double at = static_cast<double>(k) + late / log_.period;
    const double whole = std::floor(at), part = at - whole;
    const auto first = static_cast<std::ptrdiff_t>(whole);
    return (1.0 - part) * sum_at(first) + (part > 0.0 ? part * sum_at(first + 1) : 0.0);
  }
  double sum_at(std::ptrdiff_t k) {
    auto& sum = sums_[static_cast<std::size_t>(k)];
    if (!std::isnan(sum)) return sum;
    const auto reach = static_cast<std::ptrdiff_t>(shape_.size() / 2);
    sum = 0.0;
    for (std::ptrdiff_t m = -reach; m <= reach; ++m)
      sum += shape_[static_cast<std::size_t>(m + reach)].value * effort_[static_cast<std::size_t>(k + m)];
    return sum *= log_.period;
  }

  static Matrix regularised(const Matrix& normal) {
    Vector scale;
    for (int c = 0; c < columns; ++c) scale[c] = std::max(normal(c, c), 1e-300);
    return normal + 1e-9 * Matrix(scale.asDiagonal());
  }
  static Vector solved(const Sums& sums, std::size_t delay) {
    return regularised(sums.normal).ldlt().solve(sums.right[delay]);
  }
  static double squares(const Sums& sums, std::size_t delay) {
    return std::max(0.0, sums.square[delay] - sums.right[delay].dot(solved(sums, delay)));
  }
  static double best_delay(const Sums& sums) {
    const auto solver = regularised(sums.normal).ldlt();
    Values rest(std::size_t{delays});
    for (std::size_t d = 0; d < rest.size(); ++d)
      rest[d] = (sums.square[d] - sums.right[d].dot(solver.solve(sums.right[d]))) / std::max(1e-300, sums.square[d]);
    const auto at = static_cast<std::size_t>(std::ranges::min_element(rest) - rest.begin());
    double vertex = 0.0;
    if (at > 0 && at + 1 < rest.size()) {
      const double bend = rest[at - 1] - 2.0 * rest[at] + rest[at + 1];
      if (bend > 0.0) vertex = std::clamp(0.5 * (rest[at - 1] - rest[at + 1]) / bend, -0.5, 0.5);
    }
    return delay_at(static_cast<double>(at) + vertex);
  }
  // Power of the effort less that of mass and offset, by the effort's and the speed's magnitudes.
  static double friction_part(const Sums& sums, std::size_t delay) {
    const auto solution = solved(sums, delay);
    const double power = sums.right[delay][1] - solution[0] * sums.normal(1, 0) - solution[4] * sums.normal(1, 4);
    return power / std::max(1e-300, std::sqrt(sums.square[delay] * sums.normal(1, 1)));
  }

  const Log& log_;
  const AxisLog& axis_;
  const Values& effort_;
  double half_, taps_, middle_ = 0.0, fastest_ = 0.0, rest_ = 0.0;
  std::vector<Window> shape_;
  Values speed_, sums_;
  std::array<Values, distances.size()> built_up_;
  std::vector<Sums> parts_;
  Sums total_;
};

}  // namespace

std::optional<RigidMotion> rigid_motion(const Log& log, const AxisLog& axis, const std::vector<double>& effort,
                                        double at) {
  if (axis.x.empty() || effort.size() != axis.x.size()) return std::nullopt;
  const auto [least, most] = std::ranges::minmax(axis.x);
  if (least == most) return std::nullopt;
  for (const double window : windows) {
    if (window < static_cast<double>(fewest_samples) * log.period) continue;
    const Fit fit(log, axis, effort, window);
    if (fit.noise_share() < most_noise) return fit.result(at);
  }
  return std::nullopt;
}

}  // namespace stiction::host
