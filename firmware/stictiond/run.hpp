// Runs a task over a backend: real time, the thread beside the loop, the loop, and what it has to say at its end.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware/machine/configuration/conversion.hpp"
#include "firmware/stictiond/cam_drive.hpp"
#include "firmware/stictiond/can_server.hpp"
#include "firmware/stictiond/configuration.hpp"
#include "firmware/stictiond/log_output.hpp"
#include "firmware/stictiond/loop_watchdog.hpp"
#include "firmware/stictiond/master_encoder_bus.hpp"
#include "firmware/stictiond/modbus_motion.hpp"
#include "firmware/stictiond/modbus_publisher.hpp"
#include "firmware/stictiond/object_thread.hpp"
#include "firmware/stictiond/programme.hpp"
#include "firmware/stictiond/real_time.hpp"
#include "firmware/stictiond/remote_setup.hpp"
#include "firmware/stictiond/run_record.hpp"
#include "firmware/stictiond/service_notify.hpp"
#include "firmware/stictiond/service_thread.hpp"
#include "firmware/stictiond/sync_follower.hpp"
#include "firmware/stictiond/trace_room.hpp"
#include "hal/gated_backend.hpp"
#include "hal/loop_timing.hpp"
#include "hal/power_cut.hpp"
#include "hal/program.hpp"
#include "hal/tick_clock.hpp"

namespace stiction::drive {

struct RunResult {
  bool faulted = false;
};

// What the loop did with its time, for people. `timing`: durations of reading, control and writing; `lateness`: of the
// ticks; `missed`: number of ticks that began later than a period; `processor_ns`: that the loop's thread ran in a
// tick, without waiting, in the mean.
std::string describe_timing(const hal::LoopTiming& timing, const hal::TimeHistogram& lateness, std::uint64_t missed,
                            double processor_ns);

// Of the calling thread, ns.
std::int64_t processor_time_ns();

// What the loop did with its time, for a client. `clock`: of the loop; `timing`: durations; `state`: is filled.
void show_timing(const hal::TickClock& clock, const hal::LoopTiming& timing, PublishedState& state);

// Throws StartRefused where the motion and its trace do not fit into memory. `options`, `configuration`: as below;
// `locked`: whether memory is locked.
void check_room(const DriveOptions& options, const DriveConfiguration& configuration, bool locked);

// Throws StartRefused where the machine file asks for signals of motor or power stage that the backend does not have.
// `configuration`: of the drive; `sets`: what the backend has, one an axis.
void check_motor_inputs(const DriveConfiguration& configuration, std::span<const MotorSignalSet> sets);

// Throws StartRefused where a cam is tuned by an encoder at the load that the backend does not have. `configuration`:
// of the drive; `cam`: its cam, may be null; `has_them`: whether the backend is a LoadEncoderBackend.
void check_load_encoder(const DriveConfiguration& configuration, CamDrive* cam, bool has_them);

inline constexpr std::uint64_t row_bytes = 256;  // of a trace's file, for one axis in one tick, at most

// The task of the options. `positions`: where the axes stand (m). Throws MotionError. `options`: of the command line;
// `configuration`: of the drive.
// `cam`: of --cam and --master; null: none.
Task task_of(const DriveOptions& options, const DriveConfiguration& configuration, std::span<const double> positions,
             CamDrive* cam = nullptr);
// Of --hold. `options`, `configuration`: as above.
std::uint64_t ticks_of(const DriveOptions& options, const DriveConfiguration& configuration);
// Of the motion that a trace keeps. `options`, `configuration`, `task`: as above.
std::uint64_t traced_ticks(const DriveOptions& options, const DriveConfiguration& configuration, const Task& task);
// Null where the options ask for no cam. Throws StartRefused. `options`, `configuration`: as above.
std::unique_ptr<CamDrive> cam_of(const DriveOptions& options, const DriveConfiguration& configuration);

// The loop's clock behind a controller's SYNC.
class ControllerClock {
 public:
  explicit ControllerClock(const DriveConfiguration& c)
      : follower_(c.period_ns * (c.setup.can_server ? remote_axes(c).front().interpolation.ticks : 1)) {}

