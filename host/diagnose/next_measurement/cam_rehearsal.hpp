// The separating cams within what an axis and its records allow, run on the machine file's simulation.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/diagnose/next_measurement/trajectory_rehearsal.hpp"
#include "sim/cam/separating_cams.hpp"

namespace stiction::host {

// What records say of the cam that made them.
struct RecordedCam {
  sim::cam::CamRange range;
  double master_speed = 0.0;  // rad/s, the highest of the records
};

// Of `logs` of an `axis`, with linear channels: from the first one whose master turns steadily through cycles that are
// alike. None where there is none, where the axis did not move in it, and where it went on from cycle to cycle though
// it is not endless: its travel does not hold as many cycles as a measurement takes.
std::optional<RecordedCam> recorded_cam(const std::vector<Log>& logs, const machine::AxisModel& axis);

// Cams like the `recorded` one that keep the limits of the axis, that its drive takes and that the machine follows in
// simulation. `axis` as the file has it; `rows` and `context` of the search, `settings` of the rows. The logs have the
// master.
std::vector<Rehearsal> rehearse_cams(const machine::Machine& machine, std::size_t axis, const RecordedCam& recorded,
                                     const LogRows& rows, const SearchContext& context, const SignalSettings& settings);

// Where the slave goes, how fast, what to record, and a warning where the master turned slower in the records: of the
// `log` of a rehearsal, of linear channels, of the cam `proposed`, in the `units` of the axis.
std::string cam_words(const ProposedCam& proposed, const Log& log, const ShownUnits& units);

}  // namespace stiction::host
