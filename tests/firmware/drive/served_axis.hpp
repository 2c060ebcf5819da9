// An axis as a bus sees it (remote_axis.hpp before servo_drive.hpp before the cascade) whose carriage is where its
// set-point was a tick before, and coasts without power. A value: a copy is the same axis in the same motion.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "stiction/drive/remote_axis.hpp"
#include "tests/firmware/drive/axis_bench.hpp"

namespace stiction::test {

struct ServedAxis {
  using S = FixedSignals;

  static constexpr double quick_deceleration = 10.0, slow_deceleration = 5.0, acceleration = 20.0;  // m/s^2
  static constexpr double most_speed = 1.25, end = 0.5;                                             // m/s, m
  static constexpr double most_current = 40.0, acceleration_of_current = 0.4;                       // A, m/s^2 per A
  static constexpr double search_speed = 0.2;                                                       // m/s
  static constexpr int cycle_ticks = 16;

  static ServoDriveConfig<S> drive_config(const StopCodes& stops, HomingMethod method) {
    ServoDriveConfig<S> c;
    c.stops = stops;
    c.ramp = {si<S::Velocity>(quick_deceleration * tick), S::seconds(tick_ns / 2), S::rate(tick_ns)};
    c.slow_down = si<S::Velocity>(slow_deceleration * tick);
    c.most_change = si<S::Velocity>(acceleration * tick);
    c.supervision.period_ns = tick_ns;
    c.supervision.frozen_distance = si<S::Distance>(0.1);
    c.supervision.encoder_jump = si<S::Distance>(10e-6);
    c.supervision.current_sum = si<S::Current>(5.0);
    c.supervision.runaway_current = si<S::Current>(100.0);
    c.supervision.runaway_rise = si<S::Velocity>(1.0);
    c.supervision.least_speed = si<S::Velocity>(1e-3);
    c.homing = {
        method, si<S::Velocity>(search_speed), si<S::Velocity>(2e-3), si<S::Position>(0.0), si<S::Position>(2.0),
        400'000};
    c.standstill_speed = si<S::Velocity>(1e-3);
    c.standstill_way = si<S::Position>(4e-6);
    return c;
  }
  static RemoteAxisConfig remote_config(const StopCodes& stops, const CommandOwner::Config& owner) {
    RemoteAxisConfig c;
    c.owner = owner;
    const double cycle = cycle_ticks * tick;
    c.interpolation =
        SetPointInterpolator::configure(tick_ns, cycle_ticks, si<SetPointInterpolator::Way>(most_speed * cycle),
                                        si<SetPointInterpolator::Way>(2.0 * acceleration * cycle * cycle + 10e-6));
    c.streamed = true;
    c.low = si<S::Position>(-end);
    c.high = si<S::Position>(end);
    c.profile = {S::seconds(tick_ns), S::rate(tick_ns), 6};
    const auto change = si<S::Velocity>(acceleration * tick);
    c.fastest = {{}, si<S::Velocity>(most_speed), change, change};
    c.target_window = si<S::Position>(10e-6);
    c.step_limit = {change, S::seconds(tick_ns / 2), S::rate(tick_ns), si<S::Position>(2e-3)};
    c.torque = torque_config();
    if (stops.halt == 2) c.halting = si<S::Velocity>(quick_deceleration * tick);
    return c;
  }

  // m/s^2 per A is that of the cascade's feedforward; slope: the limit in 1 ms.
  static TorqueMode::Config torque_config() {
    TorqueMode::Config c;
    c.most = si<S::Current>(most_current);
    c.slope = si<S::Current>(most_current / 16.0);
    c.speed = si<S::Velocity>(most_speed);
    c.deceleration = si<S::Velocity>(quick_deceleration * tick);
    c.speed_of_current = si<TorqueMode::SpeedOfCurrent>(acceleration_of_current * tick);
    c.gain = si<S::VelocityGain>(600.0);
    c.low = si<S::Position>(-end);
    c.high = si<S::Position>(end);
    c.rate = S::rate(tick_ns);
    return c;
  }

  explicit ServedAxis(const StopCodes& stops = {}, HomingMethod method = HomingMethod::none, double at = 0.0,
                      const CommandOwner::Config& owner = {})
      : remote(remote_config(stops, owner)), drive(drive_config(stops, method)), axis(cascade()), x(at) {
    drive.start(feedback(), axis);
  }
  ServedAxis(const ServoDriveConfig<S>& drive_configuration, const AxisConfig<S>& cascade_configuration)
      : remote(remote_config({}, {})), drive(drive_configuration), axis(cascade_configuration), x(0.0) {
    drive.start(feedback(), axis);
  }

  static AxisConfig<S> cascade() {
    auto c = bench_config<S>();
    c.following_error_fault = si<S::Distance>(0.1);
    return c;
  }

  Feedback<S> feedback() const {
    Feedback<S> f;
    f.position = S::Position::from_raw(std::llround(x * 0x1p40));
    f.position_time_ns = now_ns;
    f.position_valid = position_valid;
    f.fault = stage_fault;
    return f;
  }

  // One tick; a cycle begins each cycle_ticks of them.
  void step() {
    now_ns += tick_ns;
    if (ticks % cycle_ticks == 0) remote.begin_cycle();
    DriveDemand<S> demand;
    demand.set_point = remote.tick(drive);
    demand.controlword = remote.controlword();
    demand.mode = remote.mode();
    demand.brake = remote.brakes();
    demand.along = remote.along();
    demand.velocity_offset = remote.velocity_offset();
    demand.causes[0] = remote.fault();
    demand.causes[1] = trip;
    if (direct_mode) demand = {remote.controlword(), *direct_mode, {drive.set_position(), {}, {}}};
    if (direct_mode) demand.set_point.valid = set_point_valid;
    demand.causes[2] = direct_mode ? trip : Fault::none;
    const auto set = drive.before(demand, feedback(), inputs, now_ns, axis);
    AxisSignals<S> signals;
    axis.tick(set, feedback(), now_ns, ticks % ticks_per_slow_tick == 0, signals);
    drive.after(signals, axis);
    set_speed_before = set_speed;
    set_speed = machine::to_si(set.velocity);
    current = machine::to_si(signals.i_set);
    by_current = set.by_current;
    lead_by_current |= by_current;
    if (jammed) {
      v = 0.0;
    } else if (drive.powered() && by_current) {
      v += (current + load) * acceleration_of_current * tick;
      x += v * tick;
    } else if (drive.powered()) {
      // A current finds the carriage where it is, and what takes over from it goes on from there.
      const double lead = lead_by_current ? machine::to_si(set.velocity) * tick : 0.0;
      const double to = machine::to_si(set.position) - lag + lead + (ticks / 8 % 2 == 0 ? wobble : -wobble);
      v = (to - x) / tick;
      x = to;
    } else {
      v = coasts ? v : 0.0;
      x += v * tick;
    }
    ++ticks;
  }
  void run(int count) {
    for (int i = 0; i < count; ++i) step();
  }

  // Streams of csp and csv at a speed (m/s), and the same speed asked of pv and pp.
  void stream(int count, double speed) {
    for (int i = 0; i < count; ++i) {
      if (ticks % cycle_ticks == 0) send(speed);
      step();
    }
  }
  void send(double speed) {
    // A change of speed as the limits of the axis allow it.
    const double most = acceleration * cycle_ticks * tick;
    streamed_speed += std::clamp(speed - streamed_speed, -most, most);
    if (!drive.follows() || remote.mode() != OperationMode::cyclic_position) {
      streamed_speed = 0.0;
      streamed = machine::to_si(drive.set_position());
    }
    streamed += streamed_speed * cycle_ticks * tick;
    remote.offer(si<S::Position>(streamed), true);
    remote.offer_speed(si<S::Velocity>(speed), true);
    remote.offer_torque(si<S::Current>(torque.value_or(std::clamp(1000.0 * (speed - v), -most_current, most_current))));
  }

  // Led to operation enabled, at rest; false where it does not get there.
  bool enable() {
    for (int i = 0; i < 2000 && drive.state() != DriveState::operation_enabled; ++i) {
      remote.ask(controlword_to_enable(drive.state()));
      stream(1, 0.0);
    }
    return drive.state() == DriveState::operation_enabled;
  }

  std::uint16_t statusword() const { return remote.statusword(drive.statusword()); }
  bool shows(std::uint16_t bit) const { return (statusword() & bit) != 0; }
  // Of the last tick, m/s.
  double step_of_speed() const { return std::abs(set_speed - set_speed_before); }

  RemoteAxis remote;
  ServoDrive<S> drive;
  stiction::Axis<S> axis;
  double x, v = 0.0;                                 // m, m/s
  double set_speed = 0.0, set_speed_before = 0.0;    // m/s
  double current = 0.0, load = 0.0;                  // A, of the motor and of a force from outside
  bool by_current = false, lead_by_current = false;  // the last set-point; any before it
  std::optional<double> torque;                      // A, streamed in cst; else what leads to the speed
  double streamed = 0.0, streamed_speed = 0.0;       // m, m/s
  bool jammed = false;                               // the carriage does not move
  double lag = 0.0;                                  // m, of the carriage behind its set-point
  bool stage_fault = false, coasts = true, position_valid = true, set_point_valid = true;
  std::optional<OperationMode> direct_mode;  // of a source that is not the bus; its set-point stays where it is
  double wobble = 0.0;                       // m, to and fro each eight ticks
  Fault trip = Fault::none;
  DigitalInputs<S> inputs{};
  std::int64_t now_ns = 0;
  std::uint64_t ticks = 0;
};

}  // namespace stiction::test
