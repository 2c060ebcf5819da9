// Forces that a caller gives to the axes of a request, in the axes' own units and watched.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/requests/request.hpp"
#include "sim/effects/given_force.hpp"

namespace stiction::host {

// A force of an axis, which refuses what is no number and knows whether anyone asked for it.
class WatchedForce {
 public:
  // Of the axis of that name.
  WatchedForce(std::string axis, AxisForce force) : axis_(std::move(axis)), force_(std::move(force)) {}

  // Gives it to plants of `axis`, as long as this is there.
  void act_on(machine::AxisModel& axis);
  bool asked() const { return asked_; }
  const std::string& axis() const { return axis_; }

 private:
  // Throws UsageError for a value that is not finite.
  double at(const AxisState& state) const;

  std::string axis_;
  AxisForce force_;
  mutable std::atomic<bool> asked_ = false;
  std::vector<std::unique_ptr<sim::GivenForce>> given_;
};

// Adds `forces`, which are watched, to the axes of `machine`. Throws UsageError for an axis that it does not have.
void add_forces(machine::Machine& machine, const std::vector<RequestForce>& forces);

}  // namespace stiction::host
