// Many axes in closed loop at once: each is an axis of a machine that runs by itself, with the firmware's cascade in
// double precision and its friction compensation. What comes out of each is what ControlRun<DoubleSignals> gives for a
// machine with that axis alone, to the bit, whatever else is in the batch.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/batch/instruction_set.hpp"
#include "host/batch/kernel.hpp"
#include "sim/experiment/set_point.hpp"
#include "stiction/drive/ticker.hpp"

namespace stiction::host {

class BatchRun {
 public:
  // One axis of the batch: axis `axis` of the `machine` at rest at `position`, m.
  struct Member {
    const machine::Machine* machine;
    std::size_t axis = 0;
    double position = 0.0;
  };

  // All `members` have the same periods of their loops. `set`: one of instruction_sets(). Throws
  // machine::ConfigurationError for no member, for an axis without the cascade and for one whose periods are others.
  explicit BatchRun(std::span<const Member> members, InstructionSet set = widest_instruction_set());

  std::size_t size() const { return places_.size(); }
  double time() const { return static_cast<double>(ticker_.now_ns()) * 1e-9; }  // s, of the tick that comes next

  // From outside on the carriages (N, positive in +x), a value a member, held until changed.
  void set_external_force(std::span<const double> force);

  // Controls one tick with a set-point a member, or one for all.
  void tick(std::span<const sim::AxisSetPoint> set_points);

  // Of the tick before, a value a member; motor_force and position as the samples of the next tick see them.
  void values(Row row, std::span<double> out);
  AxisSignals<LaneSignals> signals(std::size_t member) const;
  FrictionCompensationSignals<LaneSignals> compensation(std::size_t member) const;
  Fault fault(std::size_t member) const { return signals(member).fault; }
  // Whether any member has a fault: those go on without power, as the drive has them, and the others as they were.
  bool any_fault() const;

  // Members that share a batch of plants, and batches that run.
  std::size_t vectorised() const { return vectorised_; }
  std::size_t batches() const { return batches_.size(); }

 private:
  struct Place {
    std::size_t batch, lane;
  };
  struct Running {
    std::unique_ptr<Kernel> kernel;
    std::vector<double> rows;          // set-points: four rows of a value a lane
    std::vector<std::size_t> members;  // by lane; none of lanes that are left over
  };

  void add_batches(std::vector<BatchLane>& lanes, std::span<const Member> members, InstructionSet set);

  Ticker ticker_;
  std::vector<Running> batches_;
  std::vector<Place> places_;
  std::vector<double> row_;
  std::size_t vectorised_ = 0;
};

}  // namespace stiction::host
