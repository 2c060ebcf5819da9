#include "host/diagnose/between_encoders.hpp"

#include "host/diagnose/judge/encoder_difference.hpp"
#include "sim/effects/effects.hpp"

namespace stiction::host {

BetweenEncoders between_encoders(const DiagnoseInput& input, const Prepared& prepared) {
  BetweenEncoders found;
  const auto training = EncoderDifference::of(prepared.training, prepared.axis, prepared.settings);
  const auto held_out = EncoderDifference::of(prepared.held_out, prepared.axis, prepared.settings);
  if (!training || !held_out) return found;
  found.causes =
      find_between_encoders(*training, *held_out, prepared.axis, ShownUnits(prepared.axis.coordinate), input.seed);
  if (found.causes.findings.empty()) return found;
  found.input = input;
  auto& effects = found.input->machine.axes[input.axis].effects;
  for (const auto& finding : found.causes.findings) {
    // One that may stand once replaces the file's own.
    if (!finding.effect->several)
      std::erase_if(effects, [&](const machine::Effect& known) { return known.name == finding.effect->name; });
    effects.push_back(finding.row());
  }
  return found;
}

}  // namespace stiction::host
