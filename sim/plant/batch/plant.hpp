// AxisPlant over batches: the same motors, friction laws and encoder mounts, each lane an axis. A lane whose power
// stage is off goes on without a motor; the others are not touched by it.
#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <vector>

#include "firmware/machine/batch/batch.hpp"
#include "sim/plant/batch/arithmetic.hpp"
#include "sim/plant/batch/lane_forces.hpp"
#include "sim/plant/batch/plant_lane.hpp"
#include "sim/plant/encoder_mount.hpp"
#include "sim/plant/motor.hpp"
#include "sim/plant/plant_steps.hpp"

namespace stiction::sim {

// Takes the numbers of an object over doubles into lane `k` of one over batches, which has as many.
template <class Isa, class Object>
STICTION_INLINE void set_lane(Object& object, std::size_t k, const double* numbers) {
  using Real = machine::Batch<Isa>;
  static_assert(std::is_trivially_copyable_v<Object> && sizeof(Object) % sizeof(Real) == 0);
  char* const bytes = reinterpret_cast<char*>(&object) + k * sizeof(double);
  for (std::size_t i = 0; i < sizeof(Object) / sizeof(Real); ++i)
    std::memcpy(bytes + i * sizeof(Real), numbers + i, sizeof(double));
}

// An object that set_lane() fills.
template <class Isa, class Object>
STICTION_INLINE Object zeroed() {
  return __builtin_bit_cast(Object, std::array<machine::Batch<Isa>, sizeof(Object) / sizeof(machine::Batch<Isa>)>{});
}

template <class Isa, template <class> class Motor, class Friction>
class BatchPlant {
 public:
  using Real = machine::Batch<Isa>;
  using Mask = machine::BatchMask<Isa>;
  static constexpr std::size_t phases = Motor<Real>::phases;

  explicit BatchPlant(const PlantKind& kind)
      : forces_(Real::lanes),
        steps_(kind.steps),
        change_(kind.change),
        evenly_(kind.change == 0 && kind.steps == plant_steps_per_tick) {
    commands_.resize(kind.commands);
  }

  void set_lane(std::size_t k, const PlantLane& lane) {
    sim::set_lane<Isa>(motor_, k, lane.motor.data());
    sim::set_lane<Isa>(friction_, k, lane.friction.data());
    sim::set_lane<Isa>(mount_, k, lane.mount.data());
    half_step_.set_lane(k, lane.half_step);
    position_.set_lane(k, lane.position);
    encoder_increment_.set_lane(k, lane.encoder_increment);
    increments_per_metre_.set_lane(k, lane.increments_per_metre);
    viscous_.set_lane(k, lane.viscous);
    voltage_limit_.set_lane(k, lane.voltage_limit);
    share_before_.set_lane(k, lane.share_before);
  }
  // Of the effects of `axis`, for lane `k` at rest at `position`, m; `step`: of the plant, s.
  void set_forces(std::size_t k, const machine::AxisModel& axis, double step, double position) {
    forces_.set(k, axis, step, position);
  }

  STICTION_INLINE void command(const PhaseValuesOf<Real>& voltage, Mask enable) {
    enabled_ = enable;
    command_ = voltage;
    if (all(enable)) [[likely]]
      return;
    for (auto& u : command_) u = select(enable, u, Real());
    for (auto& past : commands_)
      for (auto& u : past) u = select(enable, u, Real());
  }
  STICTION_INLINE void set_external_force(Real force) { external_force_ = force; }

  STICTION_INLINE void advance_tick() {
    for (std::size_t k = 0; k < phases; ++k) commands_[oldest_][k] = limited(command_[k]);
    oldest_ = after(oldest_);
    if (evenly_ && all(enabled_) && !forces_.any()) [[likely]]
      advance_evenly();
    else
      advance_unevenly();
  }

  STICTION_INLINE Real position() const { return position_; }
  STICTION_INLINE Real velocity() const { return velocity_; }
  STICTION_INLINE Real motor_force() const { return motor_force_; }
  STICTION_INLINE const PhaseValuesOf<Real>& current() const { return current_; }
  STICTION_INLINE Real encoder_velocity() const { return velocity_ + 0.0 + mount_.velocity(); }
  STICTION_INLINE Real read_encoder() const {
    const Real reading = position_ + 0.0 + mount_.deflection();
    const Real increments = reading * increments_per_metre_;
    constexpr double no_fraction = 0x1.8p52;
    const Real whole = increments + no_fraction - no_fraction;
    return select(absolute(increments) < 0x1p51, encoder_increment_ * whole, reading);
  }

