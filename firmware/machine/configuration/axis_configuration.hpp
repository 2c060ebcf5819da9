// From the machine file's SI values to the drive's configuration, by way of the design that a drive maker writes
// himself (stiction/design/axis_design.hpp).
#pragma once

#include <stdexcept>
#include <string>

#include "firmware/machine/model/machine.hpp"
#include "stiction/design/axis_design.hpp"
#include "stiction/design/problems.hpp"
#include "stiction/drive/axis.hpp"

namespace stiction::machine {

// A parameter that the signal formats cannot hold. what() names the machine file's key, the value and the range.
class ConfigurationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The drive's part of an axis. Throws ConfigurationError for a motor or a source of the velocity that no drive has.
AxisDesign design_of(const Timing& timing, const AxisModel& axis);

// Throws ConfigurationError with the first of the `problems`, whose key is named from the file's root; `axis`: its
// name. Does nothing where there is none.
void refuse(const design::Problems& problems, const std::string& axis);

// S: FixedSignals or DoubleSignals. Throws ConfigurationError.
template <class S>
AxisConfig<S> configure_axis(const Timing& timing, const AxisModel& axis);

// Whole fast periods in a slow one.
int slow_ratio(const Timing& timing);
// The fast period in whole nanoseconds.
std::int64_t fast_period_ns(const Timing& timing);

}  // namespace stiction::machine
