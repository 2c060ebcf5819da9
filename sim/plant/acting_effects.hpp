// What the mechanics and the effects of one axis do in the steps of its plant: the shaft between motor and carriage,
// forces on the carriage, its weight among them, the play in front of the encoder, and the errors of what it reads.
// What they change in the plant's parameters is done before, by plant_axis().
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "sim/effects/backlash/backlash.hpp"
#include "sim/effects/cross_axis_coupling/cross_axis_coupling.hpp"
#include "sim/effects/effects.hpp"
#include "sim/effects/encoder_subdivision_error/encoder_subdivision_error.hpp"
#include "sim/effects/force_saturation/force_saturation.hpp"
#include "sim/effects/given_force.hpp"
#include "sim/effects/load_dependent_friction/load_dependent_friction.hpp"
#include "sim/effects/structural_resonance/structural_resonance.hpp"
#include "sim/plant/brake.hpp"
#include "sim/plant/gravity.hpp"
#include "sim/plant/transmission_error.hpp"
#include "sim/plant/two_masses.hpp"

namespace stiction::sim {

class ActingEffects {
 public:
  // `axis` as plant_axis() returns it, at rest at `position` (m); its clock begins at `time` (s). Throws EffectError.
  // `step`: of the plant, s.
  ActingEffects(const machine::AxisModel& axis, double step, double position, double time = 0.0)
      : step_(step), start_(time), follower_(position) {
    if (axis.elastic()) add_shaft(axis, step, position);
    for (const auto& parameters : effects_of<StructuralResonance>(axis)) add_resonance(parameters, axis, step);
    for (const auto& parameters : effects_of<Backlash>(axis)) add_gap(parameters, axis, step, position);
    if (axis.gravity) {
      auto gravity = std::make_unique<Gravity>(axis, step);
      if (!effects_of<LoadDependentFriction>(axis).empty()) weight_ = gravity.get();
      forces_.push_back({std::move(gravity), false});
    }
    if (axis.brake) {
      auto brake = std::make_unique<Brake>(*axis.brake, axis.mass, step);
      brake_ = brake.get();
      forces_.push_back({std::move(brake), false});
    }
    for (const auto& parameters : effects_of<ForceSaturation>(axis)) saturation_.emplace(parameters, axis);
    for (const auto& parameters : effects_of<CrossAxisCoupling>(axis)) coupling_mass_ += parameters.mass;
    for (const EffectId id : all_effects())
      if (id->law.make_force != nullptr)
        for (const machine::Effect& effect : axis.effects)
          if (effect.name == id->name)
            forces_.push_back({id->law.make_force(effect.values, carriage(axis), axis), id->law.is_friction});
    for (const machine::Effect& effect : axis.effects)
      if (auto law = given_force(effect)) forces_.push_back({std::make_unique<FunctionForce>(std::move(law)), false});
    for (const auto& parameters : effects_of<EncoderSubdivisionError>(axis)) reading_.emplace_back(parameters);
  }

  bool any() const { return !forces_.empty() || play_ || !reading_.empty() || mode_ || saturation_ || coupled(); }
  bool coupled() const { return coupling_mass_ != 0.0; }  // with the other axis
  // Whether they are forces on the carriage alone, which advance() tells.
  bool only_forces() const {
    return !play_ && reading_.empty() && !mode_ && !saturation_ && !coupled() && brake_ == nullptr;
  }
  // What moves with the encoder: of an axis with an elastic mode the measured part alone.
  Body carriage(const machine::AxisModel& axis) const { return {mode_ ? mode_->load_mass() : axis.mass, step_}; }

  // Whether the brake is `released`, where there is one; the carriage is at `position`, m.
  void set_brake(bool released, double position) {
    if (brake_ != nullptr) brake_->set(released, position);
  }

  // Of the other axis, m/s^2; held until changed.
  void set_other_acceleration(double acceleration) { coupling_force_ = coupling_mass_ * acceleration; }

  // m/s, in the last step.
  double motor_lead_rate_change() const { return motor_apart() ? mode_->rate_change() : 0.0; }
  // From now on the shaft's damping is that of the middle of a step.
  void step_finely() {
    if (mode_) mode_->step_finely();
    if (behind_) behind_->step_finely();
  }
  // How friction on the motor alone changes its velocity (m/s) in a step under a force (N).
  void set_motor_friction(std::function<double(double, double)> friction) {
    mode_->set_motor_friction(std::move(friction));
  }
  // Of the motor against the carriage: m, m/s.
  double motor_lead() const { return motor_apart() ? mode_->motor_lead() : 0.0; }
  double motor_lead_rate() const { return motor_apart() ? mode_->motor_lead_rate() : 0.0; }
  // Force (N) of a motor whose force is proportional to its current but for the effects.
  double motor_force(double linear) const { return saturation_ ? saturation_->of_linear(linear) : linear; }
  // The same the other way about.
  double linear_force(double force) const { return saturation_ ? saturation_->linear_for(force) : force; }
  // What of the motor's force (N) reaches the carriage during one step, with the shaft's; ends with follow().
  double transmitted(double motor_force) {
    if (!mode_) return motor_force;
    on_other_body_ = motor_on_carriage_ ? 0.0 : motor_force;
    shaft_force_ = mode_->force();
    if (behind_) [[unlikely]] {
      force_from_behind_ = behind_->force();
      return shaft_force_ + force_from_behind_;
    }
    return motor_on_carriage_ ? motor_force + shaft_force_ : shaft_force_;
  }

