#include "hal/gpio/inputs_outputs.hpp"

namespace stiction::hal {

GpioInputsOutputs::GpioInputsOutputs(Lines& lines, std::span<const AxisLines> axes, const WatchdogConfig& watchdog,
                                     std::span<const LineConfig> tracks)
    : lines_(lines), pulse_(watchdog.period_ns) {
  if (watchdog.line.wired()) watchdog_ = lines.add_output(watchdog.line, "watchdog");
  for (const auto& track : tracks) {
    const std::string name = "cam track " + std::to_string(tracks_.size() + 1);
    tracks_.push_back(track.wired() ? Place(lines.add_output(track, name)) : Place());
  }
  for (const auto& wired : axes) {
    const auto name = [&](const char* what) { return "axis " + wired.name + " " + what; };
    const auto input = [&](const LineConfig& line, const char* what) {
      return line.wired() ? Place(lines.add_input(line, name(what))) : Place();
    };
    const auto output = [&](const LineConfig& line, const char* what) {
      return line.wired() ? Place(lines.add_output(line, name(what))) : Place();
    };
    axes_.push_back(
        {.enable = output(wired.enable, "enable"),
         .brake = output(wired.brake, "brake"),
         .fault = input(wired.fault, "fault"),
         .limit_negative = input(wired.limit_negative, "negative limit"),
         .limit_positive = input(wired.limit_positive, "positive limit"),
         .home = input(wired.home, "home"),
         .index = input(wired.index, "index"),
         .torque_off = {input(wired.torque_off_a, "safe torque off A"), input(wired.torque_off_b, "safe torque off B")},
         .hall = {input(wired.hall_a, "Hall A"), input(wired.hall_b, "Hall B"), input(wired.hall_c, "Hall C")},
         .released = true});
  }
}

// A switch that was reached only between two ticks was reached.
void GpioInputsOutputs::read_inputs(std::size_t axis, DigitalInputs<FixedSignals>& inputs) const {
  const auto& places = axes_[axis];
  const auto take = [&](const Place& place, bool& input) {
    if (place) input = lines_.was_active(*place);
  };
  take(places.limit_negative, inputs.limit_negative);
  take(places.limit_positive, inputs.limit_positive);
  take(places.home, inputs.home);
  if (!places.has_hall()) return;
  inputs.hall = 0;  // as the three are now: one that was high is another place
  for (std::size_t k = 0; k < places.hall.size(); ++k)
    if (lines_.level(*places.hall[k])) inputs.hall = static_cast<std::uint8_t>(inputs.hall | 1u << k);
}

// A channel that was open only between two ticks was open.
void GpioInputsOutputs::read_protection(std::size_t axis, ProtectionInputs<FixedSignals>& inputs) const {
  const auto& [a, b] = axes_[axis].torque_off;
  if (a) inputs.torque_off_a = lines_.was_active(*a);
  if (b) inputs.torque_off_b = lines_.was_active(*b);
}

MotorSignalSet GpioInputsOutputs::motor_signals(std::size_t axis) const {
  const auto& places = axes_[axis];
  return {.hall = places.has_hall(), .torque_off = places.torque_off[0] && places.torque_off[1]};
}

bool GpioInputsOutputs::fault(std::size_t axis) const {
  const auto& place = axes_[axis].fault;
  return lines_.failed() || (place && lines_.was_active(*place));
}

std::span<const Edge> GpioInputsOutputs::index_edges(std::size_t axis) const {
  const auto& place = axes_[axis].index;
  return place ? lines_.edges(*place) : std::span<const Edge>();
}

bool GpioInputsOutputs::index_queue_was_full(std::size_t axis) const {
  const auto& place = axes_[axis].index;
  return place && lines_.queue_was_full(*place);
}

std::uint64_t GpioInputsOutputs::lost_edges(std::size_t axis) const {
  const auto& places = axes_[axis];
  std::uint64_t lost = 0;
  for (const auto& place : {places.fault, places.limit_negative, places.limit_positive, places.home, places.index,
                            places.torque_off[0], places.torque_off[1], places.hall[0], places.hall[1], places.hall[2]})
    if (place) lost += lines_.lost_edges(*place);
  return lost;
}

void GpioInputsOutputs::set_enable(std::size_t axis, bool on) {
  const auto& places = axes_[axis];
  if (places.enable) lines_.set(*places.enable, on);
  if (places.brake) lines_.set(*places.brake, on && places.released);
}

}  // namespace stiction::hal
