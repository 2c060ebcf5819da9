// Set-points for records that have none: those with which the file's machine moves as the record did. They come by
// learning: what the simulated motion lacks of the recorded one is added to what it is driven with (Arimoto, Kawamura,
// Miyazaki, J. Robotic Systems 1, 1984), with the lead that the position loop takes away. The motor's signal has no
// part in it, so that an effect in the record stays in its residual force.
#pragma once

#include <cstddef>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

// Whether each of the `logs` has set positions of `axis`.
bool have_set_points(const std::vector<Log>& logs, const machine::AxisModel& axis);

// Whether a simulation has to go the way of the record. A draw of the exact machine that sticks elsewhere is a draw all
// the same.
enum class Following { as_recorded, as_near_as_it_comes };

// The `logs` with set positions (m) of the axis where they have none; as they are where the controller of the axis is
// not known or its simulation cannot follow, by `how`. `machine` of the file; `axis`: its index; `made_by`: logs with
// set-points that made those of an exact machine: learning begins near its end there. Empty: with the motion itself.
std::vector<Log> with_set_points(const machine::Machine& machine, std::size_t axis, std::vector<Log> logs,
                                 Following how = Following::as_recorded, const std::vector<Log>& made_by = {});

// The `logs` with the recorded positions up to `cutoff` (Hz) for set positions (m) where they have none: how about the
// axis went. `axis` of the file.
std::vector<Log> with_recorded_set_points(const machine::AxisModel& axis, std::vector<Log> logs, double cutoff);

// Hz, up to where such set-points hold the motion of the `axis`: twice the bandwidth of its position loop, as far as
// logs with `period` (s) reach.
double followed_up_to(const machine::AxisModel& axis, double period);

}  // namespace stiction::host
