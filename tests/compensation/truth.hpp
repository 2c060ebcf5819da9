// Machines whose friction is not the compensation's model, and what may change on them after it was tuned.
#pragma once

#include <functional>
#include <span>

#include "firmware/machine/model/machine.hpp"

namespace stiction::compensation {

// The shipped cross table with an estimated velocity and an encoder that is noisy: 2 nm rms.
machine::Machine cross_table();

struct Truth {
  const char* name;
  const char* text;
  void (*apply)(machine::AxisModel&);
  // Whether the figures asked for hold here; a contact without any presliding is no machine, but a limit.
  bool held = true;
};
std::span<const Truth> truths();

// On the plant alone: the drive keeps what the machine file says.
struct Change {
  const char* name;
  void (*apply)(machine::AxisModel&);
};
std::span<const Change> changes();

}  // namespace stiction::compensation
