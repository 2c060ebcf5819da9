// Lost motion between the motor's carriage and the measured position, in front of one of two bodies; the drive closes
// its loop on what the encoder sees, and it begins in the middle of the gap.
// - A light one, without friction, as a probe or the scale itself: the play operator. The measured position y follows
//   the carriage x only where the gap is closed,
//     x - width/2 <= y <= x + width/2,
//   so at a reversal the carriage moves by `width` before the encoder sees any of it.
// - A heavy one, the slide behind a nut or a coupling, r of the mass M with its friction and all forces of the
//   surroundings: the motor, without friction, drives it by contacts of a stiffness k and damping d,
//     (1 - r) M x'' = F - f,  r M y'' = f - friction + ..,  f = 0 in the gap, else k (x - y -+ width/2) + d (x' - y'),
//   and a contact never pulls (Nordin, Gutman 2002). `frequency` is that of both masses in contact,
//   w^2 = k / (r (1 - r) M).
#pragma once

#include <algorithm>
#include <array>
#include <numbers>

#include "firmware/machine/model/machine.hpp"
#include "firmware/machine/model/parameter.hpp"

namespace stiction::sim {

class Backlash {
 public:
  struct Parameters {
    double width = 0.0;
    double mass_ratio = 0.0;
    double frequency = usual_frequency;
  };
  // Of a contact, in Hz: a stiff one, which a drive does not see; and its damping ratio.
  static constexpr double usual_frequency = 500.0, damping_ratio = 0.3;
  static constexpr std::string_view name = "backlash";
  static constexpr std::string_view text = "lost motion between motor and measured position";
  static constexpr bool several = false;
  static constexpr std::array<machine::Parameter<Parameters>, 3> parameters{{
      {"width", "m", machine::not_negative(), &Parameters::width, {}, "play, from contact to contact"},
      {"mass_ratio",
       "1",
       {0.0, 0.999},
       &Parameters::mass_ratio,
       0.0,
       "mass behind the gap, with the friction, over the whole; 0: nothing heavy is there, and the friction in front"},
      {"frequency", "Hz", machine::positive(2000.0), &Parameters::frequency, usual_frequency,
       "of a contact between the two masses, where mass_ratio is not 0"},
  }};

  // Throws EffectError for a heavy body behind a gap of an axis that has a shaft or an elastic mode there already.
  static void check_axis(const Parameters& p, const machine::AxisModel& axis);
  // In front of a heavy body.
  struct Contact {
    double mass_behind, mass_in_front;  // kg
    double stiffness;                   // N/m
    double damping;                     // N s/m
  };
  // `p`: with a mass_ratio; `mass` (kg): of both together.
  static Contact contact(const Parameters& p, double mass) {
    const double w = 2.0 * std::numbers::pi * p.frequency, behind = p.mass_ratio * mass;
    const double stiffness = w * w * behind * (1.0 - p.mass_ratio);
    return {behind, mass - behind, stiffness, 2.0 * damping_ratio * stiffness / w};
  }

  // In front of a light body. `position` (m): of the carriage at the start.
  Backlash(const Parameters& p, double position) : half_width_(0.5 * p.width), follower_(position) {}

  // Follows the carriage to `position` (m); returns whether the gap is closed, so that the follower moves with it.
  bool advance(double position) {
    const double before = follower_;
    follower_ = std::clamp(follower_, position - half_width_, position + half_width_);
    return follower_ != before;
  }
  double follower() const { return follower_; }  // m, y

 private:
  double half_width_;
  double follower_;
};

}  // namespace stiction::sim
