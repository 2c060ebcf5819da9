#include "host/simulate/replay_together.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "host/batch/batch_run.hpp"
#include "host/simulate/injection.hpp"
#include "host/simulate/late_set_points.hpp"
#include "host/simulate/on_all_cores.hpp"
#include "host/simulate/replay.hpp"
#include "host/simulate/replay_motion.hpp"
#include "host/simulate/replay_sampler.hpp"
#include "host/simulate/swing_time.hpp"
#include "sim/plant/batch/plant_lane.hpp"

namespace stiction::host {
namespace {

// What a batch has lanes for, and what it tells of them is all that a replay keeps.
bool has_lane(const ReplayOf& one) {
  if (one.machine->axes.size() != 1 || one.log->axes.size() != 1) return false;
  const auto& axis = one.machine->axes.front();
  return axis.cascaded() && !axis.modulo_counts && !axis.second_encoder;
}

// Lanes that are worth a batch: it takes as long as two runs alone, or, where each lane's plant goes on by itself,
// three.
constexpr std::size_t fewest = 3, fewest_with_plants = 4;

// One of the replays, with a way that others may go too.
struct Lane {
  std::size_t index;  // among those that were asked for
  const machine::Machine* machine;
  const Log* log;
  std::size_t motion;       // among the Motions
  double zero = 0.0;        // s
  double length = 0.0;      // s
  bool vectorised = false;  // its plant, too

  const machine::AxisModel& axis() const { return machine->axes.front(); }
  const AxisLog& channels() const { return log->axes.front(); }
  // Lanes of one kind may share a batch.
  std::tuple<bool, double, double> kind() const {
    return {vectorised, machine->timing.fast_period, machine->timing.slow_period};
  }
};

// The ways of all lanes: those that go the same way share one, since it takes longer to make than to go.
class Motions {
 public:
  std::size_t of(const Lane& lane) {
    for (std::size_t k = 0; k < known_.size(); ++k)
      if (same(known_[k].first, lane)) return k;
    known_.push_back(
        {lane,
         {ReplayMotion(*lane.log, lane.channels(), lane.axis()), Injection(*lane.log, lane.channels(), lane.axis())}});
    return known_.size() - 1;
  }
  const ReplayMotion& motion(std::size_t k) const { return known_[k].second.motion; }
  sim::AxisSetPoint at(std::size_t k, double t) const {
    auto point = known_[k].second.motion.at(t);
    point.injection = known_[k].second.injection.at(t);
    return point;
  }

 private:
  struct Way {
    ReplayMotion motion;
    Injection injection;
  };
  // Whether two axes are led the same way: of what a motion takes from an axis nothing differs.
  static bool same(const Lane& a, const Lane& b) {
    const auto facts = [](const Lane& lane) {
      const auto& axis = lane.axis();
      return std::tuple(axis.modulo, axis.travel, axis.max_velocity, axis.motor.model, swing_time(axis),
                        lane.machine->timing.slow_period, lane.log->t.front(), lane.log->period, lane.log->t.size());
    };
    if (facts(a) != facts(b)) return false;
    const auto &one = a.channels(), &other = b.channels();
    return one.x_set == other.x_set && one.v_set == other.v_set && one.a_set == other.a_set &&
           one.i_inject == other.i_inject && one.u_inject == other.u_inject;
  }

  std::vector<std::pair<Lane, Way>> known_;
};

// Lanes that run together, to the end of the longest.
class Together {
 public:
  Together(std::span<const Lane> lanes, const Motions& motions) : lanes_(lanes), motions_(motions) {
    std::vector<BatchRun::Member> members;
    for (const auto& lane : lanes_) {
      members.push_back({lane.machine, 0, motions_.motion(lane.motion).at(lane.zero).position});
      samplers_.emplace_back(*lane.log, std::vector<std::size_t>{0}, *lane.machine);
      late_.emplace_back(*lane.machine);
      pushed_ = pushed_ || !lane.channels().external_force.empty();
    }
    run_.emplace(members);
    for (auto* row : {&x_, &v_, &i_, &i_set_, &force_, &external_}) row->resize(lanes_.size());
    points_.resize(lanes_.size());
    faults_.resize(lanes_.size());
  }

  void operator()(std::vector<std::optional<Replayed>>& results) {
    while (std::ranges::any_of(lanes_, [&](const Lane& lane) { return runs(lane); })) tick();
    for (std::size_t k = 0; k < lanes_.size(); ++k) {
      auto& result = results[lanes_[k].index];
      if (faults_[k]) {
        result = *faults_[k];
        continue;
      }
      auto log = samplers_[k].finish();
      finish_replay(log.axes.front(), lanes_[k].channels(), lanes_[k].axis(), motions_.motion(lanes_[k].motion));
      result = std::move(log);
    }
  }

