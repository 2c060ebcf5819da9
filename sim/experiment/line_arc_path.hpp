// A plane path of straight lines and arcs at constant path speed, with an accelerated lead-in along the first
// direction.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "sim/experiment/set_point.hpp"
#include "sim/experiment/speed_ramp.hpp"

namespace stiction::sim {

class LineArcPath {
 public:
  // Begins at the origin with the direction `heading` (rad from +x). The lead-in starts at rest before the origin and
  // reaches `speed` (m/s) there with `acceleration` (m/s^2).
  LineArcPath(double heading, double speed, double acceleration)
      : speed_(speed), acceleration_(acceleration), lead_time_(speed / acceleration), heading_(heading) {}
  // The same `heading`, `speed` and `acceleration`, with a lead-in whose `jerk` (m/s^3) is limited.
  LineArcPath(double heading, double speed, double acceleration, double jerk)
      : speed_(speed),
        acceleration_(acceleration),
        ramp_(SpeedRamp(speed, acceleration, jerk)),
        lead_time_(ramp_->duration()),
        heading_(heading) {}

  void line(double length) { add(length, 0.0); }
  // Turns by `angle` (rad, positive to the left) on `radius` (m).
  void arc(double radius, double angle) { add(radius * std::abs(angle), std::copysign(1.0 / radius, angle)); }

  double lead_time() const { return lead_time_; }  // s, until the origin is passed
  // s, when the end of the first `count` elements is passed
  double end_of(std::size_t count) const { return lead_time_ + elements_[count - 1].end / speed_; }
  double duration() const { return end_of(elements_.size()); }
  // s, rising: where acceleration or jerk steps.
  std::vector<double> knots() const {
    std::vector<double> all{0.0};
    if (ramp_) all.insert(all.end(), {ramp_->rise(), lead_time_ - ramp_->rise()});
    all.push_back(lead_time_);
    for (std::size_t i = 1; i <= elements_.size(); ++i) all.push_back(end_of(i));
    return all;
  }

  std::array<AxisSetPoint, 2> at(double t) const {
    if (t < lead_time_ && ramp_) {
      const auto m = ramp_->at(t);
      return along(0.0, 0.0, heading_, m.distance - 0.5 * speed_ * lead_time_, m.speed, m.acceleration);
    }
    if (t < lead_time_) {
      const double rest = lead_time_ - t;
      return along(0.0, 0.0, heading_, -speed_ * rest + 0.5 * acceleration_ * rest * rest,
                   speed_ - acceleration_ * rest, acceleration_);
    }
    const double distance = speed_ * (t - lead_time_);
    std::size_t i = 0;
    while (i + 1 < elements_.size() && distance >= elements_[i].end) ++i;
    const auto& e = elements_[i];
    const double s = distance - e.begin;
    if (e.curvature == 0.0) return along(e.x, e.y, e.heading, s, speed_, 0.0);
    const double heading = e.heading + e.curvature * s;
    const double normal = speed_ * speed_ * e.curvature;
    const double c = std::cos(heading), n = std::sin(heading);
    return {{{e.x + (n - std::sin(e.heading)) / e.curvature, speed_ * c, -normal * n},
             {e.y - (c - std::cos(e.heading)) / e.curvature, speed_ * n, normal * c}}};
  }

 private:
  struct Element {
    double begin, end;  // m along the path
    double x, y, heading;
    double curvature;  // 1/m
  };

  static std::array<AxisSetPoint, 2> along(double x, double y, double heading, double s, double v, double a) {
    const double c = std::cos(heading), n = std::sin(heading);
    return {{{x + s * c, v * c, a * c}, {y + s * n, v * n, a * n}}};
  }

  void add(double length, double curvature) {
    Element e{0.0, length, 0.0, 0.0, heading_, curvature};
    if (!elements_.empty()) {
      const auto& last = elements_.back();
      const double s = last.end - last.begin;
      e.begin = last.end;
      e.end = last.end + length;
      e.heading = last.heading + last.curvature * s;
      e.x = last.x + (last.curvature == 0.0 ? s * std::cos(last.heading)
                                            : (std::sin(e.heading) - std::sin(last.heading)) / last.curvature);
      e.y = last.y + (last.curvature == 0.0 ? s * std::sin(last.heading)
                                            : -(std::cos(e.heading) - std::cos(last.heading)) / last.curvature);
    }
    elements_.push_back(e);
  }

  double speed_;
  double acceleration_;
  std::optional<SpeedRamp> ramp_;  // of the lead-in, where its jerk is limited
  double lead_time_;
  double heading_;
  std::vector<Element> elements_;
};

}  // namespace stiction::sim
