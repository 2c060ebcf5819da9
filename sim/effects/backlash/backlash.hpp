// Lost motion between the motor's carriage and the measured position: the play operator of the given width. The
// measured position y follows the carriage x only where the gap is closed,
//   x - width/2 <= y <= x + width/2,
// so at a reversal the carriage moves by `width` before the encoder sees any of it; the drive closes its loop on what
// the encoder sees. It begins in the middle of the gap.
#pragma once

#include <algorithm>
#include <array>

#include "firmware/machine/model/parameter.hpp"

namespace stiction::sim {

class Backlash {
 public:
  struct Parameters {
    double width = 0.0;
  };
  static constexpr std::string_view name = "backlash";
  static constexpr std::string_view text = "lost motion between motor and measured position";
  static constexpr bool several = false;
  static constexpr std::array<machine::Parameter<Parameters>, 1> parameters{{
      {"width", "m", machine::not_negative(), &Parameters::width, {}, "play, from contact to contact"},
  }};

  // `position` (m): of the carriage at the start.
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
