#include "host/batch/batch_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/configuration/compensation_configuration.hpp"
#include "sim/effects/effects.hpp"

namespace stiction::host {
namespace {

constexpr std::size_t set_point_rows = 4;

std::unique_ptr<Kernel> make_kernel_of(InstructionSet set, const BatchKind& kind) {
  switch (set) {
    case InstructionSet::sse2:
      return make_kernel_sse2(kind);
    case InstructionSet::neon:
      return make_kernel_neon(kind);
    case InstructionSet::avx2:
      return make_kernel_avx2(kind);
    case InstructionSet::avx512:
      return make_kernel_avx512(kind);
  }
  return nullptr;
}

void require_member(const machine::AxisModel& axis) {
  if (!axis.cascaded())
    throw machine::ConfigurationError(
        fmt::format("axis {}: found a controller.structure of its own; expected the cascade, which is what a batch of "
                    "axes has",
                    axis.name));
}

BatchLane lane_of(const BatchRun::Member& member) {
  const machine::Machine& machine = *member.machine;
  const machine::AxisModel& axis = machine.axes.at(member.axis);
  require_member(axis);
  BatchLane lane;
  lane.axis = machine::configure_axis<LaneSignals>(machine.timing, sim::drive_axis(axis));
  auto& kind = lane.kind;
  kind.period_ns = machine::fast_period_ns(machine.timing);
  kind.slow_ratio = machine::slow_ratio(machine.timing);
  kind.current_loop = lane.axis.current_loop;
  kind.velocity_feedback = lane.axis.velocity_feedback;
  kind.notch = lane.axis.notch.enabled;
  kind.quantizer = lane.axis.quantizer.enabled;
  kind.limit_cycle_window_ticks = lane.axis.limit_cycle_window_ticks;
  machine::Machine alone = machine;
  alone.axes = {axis};
  const auto compensations = machine::configure_compensations<LaneSignals>(alone);
  kind.compensated = !compensations.empty();
  if (kind.compensated) {
    lane.compensation = compensations.front();
    kind.compensation = lane.compensation.kind;
    kind.set_point_delay = lane.compensation.set_point_delay;
  }
  lane.plant = sim::plant_lane(machine.timing, axis, member.position);
  if (lane.plant) {
    kind.plant = lane.plant->kind;
    lane.forces = sim::plant_axis(axis);
  }
  return lane;
}

std::unique_ptr<sim::AxisPlant> own_plant(const BatchRun::Member& member) {
  constexpr std::uint64_t seed = 1;  // of a machine's first axis
  return std::make_unique<sim::AxisPlant>(member.machine->timing, member.machine->axes[member.axis], member.position,
                                          seed);
}

}  // namespace

BatchRun::BatchRun(std::span<const Member> members, InstructionSet set) : ticker_(1, 1), places_(members.size()) {
  if (members.empty()) throw machine::ConfigurationError("batch: found no axis; expected at least one");
  std::vector<BatchLane> lanes;
  for (const auto& member : members) lanes.push_back(lane_of(member));
  const auto& first = lanes.front().kind;
  for (std::size_t k = 0; k < lanes.size(); ++k)
    if (lanes[k].kind.period_ns != first.period_ns || lanes[k].kind.slow_ratio != first.slow_ratio)
      throw machine::ConfigurationError(
          fmt::format("axis {}: found a fast period of {} ns and {} of them in a slow one; expected {} ns and {}, as "
                      "the first axis of the batch has",
                      members[k].machine->axes[members[k].axis].name, lanes[k].kind.period_ns, lanes[k].kind.slow_ratio,
                      first.period_ns, first.slow_ratio));
  ticker_ = Ticker(first.period_ns, static_cast<std::uint32_t>(first.slow_ratio));
  add_batches(lanes, members, set);
}

void BatchRun::add_batches(std::vector<BatchLane>& lanes, std::span<const Member> members, InstructionSet set) {
  std::map<BatchKind, std::vector<std::size_t>> kinds;
  for (std::size_t k = 0; k < lanes.size(); ++k) kinds[lanes[k].kind].push_back(k);
  std::size_t widest = 0;
  for (const auto& [kind, of_kind] : kinds) {
    if (kind.plant) vectorised_ += of_kind.size();
    for (std::size_t begin = 0; begin < of_kind.size();) {
      Running running{make_kernel_of(set, kind), {}, {}};
      if (!running.kernel)
        throw machine::ConfigurationError(
            fmt::format("instruction set: found {}, which this program or processor does not have; expected {}",
                        name_of(set), name_of(widest_instruction_set())));
      const std::size_t width = running.kernel->lanes();
      widest = std::max(widest, width);
      running.rows.resize(set_point_rows * width);
      for (std::size_t lane = 0; lane < width; ++lane) {
        // Lanes that are left over repeat the last member, without what acts lane by lane; they are not looked at.
        const bool left_over = begin + lane >= of_kind.size();
        const std::size_t member = left_over ? of_kind.back() : of_kind[begin + lane];
        if (left_over) {
          lanes[member].forces.reset();
        } else {
          places_[member] = {batches_.size(), lane};
          if (!kind.plant) lanes[member].own_plant = own_plant(members[member]);
          running.members.push_back(member);
        }
        running.kernel->set_lane(lane, lanes[member]);
      }
      running.kernel->start();
      batches_.push_back(std::move(running));
      begin += width;
    }
  }
  row_.resize(widest);
}

void BatchRun::tick(std::span<const sim::AxisSetPoint> set_points) {
  if (set_points.size() == 1) {
    const auto& point = set_points.front();
    const SetPointRows all{&point.position, &point.velocity, &point.acceleration, &point.injection, true};
    for (auto& batch : batches_) batch.kernel->tick(all, ticker_.now_ns(), ticker_.slow());
    return ticker_.advance();
  }
  for (auto& batch : batches_) {
    const std::size_t width = batch.kernel->lanes();
    double* const rows = batch.rows.data();
    for (std::size_t lane = 0; lane < width; ++lane) {
      const auto& point = set_points[batch.members[std::min(lane, batch.members.size() - 1)]];
      rows[lane] = point.position;
      rows[width + lane] = point.velocity;
      rows[2 * width + lane] = point.acceleration;
      rows[3 * width + lane] = point.injection;
    }
    batch.kernel->tick({rows, rows + width, rows + 2 * width, rows + 3 * width}, ticker_.now_ns(), ticker_.slow());
  }
  ticker_.advance();
}

void BatchRun::set_external_force(std::span<const double> force) {
  for (auto& batch : batches_) {
    for (std::size_t lane = 0; lane < batch.members.size(); ++lane) row_[lane] = force[batch.members[lane]];
    batch.kernel->set_external_force(row_.data());
  }
}

void BatchRun::values(Row row, std::span<double> out) {
  for (auto& batch : batches_) {
    batch.kernel->row(row, row_.data());
    for (std::size_t lane = 0; lane < batch.members.size(); ++lane) out[batch.members[lane]] = row_[lane];
  }
}

AxisSignals<LaneSignals> BatchRun::signals(std::size_t member) const {
  AxisSignals<LaneSignals> signals;
  const Place place = places_[member];
  batches_[place.batch].kernel->signals(place.lane, signals);
  return signals;
}

FrictionCompensationSignals<LaneSignals> BatchRun::compensation(std::size_t member) const {
  FrictionCompensationSignals<LaneSignals> signals;
  const Place place = places_[member];
  batches_[place.batch].kernel->compensation(place.lane, signals);
  return signals;
}

bool BatchRun::any_fault() const {
  return std::ranges::any_of(batches_, [](const Running& batch) {
    const unsigned in_use = ~0U >> (8 * sizeof(unsigned) - batch.members.size());
    return (batch.kernel->faulted() & in_use) != 0;
  });
}

}  // namespace stiction::host
