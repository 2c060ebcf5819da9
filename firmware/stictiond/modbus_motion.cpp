#include "firmware/stictiond/modbus_motion.hpp"

#include "firmware/machine/configuration/conversion.hpp"
#include "firmware/stictiond/modbus_cam.hpp"

namespace stiction::drive {

void ask(const MotionWrite& write, double period, RemoteAxis& axis, CommandSource source) {
  using enum MotionWrite::What;
  using S = FixedSignals;
  const auto speed = [](double value) { return machine::to_signal<S::Velocity>(value).value_or(S::Velocity{}); };
  const auto current = [&](double share) {
    return machine::to_signal<S::Current>(share * machine::to_si(axis.rated_torque())).value_or(S::Current{});
  };
  if (write.what == controlword) {
    axis.ask(static_cast<std::uint16_t>(write.value), source, write.of_other);
    return;
  }
  // A value of who does not command is none; the publisher has answered so.
  if (!axis.owner().accepts(source)) return;
  axis.hear(source);
  if (ask_cam(write, period, axis)) return;
  switch (write.what) {
    case mode:
      return axis.ask(static_cast<OperationMode>(static_cast<std::int8_t>(write.value)));
    case target: {
      const auto position = machine::to_signal<S::Position>(write.value);
      return axis.ask_target(position.value_or(S::Position{}), position.has_value());
    }
    case velocity:
      return axis.ask_velocity(speed(write.value));
    case acceleration:
      return axis.ask_acceleration(speed(write.value * period));
    case deceleration:
      return axis.ask_deceleration(speed(write.value * period));
    case target_velocity:
      return axis.ask_speed(speed(write.value));
    case target_torque:
      return axis.ask_torque(current(write.value));
    case max_torque:
      return axis.ask_most_torque(current(write.value));
    default:
      return;  // the controlword, and what a cam has taken
  }
}

void show_asked(const RemoteAxis& axis, double period, PublishedAxis& shown) {
  show_cam(axis, period, shown.cam);
  const auto& move = axis.move();
  shown.controlword = axis.controlword();
  shown.owner = axis.owner().owner();
  shown.held_by = axis.owner().held_by();
  shown.owner_token = axis.owner().token();
  shown.refusal = axis.refusal();
  shown.target_velocity = machine::to_si(axis.speed());
  const double rated = machine::to_si(axis.rated_torque());
  shown.torque = shown.current / rated;
  shown.target_torque = machine::to_si(axis.torque()) / rated;
  shown.max_torque = machine::to_si(axis.most_torque()) / rated;
  shown.mode = static_cast<std::int16_t>(axis.mode());
  shown.target = machine::to_si(move.target);
  shown.profile_velocity = machine::to_si(move.velocity);
  shown.profile_acceleration = machine::to_si(move.acceleration) / period;
  shown.profile_deceleration = machine::to_si(move.deceleration) / period;
}

}  // namespace stiction::drive
