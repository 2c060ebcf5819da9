#include "firmware/stictiond/remote_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/configuration/conversion.hpp"
#include "hal/can/can_socket.hpp"
#include "stiction/design/axis_parameters.hpp"

namespace stiction::drive {
namespace {

using S = FixedSignals;

// Of the way that max_velocity allows in a cycle: targets are rounded, and clocks differ.
constexpr double way_tolerance = 1.01;
// In which a current in cst reaches its limit where the file does not say otherwise: slow beside a current loop, fast
// beside a mass.
constexpr double torque_rise_time = 10e-3;  // s

// Of all motors; V of a force source.
double current_limit(const machine::AxisModel& axis) {
  return axis.motor.driven_by_volts() ? axis.inverter.voltage_limit : axis.inverter.current_limit * axis.motor.count;
}

template <class T>
T held(double value, const std::string& key) {
  if (const auto signal = machine::to_signal<T>(value)) return *signal;
  throw StartRefused(
      fmt::format("{}: found {:g}; expected at most {:g} in magnitude, the range of the drive's number "
                  "format",
                  key, value, machine::highest<T>()));
}

// Slow ticks from one target to the next.
std::uint32_t cycle_ticks(const DriveConfiguration& c) {
  const double slow = c.machine.timing.slow_period;
  if (!c.setup.can_server || !c.setup.can_server->period) return 1;
  const double period = *c.setup.can_server->period;
  const double ticks = std::round(period / slow);
  if (ticks < 1.0 || std::abs(ticks * slow / period - 1.0) > 1e-6)
    throw StartRefused(
        fmt::format("drive.can_server.period: found {:g} ms; expected a whole multiple of "
                    "timing.slow_period, {:g} ms",
                    period * 1e3, slow * 1e3));
  return static_cast<std::uint32_t>(ticks);
}

int smoothing_bits(double jerk_time, double period) {
  const double ticks = std::max(jerk_time / period, 1.0);
  return std::min(static_cast<int>(std::lround(std::log2(ticks))), PositionProfile::most_smoothing_bits);
}

// The position loop towards an end is half as fast as the axis' own at most, so that it does not swing beyond it.
int stiffness_bits(double position_gain, double period) {
  return std::clamp(static_cast<int>(std::lround(std::log2(2.0 / (position_gain * period)))), 1, 16);
}

TorqueMode::Config torque_mode(const DriveConfiguration& c, const machine::AxisModel& axis,
                               const machine::DriveAxisSetup& setup) {
  const std::string of_axis = "axis." + axis.name, of_drive = "drive.axis." + axis.name;
  const double period = c.machine.timing.fast_period, limit = current_limit(axis);
  const double speed = setup.max_motor_speed.value_or(axis.max_velocity);
  if (speed > axis.max_velocity)
    throw StartRefused(fmt::format("{}.max_motor_speed: found {:g} m/s; expected at most {}.max_velocity, {:g} m/s",
                                   of_drive, speed, of_axis, axis.max_velocity));
  const double slope = setup.torque_slope.value_or(limit / torque_rise_time) * period;
  const double braking = std::min(axis.max_acceleration, setup.quick_stop_deceleration) * period;
  TorqueMode::Config config;
  config.most = held<S::Current>(limit, of_axis + ".inverter.current_limit");
  config.slope = std::clamp(held<S::Current>(std::min(slope, limit), of_drive + ".torque_slope"),
                            S::Current::from_raw(1), config.most);
  config.speed = held<S::Velocity>(speed, of_drive + ".max_motor_speed");
  config.deceleration =
      std::max(held<S::Velocity>(braking, of_drive + ".quick_stop_deceleration"), S::Velocity::from_raw(1));
  config.speed_of_current = held<TorqueMode::SpeedOfCurrent>(axis.motor.force_constant / axis.mass * period,
                                                             of_axis + ".motor.force_constant");
  config.gain = held<S::VelocityGain>(axis.velocity_controller.gain, of_axis + ".velocity_controller.gain");
  config.stiffness_bits = stiffness_bits(axis.position_controller.gain, period);
  config.low = held<S::Position>(setup.negative_end.value(), of_drive + ".negative_end");
  config.high = held<S::Position>(setup.positive_end.value(), of_drive + ".positive_end");
  config.rate = S::rate(c.period_ns);
  return config;
}

RemoteAxisConfig remote_axis(const DriveConfiguration& c, const machine::AxisModel& axis,
                             const machine::DriveAxisSetup& setup) {
  const auto& timing = c.machine.timing;
  const auto ticks = cycle_ticks(c) * static_cast<std::uint32_t>(machine::slow_ratio(timing));
  const double cycle = ticks * timing.fast_period;
  const std::string of_axis = "axis." + axis.name, of_drive = "drive.axis." + axis.name;
  const double way = axis.max_velocity * cycle * way_tolerance;
  const auto most = machine::highest<SetPointInterpolator::Way>();
  if (way > most && c.setup.can_server)
    throw StartRefused(
        fmt::format("drive.can_server.period: found {:g} ms with {}.max_velocity = {:g} m/s; expected a displacement "
                    "of at most {:g} mm between set-points, which means a period up to {:g} ms",
                    cycle * 1e3, of_axis, axis.max_velocity, most * 1e3, most / way * cycle * 1e3));
  RemoteAxisConfig config;
  // Twice, as a controller's profile of limited jerk has peaks between its targets; and a window, as it begins with the
  // measured position.
  const double change = 2.0 * axis.max_acceleration * cycle * cycle + setup.target_window;
  config.interpolation = SetPointInterpolator::configure(
      c.period_ns, ticks, held<SetPointInterpolator::Way>(std::min(way, most), of_axis + ".max_velocity"),
      held<SetPointInterpolator::Way>(std::min(change, most), of_axis + ".max_acceleration"));
  config.streamed = c.setup.can_server.has_value();
  config.low = held<S::Position>(setup.negative_end.value(), of_drive + ".negative_end");
  config.high = held<S::Position>(setup.positive_end.value(), of_drive + ".positive_end");
  config.profile = {S::seconds(c.period_ns), S::rate(c.period_ns),
                    smoothing_bits(setup.profile_jerk_time, timing.fast_period)};
  const double tick_change = axis.max_acceleration * timing.fast_period;
  const auto fastest_change =
      std::max(held<S::Velocity>(tick_change, of_axis + ".max_acceleration"), S::Velocity::from_raw(1));
  config.fastest = {
      {}, held<S::Velocity>(axis.max_velocity, of_axis + ".max_velocity"), fastest_change, fastest_change};
  config.step_limit = {fastest_change, S::seconds(c.period_ns / 2), S::rate(c.period_ns),
                       held<S::Position>(axis.supervision.following_error.value_or(design::default_following_error),
                                         of_axis + ".supervision.following_error")};
  config.torque = torque_mode(c, axis, setup);
  if (setup.stops.halt == 2)
    config.halting =
        held<S::Velocity>(setup.quick_stop_deceleration * timing.fast_period, of_drive + ".quick_stop_deceleration");
  const auto ticks_of = [&](double time) { return static_cast<std::uint32_t>(std::ceil(time / timing.fast_period)); };
  config.owner.reaction = static_cast<AbortReaction>(setup.stops.commander_lost);
  const auto timeout_of = [&](CommandSource source) -> std::uint32_t& {
    return config.owner.timeout_ticks[static_cast<std::size_t>(source)];
  };
  if (c.setup.can_server) timeout_of(CommandSource::can) = ticks_of(c.setup.can_server->commander_timeout);
  if (c.setup.modbus_server) timeout_of(CommandSource::modbus) = ticks_of(c.setup.modbus_server->commander_timeout);
  config.target_window = held<S::Position>(setup.target_window, of_drive + ".target_window");
  return config;
}

std::vector<std::uint32_t> identifiers(const CanServerConfig& config) {
  std::vector<std::uint32_t> ids;
  // The drive's own sockets hear one another.
  for (const auto& row : hal::can::identifier_table) {
    const bool of_power_stage =
        row.base == hal::can::position_id || row.base == hal::can::command_id || row.base == hal::can::current_id;
    if (row.use == hal::can::CobId::sync || of_power_stage) continue;  // those are of the other one of its buses
    if (!row.of_node) ids.push_back(row.base);
    if (!row.of_node) continue;
    for (const int node : config.nodes) ids.push_back(id_of(row.use, node));
  }
  if (config.heartbeat_node != 0) ids.push_back(id_of(hal::can::CobId::heartbeat, config.heartbeat_node));
  return ids;
}

bool on_one_bus(const machine::DriveSetup& setup) {
  return setup.can && setup.can_server && setup.can->interface == setup.can_server->interface;
}

std::string rates(double arbitration, const std::optional<double>& data) {
  return fmt::format("{:g} bit/s{}", arbitration, data ? fmt::format(" and {:g} bit/s", *data) : "");
}

}  // namespace

std::vector<RemoteAxisConfig> remote_axes(const DriveConfiguration& configuration) {
  std::vector<RemoteAxisConfig> axes;
  for (const auto& axis : configuration.machine.axes)
    axes.push_back(remote_axis(configuration, axis, configuration.setup.axes.at(axis.name)));
  return axes;
}

CanServerConfig can_server_config(const DriveConfiguration& c) {
  const auto& server = c.setup.can_server.value();
  CanServerConfig config;
  config.interface = server.interface;
  config.format = server.data_bit_rate ? hal::can::Format::fd : hal::can::Format::classical;
  config.increment = server.position_increment;
  config.frames = static_cast<int>(server.frames);
  config.cycle_ticks = cycle_ticks(c);
  config.motion_allowed = server.motion_allowed;
  config.heartbeat_node = server.heartbeat_node;
  config.follows_sync = server.sync_followed;
  config.sends_sync = !on_one_bus(c.setup) && !server.sync_followed;
  if (server.sync_followed && on_one_bus(c.setup))
    throw StartRefused(
        fmt::format("{}: found drive.can_server.sync = \"followed\" on the interface of [drive.can], {}, where the "
                    "drive itself sends SYNC; expected \"sent\" or a different interface",
                    c.machine.id, server.interface));
  for (const auto& axis : c.machine.axes) {
    const int node = c.setup.axes.at(axis.name).server_node;
    if (node == 0)
      throw StartRefused(
          fmt::format("{}: found no drive.axis.{}.server_node; expected the axis' node on the bus of "
                      "[drive.can_server], 1 to 127",
                      c.machine.id, axis.name));
    if (std::find(config.nodes.begin(), config.nodes.end(), node) != config.nodes.end())
      throw StartRefused(
          fmt::format("{}: found drive.axis.{}.server_node = {} a second time; expected a node of its own",
                      c.machine.id, axis.name, node));
    config.nodes.push_back(node);
    config.current_limit.push_back(current_limit(axis));
  }
  if (on_one_bus(c.setup) &&
      (server.bit_rate != c.setup.can->bit_rate || server.data_bit_rate != c.setup.can->data_bit_rate))
    throw StartRefused(fmt::format(
        "{}: found {} of [drive.can_server] and {} of [drive.can] on one interface, {}; expected the same bit rates",
        c.machine.id, rates(server.bit_rate, server.data_bit_rate),
        rates(c.setup.can->bit_rate, c.setup.can->data_bit_rate), server.interface));
  return config;
}

std::vector<hal::CyclicFrame> can_server_frames(const DriveConfiguration& configuration) {
  const auto config = can_server_config(configuration);
  const bool fd = config.format == hal::can::Format::fd;
  const double period = config.cycle_ticks * configuration.machine.timing.slow_period;
  const auto frame = [&](const char* name, int bytes, int per_cycle) {
    return hal::CyclicFrame{.name = name, .bytes = bytes, .fd = fd, .per_cycle = per_cycle, .period = period};
  };
  std::vector<hal::CyclicFrame> frames;
  const auto axes = static_cast<int>(config.nodes.size());
  if (config.sends_sync || config.follows_sync) frames.push_back(frame("server sync", 0, 1));
  constexpr std::array<const char*, 8> names{"mode", "target", "offsets", "state", "motion", "", "", "state"};
  for (const auto& row : hal::can::pdo_table)
    // The mode is sent when it changes, and a speed or a torque in the place of a target.
    if (row.cyclic && row.exchanged_at(config.frames))
      frames.push_back(frame(names[static_cast<std::size_t>(row.pdo)], row.size, axes));
  const auto& encoder = configuration.setup.master_encoder;
  if (encoder && encoder->interface == config.interface)
    frames.push_back({.name = "master encoder", .bytes = 4, .fd = false, .per_cycle = 1, .period = encoder->period});
  return frames;
}

hal::BusBudget can_server_budget(const DriveConfiguration& configuration) {
  if (on_one_bus(configuration.setup)) return can_bus_budget(configuration);
  const auto& server = configuration.setup.can_server.value();
  return hal::can_budget(server.interface, {server.bit_rate, server.data_bit_rate}, can_server_frames(configuration),
                         hal::can::is_virtual(server.interface));
}

std::vector<std::uint32_t> can_server_identifiers(const DriveConfiguration& configuration) {
  return on_one_bus(configuration.setup) ? identifiers(can_server_config(configuration)) : std::vector<std::uint32_t>{};
}

void check_remote(const DriveConfiguration& configuration) {
  remote_axes(configuration);
  if (configuration.setup.can_server) hal::check(can_server_budget(configuration));
}

}  // namespace stiction::drive
