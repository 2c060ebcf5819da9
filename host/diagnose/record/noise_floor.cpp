#include "host/diagnose/record/noise_floor.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "firmware/machine/model/motor_force.hpp"
#include "host/diagnose/record/record_rows.hpp"
#include "host/identify/identification.hpp"
#include "host/log/resolution.hpp"

namespace stiction::host {
namespace {

using Values = std::vector<double>;

// Hz, of the residual's rows. A record that is five times as fast shows the noise of its effort above that band; what a
// slower one has there is its motion.
constexpr double residual_band = 100.0, much_faster = 5.0;
constexpr double smooth_below = 15.0;  // Hz

double root_mean_square(const Eigen::VectorXd& v) {
  return v.size() == 0 ? 0.0 : std::sqrt(v.squaredNorm() / static_cast<double>(v.size()));
}

// The standard deviation of the white noise of a channel, from its third differences, which hardly know the signal:
// their variance is 20 times that of the noise. By the median, so that single events do not count.
double white_noise(const Values& values) {
  if (values.size() < 20) return 0.0;
  Values differences;
  for (std::size_t k = 3; k < values.size(); ++k)
    differences.push_back(std::abs(values[k] - 3.0 * values[k - 1] + 3.0 * values[k - 2] - values[k - 3]));
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return *middle / 0.6745 / std::sqrt(20.0);
}

// N, of the motor, without the known test signal.
Values effort_of(const Log& log, const machine::AxisModel& axis) {
  const auto& channels = channels_of(log, axis);
  auto force = force_of(log, channels, axis, Amperes::amplitude);
  if (!channels.force.empty()) return force;
  const bool source = axis.motor.driven_by_volts();
  const auto& test = source ? channels.u_inject : channels.i_inject;
  for (std::size_t k = 0; k < test.size(); ++k) force[k] -= machine::acting_force_constant(axis.motor) * test[k];
  return force;
}

// N: the noise of the effort of one record.
double effort_noise(const Log& log, const machine::AxisModel& axis, const Log* replayed) {
  const auto effort = effort_of(log, axis);
  const double rounding = increment_of(effort) / std::sqrt(12.0);
  if (log.period * residual_band * much_faster > 1.0) return rounding;
  const double seen = white_noise(effort);
  double own = 0.0;
  if (replayed != nullptr) {
    auto simulated = *replayed;
    simulated.axes.front().force.clear();  // as the record has it: of the current
    simulated.axes.front().i_inject = channels_of(log, axis).i_inject;
    simulated.axes.front().u_inject = channels_of(log, axis).u_inject;
    own = white_noise(effort_of(simulated, axis));
  }
  return std::max(rounding, std::sqrt(std::max(seen * seen - own * own, 0.0)));
}

// The logs with another position of the axis, made of its filtered motion.
std::vector<Log> with_position(const std::vector<Log>& logs, const LogRows& rows, const machine::AxisModel& axis,
                               const std::function<double(const Log&, const Motion&, std::size_t)>& position) {
  auto all = logs;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto place = static_cast<std::size_t>(&channels_of(logs[k], axis) - logs[k].axes.data());
    auto& x = all[k].axes[place].x;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = position(logs[k], rows.motions()[k], i);
  }
  return all;
}

// Of an increment: the record's own steps are whole ones.
constexpr double off_the_grid = 0.37;
double rounded(double x, double increment) { return increment > 0.0 ? std::round(x / increment) * increment : x; }

}  // namespace

double NoiseFloor::force() const {
  return std::sqrt(encoder * encoder + clock * clock + effort * effort + dynamics * dynamics);
}

NoiseFloor noise_floor(const std::vector<Log>& logs, const machine::AxisModel& axis, const SignalSettings& settings,
                       const Eigen::VectorXd& counts, const std::vector<Log>& replayed, const Eigen::VectorXd& expected,
                       std::uint64_t seed) {
  NoiseFloor floor;
  floor.increment = axis.encoder.increment;
  double jitter_square = 0.0;
  // Rounded is a motion that is smoother than the record: one that was rounded already would fall on the same steps.
  auto smooth = settings;
  smooth.cutoff = smooth_below;
  const auto rows = rows_of(logs, axis, smooth);
  for (std::size_t k = 0; k < logs.size(); ++k) {
    floor.increment = std::max(floor.increment, increment_of(channels_of(logs[k], axis), &AxisLog::x));
    const double jitter = logs[k].clock.resampled ? 0.0 : logs[k].clock.jitter;
    double square = 0.0;
    for (const double v : rows.motions()[k].v) square += v * v;
    jitter_square = std::max(jitter_square, jitter * jitter * square / static_cast<double>(rows.motions()[k].v.size()));
  }
  const double noise = axis.encoder.noise, hunting = axis.position_controller.increment;
  floor.position =
      std::sqrt((floor.increment * floor.increment + hunting * hunting) / 6.0 + 2.0 * noise * noise + jitter_square);
  floor.dynamics = resolution_of_dynamics * root_mean_square(expected.cwiseProduct(counts));

  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto force_of_positions = [&](const auto& position) {
    return expected_force(rows_of(with_position(logs, rows, axis, position), axis, settings), axis);
  };
  const Eigen::VectorXd exact =
      force_of_positions([](const Log&, const Motion& motion, std::size_t i) { return motion.x[i]; });
  const auto off = [&](const auto& position) {
    return root_mean_square((force_of_positions(position) - exact).cwiseProduct(counts));
  };
  if (floor.increment > 0.0 || noise > 0.0)
    floor.encoder = off([&](const Log&, const Motion& motion, std::size_t i) {
      return rounded(motion.x[i] + noise * normal(random) + off_the_grid * floor.increment, floor.increment) -
             off_the_grid * floor.increment;
    });
  if (jitter_square > 0.0)
    floor.clock = off([&](const Log& log, const Motion& motion, std::size_t i) {
      return motion.x[i] + (log.clock.resampled ? 0.0 : log.clock.jitter * motion.v[i] * normal(random));
    });
  Values deviations;
  for (std::size_t k = 0; k < logs.size(); ++k)
    deviations.push_back(effort_noise(logs[k], axis, k < replayed.size() ? &replayed[k] : nullptr));
  floor.effort = root_mean_square(rows.stacked([&](const Motion& motion) {
                                        Values column(motion.t.size());
                                        const auto log = static_cast<std::size_t>(&motion - rows.motions().data());
                                        for (double& value : column) value = deviations[log] * normal(random);
                                        return column;
                                      })
                                      .cwiseProduct(counts));
  return floor;
}

}  // namespace stiction::host
