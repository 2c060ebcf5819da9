#include "host/requests/tuning_options.hpp"

#include <fmt/format.h>

#include "host/requests/axis_choice.hpp"
#include "host/requests/run_options.hpp"
#include "host/requests/usage_error.hpp"

namespace stiction::host {

MachineTuningSettings tuning_settings(const TuningTexts& texts, const machine::Machine& machine,
                                      const std::vector<Log>& logs) {
  MachineTuningSettings settings;
  if (!texts.shown.empty()) {
    const auto shown = feeds(texts.shown, "--show");
    if (shown.size() != 1) throw UsageError(fmt::format("--show: found {} feeds; expected one", shown.size()));
    settings.shown = shown.front();
  }
  if (!texts.feed.empty()) settings.feeds = feeds(texts.feed);
  settings.axes = axes_to_tune(texts.axis, machine, logs);
  settings.pulse = !texts.no_pulse;
  return settings;
}

}  // namespace stiction::host
