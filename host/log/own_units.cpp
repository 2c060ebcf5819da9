#include "host/log/own_units.hpp"

#include <numbers>

namespace stiction::host {
namespace {

constexpr double degrees = 180.0 / std::numbers::pi;

template <class Convert>
AxisLog converted(AxisLog axis, Convert&& convert) {
  for (std::size_t c = 0; c < log_channels.size(); ++c) {
    const auto& channel = log_channels[c];
    for (double& value : axis.*channel.values) value = convert(value, channel.unit);
    if (c < axis.increments.size()) axis.increments[c] = convert(axis.increments[c], channel.unit);
  }
  return axis;
}

}  // namespace

AxisLog as_linear(AxisLog axis, const machine::Coordinate& coordinate) {
  if (!coordinate.rotary()) return axis;
  axis =
      converted(std::move(axis), [&](double value, const char* unit) { return coordinate.own(unit).to_linear(value); });
  axis.rotary = false;
  return axis;
}

AxisLog in_own_units(AxisLog axis, const machine::Coordinate& coordinate) {
  if (!coordinate.rotary()) return axis;
  axis = converted(std::move(axis),
                   [&](double value, const char* unit) { return coordinate.own(unit).from_linear(value); });
  axis.rotary = true;
  return axis;
}

ShownUnit shown_deviation(bool rotary) { return {1e6, rotary ? "urad" : "um"}; }
ShownUnit shown_position(bool rotary) { return rotary ? ShownUnit{degrees, "deg"} : ShownUnit{1e3, "mm"}; }
ShownUnit shown_speed(bool rotary) { return rotary ? ShownUnit{degrees, "deg/s"} : ShownUnit{60.0, "m/min"}; }
const char* force_unit(bool rotary) { return rotary ? "N m" : "N"; }

}  // namespace stiction::host
