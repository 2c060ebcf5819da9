#include "firmware/machine/configuration/drive_configuration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware/machine/configuration/conversion.hpp"
#include "firmware/machine/configuration/double_signals.hpp"
#include "firmware/machine/configuration/motor_configuration.hpp"
#include "stiction/design/axis_parameters.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::machine {
namespace {

// Slower than any motion that has an end, faster than noise of 60 nm makes in one 62.5 us.
constexpr double standstill_speed = 1e-3;  // m/s
constexpr double stop_margin = 0.1;        // s, from the end of a stop's set-point to the end of its power
// Of the travel, by which a switch may lie inside or outside of its end.
constexpr double switch_margin = 0.01;

class Converter {
 public:
  explicit Converter(std::string axis) : axis_(std::move(axis)) {}

  template <class T>
  T operator()(double value, const char* key) const {
    if (const auto signal = to_signal<T>(value)) return *signal;
    throw ConfigurationError(
        fmt::format("drive.axis.{}.{}: found {:g}; expected at most {:g} in magnitude, the range "
                    "of the drive's number format",
                    axis_, key, value, highest<T>()));
  }
  // Refuses what would round to nothing or to another value.
  template <class T>
  T resolved(double value, const char* key) const {
    const T signal = (*this).template operator()<T>(value, key);
    if (std::abs(to_si(signal) / value - 1.0) < 0.01) return signal;
    throw ConfigurationError(
        fmt::format("drive.axis.{}.{}: found {:g}; expected a value that the drive's number format resolves to 1 % (it "
                    "would become {:g})",
                    axis_, key, value, to_si(signal)));
  }
  std::uint32_t ticks(double time, double period, const char* key) const {
    const double count = std::ceil(time / period);
    if (count < static_cast<double>(std::numeric_limits<std::uint32_t>::max()))
      return static_cast<std::uint32_t>(count);
    throw ConfigurationError(fmt::format("drive.axis.{}.{}: it would take {:g} s; expected less than {:g} s", axis_,
                                         key, time, period * 4294967295.0));
  }

 private:
  std::string axis_;
};

stiction::HomingMethod method_of(HomingMethod method) {
  switch (method) {
    case HomingMethod::none:
      return stiction::HomingMethod::none;
    case HomingMethod::here:
      return stiction::HomingMethod::here;
    case HomingMethod::limit_negative:
      return stiction::HomingMethod::limit_negative;
    case HomingMethod::limit_positive:
      return stiction::HomingMethod::limit_positive;
    case HomingMethod::home_positive:
      return stiction::HomingMethod::home_positive;
    case HomingMethod::home_negative:
      return stiction::HomingMethod::home_negative;
    case HomingMethod::index_negative:
      return stiction::HomingMethod::index_negative;
    case HomingMethod::index_positive:
      return stiction::HomingMethod::index_positive;
  }
  throw ConfigurationError("homing.method: unknown method");
}

template <class S>
SupervisionConfig<S> supervision_of(const Timing& timing, const AxisModel& axis, const DriveAxisSetup& setup,
                                    const Converter& convert) {
  SupervisionConfig<S> c;
  const bool force_source = axis.motor.model == MotorModel::force;
  c.period_ns = fast_period_ns(timing);
  c.frozen_distance = convert.template operator()<typename S::Distance>(setup.frozen_distance, "frozen_distance");
  c.encoder_jump = convert.template operator()<typename S::Distance>(setup.encoder_jump.value(), "encoder_jump");
  c.phases_sum = axis.motor.model == MotorModel::synchronous;
  c.current_measured = !force_source;
  // A force source has no current: its voltage command stands for it.
  if (!force_source)
    c.current_sum = convert.template operator()<typename S::Current>(setup.current_sum.value(), "current_sum");
  const double current = force_source ? axis.inverter.voltage_limit / 5.0 : setup.runaway_current.value();
  c.runaway_current = convert.template operator()<typename S::Current>(current, "runaway_current");
  const double acceleration = current * axis.motor.force_constant / axis.mass;
  c.runaway_rise = convert.template operator()<typename S::Velocity>(
      0.5 * acceleration * (supervised_row_ticks - 1) * timing.fast_period, "runaway_current");
  c.least_speed = convert.template operator()<typename S::Velocity>(standstill_speed, "supervision");
  c.negative_switch = setup.line.limit_negative >= 0;
  c.positive_switch = setup.line.limit_positive >= 0;
  const double low = setup.negative_end.value(), high = setup.positive_end.value();
  if (!(low < high))
    throw ConfigurationError(
        fmt::format("drive.axis.{}.positive_end: found {:g} m; expected more than negative_end, "
                    "{:g} m",
                    axis.name, high, low));
  const double margin = switch_margin * (high - low);
  const auto position = [&](double x, const char* key) {
    return convert.template operator()<typename S::Position>(x, key);
  };
  c.negative_from = position(low + margin, "negative_end");
  c.negative_by = position(low - margin, "negative_end");
  c.positive_from = position(high - margin, "positive_end");
  c.positive_by = position(high + margin, "positive_end");
  return c;
}

// The way is that of the whole travel and a tenth more. The time is that of the way at the speed at which it is made,
// of a tenth of the travel at creep speed, and five seconds.
template <class S>
HomingConfig<S> homing_of(const Timing& timing, const DriveAxisSetup& setup, const Converter& convert) {
  const auto& homing = setup.homing;
  const double travel = 1.1 * (setup.positive_end.value() - setup.negative_end.value());
  HomingConfig<S> c;
  c.method = method_of(homing.method);
  c.search_speed = convert.template resolved<typename S::Velocity>(homing.search_speed, "homing.search_speed");
  c.creep_speed = convert.template resolved<typename S::Velocity>(homing.creep_speed, "homing.creep_speed");
  c.offset = convert.template operator()<typename S::Position>(homing.offset, "homing.offset");
  c.longest_way = convert.template operator()<typename S::Position>(travel, "positive_end");
  const bool to_index = homing.method == HomingMethod::index_negative || homing.method == HomingMethod::index_positive;
  const double way_speed = to_index ? homing.creep_speed : homing.search_speed;
  c.longest_ticks = convert.ticks(travel / way_speed + 0.1 * travel / homing.creep_speed + 5.0, timing.fast_period,
                                  "homing.creep_speed");
  return c;
}

}  // namespace

