// Pulses that are added to a rise so that the load's vibration and theirs cancel (Dostrasil 2014, 6.1 and 6.2). The
// residual is linear in the amplitudes: each is found in closed form, the place of a single one by bisection.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "sim/cam/shaping/task.hpp"

namespace stiction::sim::cam {

// The own rise of a `task`, scaled to `stroke`.
Curve own_rise(const ShapingTask& task, double stroke);

struct Pulse {
  double position = 0.0;   // of the master, where it begins
  double amplitude = 0.0;  // of the slave
};

// Of a `task`, as extended in 6.2: a rise of its own by `amplitude` over `length` by `law`, inside of the rise, whose
// own stroke is that much less. The last place before the end of the rise, since a pulse is smallest there; none where
// the rise has no such place.
std::optional<Pulse> tuned_pulse(const ShapingTask& task, std::string_view law, double length);
// The rise of the `task` with that `pulse` by `law` over `length`.
Curve with_pulse(const ShapingTask& task, const Pulse& pulse, std::string_view law, double length);

// The master's way in the longest time constant of the drive of a `task` itself, its load's mode apart: so long a drive
// needs to follow a pulse.
double drive_lag(const ShapingTask& task);

// As published first (6.1): a bump (1 - cos)/2 of `length`, one period of the mode, at the beginning of the dwell. It
// begins within half a period behind the rise of `task`.
std::optional<Pulse> tuned_dwell_pulse(const ShapingTask& task, double length);
// The rise of the `task` with that `pulse` of `length` behind it.
Curve with_dwell_pulse(const ShapingTask& task, const Pulse& pulse, double length);

// Where two pulses are, in periods of the load's mode.
struct PulsePlaces {
  double length = 0.5;  // of each
  double apart = 0.25;  // their beginnings
  double before = 0.0;  // the end of the second one, before the end of the rise

  double room() const { return length + apart + before; }  // periods of the rise that they take
};

// Those that a tuner tries in turn: at the end of the rise, where pulses are smallest, then further apart, earlier and
// longer, where they ask for less acceleration.
const std::vector<PulsePlaces>& pulse_places();

struct PulsePair {
  Pulse first, second;
  double length = 0.0;
};

// Two pulses at `places`: one linear equation for both amplitudes, whatever the vibration that they have to cancel.
// `residual`: that vibration at the end of the rise, as modal_residual() has it. None in a rise of `task` without room.
std::optional<PulsePair> pulse_pair(const ShapingTask& task, std::complex<double> residual,
                                    const PulsePlaces& places = {});
// The same of pulses where those of `where` are, in a `task` whose `residual` they are to cancel.
PulsePair pulse_pair_at(const ShapingTask& task, std::complex<double> residual, PulsePair where);
// The rise of the `task` with both `pulses`.
Curve with_pulses(const ShapingTask& task, const PulsePair& pulses);
// The same with those of all `pairs`.
Curve with_pulses(const ShapingTask& task, std::span<const PulsePair> pairs);

}  // namespace stiction::sim::cam
