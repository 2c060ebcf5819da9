// From the unit of a log's column to the unit of the channel, value by value.
#pragma once

#include <cmath>
#include <string>
#include <string_view>

#include "firmware/machine/file/units.hpp"

namespace stiction::host {

class UnitScale {
 public:
  UnitScale() = default;  // the channel's own unit
  // Throws sim::UnitError for an unknown unit, or one of another dimension than `channel_unit`.
  UnitScale(std::string_view unit, std::string_view channel_unit) {
    if (unit == channel_unit) return;
    const std::string text(unit);
    offset_ = machine::parse_quantity("0 " + text, channel_unit);
    factor_ = machine::parse_quantity("1 " + text, channel_unit) - offset_;
    // 1e-3 is no double, 1000 is: dividing rounds once, and 62.5 mm is the double 62.5e-3.
    const double inverse = std::round(1.0 / factor_);
    if (offset_ == 0.0 && std::abs(factor_) < 1.0 && std::abs(inverse * factor_ - 1.0) < 1e-14) divisor_ = inverse;
  }

  double operator()(double value) const { return divisor_ != 1.0 ? value / divisor_ : value * factor_ + offset_; }
  double factor() const { return factor_; }

 private:
  double factor_ = 1.0;
  double divisor_ = 1.0;
  double offset_ = 0.0;
};

}  // namespace stiction::host
