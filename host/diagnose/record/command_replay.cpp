#include "host/diagnose/record/command_replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/configuration/conversion.hpp"
#include "firmware/machine/configuration/double_signals.hpp"
#include "host/log/set_points.hpp"
#include "host/simulate/injection.hpp"
#include "host/simulate/replay.hpp"
#include "sim/effects/effects.hpp"
#include "sim/effects/master_delay/master_delay.hpp"
#include "sim/plant/axis_plant.hpp"
#include "stiction/drive/axis.hpp"
#include "stiction/drive/ticker.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

// The windings under the drive's voltages on a given way.
class Windings {
 public:
  Windings(const machine::AxisModel& axis, double step)
      : step_(step), inverter_(axis.inverter, step, sim::plant_steps_per_tick), motor_(make(axis.motor, step)) {}

  sim::PhaseValues current() const {
    return std::visit([](const auto& motor) -> sim::PhaseValues { return motor.current(); }, motor_);
  }
  // One tick from position x (m) at velocity v (m/s).
  void advance_tick(const sim::PhaseValues& voltage, double x, double v) {
    inverter_.command(voltage);
    inverter_.advance_tick<std::tuple_size_v<sim::PhaseValues>>();
    const auto acting = inverter_.acting();
    std::visit(
        [&](auto& motor) {
          for (int i = 0; i < sim::plant_steps_per_tick; ++i)
            motor.advance(i >= acting.change      ? acting.after
                          : i + 1 < acting.change ? acting.before
                                                  : acting.between,
                          x + v * step_ * i, v);
        },
        motor_);
  }

 private:
  using Motor = std::variant<sim::DcMotor, sim::SynchronousMotor, sim::ForceSource>;
  static Motor make(const machine::MotorParameters& motor, double step) {
    if (motor.model == machine::MotorModel::synchronous) return sim::SynchronousMotor(motor, step);
    if (motor.model == machine::MotorModel::force) return sim::ForceSource(motor, step);
    return sim::DcMotor(motor, step);
  }

  double step_;
  sim::InverterModel inverter_;
  Motor motor_;
};

// The record is judged, not protected: no threshold stops the control.
template <class S>
AxisConfig<S> unsupervised(AxisConfig<S> config) {
  const auto most = [](auto& limit) {
    using T = std::remove_reference_t<decltype(limit)>;
    machine::convert(std::min(0.99 * machine::highest<T>(), 1e9), limit);
  };
  most(config.following_error_fault);
  most(config.over_current_fault);
  most(config.over_speed_fault);
  config.limit_cycle_window_ticks = 1;  // too short for one
  return config;
}

// Before the log as uniformly accelerated as at its `begin`.
sim::AxisSetPoint late_point(const SetPoints& set, double begin, double t) {
  auto point = set.at(std::max(t, begin));
  if (const double by = t - begin; by < 0.0) {
    point.position += by * (point.velocity + 0.5 * by * point.acceleration);
    point.velocity += by * point.acceleration;
  }
  return point;
}

AxisLog measured_as_set(const AxisLog& channels) {
  AxisLog measured;
  measured.x_set = channels.x;
  return measured;
}

}  // namespace

std::optional<RecordedCommand> recorded_command(const AxisLog& channels, const machine::AxisModel& axis) {
  const bool force_motor = axis.motor.driven_by_volts();
  if (channels.x_set.empty() || !refused_injection(channels, axis).empty()) return std::nullopt;
  if (force_motor) {
    if (channels.u.empty()) return std::nullopt;
    return RecordedCommand{&AxisLog::u, "V", "u"};
  }
  if (!channels.i.empty()) return RecordedCommand{&AxisLog::i, "A", "i"};
  if (!channels.i_set.empty()) return RecordedCommand{&AxisLog::i_set, "A", "i_set"};
  return std::nullopt;
}

template <class S>
std::vector<double> replay_command(const machine::Timing& timing, const machine::AxisModel& axis, const Log& log,
                                   const AxisLog& channels) {
  const double tick = timing.fast_period, ratio = log.period / tick;
  const SetPoints set(log, channels), measured(log, measured_as_set(channels));
  const bool each_tick = std::abs(ratio - 1.0) < 1e-6;  // nothing to interpolate
  const double allowed = axis.supervision.following_error.value_or(2e-3);
  const double offset = encoder_offset(channels, allowed);
  const bool force_motor = axis.motor.driven_by_volts();
  const Injection injection(log, channels, axis);
  const bool wants_set_current = !force_motor && channels.i.empty();
  const double late = sim::master_delay(axis);

  Axis<S> drive(unsupervised(machine::configure_axis<S>(timing, sim::drive_axis(axis))));
  Ticker ticker(machine::fast_period_ns(timing), static_cast<std::uint32_t>(machine::slow_ratio(timing)));
  Windings windings(sim::plant_axis(axis), tick / sim::plant_steps_per_tick);
  AxisSignals<S> signals;
  std::vector<double> command;
  command.reserve(log.t.size());
  double before = 0.0;
  for (long k = 0; command.size() < log.t.size(); ++k) {
    const double place = static_cast<double>(k) / ratio, t = log.t.front() + place * log.period;
    const auto at = measured.at(t);
    const double x =
        (each_tick ? channels.x[std::min(static_cast<std::size_t>(k), channels.x.size() - 1)] : at.position) - offset;
    Feedback<S> feedback;
    feedback.position_valid = machine::convert({x, at.velocity}, feedback.position, feedback.velocity);
    feedback.position_time_ns = ticker.now_ns();
    for (std::size_t p = 0; p < 3; ++p) feedback.fault |= !machine::convert(windings.current()[p], feedback.current[p]);
    if (k == 0) drive.start(feedback);
    auto point = late_point(set, log.t.front(), t - late);
    point.injection = injection.at(t);
    const auto output = drive.tick(sim::to_set_point<S>(point), feedback, ticker.now_ns(), ticker.slow(), signals);
    if (drive.fault() != Fault::none)
      throw LogError(fmt::format(
          "{}: found inputs at {:.4f} s that stop the control of the drive ({}); expected a record of this drive",
          log.source, t, name_of(drive.fault())));
    ticker.advance();
    const double now = machine::to_si(wants_set_current ? signals.i_set : signals.i);
    // Samples between the last tick and this one.
    for (double sample = static_cast<double>(command.size()) * ratio;
         command.size() < log.t.size() && sample <= static_cast<double>(k) + 1e-6;
         sample = static_cast<double>(command.size()) * ratio) {
      const double share = std::clamp(sample - static_cast<double>(k - 1), 0.0, 1.0);
      command.push_back(k == 0 ? now : before + (now - before) * share);
    }
    before = now;
    windings.advance_tick(
        {machine::to_si(output.voltage[0]), machine::to_si(output.voltage[1]), machine::to_si(output.voltage[2])}, x,
        at.velocity);
  }
  return command;
}

template std::vector<double> replay_command<FixedSignals>(const machine::Timing&, const machine::AxisModel&, const Log&,
                                                          const AxisLog&);
template std::vector<double> replay_command<machine::DoubleSignals>(const machine::Timing&, const machine::AxisModel&,
                                                                    const Log&, const AxisLog&);

}  // namespace stiction::host
