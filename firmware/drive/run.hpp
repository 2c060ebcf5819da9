// Runs a task over a backend: real time, the thread beside the loop, the loop, and what it has to say at its end.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <optional>
#include <string>
#include <vector>

#include "firmware/drive/configuration.hpp"
#include "firmware/drive/modbus_service.hpp"
#include "firmware/drive/programme.hpp"
#include "firmware/drive/real_time.hpp"
#include "firmware/drive/service_notify.hpp"
#include "firmware/drive/service_thread.hpp"
#include "hal/loop_timing.hpp"
#include "hal/tick_clock.hpp"
#include "sim/control/conversion.hpp"

namespace stiction::drive {

// Set by SIGTERM and SIGINT: a controlled stop, then the end.
extern volatile std::sig_atomic_t stop_wanted;
void catch_stop_signals();

struct RunResult {
  bool faulted = false;
  bool motion_done = false;
};

// What the loop did with its time, for people.
std::string describe_timing(const hal::LoopTiming& timing, const hal::TimeHistogram& lateness, std::uint64_t missed);

// The task of the options. `positions`: where the axes stand (m). Throws MotionError.
Task task_of(const DriveOptions& options, const DriveConfiguration& configuration, std::span<const double> positions);

// The state of the axes for others. Wait-free.
template <hal::Backend B>
void publish(const hal::DriveLoop<B>& loop, const hal::TickClock* clock, hal::Snapshot<PublishedState>& snapshot) {
  auto& state = snapshot.next();
  state.seconds = static_cast<std::uint32_t>(loop.now_ns() / 1'000'000'000);
  state.missed_deadlines = static_cast<std::uint32_t>(loop.missed_ticks());
  state.largest_lateness =
      clock == nullptr ? 0.0 : std::max(state.largest_lateness, static_cast<double>(clock->lateness_ns()) * 1e-9);
  for (std::size_t i = 0; i < loop.axis_count(); ++i) {
    auto& axis = state.axes[i];
    const auto& signals = loop.loop().signals()[i];
    axis.statusword = loop.statusword(i);
    axis.fault = loop.fault(i);
    axis.position = sim::to_si(loop.drive(i).position());
    axis.set_position = sim::to_si(loop.drive(i).set_position());
    axis.velocity = sim::to_si(signals.v);
    axis.current = sim::to_si(signals.i);
    axis.following_error = sim::to_si(signals.e);
  }
  snapshot.publish();
}

// `clock`: the one that the backend waits for; null: it has a time of its own.
template <hal::Backend B>
RunResult run(B& backend, hal::TickClock* clock, const DriveConfiguration& configuration, const DriveOptions& options,
              const std::string& title) {
  const RealTimeRequest request{.priority = configuration.setup.real_time.priority,
                                .cpu = configuration.setup.real_time.cpu};
  RealTime real_time;
  auto steps = real_time.prepare_process(request);

  hal::LoopTiming timing;
  hal::TimedBackend<B> timed(backend, timing);
  hal::DriveLoop<hal::TimedBackend<B>> loop(timed, configuration.axes, configuration.drives, configuration.ticker,
                                            configuration.compensations);
  std::vector<double> positions;
  for (const auto& feedback : loop.loop().feedback()) positions.push_back(sim::to_si(feedback.position));
  const Task task = task_of(options, configuration, positions);
  Trace trace(configuration.names.size(), options.trace.empty() ? 0 : task.motion.ticks());
  LogRing log;
  std::optional<ModbusService> modbus;
  if (const auto& server = configuration.setup.modbus_server)
    modbus.emplace(configuration, *server, parameter_file(options));
  const bool remote = modbus && configuration.setup.modbus_server->motion_allowed;
  Programme programme(loop, task, log, options.trace.empty() ? nullptr : &trace, remote ? &modbus->demand() : nullptr);

  ServiceNotify notify;
  constexpr std::int64_t starvation_ns = 100'000'000;
  {
    ServiceThread service(
        log, log_to_standard_error, notify,
        {.progress = [&] { return programme.progress(); }, .status = [&] { return title; }, .starved = [] {}},
        starvation_ns);
    for (auto& step : real_time.prepare_thread(request)) steps.push_back(std::move(step));
    if (any_refused(steps)) fmt::print(stderr, "{}", text_of(steps));
    notify.ready(title);
    if (clock != nullptr) clock->restart();  // what came before took its time
    programme.tick(false);
    log.push(loop.now_ns(), LogLevel::info, "the loop has begun");
    while (!programme.over()) {
      programme.tick(stop_wanted != 0);
      if (modbus && loop.loop().slow()) publish(loop, clock, modbus->state());
    }
    notify.stopping("the axes are off");
  }
  if (!options.trace.empty())
    trace.write(options.trace, configuration.names,
                std::vector<std::string>{"log: stictiond", "machine: " + configuration.machine.name});
  if (clock != nullptr) fmt::print("{}", describe_timing(timing, clock->lateness(), clock->missed()));
  return {programme.faulted(), !programme.faulted()};
}

}  // namespace stiction::drive
