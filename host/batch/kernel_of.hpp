// The kernel over an instruction set: the firmware's cascade with its friction compensation over BatchSignals, and a
// batch of plants or a plant for each lane. Included by one source for each set alone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>

#include "firmware/machine/batch/batch_lane.hpp"
#include "firmware/machine/batch/batch_signals.hpp"
#include "host/batch/kernel.hpp"
#include "sim/plant/batch/plant.hpp"
#include "sim/plant/friction/classical.hpp"
#include "sim/plant/friction/coulomb_viscous.hpp"
#include "sim/plant/friction/elasto_plastic.hpp"
#include "sim/plant/friction/linear_ramp.hpp"
#include "sim/plant/friction/lugre.hpp"

namespace stiction::host {

// As sim::BatchPlant, of plants that are moved on one by one.
template <class Isa>
class PlantsOfLanes {
 public:
  using Real = machine::Batch<Isa>;
  static constexpr std::size_t phases = 3;

  PlantsOfLanes() : plants_(Real::lanes) {}

  void set_lane(std::size_t k, BatchLane& lane) { plants_.set(k, std::move(lane.own_plant)); }
  void set_external_force(const double* force) { plants_.set_external_force(force); }
  void command(const sim::PhaseValuesOf<Real>& voltage, machine::BatchMask<Isa> enable) {
    std::array<double, 3 * Real::lanes> rows;
    for (std::size_t phase = 0; phase < 3; ++phase) voltage[phase].store(rows.data() + phase * Real::lanes);
    plants_.command(rows.data(), enable.bits());
  }
  void advance_tick() { plants_.advance_tick(); }
  struct Reading {
    Real position, velocity;
  };
  Reading read() {
    std::array<double, Real::lanes> position, velocity;
    plants_.read(position.data(), velocity.data());
    return {Real::load(position.data()), Real::load(velocity.data())};
  }
  sim::PhaseValuesOf<Real> current() const {
    std::array<double, 3 * Real::lanes> rows;
    plants_.currents(rows.data());
    sim::PhaseValuesOf<Real> current;
    for (std::size_t phase = 0; phase < 3; ++phase) current[phase] = Real::load(rows.data() + phase * Real::lanes);
    return current;
  }
  void motor_force(double* out) const { plants_.motor_force(out); }
  void position(double* out) const { plants_.position(out); }

 private:
  LanePlants plants_;
};

template <class Isa, template <class> class Motor, class Friction>
class PlantBatch : public sim::BatchPlant<Isa, Motor, Friction> {
 public:
  using Base = sim::BatchPlant<Isa, Motor, Friction>;
  using Real = machine::Batch<Isa>;
  using Base::Base;

  void set_lane(std::size_t k, BatchLane& lane) {
    Base::set_lane(k, *lane.plant);
    if (lane.forces) Base::set_forces(k, *lane.forces, 2.0 * lane.plant->half_step, lane.plant->position);
  }
  void set_external_force(const double* force) { Base::set_external_force(Real::load(force)); }
  struct Reading {
    Real position, velocity;
  };
  STICTION_INLINE Reading read() const { return {Base::read_encoder(), Base::encoder_velocity()}; }
  void motor_force(double* out) const { Base::motor_force().store(out); }
  void position(double* out) const { Base::position().store(out); }
};

// `flat`: with the whole cascade inline, for fewer instructions and a longer compilation.
template <class Isa, class Plant, bool flat>
class KernelOf final : public Kernel {
 public:
  using S = machine::BatchSignals<Isa>;
  using Real = machine::Batch<Isa>;
  using Mask = machine::BatchMask<Isa>;

  KernelOf(const BatchKind& kind, Plant&& plant)
      : compensated_(kind.compensated), axis_(AxisConfig<S>{}), plant_(std::move(plant)) {}

  std::size_t lanes() const override { return Real::lanes; }
  void set_lane(std::size_t lane, BatchLane& from) override {
    machine::set_lane(axis_config_, lane, from.axis);
    machine::set_lane(compensation_config_, lane, from.compensation);
    plant_.set_lane(lane, from);
  }
  void start() override {
    axis_ = Axis<S>(axis_config_);
    compensation_ = std::make_unique<FrictionCompensation<S>>(compensation_config_);
    sample(0);
    axis_.start(feedback_);
    compensation_->start(feedback_.position);
  }
  void set_external_force(const double* force) override { plant_.set_external_force(force); }
  // `rows`: set-points; `now_ns`: time of the tick; `slow`: whether it is one of the position controller.
  void tick(const SetPointRows& rows, std::int64_t now_ns, bool slow) override {
    if constexpr (flat)
      flat_tick(rows, now_ns, slow);
    else
      control(rows, now_ns, slow);
  }
  void row(Row row, double* out) const override {
    switch (row) {
      case Row::x:
        return signals_.x.store(out);
      case Row::v:
        return signals_.v.store(out);
      case Row::i:
        return signals_.i.store(out);
      case Row::i_set:
        return signals_.i_set.store(out);
      case Row::e:
        return signals_.e.store(out);
      case Row::e_held:
        return signals_.e_held.store(out);
      case Row::motor_force:
        return plant_.motor_force(out);
      case Row::position:
        return plant_.position(out);
    }
  }
  unsigned faulted() const override { return (!(axis_.fault() == machine::BatchFault<Isa>())).bits(); }
  void signals(std::size_t lane, AxisSignals<LaneSignals>& out) const override {
    machine::get_lane(signals_, lane, out);
  }
  void compensation(std::size_t lane, FrictionCompensationSignals<LaneSignals>& out) const override {
    machine::get_lane(compensation_signals_, lane, out);
  }