template <class S>
ServoDriveConfig<S> configure_drive(const Timing& timing, const AxisModel& axis, const DriveAxisSetup& setup) {
  const Converter convert(axis.name);
  const double period = timing.fast_period;
  ServoDriveConfig<S> c;
  c.ramp.change = convert.template resolved<typename S::Velocity>(setup.quick_stop_deceleration * period,
                                                                  "quick_stop_deceleration");
  c.ramp.half_period = S::seconds(fast_period_ns(timing) / 2);
  c.ramp.rate = S::rate(fast_period_ns(timing));
  const double slow_down = setup.slow_down_deceleration.value_or(setup.quick_stop_deceleration);
  if (slow_down > setup.quick_stop_deceleration)
    throw ConfigurationError(
        fmt::format("drive.axis.{}.slow_down_deceleration: found {:g} m/s^2; expected at most "
                    "quick_stop_deceleration, {:g} m/s^2",
                    axis.name, slow_down, setup.quick_stop_deceleration));
  c.slow_down = convert.template resolved<typename S::Velocity>(slow_down * period, "slow_down_deceleration");
  c.most_change = convert.template operator()<typename S::Velocity>(
      std::max(axis.max_acceleration, setup.quick_stop_deceleration) * period, "quick_stop_deceleration");
  if (c.most_change < c.ramp.change) c.most_change = c.ramp.change;
  c.following_error = convert.template operator()<typename S::Distance>(
      axis.supervision.following_error.value_or(design::default_following_error), "following_error_timeout");
  c.following_error_ticks = convert.ticks(setup.following_error_timeout, period, "following_error_timeout");
  const auto& stops = setup.stops;
  c.stops = {stops.quick_stop, stops.shutdown, stops.disable_operation, stops.halt, stops.fault_reaction};
  c.supervision = supervision_of<S>(timing, axis, setup, convert);
  c.homing = homing_of<S>(timing, setup, convert);
  c.standstill_speed = c.supervision.least_speed;
  c.standstill_way = convert.template operator()<typename S::Position>(
      standstill_speed * ServoDrive<S>::self_test_ticks * period, "supervision");
  c.stop_margin_ticks = convert.ticks(stop_margin, period, "quick_stop_deceleration");
  c.brake_ticks = convert.ticks(setup.brake_time, period, "brake_time");
  configure_motor(timing, axis, setup, c);
  return c;
}

template <class S>
std::vector<ServoDriveConfig<S>> configure_drives(const Machine& machine, const DriveSetup& setup) {
  std::vector<ServoDriveConfig<S>> configs;
  for (const auto& axis : machine.axes)
    configs.push_back(configure_drive<S>(machine.timing, axis, setup.axes.at(axis.name)));
  return configs;
}

template ServoDriveConfig<FixedSignals> configure_drive<FixedSignals>(const Timing&, const AxisModel&,
                                                                      const DriveAxisSetup&);
template ServoDriveConfig<DoubleSignals> configure_drive<DoubleSignals>(const Timing&, const AxisModel&,
                                                                        const DriveAxisSetup&);
template std::vector<ServoDriveConfig<FixedSignals>> configure_drives<FixedSignals>(const Machine&, const DriveSetup&);
template std::vector<ServoDriveConfig<DoubleSignals>> configure_drives<DoubleSignals>(const Machine&,
                                                                                      const DriveSetup&);

}  // namespace stiction::machine
