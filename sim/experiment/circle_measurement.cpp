#include "sim/experiment/circle_measurement.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace stiction::sim {
namespace {

// Least-squares fit of the deviation by a change of radius and a shift of the centre, (r, c_x, c_y): for deviations far
// below the radius this is the least-squares circle.
Eigen::Vector3d fit_circle(const std::vector<double>& angle, const std::vector<double>& deviation) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < angle.size(); ++i) {
    const Eigen::Vector3d row(1.0, std::cos(angle[i]), std::sin(angle[i]));
    normal += row * row.transpose();
    right += row * deviation[i];
  }
  return normal.ldlt().solve(right);
}

struct Extremes {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

// Deviations from the circle about the lap's least-squares centre.
void add_centred(Extremes& extremes, const std::vector<double>& angle, const std::vector<double>& deviation,
                 const Eigen::Vector3d& fit) {
  for (std::size_t i = 0; i < angle.size(); ++i)
    extremes.add(deviation[i] - fit[1] * std::cos(angle[i]) - fit[2] * std::sin(angle[i]));
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

}  // namespace

CircleMeasurement::CircleMeasurement(const CircleSettings& settings, double sample_period,
                                     const std::vector<std::string>& axes) {
  run_.feed = settings.feed;
  run_.radius = settings.radius;
  run_.direction = settings.direction;
  run_.sample_period = sample_period;
  for (const auto& axis : axes) run_.axes.emplace_back().axis = axis;
}

void CircleMeasurement::add(const CirclePath::Point& set, const std::array<CircleAxisSample, 2>& axes) {
  if (set.turned < CirclePath::lap_begin || set.turned >= CirclePath::lap_end) return;
  run_.angle.push_back(std::atan2(set.axes[1].position, set.axes[0].position));
  if (run_.is_circle()) run_.radial_deviation.push_back(std::hypot(axes[0].position, axes[1].position) - run_.radius);
  for (std::size_t k = 0; k < run_.axes.size(); ++k) {
    auto& lap = run_.axes[k];
    lap.error.push_back(axes[k].error);
    lap.current.push_back(axes[k].current);
    lap.peak_error = std::max(lap.peak_error, std::abs(axes[k].error));
    lap.peak_error_quantised = std::max(lap.peak_error_quantised, std::abs(axes[k].error_held));
    lap.peak_current = std::max(lap.peak_current, std::abs(axes[k].current));
  }
}

CircleRun CircleMeasurement::finish() const {
  if (run_.angle.empty()) throw std::logic_error("circle: the evaluated lap was not reached");
  CircleRun run = run_;
  if (run.is_circle()) run.errors = circular_errors(run.angle, run.radial_deviation);
  return run;
}

CircularErrors circular_errors(const std::vector<double>& angle, const std::vector<double>& radial_deviation) {
  const auto fit = fit_circle(angle, radial_deviation);
  Extremes centred, programmed;
  add_centred(centred, angle, radial_deviation, fit);
  for (const double deviation : radial_deviation) programmed.add(deviation);
  return {centred.high - centred.low, programmed.high, programmed.low, {fit[1], fit[2]}};
}

BidirectionalErrors bidirectional_errors(const CircleRun& a, const CircleRun& b) {
  // One centre for both laps: the mean of theirs, as the laps are sampled alike.
  const Eigen::Vector3d fit = 0.5 * (fit_circle(a.angle, a.radial_deviation) + fit_circle(b.angle, b.radial_deviation));
  Extremes centred;
  add_centred(centred, a.angle, a.radial_deviation, fit);
  add_centred(centred, b.angle, b.radial_deviation, fit);
  return {centred.high - centred.low, 0.5 * (mean(a.radial_deviation) + mean(b.radial_deviation))};
}

}  // namespace stiction::sim
