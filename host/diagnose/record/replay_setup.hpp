// One axis of a machine alone, with the logs that have set-points for it: what replays run on.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/diagnose/record/followed_set_points.hpp"
#include "host/diagnose/record/record.hpp"
#include "host/identify/motion.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

struct ReplaySetup {
  machine::Machine machine;  // of one axis, or of both where they act on each other
  std::vector<Log> logs;     // with their channels only, the axis' first
};

// Logs without set-points are left out. `coupled`: with the other axis of two, where a log has its set-points.
// `machine` of the file; `logs` that are replayed.
ReplaySetup replay_setup_of(const machine::Machine& machine, std::size_t axis, const std::vector<Log>& logs,
                            bool coupled = false);

// The `axis` with the equivalent motor, which takes a third of the time and moves it the same but for how it hunts.
void without_windings(machine::AxisModel& axis);

// Why replays of this axis would not be what was recorded: its controller is not known, or a test signal of `logs`
// cannot act in them, nor in those of the other axis if they are `coupled` ("FILE: found ..."). Empty when they are.
// `machine` of the file; `axis`: its index.
std::string why_not_simulated(const machine::Machine& machine, std::size_t axis, const std::vector<Log>& logs,
                              bool coupled = false);

// The `machine` with that axis alone; `axis`: its index.
machine::Machine machine_of_axis(const machine::Machine& machine, std::size_t axis);

// What the bench's axis makes of each log's set-points. Throws FaultTripped, LogError.
std::vector<Log> replays(const ReplaySetup& setup);
// The same of the logs of many records at once, in double precision where the axis has it (replay_together.hpp);
// nothing of a record that the `machine`, of one axis, cannot follow. Each log has a noise of the encoder to itself,
// those after the machine's. Throws LogError.
std::vector<std::optional<std::vector<Log>>> replays_together(const machine::Machine& machine,
                                                              std::span<const std::vector<Log>> records);
// Its position alone (m), at the log's samples.
std::vector<std::vector<double>> simulated_positions(const ReplaySetup& setup);

// Logs as the machine's simulation without the encoder's noise goes through them.
struct WithoutNoise {
  std::vector<Log> motion;    // the logs, with the simulated position
  std::vector<Log> replayed;  // the replays themselves
};
// The motion is the same logs with the simulated position in place of the measured one: the motion without what noise
// and the effects looked for did to it. A regressor of the measured motion carries the disturbance that it is regressed
// on, through the control loop (Gilson, Garnier, Young, Van den Hof 2011); one of this motion does not. Empty when a
// log has no set-points, when the machine cannot follow them, when it goes another way than the measured one, or when a
// test signal cannot act in the simulation.
// `axis`: its index; `how`: whether another way is allowed.
WithoutNoise without_noise(const machine::Machine& machine, std::size_t axis, const std::vector<Log>& logs,
                           Following how = Following::as_recorded);
// The runs of many records at once, by replays_together(): the replays of WithoutNoise, empty as these. `machine`,
// `axis`, `how`: as above.
std::vector<std::vector<Log>> runs_without_noise(const machine::Machine& machine, std::size_t axis,
                                                 std::span<const std::vector<Log>> records, Following how);

}  // namespace stiction::host