 private:
  STICTION_INLINE Real limited(Real voltage) const {
    const Real above = select(voltage < -voltage_limit_, -voltage_limit_, voltage);
    return select(above > voltage_limit_, voltage_limit_, above);
  }
  STICTION_INLINE std::size_t after(std::size_t slot) const { return slot + 1 == commands_.size() ? 0 : slot + 1; }

  STICTION_INLINE void advance_evenly() {
    const PhaseValuesOf<Real> voltage = commands_[oldest_];
    static_assert(plant_steps_per_tick == 4);
    step<false, true, false>(voltage);
    step<false, true, false>(voltage);
    step<false, true, false>(voltage);
    step<false, true, false>(voltage);
    current_ = motor_.current();
  }
  [[gnu::noinline]] void advance_unevenly() {
    const PhaseValuesOf<Real>& before = commands_[oldest_];
    const PhaseValuesOf<Real>& after_change = commands_[change_ != 0 ? after(oldest_) : oldest_];
    PhaseValuesOf<Real> between;
    for (std::size_t k = 0; k < between.size(); ++k)
      between[k] =
          select(share_before_ == 1.0, before[k], share_before_ * before[k] + (1.0 - share_before_) * after_change[k]);
    for (int i = 0; i < steps_; ++i) {
      const auto& voltage = i >= change_ ? after_change : i + 1 < change_ ? before : between;
      if (steps_ == plant_steps_per_tick)
        step<false, false, true>(voltage);
      else
        step<true, false, true>(voltage);
    }
    if (!all(enabled_)) switch_off();
    current_ = motor_.current();
  }
  // Of a motor that is off nothing flows on.
  void switch_off() {
    using Numbers = std::array<Real, sizeof(Motor<Real>) / sizeof(Real)>;
    auto stopped = motor_;
    stopped.switch_off();
    auto kept = __builtin_bit_cast(Numbers, motor_);
    const auto off = __builtin_bit_cast(Numbers, stopped);
    for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = select(enabled_, kept[i], off[i]);
    motor_ = __builtin_bit_cast(Motor<Real>, kept);
  }

  // As AxisPlant's. `all_on`: no lane is off; `effects`: lanes may have forces of their own.
  template <bool fine, bool all_on, bool effects>
  STICTION_INLINE void step(const PhaseValuesOf<Real>& voltage) {
    Real at = velocity_;
    if constexpr (fine) at = select(enabled_, velocity_ + 0.5 * change_of_velocity_, velocity_);
    motor_force_ = motor_.advance(voltage, position_, at);
    if constexpr (!all_on) motor_force_ = select(enabled_, motor_force_, Real());
    Real on_friction = motor_force_ + external_force_;
    if constexpr (effects)
      if (forces_.any()) on_friction = with_forces(on_friction);
    if constexpr (fine)
      on_friction =
          select(enabled_ && velocity_ != 0.0, on_friction + 0.5 * viscous_ * change_of_velocity_, on_friction);
    const Real next = friction_.advance(velocity_, on_friction);
    change_of_velocity_ = next - velocity_;
    position_ += half_step_ * (velocity_ + next);
    velocity_ = next;
    mount_.advance(change_of_velocity_);
  }

  // A force on the carriage with those of the lanes' effects, for the step that begins.
  [[gnu::noinline]] Real with_forces(Real force) {
    std::array<double, Real::lanes> position, velocity, motor_force, applied, friction;
    position_.store(position.data());
    velocity_.store(velocity.data());
    motor_force_.store(motor_force.data());
    forces_.advance(position.data(), velocity.data(), motor_force.data(), applied.data(), friction.data());
    return force + Real::load(applied.data()) + Real::load(friction.data());
  }

  LaneForces forces_;
  Real position_, velocity_, change_of_velocity_, motor_force_;
  Motor<Real> motor_ = zeroed<Isa, Motor<Real>>();
  Friction friction_ = zeroed<Isa, Friction>();
  EncoderMountModelOf<Real> mount_ = zeroed<Isa, EncoderMountModelOf<Real>>();
  Real half_step_, external_force_, viscous_;
  Mask enabled_;
  PhaseValuesOf<Real> command_{}, current_{};
  Real voltage_limit_, share_before_, encoder_increment_, increments_per_metre_;
  int steps_, change_;
  bool evenly_;
  std::vector<PhaseValuesOf<Real>> commands_;
  std::size_t oldest_ = 0;
};

}  // namespace stiction::sim