 private:
  // With the cascade inline.
  [[gnu::flatten]] void flat_tick(const SetPointRows& rows, std::int64_t now_ns, bool slow) {
    control(rows, now_ns, slow);
  }
  STICTION_INLINE void control(const SetPointRows& rows, std::int64_t now_ns, bool slow) {
    SetPoint<S> set = set_point(rows);
    if (compensated_) compensation_->step(set, compensation_signals_);
    const auto command = axis_.tick(set, feedback_, now_ns, slow, signals_);
    if (compensated_) compensation_->observe(signals_, compensation_signals_);
    plant_.command(command.voltage, command.enable);
    plant_.advance_tick();
    sample(now_ns + axis_config_.period_ns);
  }

  STICTION_INLINE static Real value(const SetPointRows& rows, const double* row) {
    return rows.shared ? Real(*row) : Real::load(row);
  }
  // As sim::to_set_point(): what is not a number makes its lane's set-point invalid and is not looked at.
  STICTION_INLINE static SetPoint<S> set_point(const SetPointRows& rows) {
    const Real x = value(rows, rows.position), v = value(rows, rows.velocity), a = value(rows, rows.acceleration),
               given = value(rows, rows.injection);
    SetPoint<S> set{x, v, a};
    const Mask finite = is_finite(x + v + a), injected = given != 0.0, possible = is_finite(given);
    set.valid = finite && (!injected || possible);
    set.injection = select(injected && possible, given, Real());
    if (all(finite)) [[likely]]
      return set;
    set.position = select(finite, x, Real());
    set.velocity = select(finite, v, Real());
    set.acceleration = select(finite, a, Real());
    return set;
  }

  // As SimulatedBackend's.
  STICTION_INLINE void sample(std::int64_t now_ns) {
    const auto reading = plant_.read();
    const auto current = plant_.current();
    feedback_.position_time_ns = now_ns;
    feedback_.position_valid = is_finite(reading.position + reading.velocity);
    assign(feedback_.position_valid, feedback_.position, reading.position);
    assign(feedback_.position_valid, feedback_.velocity, reading.velocity);
    const Mask first = is_finite(current[0]);
    assign(first, feedback_.current[0], current[0]);
    feedback_.fault = !first;
    if constexpr (Plant::phases == 3) {
      const Mask others = is_finite(current[1] + current[2]);
      assign(others, feedback_.current[1], current[1]);
      assign(others, feedback_.current[2], current[2]);
      feedback_.fault |= !others;
    }
  }

  bool compensated_;
  AxisConfig<S> axis_config_{};
  FrictionCompensationConfig<S> compensation_config_{};
  Axis<S> axis_;
  std::unique_ptr<FrictionCompensation<S>> compensation_;
  Plant plant_;
  Feedback<S> feedback_{};
  AxisSignals<S> signals_{};
  FrictionCompensationSignals<S> compensation_signals_{};
};

template <class Isa, bool flat, class Plant>
std::unique_ptr<Kernel> kernel_with(const BatchKind& kind, Plant&& plant) {
  return std::make_unique<KernelOf<Isa, Plant, flat>>(kind, std::move(plant));
}

template <class Isa, class Friction>
std::unique_ptr<Kernel> kernel_with_friction(const BatchKind& kind) {
  constexpr bool flat = std::is_same_v<Friction, sim::LuGre<machine::Batch<Isa>>>;  // what most machines have
  switch (kind.plant->motor) {
    case machine::MotorModel::dc:
      return kernel_with<Isa, flat>(kind, PlantBatch<Isa, sim::DcMotorOf, Friction>(*kind.plant));
    case machine::MotorModel::synchronous:
      return kernel_with<Isa, flat>(kind, PlantBatch<Isa, sim::SynchronousMotorOf, Friction>(*kind.plant));
    case machine::MotorModel::force:
      return kernel_with<Isa, flat>(kind, PlantBatch<Isa, sim::ForceSourceOf, Friction>(*kind.plant));
  }
  return nullptr;
}

template <class Isa>
std::unique_ptr<Kernel> make_kernel(const BatchKind& kind) {
  if (!kind.plant) return kernel_with<Isa, false>(kind, PlantsOfLanes<Isa>());
  using Real = machine::Batch<Isa>;
  std::unique_ptr<Kernel> made;
  const auto try_law = [&]<class Law>() {
    if (kind.plant->friction == Law::name) made = kernel_with_friction<Isa, Law>(kind);
  };
  try_law.template operator()<sim::LuGre<Real>>();
  try_law.template operator()<sim::ElastoPlastic<Real>>();
  try_law.template operator()<sim::LinearRamp<Real>>();
  try_law.template operator()<sim::Classical<Real>>();
  try_law.template operator()<sim::CoulombViscous<Real>>();
  return made;
}

}  // namespace stiction::host
