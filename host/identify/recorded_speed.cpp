#include "host/identify/recorded_speed.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "host/identify/filter.hpp"
#include "host/log/resolution.hpp"

namespace stiction::host {
namespace {

// Half an octave apart; at the first the position's speed is compared that is quiet enough, from the widest on.
constexpr double edges[]{40.0, 28.0, 20.0, 14.0, 10.0, 7.0, 5.0, 3.5, 2.5, 1.8, 1.2, 0.8};  // Hz
constexpr double quiet = 0.01;                                                              // noise over speed, rms
constexpr std::size_t blocks = 20;    // of a record, whose scatter gives the standard errors
constexpr double scale_error = 0.01;  // beyond which a speed has a different scale
// A speed that comes so late turns the acceleration's phase by a degree at 10 Hz: friction takes a fiftieth of the
// inertia's force there.
constexpr double late = 0.3e-3;          // s
constexpr double standard_errors = 3.0;  // beyond which a difference is one

using Values = std::vector<double>;

Values low_passed(const Values& values, double edge, double period) {
  const auto lowpass = butterworth(4, std::min(2.0 * edge * period, 0.9));
  const double padding = static_cast<double>(default_padding(lowpass)) * std::max(1.0, 0.1 / (edge * period));
  return filter_both_ways(lowpass, values, static_cast<std::size_t>(padding));
}

double rms_of(const Values& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(values.size(), 1)));
}

// Noise of the speed that differences of a white position noise of 1 m leave below `edge`: the integral of the squared
// angular frequency over the band.
double speed_gain(double edge, double period) {
  const double w = 2.0 * 3.141592653589793 * edge;
  return w * std::sqrt(2.0 * edge * period / 3.0);
}

struct Compared {
  Values v, a, recorded;  // in one band
};

// Sums of a least squares of the recorded speed over speed and acceleration.
struct Sums {
  Eigen::Matrix2d gram = Eigen::Matrix2d::Zero();
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();

  Eigen::Vector2d solve() const { return gram.ldlt().solve(moment); }
};

std::vector<Sums> sums_of(const Compared& c) {
  std::vector<Sums> sums(blocks);
  for (std::size_t k = 0; k < c.v.size(); ++k) {
    auto& s = sums[std::min(k * blocks / c.v.size(), blocks - 1)];
    const Eigen::Vector2d row(c.v[k], c.a[k]);
    s.gram += row * row.transpose();
    s.moment += row * c.recorded[k];
  }
  return sums;
}

// Scale and delay, with standard errors by leaving each block out.
void estimate(const Compared& c, RecordedSpeed& speed) {
  const auto sums = sums_of(c);
  Sums total;
  for (const auto& s : sums) {
    total.gram += s.gram;
    total.moment += s.moment;
  }
  const Eigen::Vector2d all = total.solve();
  Eigen::Vector2d squares = Eigen::Vector2d::Zero();
  for (const auto& s : sums) {
    const Eigen::Vector2d without = Sums{total.gram - s.gram, total.moment - s.moment}.solve();
    squares += (without - all).cwiseAbs2();
  }
  const Eigen::Vector2d errors =
      (squares * (static_cast<double>(blocks) - 1.0) / static_cast<double>(blocks)).cwiseSqrt();
  speed.scale = all[0];
  speed.scale_error = errors[0];
  // v(t - d) is v - d a to first order.
  speed.delay = -all[1] / all[0];
  speed.delay_error = errors[1] / std::abs(all[0]);
}

void judge(RecordedSpeed& speed) {
  const bool scaled = std::abs(speed.scale - 1.0) > std::max(scale_error, standard_errors * speed.scale_error);
  const bool shifted = std::abs(speed.delay) > std::max(late, standard_errors * speed.delay_error);
  const bool unknown = speed.scale_error > scale_error || speed.delay_error > late;
  speed.consistent = !scaled && !shifted && !unknown;
  if (scaled)
    speed.objection =
        fmt::format("it is {:.4g} +- {:.2g} times that of the position", speed.scale, 1.96 * speed.scale_error);
  else if (shifted)
    speed.objection = fmt::format("it comes about {:.2g} ms {} the position's", 1e3 * std::abs(speed.delay),
                                  speed.delay > 0.0 ? "after" : "before");
  else if (unknown)
    speed.objection =
        fmt::format("the record tells its scale to {:.2g} % and its delay to {:.2g} ms only, against the position's",
                    196.0 * speed.scale_error, 1.96e3 * speed.delay_error);
}

}  // namespace

RecordedSpeed recorded_speed(const Log& log, const AxisLog& channels, double position_noise) {
  RecordedSpeed speed;
  speed.noise = std::max(noise_of(channels.v), increment_of(channels, &AxisLog::v) / std::sqrt(12.0));
  for (const double edge : edges) {
    if (edge > 0.2 / log.period) continue;
    auto moved = derivatives(low_passed(channels.x, edge, log.period), log.period);
    if (position_noise * speed_gain(edge, log.period) > quiet * rms_of(moved.first)) continue;
    estimate({std::move(moved.first), std::move(moved.second), low_passed(channels.v, edge, log.period)}, speed);
    judge(speed);
    return speed;
  }
  speed.objection = "the position is too coarse, or the record too slow, to compare it with";
  return speed;
}

}  // namespace stiction::host
