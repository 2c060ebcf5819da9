#include "host/requests/replay_request.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "firmware/machine/configuration/double_signals.hpp"
#include "host/log/read_log.hpp"
#include "host/requests/names.hpp"
#include "host/requests/run_options.hpp"
#include "host/requests/usage_error.hpp"
#include "host/simulate/friction_choice.hpp"
#include "host/simulate/replay.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

std::vector<ReplayCase> replays_of(const ReplayRequest& request, const ReplayHooks& hooks) {
  std::vector<ReplayCase> cases;
  const auto& names = request.machines;
  auto needs = needs_of("replay");
  // The limits of the number formats are the firmware's alone.
  if (request.signals == "double") needs.formats = Formats::any;
  for (const auto& name : names) {
    const auto machine = hooks.load(name, needs);
    const auto models = friction_models(request.friction, machine);
    for (const auto& friction : models) {
      const auto label = names.size() == 1    ? friction
                         : models.size() == 1 ? machine.id
                                              : fmt::format("{}, {}", machine.id, friction);
      for (const auto& other : cases)
        if (other.label == label)
          throw UsageError(fmt::format("--machine, --friction: found {} twice; expected different names", label));
      auto& c = cases.emplace_back(ReplayCase{label, machine, {}});
      use_friction(c.machine, friction);
      // Machines have colours of their own, and so have axes with laws of their own.
      if (label != machine.id && machine.axes.front().friction.models.contains(friction)) c.friction = friction;
    }
  }
  return cases;
}

}  // namespace

Replayed replay_request(const ReplayRequest& request, const ReplayHooks& hooks) {
  require_known("--signals", request.signals, "one of", {"fixed", "double"});
  Replayed replayed;
  replayed.cases = replays_of(request, hooks);
  if (hooks.begin) hooks.begin(replayed.cases.size());
  replayed.log = read_log(request.from, {request.columns, {}});
  // A controller that is not the firmware's has doubles alone.
  const bool fixed =
      request.signals != "double" && std::ranges::all_of(replayed.cases, [](const ReplayCase& c) {
        return std::ranges::all_of(c.machine.axes, [](const machine::AxisModel& axis) { return axis.cascaded(); });
      });
  for (auto& c : replayed.cases) {
    if (hooks.running) hooks.running(c.label);
    c.simulated = fixed ? replay<FixedSignals>(c.machine, replayed.log, {request.axis})
                        : replay<machine::DoubleSignals>(c.machine, replayed.log, {request.axis});
  }
  replayed.result = replay_result(replayed.log, replayed.cases,
                                  fixed ? FixedSignals::name : machine::DoubleSignals::name, request.axis);
  return replayed;
}

}  // namespace stiction::host
