// A mass on a surface, without a drive: the bench on which friction models show their properties (Mendricky 2006,
// 4.4.3).
#pragma once

#include "firmware/machine/model/machine.hpp"
#include "sim/plant/friction/laws.hpp"

namespace stiction::host {

// The mass, whose law of friction says with which velocity it leaves a step.
class MassOnBench {
 public:
  static constexpr double step = 20e-6;  // s

  // `mass`: kg, at rest.
  explicit MassOnBench(double mass) : mass_(mass) {}

  // One step under `force` (N), the sum of all forces but friction, to the velocity `next` (m/s).
  void move(double force, double next) {
    friction_force_ = force - mass_ * (next - velocity_) / step;
    position_ += 0.5 * step * (velocity_ + next);
    velocity_ = next;
    time_ += step;
  }

  double time() const { return time_; }                      // s
  double position() const { return position_; }              // m
  double velocity() const { return velocity_; }              // m/s
  double friction_force() const { return friction_force_; }  // N, mean over the last step

 private:
  double mass_;
  double time_ = 0.0, position_ = 0.0, velocity_ = 0.0, friction_force_ = 0.0;
};

class FrictionBench : public MassOnBench {
 public:
  // The axis' mass on the friction model that its machine file uses, at rest.
  explicit FrictionBench(const machine::AxisModel& axis)
      : MassOnBench(axis.mass), friction_(sim::make_friction(axis.friction, {axis.mass, step})) {}

  // One step under `force` (N), the sum of all forces but friction.
  void advance(double force) {
    move(force, std::visit([&](auto& model) { return model.advance(velocity(), force); }, friction_));
  }

 private:
  sim::FrictionModel friction_;
};

}  // namespace stiction::host
