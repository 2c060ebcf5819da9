#include "firmware/stictiond/run.hpp"

#include <fmt/format.h>
#include <time.h>

#include <cmath>

#include "firmware/machine/file/units.hpp"
#include "sim/experiment/circle_path.hpp"

namespace stiction::drive {

std::int64_t processor_time_ns() {
  timespec used{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return used.tv_sec * 1'000'000'000 + used.tv_nsec;
}

std::string describe_timing(const hal::LoopTiming& timing, const hal::TimeHistogram& lateness, std::uint64_t missed,
                            double processor_ns) {
  std::string text =
      fmt::format("{:<10} {:>12} {:>12} {:>12} {:>12}\n", "time, us", "median", "99.9 %", "largest", "mean");
  const auto row = [&](const char* name, const hal::TimeHistogram& histogram) {
    const auto counts = histogram.read();
    text += fmt::format("{:<10} {:>12.2f} {:>12.2f} {:>12.2f} {:>12.3f}\n", name,
                        static_cast<double>(counts.quantile(0.5)) * 1e-3,
                        static_cast<double>(counts.quantile(0.999)) * 1e-3, static_cast<double>(counts.maximum) * 1e-3,
                        counts.mean * 1e-3);
  };
  row("lateness", lateness);
  row("work", timing.work());
  for (const auto part : {hal::LoopPart::read, hal::LoopPart::control, hal::LoopPart::write})
    row(hal::loop_part_names[static_cast<std::size_t>(part)], timing.part(part));
  text += fmt::format("processor time of the loop's thread {:.3f} us a tick\n", processor_ns * 1e-3);
  return text + fmt::format("missed ticks {}\n", missed);
}

void show_timing(const hal::TickClock& clock, const hal::LoopTiming& timing, PublishedState& state) {
  state.missed_deadlines = static_cast<std::uint32_t>(clock.missed());
  state.largest_lateness = static_cast<double>(clock.lateness().maximum()) * 1e-9;
  state.largest_work = static_cast<double>(timing.work().maximum()) * 1e-9;
}

namespace {

// m/s
double feed_of(const DriveOptions& options) {
  try {
    return machine::parse_quantity(options.circle, "m/s");
  } catch (const machine::UnitError& error) {
    throw MotionError(
        fmt::format("--circle: found '{}' ({}); expected a feed such as \"16 m/min\"", options.circle, error.what()));
  }
}

}  // namespace

std::uint64_t ticks_of(const DriveOptions& options, const DriveConfiguration& configuration) {
  return static_cast<std::uint64_t>(std::ceil(*options.hold / configuration.machine.timing.fast_period));
}

std::uint64_t traced_ticks(const DriveOptions& options, const DriveConfiguration& configuration, const Task& task) {
  if (task.cam_ticks == 0) return task.motion.ticks();
  // And the stop.
  const double stop = CamDrive::longest_stop / configuration.machine.timing.fast_period;
  return ticks_of(options, configuration) + static_cast<std::uint64_t>(std::ceil(stop));
}

std::unique_ptr<CamDrive> cam_of(const DriveOptions& options, const DriveConfiguration& configuration) {
  if (options.master.empty() && options.cam.empty() && options.speed.empty()) return {};
  if (options.master.empty())
    throw StartRefused(
        "--cam, --speed: found no --master; expected what the axes follow: virtual, an axis, or can:NODE");
  if (!options.circle.empty()) throw StartRefused("--circle: found --master as well; expected one of both");
  return std::make_unique<CamDrive>(options, configuration);
}

void check_room(const DriveOptions& options, const DriveConfiguration& configuration, bool locked) {
  if (!options.cam.empty() && options.hold && !options.trace.empty()) {
    const double ticks = *options.hold / configuration.machine.timing.fast_period;
    check_memory(ticks * sizeof(AxisSignals<FixedSignals>) * static_cast<double>(configuration.axes.size()), locked);
  }
  if (options.circle.empty()) return;
  const double feed = feed_of(options);
  if (!(feed > 0.0)) return;  // refused by the motion itself
  constexpr std::size_t set_bytes = sizeof(Motion::Set), signal_bytes = sizeof(AxisSignals<FixedSignals>);
  const double ticks =
      sim::CirclePath::lap_end * sim::CircleSettings{}.radius / feed / configuration.machine.timing.fast_period;
  const double bytes = static_cast<double>(set_bytes + (options.trace.empty() ? 0 : signal_bytes));
  check_memory(ticks * bytes * static_cast<double>(configuration.axes.size()), locked);
}

Task task_of(const DriveOptions& options, const DriveConfiguration& configuration, std::span<const double> positions,
             CamDrive* cam) {
  const auto& machine = configuration.machine;
  Task task{.approach = Motion(machine.axes.size()), .motion = Motion(machine.axes.size())};
  task.cam = cam;
  if (cam != nullptr && options.hold) {
    std::vector<double> begin(positions.begin(), positions.end());
    begin[cam->own_axis()] = cam->start();
    task.motion = Motion::standing_at(begin);
    task.approach = task.motion.approach(machine, positions);
    task.cam_ticks = ticks_of(options, configuration);
  } else if (!options.circle.empty()) {
    task.motion = Motion::circle(machine, feed_of(options));
    task.approach = task.motion.approach(machine, positions);
  } else if (options.hold) {
    task.idle_ticks = ticks_of(options, configuration);
  } else {
    task.serve = true;
  }
  return task;
}

void check_load_encoder(const DriveConfiguration& configuration, CamDrive* cam, bool has_them) {
  if (has_them || cam == nullptr || cam->tuning() == nullptr || cam->tuning()->own_encoder()) return;
  throw StartRefused(fmt::format(
      "{}: [drive.cam_tuning]: found axis {} with a second encoder at the load, which this backend does not "
      "read; expected --hal simulated, or an axis whose own encoder is at the load",
      configuration.machine.id, configuration.names[cam->tuning()->axis()]));
}

void check_motor_inputs(const DriveConfiguration& configuration, std::span<const MotorSignalSet> sets) {
  for (std::size_t i = 0; i < configuration.names.size(); ++i) {
    const std::string axis = "drive.axis." + configuration.names[i];
    const auto& drive = configuration.drives[i];
    const auto& p = drive.protection;
    const auto& set = sets[i];
    const auto demand = [&](bool asked, bool there, const std::string& key, const char* signal, const char* instead) {
      if (asked && !there)
        throw StartRefused(fmt::format("{}: found {}.{}, and nothing that gives {}; expected {}",
                                       configuration.file.string(), axis, key, signal, instead));
    };
    const char* watched =
        "a power stage that tells it over CAN FD or Modbus, or one that watches it and reports by its "
        "fault input";
    demand(drive.commutation.method == CommutationMethod::hall, set.hall, "commutation.method = \"hall\"",
           "the Hall signals",
           "lines hall_a, hall_b and hall_c, a node that tells them over CAN FD, or a different method");
    demand(p.watches_dc_high, set.dc_link, "protection.dc_link_high", "the voltage of the DC link", watched);
    demand(p.watches_dc_low, set.dc_link, "protection.dc_link_low", "the voltage of the DC link", watched);
    demand(p.watches_motor_temperature, set.motor_temperature, "protection.motor_temperature",
           "the motor's temperature", watched);
    demand(p.watches_stage_temperature, set.stage_temperature, "protection.stage_temperature",
           "the power stage's temperature", watched);
    demand(p.torque_off_wired, set.torque_off, "protection.torque_off", "both channels of safe torque off",
           "lines torque_off_a and torque_off_b, or a node that tells them");
  }
}

}  // namespace stiction::drive
