// Forces of effects on the carriages of a batch, lane by lane: what no two axes have alike is not worth a vector. It is
// compiled for no instruction set in particular, so kernels call it.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "firmware/machine/batch/batch.hpp"
#include "firmware/machine/model/machine.hpp"

namespace stiction::sim {

class LaneForces {
 public:
  explicit LaneForces(std::size_t lanes);
  LaneForces(LaneForces&&) noexcept;
  LaneForces& operator=(LaneForces&&) noexcept;
  ~LaneForces();

  // Those of `axis`, as plant_axis() returns it, at rest at `position`, m; `lane`: its place; `step`: of the plant, s.
  // Throws EffectError.
  void set(std::size_t lane, const machine::AxisModel& axis, double step, double position);
  STICTION_INLINE bool any() const { return any_; }  // whether there is a lane with one

  // In one step from `position` (m) and `velocity` (m/s) with the motors' mean force in it, `motor_force` (N): N,
  // positive in +x, what is `friction` and what is `applied` otherwise. A value a lane in each.
  void advance(const double* position, const double* velocity, const double* motor_force, double* applied,
               double* friction);

 private:
  struct Lane;
  std::vector<std::unique_ptr<Lane>> lanes_;  // null where nothing acts
  bool any_ = false;
};

}  // namespace stiction::sim
