// Set-points as the drive of a slave has them that follows its master late (effect master_delay).
#pragma once

#include <cmath>
#include <deque>
#include <span>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "sim/effects/master_delay/master_delay.hpp"
#include "sim/experiment/set_point.hpp"

namespace stiction::host {

class LateSetPoints {
 public:
  explicit LateSetPoints(const machine::Machine& machine) : period_(machine.timing.fast_period) {
    for (const auto& axis : machine.axes) {
      delays_.push_back(sim::master_delay(axis) / period_);
      any_ = any_ || delays_.back() > 0.0;
    }
    given_.resize(delays_.size());
    late_.resize(delays_.size());
  }

  bool any() const { return any_; }

  // Of a tick's set-points, one an axis, those that the drive has in it; before the first ones it has these. A test
  // signal does not come from the master.
  std::span<const sim::AxisSetPoint> operator()(std::span<const sim::AxisSetPoint> set_points) {
    for (std::size_t i = 0; i < late_.size(); ++i) {
      auto& given = given_[i];
      const auto whole = static_cast<std::size_t>(delays_[i]);
      given.push_back(set_points[i]);
      if (given.size() > whole + 1) given.pop_front();
      const bool all = given.size() == whole + 1;
      late_[i] = earlier(given.front(), all ? (delays_[i] - static_cast<double>(whole)) * period_ : 0.0);
      late_[i].injection = set_points[i].injection;
    }
    return late_;
  }

 private:
  static sim::AxisSetPoint earlier(sim::AxisSetPoint point, double by) {
    point.position -= by * (point.velocity - 0.5 * by * point.acceleration);
    point.velocity -= by * point.acceleration;
    return point;
  }

  double period_;               // s
  std::vector<double> delays_;  // ticks
  bool any_ = false;
  std::vector<std::deque<sim::AxisSetPoint>> given_;
  std::vector<sim::AxisSetPoint> late_;
};

}  // namespace stiction::host
