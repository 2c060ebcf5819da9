#include "host/requests/identify_request.hpp"

#include <fmt/format.h>

#include "host/identify/own_identification.hpp"
#include "host/identify/refinement.hpp"
#include "host/identify/steady_table.hpp"
#include "host/log/own_units.hpp"
#include "host/log/shown_units.hpp"
#include "host/log/text_file.hpp"
#include "host/requests/identify_options.hpp"
#include "host/requests/usage_error.hpp"

namespace stiction::host {
namespace {

// Puts what the closed loop made of them in place of the parameters, and says what it gained.
void take(Identification& result, const Refinement& refinement, const ShownUnits& own) {
  for (const auto& refined : refinement.parameters)
    for (auto& parameter : result.parameters)
      if (parameter.name == refined.name) parameter = refined;
  result.method += fmt::format(
      " Refined in closed loop ({} simulations): the simulated {} deviates from the logs by {:.4g} {} rms (before: "
      "{:.4g}), the position by {:.3g} {} rms (before: {:.3g}).",
      refinement.simulations, own.force_word, own.force(refinement.force_after), own.force.unit,
      own.force(refinement.force_before), own.deviation(refinement.position_after), own.deviation.unit,
      own.deviation(refinement.position_before));
}

Identified from_table(const IdentifyRequest& request, const std::string& text, const machine::Machine& machine) {
  if (!request.fix.empty()) throw UsageError("--fix: found a table of steady states; expected logs");
  if (request.refine) throw UsageError("--refine: found a table of steady states; expected logs with set-points");
  const auto& file = request.files.front();
  const auto& axis = axis_to_identify(request.axis, machine, {});
  if (axis.coordinate.rotary())
    throw UsageError(
        fmt::format("{}: found a table of steady states and the rotary axis {}; expected logs", file, axis.name));
  return {
      &axis, identify_table(parse_steady_table(text, file), axis, parse_amperes(request.amperes), FitSettings{}), {}};
}

}  // namespace

Identified identify_request(const IdentifyRequest& request, const machine::Machine& machine,
                            const IdentifyHooks& hooks) {
  const auto amperes = amperes_of(request.amperes);
  if (request.files.size() == 1)
    if (const auto text = read_text_file(request.files.front()); is_steady_table(text))
      return from_table(request, text, machine);
  const auto read = hooks.read(request.files, request.columns);
  const auto& axis = axis_to_identify(request.axis, machine, read);
  if (request.refine && !axis.cascaded() && axis.controller->structure == machine::ControlStructure::unknown)
    throw UsageError(fmt::format(
        "--refine: found axis {} with an unknown controller; expected one that can be simulated", axis.name));
  Identified identified{&axis, {}, linear_logs(read, axis)};
  const auto held = held_values(request.fix, axis);
  const IdentifyOptions settings{model_to_identify(request.friction, axis), amperes, FitSettings{},
                                 request.friction.empty(), held};
  if (hooks.begin) hooks.begin();
  identified.result = identify_logs(identified.logs, axis, settings);
  if (request.refine)
    take(identified.result, refine_in_closed_loop(identified.logs, machine, axis, identified.result, settings),
         ShownUnits(axis.coordinate));
  return identified;
}

}  // namespace stiction::host
