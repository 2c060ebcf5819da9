// A parameter of the drive or its loop that may differ from the file's, and shows in what the drive commands.
#pragma once

#include <optional>
#include <span>

#include "firmware/machine/model/machine.hpp"
#include "sim/effects/effect_descriptor.hpp"

namespace stiction::host {

struct CommandParameter {
  const char* key;                                            // of the effect that it belongs to
  std::optional<double> (*value)(const machine::AxisModel&);  // SI; none: this axis has no such parameter
  void (*set)(machine::AxisModel&, double);
  double (*step)(const machine::AxisModel&, const machine::Timing&);  // for the difference, SI
  // A delay in the loop: never less than the file's, and easily taken for a record that is late.
  bool is_delay = false;
  bool of_master = false;                 // only where the records have the axis' master
  std::optional<sim::EffectId> effect{};  // by whose folder it is; set by command_parameters()
};

// Of all effects, in their order; the delays behind the others.
std::span<const CommandParameter> command_parameters();

}  // namespace stiction::host