  // Once a cycle, with the age of its SYNC. `age_ns`: none without a new SYNC; `clock`: is shifted; `log`: says when
  // both agree; `now_ns`: time of the tick.
  void follow(std::optional<std::int64_t> age_ns, hal::TickClock& clock, LogRing& log, std::int64_t now_ns) {
    if (!age_ns) return;
    clock.shift(follower_.step(*age_ns));
    if (follower_.locked() && !said_) log.push(now_ns, LogLevel::info, "CAN: the clock follows the controller's SYNC");
    said_ |= follower_.locked();
  }

 private:
  SyncFollower follower_;
  bool said_ = false;
};

// Bit 9 of a bus that is not obeyed is not set.
inline std::uint16_t statusword_on(std::uint16_t word, bool obeyed) {
  return obeyed ? word : static_cast<std::uint16_t>(word & ~statusword::remote_bit);
}

// The axes for a motion controller to see, in the machine's coordinates. `loop`, `programme`: whose state is shown;
// `obeyed`: whether its commands are; `shown`: space for one entry per axis.
template <hal::Backend B>
void show_on_can(const hal::DriveLoop<B>& loop, const Programme<B>& programme, bool obeyed,
                 std::span<ShownAxis> shown) {
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const auto& signals = loop.loop().signals()[i];
    shown[i] = {statusword_on(programme.statusword(i), obeyed),
                machine::to_si(loop.drive(i).position()),
                machine::to_si(signals.v),
                machine::to_si(signals.e),
                machine::to_si(signals.i),
                loop.fault(i)};
  }
}

// What motor and power stage of axis `i` of `loop` tell, into `axis`.
template <hal::Backend B>
void show_motor(const hal::DriveLoop<B>& loop, std::size_t i, PublishedAxis& axis) {
  const auto& commutation = loop.drive(i).commutation();
  axis.commutation = commutation.known() ? 2 : commutation.searching() ? 1 : 0;
  axis.commutation_offset = 360.0 * static_cast<double>(static_cast<std::int32_t>(commutation.offset().raw)) * 0x1p-32;
  const auto& protection = loop.protection(i);
  axis.motor_load = static_cast<double>(protection.motor().state()) * 0x1p-40;
  axis.stage_load = static_cast<double>(protection.stage_state()) * 0x1p-40;
  const auto& inputs = protection.inputs();
  axis.dc_link = machine::to_si(inputs.dc_link);
  axis.motor_temperature = 0.1 * inputs.motor_temperature;
  axis.stage_temperature = 0.1 * inputs.stage_temperature;
  axis.torque_off_a = inputs.torque_off_a;
  axis.torque_off_b = inputs.torque_off_b;
}

// The axes for others to see. Wait-free. `loop`, `programme`: whose state is published; `period`: of the fast tick, s;
// `server`: a ModbusPublisher or an ObjectServer.
template <hal::Backend B, class Server>
void show_to_clients(const hal::DriveLoop<B>& loop, Programme<B>& programme, double period, Server& server) {
  Fault fault = Fault::none;
  for (std::size_t i = 0; i < loop.axis_count(); ++i)
    if (loop.fault(i) != Fault::none) fault = loop.fault(i);
  server.publish(loop.loop().signals(), loop.now_ns(), fault, [&](std::size_t i, PublishedAxis& axis) {
    // Of the machine, as on CAN: homing has moved the zero of the encoder.
    axis.position = machine::to_si(loop.drive(i).position());
    axis.set_position = machine::to_si(loop.drive(i).set_position());
    axis.statusword = statusword_on(programme.statusword(i), server.motion_allowed());
    axis.fault = loop.fault(i);
    const auto& inputs = loop.inputs(i);
    axis.limit_negative = inputs.limit_negative;
    axis.limit_positive = inputs.limit_positive;
    axis.home = inputs.home;
    show_motor(loop, i, axis);
    show_asked(programme.remote()[i], period, axis);
    axis.cam_tuning = {};
    if (const auto* tuning = programme.tuning(i)) tuning->show(axis.cam_tuning);
  });
}