 private:
  std::size_t place(const Lane& lane) const { return static_cast<std::size_t>(&lane - lanes_.data()); }
  bool runs(const Lane& lane) const { return !faults_[place(lane)] && !samplers_[place(lane)].done(); }

  void tick() {
    const double now = run_->time();
    for (std::size_t k = 0; k < lanes_.size(); ++k) lead(k, now);
    if (pushed_) run_->set_external_force(external_);
    run_->values(Row::motor_force, force_);
    run_->tick(points_);
    run_->values(Row::x, x_);
    run_->values(Row::v, v_);
    run_->values(Row::i, i_);
    run_->values(Row::i_set, i_set_);
    for (std::size_t k = 0; k < lanes_.size(); ++k) {
      sample_.assign(1, {x_[k], v_[k], i_[k], i_set_[k], force_[k]});
      samplers_[k].add(lanes_[k].zero + now, sample_);
    }
    if (run_->any_fault()) [[unlikely]]
      take_faults(now);
  }

  // Set-point and external force of a lane for the tick at `now`, s.
  void lead(std::size_t k, double now) {
    const auto& lane = lanes_[k];
    const double t = lane.zero + now;
    const bool as_before = k > 0 && lanes_[k - 1].motion == lane.motion && lanes_[k - 1].zero == lane.zero;
    if (!as_before) given_ = motions_.at(lane.motion, t);
    points_[k] = late_[k].any() ? late_[k]({&given_, 1}).front() : given_;
    if (!lane.channels().external_force.empty()) external_[k] = at_time(*lane.log, lane.channels().external_force, t);
  }

  void take_faults(double now) {
    for (std::size_t k = 0; k < lanes_.size(); ++k)
      if (const auto fault = run_->fault(k); fault != Fault::none && runs(lanes_[k]))
        faults_[k].emplace(lanes_[k].axis().name, fault, now);
  }

  std::span<const Lane> lanes_;
  const Motions& motions_;
  std::optional<BatchRun> run_;
  std::vector<ReplaySampler> samplers_;
  std::vector<LateSetPoints> late_;
  std::vector<sim::AxisSetPoint> points_;
  sim::AxisSetPoint given_;
  std::vector<double> x_, v_, i_, i_set_, force_, external_;
  std::vector<ReplaySample> sample_;
  std::vector<std::optional<FaultTripped>> faults_;
  bool pushed_ = false;
};

Replayed alone(const ReplayOf& one) {
  try {
    return has_lane(one) ? replay_linear<machine::DoubleSignals>(*one.machine, *one.log)
                         : replay_linear_as_held(*one.machine, *one.log);
  } catch (const FaultTripped& fault) {
    return fault;
  }
}

}  // namespace

std::vector<Replayed> replay_together(std::span<const ReplayOf> which) {
  std::vector<Lane> lanes;
  std::vector<std::size_t> others;
  Motions motions;
  for (std::size_t k = 0; k < which.size(); ++k) {
    if (!has_lane(which[k])) {
      others.push_back(k);
      continue;
    }
    Lane lane{k, which[k].machine, which[k].log, 0};
    lane.motion = motions.of(lane);
    const double lead_in = motions.motion(lane.motion).lead_in();
    lane.zero = replay_zero(*lane.machine, *lane.log, lead_in);
    lane.length = lane.log->t.back() - lane.zero;
    lane.vectorised = sim::plant_lane(lane.machine->timing, lane.axis(), 0.0).has_value();
    lanes.push_back(lane);
  }
  const std::size_t width = lanes_of(widest_instruction_set());
  // Those of a batch are alike and end together, and those that go one way are neighbours.
  std::ranges::stable_sort(lanes, [](const Lane& a, const Lane& b) {
    return std::tuple(a.kind(), a.length, a.motion) > std::tuple(b.kind(), b.length, b.motion);
  });
  std::vector<std::span<const Lane>> batches;
  for (std::size_t begin = 0, end = 0; begin < lanes.size(); begin = end) {
    while (end < lanes.size() && end - begin < width && lanes[end].kind() == lanes[begin].kind()) ++end;
    const auto batch = std::span<const Lane>(lanes).subspan(begin, end - begin);
    if (batch.size() >= (batch.front().vectorised ? fewest : fewest_with_plants))
      batches.push_back(batch);
    else
      for (const auto& lane : batch) others.push_back(lane.index);
  }
  std::vector<std::optional<Replayed>> results(which.size());
  on_all_cores(batches.size() + others.size(), [&](std::size_t k) {
    if (k < batches.size()) return Together(batches[k], motions)(results);
    const std::size_t index = others[k - batches.size()];
    results[index] = alone(which[index]);
  });
  std::vector<Replayed> all;
  for (auto& result : results) all.push_back(std::move(*result));
  return all;
}

}  // namespace stiction::host
