// What `stiction tune-friction` tunes, from the texts of a request.
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"
#include "host/tune/machine_tuning.hpp"

namespace stiction::host {

// The options of `stiction tune-friction` as typed; empty: as its help says.
struct TuningTexts {
  std::string axis{}, feed{}, shown{};
  bool no_pulse = false;
};

// The tuning of `machine` from `logs`, or from its simulation where there are none, that `texts` ask for. Throws
// UsageError.
MachineTuningSettings tuning_settings(const TuningTexts& texts, const machine::Machine& machine,
                                      const std::vector<Log>& logs);

}  // namespace stiction::host