// `clock`: the one that the backend waits for; null: it has a time of its own. `real_time`: of the process, which has
// been prepared before the backend was made, so that the threads of that have its stacks too; `backend`: power stages
// and encoders; `configuration`: of the drive; `options`: of the command line; `title`: one line for the service
// manager; `record`: of this run, for the next one. Throws StartRefused, MotionError.
template <hal::Backend B>
RunResult run(RealTime& real_time, B& backend, hal::TickClock* clock, const DriveConfiguration& configuration,
              const DriveOptions& options, const std::string& title, RunRecord& record) {
  std::vector<MotorSignalSet> motor_signals(configuration.names.size());
  if constexpr (hal::ProtectionBackend<B>)
    for (std::size_t i = 0; i < motor_signals.size(); ++i) motor_signals[i] = backend.motor_signals(i);
  check_motor_inputs(configuration, motor_signals);
  hal::LoopTiming timing;
  const hal::PowerCut::Entry entry(hal::power_cut, backend);
  hal::GatedBackend<B> gated(backend, hal::power_cut);
  hal::TimedBackend<hal::GatedBackend<B>> timed(gated, timing);
  hal::DriveLoop<hal::TimedBackend<hal::GatedBackend<B>>> loop(timed, configuration.axes, configuration.drives,
                                                               configuration.ticker, configuration.compensations);
  std::vector<double> positions;
  for (const auto& feedback : loop.loop().feedback()) positions.push_back(machine::to_si(feedback.position));
  const auto cam = cam_of(options, configuration);
  check_load_encoder(configuration, cam.get(), hal::LoadEncoderBackend<B>);
  const Task task = task_of(options, configuration, positions, cam.get());
  const auto traced = traced_ticks(options, configuration, task);
  if (!options.trace.empty()) check_trace_file(options.trace, traced * configuration.axes.size() * row_bytes);
  Trace trace(configuration.names.size(), options.trace.empty() ? 0 : traced);
  LogRing log;
  LogOutput output(STDERR_FILENO, journal_listens());
  const LogSink say = [&output](LogLevel level, std::string_view text) { output.put(level, text); };
  const auto remote = remote_axes(configuration);
  Programme programme(loop, task, remote, log, options.trace.empty() ? nullptr : &trace);
  // Only who serves takes set-points: a motion of its own is the programme's alone.
  const bool serves_can = configuration.setup.can_server && task.serve;
  std::shared_ptr<ParameterDesk> desk;
  if (configuration.setup.modbus_server || serves_can)
    desk = std::make_shared<ParameterDesk>(
        configuration.machine, configuration.setup,
        KeptParameters{.file = parameter_file(options),
                       .check = [options](const ParameterSet& set) { check_whole(options, set); },
                       .begun = configuration.stored,
                       .file_holds = !configuration.rejected_parameters});
  std::optional<ModbusPublisher> modbus;
  if (configuration.setup.modbus_server)
    modbus.emplace(
        desk, configuration.machine, configuration.setup,
        [&](PublishedState& state) {
          state.trace_rows = static_cast<std::uint32_t>(trace.rows());
          state.trace_lost = static_cast<std::uint32_t>(trace.lost());
          if (clock != nullptr) show_timing(*clock, timing, state);
        },
        [] { return hal::power_cut.is_cut(); }, !task.serve);

  std::optional<CanServer> can;
  if (serves_can) can.emplace(can_server_config(configuration), log);
  std::optional<MasterEncoderBus> encoder;
  if (task.cam != nullptr && task.cam->encoder_node() != 0)
    encoder.emplace(configuration.setup.master_encoder->interface, task.cam->encoder_node());
  std::optional<ObjectServer> objects;
  std::optional<ObjectThread<hal::can::CanSocket>> object_thread;
  if (can) {
    const auto config = can_server_config(configuration);
    objects.emplace(configuration, config, desk, can->links(), [] { return hal::power_cut.is_cut(); });
    object_thread.emplace(*objects, object_socket(config));
  }
  std::vector<ShownAxis> shown(configuration.names.size());
  ControllerClock controller_clock(configuration);

  const double period = configuration.machine.timing.fast_period;
  double processor_ns = 0.0;
  ServiceNotify notify;
  {
    // One in a time of its own has no clock that it could be late by.
    std::optional<LoopWatchdog> watchdog;
    if (clock != nullptr)
      watchdog.emplace([&] { return programme.progress(); }, hal::power_cut, configuration.setup.real_time.priority);
    ServiceThread service(
        log, say, notify,
        {.progress = [&] { return programme.progress(); },
         .status = [&] { return title; },
         .starved =
             [&] {
               if (!hal::power_cut.is_cut()) return;  // it has not begun, or has no clock
               say(LogLevel::error,
                   fmt::format("fault {} '{}': the loop makes no progress, the power is off",
                               static_cast<int>(Fault::watchdog_starved), stiction::name_of(Fault::watchdog_starved)));
             },
         .round =
             [&] {
               if (cam && cam->tuning() != nullptr) cam->tuning()->round(say);
               const int asked = hal::signal_asked;
               hal::signal_asked = 0;
               if (!desk) return;
               if (asked == SIGUSR1) desk->open_commissioning();
               if (asked == SIGUSR2) desk->close_commissioning();
               for (const auto& line : desk->said().take(hal::MonotonicTime().now_ns())) say(LogLevel::notice, line);
             }},
        2 * LoopWatchdog::limit_ns);  // behind the watchdog, which acts and does not speak
    real_time.prepare_thread();
    if (any_refused(real_time.steps())) {
      // The simulated machine may be late; real axes may not.
      if (options.hal != "simulated" && configuration.setup.real_time.priority > 0)
        throw StartRefused(
            "found no real-time conditions; expected every step below, or drive.real_time.priority = 0 for a test "
            "without power\n" +
            text_of(real_time.steps()));
      for (const RealTimeStep& step : real_time.steps()) say(LogLevel::info, text_of(std::span(&step, 1)));
    }
    notify.ready(title);
    hal::start_is_over = true;
    record.begin();
    if (configuration.rejected_parameters) {
      say(LogLevel::error,
          "the stored parameters are not used, but the set before them; the axes remain off (fault 50) "
          "until the next start with parameters that can be used: " +
              *configuration.rejected_parameters);
      programme.keep_off(Fault::parameters_damaged);
    }
    if (record.broken_off()) say(LogLevel::warning, "the last run did not end in order, but " + *record.broken_off());
    if (clock != nullptr) clock->keep_clear_of_kernel_tick();
    loop.begin();  // every thread has been made, and what came before took its time
    programme.tick(false);
    const std::int64_t processor_begin_ns = processor_time_ns();
    log.push(loop.now_ns(), LogLevel::info, "the loop has begun");
    if (task.serve && !can && !modbus)
      log.push(loop.now_ns(), LogLevel::warning,
               "found neither [drive.can_server] nor [drive.modbus_server]: no client can command a motion, so the "
               "axes remain off");
    bool stop_asked = false;  // by a client, of a motion that is the programme's own
    while (!programme.over()) {
      if (modbus)
        modbus->take_motion([&](const MotionWrite& asked) {
          if (task.serve) return ask(asked, period, programme.remote()[asked.axis]);
          stop_asked = true;  // all that is let through then
        });
      if (objects)
        objects->loop().take_motion(
            [&](const MotionWrite& asked) { ask(asked, period, programme.remote()[asked.axis], CommandSource::can); });
      const bool begins = can && loop.loop().slow() && can->receive(loop.now_ns(), programme.remote());
      if (encoder)
        encoder->receive(loop.now_ns(),
                         [&](const hal::can::Frame& frame, std::int64_t age_ns) { task.cam->take(frame, age_ns); });
      const bool suspended = clock != nullptr && clock->was_suspended();
      if (suspended) log.push(loop.now_ns(), LogLevel::error, "the computer was suspended");
      tick_under_watch(programme, loop, hal::power_cut,
                       stop_asked || hal::stop_wanted != 0,  // by a signal: a controlled stop, then the end
                       suspended);
      if (begins) {
        show_on_can(loop, programme, can->motion_allowed(), shown);
        can->send(shown);
        if (clock != nullptr) controller_clock.follow(can->sync_age_ns(), *clock, log, loop.now_ns());
      }
      if (modbus && loop.loop().slow()) show_to_clients(loop, programme, period, *modbus);
      if (objects && loop.loop().slow()) show_to_clients(loop, programme, period, *objects);
    }
    processor_ns =
        static_cast<double>(processor_time_ns() - processor_begin_ns) / static_cast<double>(programme.progress());
    record.end();
    notify.stopping("the axes are off");
  }
  if (!options.trace.empty())
    trace.write(options.trace, configuration.names,
                std::vector<std::string>{"log: stictiond", "machine: " + configuration.machine.name});
  if (can)
    fmt::print("controller: {} frames accepted, {} refused, {} of a wrong length, {} answers not sent\n",
               can->counts().taken, can->counts().refused, can->counts().wrong_size, can->send_failed());
  if (clock != nullptr) fmt::print("{}", describe_timing(timing, clock->lateness(), clock->missed(), processor_ns));
  return {programme.faulted()};
}

}  // namespace stiction::drive
