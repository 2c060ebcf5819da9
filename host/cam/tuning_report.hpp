// What a tuning of two pulses found and did, cycle by cycle, as figures, charts and sentences.
#pragma once

#include <optional>
#include <vector>

#include "sim/cam/shaping/number_search.hpp"
#include "sim/cam/shaping/record_tuner.hpp"
#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

struct TuningCycle {
  sim::cam::CycleRecord record;
  sim::cam::TunedCycle learned;
  std::optional<sim::cam::PulsePair> pulses{};  // that it was run with
};

// Of a `task` as it was before, the `tuner` at the end, and all `cycles`, one or more; `running`: of a machine that
// does not stop.
sim::ExperimentResult tuning_report(const sim::cam::ShapingTask& task, const sim::cam::RecordTuner& tuner,
                                    const std::vector<TuningCycle>& cycles, bool running);

// Of a search by the quality number alone: `search` on the rise of `task`; `one_pulse`: its trials are place and
// amplitude of one pulse over `length` of the master, and not the amplitudes of two.
sim::ExperimentResult search_report(const sim::cam::ShapingTask& task, const sim::cam::NumberSearch& search,
                                    bool one_pulse, double length);

}  // namespace stiction::host
