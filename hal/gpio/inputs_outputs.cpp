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
    axes_.push_back({.enable = output(wired.enable, "enable"),
                     .brake = output(wired.brake, "brake"),
                     .fault = input(wired.fault, "fault"),
                     .limit_negative = input(wired.limit_negative, "negative limit"),
                     .limit_positive = input(wired.limit_positive, "positive limit"),
                     .home = input(wired.home, "home"),
                     .index = input(wired.index, "index"),
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
  for (const auto& place : {places.fault, places.limit_negative, places.limit_positive, places.home, places.index})
    if (place) lost += lines_.lost_edges(*place);
  return lost;
}

void GpioInputsOutputs::set_enable(std::size_t axis, bool on) {
  const auto& places = axes_[axis];
  if (places.enable) lines_.set(*places.enable, on);
  if (places.brake) lines_.set(*places.brake, on && places.released);
}

}  // namespace stiction::hal
