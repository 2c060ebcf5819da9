// Motor and load with an elastic shaft between them: lead x_m - x, force f on the load,
//   m_m x_m'' = F - f,  m_l x'' = f - friction + ..,  f = k (x_m - x) + d (x_m' - x').
// With play of the width b the force is 0 within +-b/2 of the lead, and beyond it follows the rest of the lead; damping
// acts in contact alone, and never pulls (Nordin, Gutman 2002).
// A load that is ahead by the transmission's error e has that much less to be pulled: f = k (x_m - x + e) + d (..)'.
// A shaft that warms loses a share of its stiffness with a time constant, by steps of its own, without libm.
// In steps of position, velocity, position (Verlet 1967): the step itself neither damps nor drives, its frequency is
// (w h)^2/24 off.
#pragma once

#include <cmath>
#include <functional>
#include <utility>

#include "firmware/machine/model/machine.hpp"

namespace stiction::sim {

struct Shaft {
  double load_mass, motor_mass;  // kg
  double stiffness;              // N/m
  double damping;                // N s/m
  double backlash = 0.0;         // m
  double stiffness_loss = 0.0;   // share, when it is warm
  double warming_time = 0.0;     // s; 0: it keeps its stiffness

  // Of an axis whose transmission has a stiffness.
  static Shaft of(const machine::AxisModel& axis) {
    return {axis.mass - axis.motor_mass,
            axis.motor_mass,
            *axis.transmission->stiffness,
            axis.transmission->damping.value_or(0.0),
            axis.transmission->backlash,
            axis.transmission->stiffness_loss,
            axis.transmission->warming_time.value_or(0.0)};
  }
};

class TwoMasses {
 public:
  // `step`: of the plant, s.
  TwoMasses(const Shaft& shaft, double step)
      : step_(step),
        load_mass_(shaft.load_mass),
        step_per_motor_mass_(step / shaft.motor_mass),
        stiffness_(shaft.stiffness),
        damping_(shaft.damping),
        half_gap_(0.5 * shaft.backlash),
        cold_stiffness_(shaft.stiffness),
        stiffness_loss_(shaft.stiffness_loss),
        warming_(shaft.warming_time > 0.0 ? step / shaft.warming_time : 0.0) {}

  // Velocity of the motor (m/s) after a step, from the one before and the force on it (N); none: without friction.
  void set_motor_friction(std::function<double(double, double)> friction) { motor_friction_ = std::move(friction); }

  double load_mass() const { return load_mass_; }   // kg
  double motor_lead() const { return lead_; }       // m, x_m - x
  double motor_lead_rate() const { return rate_; }  // m/s

  double rate_change() const { return rate_change_; }  // m/s, in the last step
  // From now on the damping takes the rate of the middle of a step, as the step before foretells it.
  void step_finely() { ahead_ = 0.5; }

  // From now on the load is `ahead` (m) of its motor, and that changes by `rate` (m/s).
  void set_error(double ahead, double rate) {
    ahead_by_ = ahead;
    ahead_rate_ = rate;
  }
  // At the start, with a load that is `ahead` (m): the motor is where the shaft is without a force.
  void start_ahead(double ahead) {
    set_error(ahead, 0.0);
    lead_ = -ahead;
  }

  // Force (N) on the load during the step.
  double force() const {
    const double lead = lead_ + ahead_by_ + 0.5 * step_ * (rate_ + ahead_rate_);
    if (half_gap_ == 0.0) return stiffness_ * lead + damping_ * (rate_ + ahead_rate_ + ahead_ * rate_change_);
    if (std::abs(lead) <= half_gap_) return 0.0;
    const double pushed =
        stiffness_ * (lead - std::copysign(half_gap_, lead)) + damping_ * (rate_ + ahead_rate_ + ahead_ * rate_change_);
    return pushed * lead > 0.0 ? pushed : 0.0;
  }
  // Ends the step, with the motor's force (N), force(), the load's velocity (m/s) and its change. `motor_force` in N.
  void advance(double motor_force, double force, double velocity, double change) {
    const double next = motor_friction_ ? motor_friction_(velocity - change + rate_, motor_force - force) - velocity
                                        : rate_ + step_per_motor_mass_ * (motor_force - force) - change;
    lead_ += 0.5 * step_ * (rate_ + next);
    rate_change_ = next - rate_;
    rate_ = next;
    if (warming_ != 0.0) [[unlikely]] {
      warmth_ += warming_ * (1.0 - warmth_);
      stiffness_ = cold_stiffness_ * (1.0 - stiffness_loss_ * warmth_);
    }
  }

 private:
  double step_;
  double load_mass_;
  double step_per_motor_mass_;
  double stiffness_, damping_;
  double half_gap_;  // m
  double cold_stiffness_, stiffness_loss_;
  double warming_;       // share of what it is still colder than warm, in a step
  double warmth_ = 0.0;  // 0 cold, 1 warm
  double lead_ = 0.0, rate_ = 0.0;
  double ahead_by_ = 0.0, ahead_rate_ = 0.0;  // m, m/s, of the transmission's error
  double rate_change_ = 0.0, ahead_ = 0.0;
  std::function<double(double, double)> motor_friction_;
};

}  // namespace stiction::sim
