// One axis as a lane of a batch of plants: its numbers, and of what kind it is. Axes of one kind share a batch.
#pragma once

#include <compare>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"

namespace stiction::sim {

// What is the same in all lanes of a batch.
struct PlantKind {
  machine::MotorModel motor = machine::MotorModel::dc;
  std::string friction;      // the law
  int steps = 0;             // of the plant in a tick of the drive
  int change = 0;            // InverterModel: steps after which the voltage changes in a tick; 0: it does not
  std::size_t commands = 1;  // InverterModel: that are on their way

  auto operator<=>(const PlantKind&) const = default;
};

struct PlantLane {
  PlantKind kind;
  double half_step = 0.0;  // s
  double position = 0.0;   // m, at the start
  double encoder_increment = 0.0, increments_per_metre = 0.0;
  double viscous = 0.0;  // N s/m
  double voltage_limit = 0.0, share_before = 0.0;
  // The double objects of AxisPlant, number for number.
  std::vector<double> motor, friction, mount;
};

// `axis` at rest at `position` (m) as a lane; none for an axis whose plant has more than a batch covers: effects that
// are no forces on the carriage, an elastic shaft, a brake, noise, encoders of its own or a friction law without a
// batch. Forces of effects are those of LaneForces. `timing`: periods of the loops. Throws as AxisPlant.
std::optional<PlantLane> plant_lane(const machine::Timing& timing, const machine::AxisModel& axis, double position);

}  // namespace stiction::sim
