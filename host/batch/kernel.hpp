// What runs one batch of axes of one kind in closed loop: compiled once for each instruction set.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "firmware/machine/configuration/double_signals.hpp"
#include "sim/plant/axis_plant.hpp"
#include "sim/plant/batch/plant_lane.hpp"
#include "stiction/drive/axis.hpp"
#include "stiction/drive/friction_compensation.hpp"

namespace stiction::host {

using LaneSignals = machine::DoubleSignals;

// What is the same in all lanes of a batch.
struct BatchKind {
  std::int64_t period_ns = 0;
  int slow_ratio = 0;
  CurrentLoop current_loop = CurrentLoop::direct;
  VelocityFeedback velocity_feedback = VelocityFeedback::given;
  bool notch = false, quantizer = false;
  bool compensated = false;
  CompensationKind compensation = CompensationKind::off;
  std::uint32_t set_point_delay = 0;  // ticks
  std::uint32_t limit_cycle_window_ticks = 0;
  std::optional<sim::PlantKind> plant;  // none: each lane's plant is an AxisPlant of its own

  auto operator<=>(const BatchKind&) const = default;
};

// One axis of a batch.
struct BatchLane {
  BatchKind kind;
  AxisConfig<LaneSignals> axis;
  FrictionCompensationConfig<LaneSignals> compensation;
  std::optional<sim::PlantLane> plant;
  std::optional<machine::AxisModel> forces;   // as the plant has it, where effects act on the lane
  std::unique_ptr<sim::AxisPlant> own_plant;  // where there is no lane
};

// Set-points of one tick in SI units: a value a lane in each, or one for all lanes.
struct SetPointRows {
  const double *position, *velocity, *acceleration, *injection;
  bool shared = false;
};

// Values of one tick, in SI units.
enum class Row { x, v, i, i_set, e, e_held, motor_force, position };

class Kernel {
 public:
  Kernel() = default;
  Kernel(const Kernel&) = delete;
  Kernel& operator=(const Kernel&) = delete;
  virtual ~Kernel();

  virtual std::size_t lanes() const = 0;
  // Before start().
  virtual void set_lane(std::size_t lane, BatchLane& from) = 0;
  // The first tick, at time 0: all axes rest where they are.
  virtual void start() = 0;
  // On the carriages from now on, N, a value a lane.
  virtual void set_external_force(const double* force) = 0;
  // Controls a tick and moves the plants on to the next. `now_ns`: its time; `slow`: of the position controller.
  // `set`: its set-points.
  virtual void tick(const SetPointRows& set, std::int64_t now_ns, bool slow) = 0;
  // `out`: a value a lane, of the tick before; motor_force and position as the samples of the next one see them.
  virtual void row(Row row, double* out) const = 0;
  // A bit a lane that has a fault.
  virtual unsigned faulted() const = 0;
  virtual void signals(std::size_t lane, AxisSignals<LaneSignals>& out) const = 0;
  virtual void compensation(std::size_t lane, FrictionCompensationSignals<LaneSignals>& out) const = 0;
};

// Plants of lanes whose batch has none of its own, moved on one by one. A lane without one reads zeros.
class LanePlants {
 public:
  explicit LanePlants(std::size_t lanes);
  void set(std::size_t lane, std::unique_ptr<sim::AxisPlant> plant);
  void set_external_force(const double* force);  // N, a value a lane
  // A row of `lanes` values for each of three phases; `enabled`: a bit a lane.
  void command(const double* voltage, unsigned enabled);
  void advance_tick();
  // The encoders' readings, drawn once a tick; m, m/s.
  void read(double* position, double* velocity);
  // As command()'s voltages; A.
  void currents(double* rows) const;
  void motor_force(double* out) const;
  void position(double* out) const;

 private:
  std::vector<std::unique_ptr<sim::AxisPlant>> plants_;
};

// Kernels for `kind` by instruction set; null where this program or processor does not have the set.
std::unique_ptr<Kernel> make_kernel_sse2(const BatchKind& kind);
std::unique_ptr<Kernel> make_kernel_neon(const BatchKind& kind);
std::unique_ptr<Kernel> make_kernel_avx2(const BatchKind& kind);
std::unique_ptr<Kernel> make_kernel_avx512(const BatchKind& kind);

}  // namespace stiction::host