  // Forces on the carriage during one step, N, positive in +x: those that are friction, and the others.
  struct Forces {
    double applied = 0.0;
    double friction = 0.0;
  };
  // From position (m) and velocity (m/s) at the beginning of the step, and the motor's mean force (N) in it.
  // `motor_force`: that mean, without what the effects add.
  Forces advance(double position, double velocity, double motor_force) {
    if (forces_.empty()) return forces(motor_force);
    state_ = {position, velocity, direction_.advance(velocity, step_), start_ + step_ * static_cast<double>(steps_++),
              motor_force};
    if (weight_ != nullptr) state_.weight = -weight_->force(state_);
    for (const Acting& effect : forces_) effect.force->advance(state_);
    return forces(motor_force);
  }
  // In the same step with another motor's force.
  Forces forces(double motor_force) const {
    auto state = state_;
    state.motor_force = motor_force;
    Forces sum{coupling_force_, 0.0};
    for (const Acting& effect : forces_)
      (effect.is_friction ? sum.friction : sum.applied) += effect.force->force(state);
    return sum;
  }

  // The carriage is at `position` (m) with `velocity` (m/s) at the end of a step that changed it by `change`. Returns
  // by how much the velocity behind the play changed: what the encoder's mount stands on.
  double follow(double position, double velocity, double change) {
    if (mode_) mode_->advance(on_other_body_, shaft_force_, velocity, change);
    if (behind_) [[unlikely]]
      behind_->advance(0.0, force_from_behind_, velocity, change);
    if (error_) [[unlikely]] {
      const auto ahead =
          error_->at(position, velocity, position + mode_->motor_lead(), velocity + mode_->motor_lead_rate());
      mode_->set_error(ahead.distance, ahead.rate);
    }
    if (!play_) {
      follower_ = position;
      return change;
    }
    closed_ = play_->advance(position);
    follower_ = play_->follower();
    const double before = std::exchange(follower_velocity_, closed_ ? velocity : 0.0);
    return follower_velocity_ - before;
  }
  double follower() const { return follower_; }  // m, the position behind the play
  bool closed() const { return closed_; }        // whether it moved with the carriage in the last step

  // What the encoder reads at `position` (m) less the position, m, and its slope.
  Harmonics::Point reading_error(double position) const {
    Harmonics::Point sum;
    for (const auto& error : reading_) {
      const auto one = error.at(position);
      sum.value += one.value;
      sum.slope += one.slope;
    }
    return sum;
  }

 private:
  struct Acting {
    std::unique_ptr<CarriageForce> force;
    bool is_friction;
  };
  // Of a programme's own.
  class FunctionForce : public CarriageForce {
   public:
    explicit FunctionForce(std::shared_ptr<const GivenForce::Law> law) : law_(std::move(law)) {}
    double force(const CarriageState& state) const override { return (*law_)(state); }

   private:
    std::shared_ptr<const GivenForce::Law> law_;
  };
  // The shaft of an elastic `axis`, whose load is at `position`, m.
  void add_shaft(const machine::AxisModel& axis, double step, double position) {
    Shaft shaft = Shaft::of(axis);
    for (const auto& parameters : effects_of<StructuralResonance>(axis))
      shaft.load_mass = StructuralResonance(parameters, shaft.load_mass).measured_mass;
    mode_.emplace(shaft, step);
    const TransmissionError error(axis);
    if (!error.any()) return;
    error_ = error;
    mode_->start_ahead(error.at(position, 0.0, position, 0.0).distance);
  }
  // A mode of the axis, or of a part of the load that hangs on the rest of it by a spring of its own.
  void add_resonance(const StructuralResonance::Parameters& parameters, const machine::AxisModel& axis, double step) {
    const StructuralResonance mode(parameters, axis.elastic() ? axis.mass - axis.motor_mass : axis.mass);
    const Shaft spring{mode.measured_mass, mode.other_mass, mode.stiffness, mode.damping};
    if (axis.elastic()) {
      behind_.emplace(spring, step);
      return;
    }
    mode_.emplace(spring, step);
    motor_on_carriage_ = mode.motor_measured;
  }
  void add_gap(const Backlash::Parameters& parameters, const machine::AxisModel& axis, double step, double position) {
    if (parameters.mass_ratio == 0.0) {
      play_.emplace(parameters, position);
      return;
    }
    const auto [behind, in_front, stiffness, damping] = Backlash::contact(parameters, axis.mass);
    mode_.emplace(Shaft{behind, in_front, stiffness, damping, parameters.width}, step);
  }
  bool motor_apart() const { return mode_ && !motor_on_carriage_; }

  double step_;
  std::optional<TwoMasses> mode_;
  std::optional<TwoMasses> behind_;  // of a load in two parts: the one that no shaft drives, against the other
  double force_from_behind_ = 0.0;   // N
  std::optional<TransmissionError> error_;
  std::optional<ForceSaturation> saturation_;
  double coupling_mass_ = 0.0, coupling_force_ = 0.0;
  double on_other_body_ = 0.0, shaft_force_ = 0.0;  // N
  bool motor_on_carriage_ = false;
  double start_;
  std::int64_t steps_ = 0;
  CarriageState state_{};
  std::vector<Acting> forces_;
  const Gravity* weight_ = nullptr;  // one of them, where an effect wants to know it
  Brake* brake_ = nullptr;           // one of them, where the axis has one
  SlidingDirection direction_;
  std::optional<Backlash> play_;
  std::vector<EncoderSubdivisionError> reading_;
  double follower_, follower_velocity_ = 0.0;  // m, m/s
  bool closed_ = true;
};

}  // namespace stiction::sim
