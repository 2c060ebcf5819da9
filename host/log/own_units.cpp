#include "host/log/own_units.hpp"

#include <fmt/format.h>

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

void require_same_kind(const Log& log, const AxisLog& channels, const machine::AxisModel& axis) {
  if (channels.rotary == axis.coordinate.rotary()) return;
  const auto kind = [](bool rotary) { return rotary ? "rotary" : "linear"; };
  throw LogError(
      fmt::format("{}: found columns of a {} axis; expected those of a {} one, as the machine file describes "
                  "axis {}",
                  log.source, kind(channels.rotary), kind(!channels.rotary), axis.name));
}

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
